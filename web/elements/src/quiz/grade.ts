/** Whether an answer is right. */
import { hashAnswer } from "./hash.js";
import type { ChoiceQuestion, NumericQuestion } from "./read.js";

/** A choice of options, by their places. */
export function isRightChoice(question: ChoiceQuestion, choice: readonly number[]): boolean {
  const sorted = [...choice].sort((a, b) => a - b);
  const { key, kind } = question;
  if ("choice" in key) return key.choice.length === sorted.length && key.choice.every((option, i) => option === sorted[i]);
  const first = sorted[0] ?? -1;
  const said = kind === "multiple" ? sorted : kind === "truefalse" ? first === 0 : first;
  return hashAnswer(key.salt, said) === key.sha256;
}

/**
 * Whether an option is correct; `null` where only the hash of the answer is available, and the verdict `isRight` on a choice does not tell: a
 * wrong choice of several options may contain right ones.
 */
export function isRightOption(question: ChoiceQuestion, option: number, choice: readonly number[], isRight: boolean): boolean | null {
  if ("choice" in question.key) return question.key.choice.includes(option);
  if (!choice.includes(option)) return null;
  return isRight ? true : question.kind === "multiple" ? null : false;
}

/** A number is right when it is at most the tolerance away, as in the lab format. */
export function isRightNumber(question: NumericQuestion, given: number): boolean {
  return Math.abs(given - question.answer) <= question.tol;
}
