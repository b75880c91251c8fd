/** The answers of a reader, which the browser stores under `id#index`. If the page forbids storage, nothing is stored. */
import { isObject, listOf, numberOf, textOf } from "../spec.js";

/** An answer: chosen options, or a text; the number of tries, and whether the last one was right. */
export interface Stored {
  readonly choice: readonly number[];
  readonly text: string;
  readonly tries: number;
  readonly isRight: boolean | null;
  readonly isDone: boolean;
}

const PREFIX = "labspec-quiz:";

/** An answer from data of any origin; null where it is none. */
export function readAnswer(json: unknown): Stored | null {
  if (!isObject(json)) return null;
  const isIndex = (x: unknown): x is number => typeof x === "number" && Number.isInteger(x) && x >= 0;
  const right = json["isRight"];
  return {
    choice: listOf(json["choice"]).filter(isIndex).slice(0, 100), text: (textOf(json["text"]) ?? "").slice(0, 100_000),
    tries: Math.max(0, numberOf(json["tries"]) ?? 0), isRight: typeof right === "boolean" ? right : null, isDone: json["isDone"] === true,
  };
}

export function loadAnswer(quiz: string, index: number): Stored | null {
  if (quiz === "") return null;
  try {
    const text = localStorage.getItem(`${PREFIX}${quiz}#${index}`);
    return text === null ? null : readAnswer(JSON.parse(text));
  } catch {
    return null;
  }
}

export function storeAnswer(quiz: string, index: number, answer: Stored | null): void {
  if (quiz === "") return;
  try {
    const name = `${PREFIX}${quiz}#${index}`;
    if (answer === null) localStorage.removeItem(name);
    else localStorage.setItem(name, JSON.stringify(answer));
  } catch {
    // A page without storage starts anew after a reload.
  }
}
