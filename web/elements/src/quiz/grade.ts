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

/** Whether an option is correct, or `null` if only the hash of the answer is available. */
export function isRightOption(question: ChoiceQuestion, option: number): boolean | null {
  return "choice" in question.key ? question.key.choice.includes(option) : null;
}

/** A number is right when it is at most the tolerance away, as in the lab format. */
export function isRightNumber(question: NumericQuestion, given: number): boolean {
  return Math.abs(given - question.answer) <= question.tol;
}
