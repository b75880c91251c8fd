/** Questions with options: one of several, several of several, true or false, and predictions, which a lab answers. */
import type { Models } from "labspec/slim";
import { type Card, type CardContext } from "./card.js";
import type { ChoiceQuestion } from "./read.js";
export declare function createChoice(question: ChoiceQuestion, context: CardContext, models: Models | null): Card;
