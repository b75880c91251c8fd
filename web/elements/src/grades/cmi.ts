/**
 * Values of the data model of SCORM 2004 4th edition (SCORM Run-Time Environment, section 4.2): what a page writes is in the form that
 * a learning system accepts, and what it reads is checked.
 */
import { isObject } from "../spec.js";
import type { ActivityTotals } from "./activity.js";
import { INTERACTIONS, questionId, responseOf, type QuizAnswer } from "./xapi.js";

/** An element of the data model, and its value. */
export type Setting = readonly [element: string, value: string];

/** Characters that every learning system keeps of `cmi.suspend_data`, and of the response to a long question. */
const MOST_STATE = 64_000;
const MOST_RESPONSE = 4000;
/** Characters of each text when a state is shortened, tried in this order. */
const SHORTER = [4000, 1000, 100, 0];

/** A number with seven decimals, as the data model has it. */
export const realOf = (x: number): string => String(Number(x.toFixed(7)));

/** A time of day in UTC, to the second. */
export const timestampOf = (date: Date): string => `${date.toISOString().slice(0, 19)}Z`;

/** A length of time, s, to the hundredth. */
export const durationOf = (seconds: number): string => `PT${Math.max(0, seconds).toFixed(2)}S`;

/** A share from 0 to 1; null for another text. */
export function shareOf(text: string | null): number | null {
  const value = text === null || text.trim() === "" ? NaN : Number(text);
  return value >= 0 && value <= 1 ? value : null;
}

/** A count; null for another text. */
export function countOf(text: string): number | null {
  return /^\d{1,6}$/.test(text) ? Number(text) : null;
}

/** The states of quizzes in `cmi.suspend_data`; empty where it holds something else. */
export function readStates(text: string): Readonly<Record<string, unknown>> {
  if (text.length > MOST_STATE) return {};
  try {
    const json: unknown = JSON.parse(text);
    return isObject(json) && isObject(json["quizzes"]) ? json["quizzes"] : {};
  } catch {
    return {};
  }
}

/** States of quizzes as `cmi.suspend_data`. Where they are too long, texts are shortened; null where that is not enough. */
export function writeStates(states: Readonly<Record<string, unknown>>): string | null {
  const write = (most: number): string => JSON.stringify({ quizzes: states }, (key, value: unknown) => (key === "text" && typeof value === "string" ? value.slice(0, most) : value));
  return [Infinity, ...SHORTER].map(write).find((text) => text.length <= MOST_STATE) ?? null;
}

/** A text as a localized string: braces at its start would be read as a mark of a language. */
function localized(text: string): string {
  return (text.startsWith("{") ? `{lang=en}${text}` : text).slice(0, MOST_RESPONSE);
}

/** An answer as the interaction `n`. The id comes first, the type before the response. */
export function interactionOf(detail: QuizAnswer, n: number, now: Date): Setting[] {
  const response = responseOf(detail);
  // The data model has no exponents.
  const isPlain = detail.kind !== "numeric" || /^-?\d{1,15}(\.\d{1,15})?$/.test(response);
  const type = isPlain ? (INTERACTIONS[detail.kind] ?? "other") : "long-fill-in";
  const result = detail.correct === null ? "neutral" : detail.correct ? "correct" : "incorrect";
  const value = typeof detail.answer === "string" && type !== "numeric" ? localized(response) : response;
  const settings: Setting[] = [["id", questionId(detail)], ["type", type], ["timestamp", timestampOf(now)], ["learner_response", value], ["result", result]];
  return settings.map(([element, text]) => [`cmi.interactions.${n}.${element}`, text]);
}

/** The score of a page. A page without graded questions has none. */
export function scoreOf({ right, count }: ActivityTotals): Setting[] {
  if (count === 0) return [];
  return [["cmi.score.scaled", realOf(right / count)], ["cmi.score.raw", String(right)], ["cmi.score.min", "0"], ["cmi.score.max", String(count)]];
}

/** How far a page is: completed once every question is answered, and passed or failed where there is a share to pass. */
export function statusOf({ right, count }: ActivityTotals, isCompleted: boolean, passing: number | null): Setting[] {
  const completion: Setting = ["cmi.completion_status", isCompleted ? "completed" : "incomplete"];
  if (count === 0 || passing === null) return [completion];
  const isPassed = right / count >= passing;
  return [completion, ["cmi.success_status", isPassed ? "passed" : isCompleted ? "failed" : "unknown"]];
}
