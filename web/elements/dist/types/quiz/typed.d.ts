import { type Card, type CardContext } from "./card.js";
import type { NumericQuestion, OpenQuestion } from "./read.js";
export declare function createNumeric(question: NumericQuestion, context: CardContext): Card;
export declare function createOpen(question: OpenQuestion, context: CardContext): Card;
