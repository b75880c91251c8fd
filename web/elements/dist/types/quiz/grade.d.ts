import type { ChoiceQuestion, NumericQuestion } from "./read.js";
/** A choice of options, by their places. */
export declare function isRightChoice(question: ChoiceQuestion, choice: readonly number[]): boolean;
/** Whether an option is a right one; `null` where only its hash is known. */
export declare function isRightOption(question: ChoiceQuestion, option: number): boolean | null;
/** A number is right when it is at most the tolerance away, as in the lab format. */
export declare function isRightNumber(question: NumericQuestion, given: number): boolean;
