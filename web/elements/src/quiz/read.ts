/** Reads the questions of a quiz from JSON, with messages about mistakes. */
import { isObject, listOf, numberOf, textOf, type Json } from "../spec.js";
import type { Say } from "../text/messages.js";

/** The right answer: an index, indexes, or the hash of it. */
export type Key = { readonly choice: readonly number[] } | { readonly salt: string; readonly sha256: string };

interface Common {
  /** HTML. */
  readonly q: string;
  readonly explain: string | null;
  readonly label: string | null;
}

export interface ChoiceQuestion extends Common {
  readonly kind: "mcq" | "debug" | "predict" | "multiple" | "truefalse";
  readonly options: readonly string[];
  readonly key: Key;
  /** The number of tries. */
  readonly attempts: number;
  /** The lab of a prediction. */
  readonly sim: Json | null;
}

export interface NumericQuestion extends Common {
  readonly kind: "numeric";
  readonly answer: number;
  readonly tol: number;
  readonly unit: string;
  /** The number of tries; `Infinity` without a limit. */
  readonly attempts: number;
}

export interface OpenQuestion extends Common {
  readonly kind: "open" | "code";
  readonly reference: string | null;
}

export type Question = ChoiceQuestion | NumericQuestion | OpenQuestion;

export interface QuizSpec {
  readonly id: string;
  readonly title: string | null;
  readonly questions: readonly (Question | { readonly kind: "broken"; readonly why: string })[];
}

export function readQuiz(json: Json, say: Say): QuizSpec | null {
  if (!Array.isArray(json["questions"])) return null;
  const questions = listOf(json["questions"]).map((question) => {
    try {
      return readQuestion(isObject(question) ? question : {}, say);
    } catch (e) {
      return { kind: "broken" as const, why: e instanceof Error ? e.message : String(e) };
    }
  });
  return { id: textOf(json["id"]) ?? "", title: textOf(json["title"]), questions };
}

function readQuestion(json: Json, say: Say): Question {
  const q = textOf(json["q"]);
  if (q === null) throw new Error(say("needsText"));
  const kind = textOf(json["kind"]) ?? "mcq";
  const common = { q, explain: textOf(json["explain"]), label: textOf(json["label"]) };
  const attempts = numberOf(json["attempts"]);
  switch (kind) {
    case "mcq": case "debug": case "predict": case "multiple": case "truefalse":
      return { ...common, kind, ...readChoices(json, kind, say), attempts: Math.max(1, attempts ?? 1), sim: isObject(json["sim"]) ? json["sim"] : null };
    case "numeric": {
      const answer = numberOf(json["answer"]);
      if (answer === null) throw new Error(say("needsNumber"));
      const tol = numberOf(json["tol"]) ?? 0.02 * Math.abs(answer);
      return { ...common, kind, answer, tol, unit: textOf(json["unit"]) ?? "", attempts: Math.max(1, attempts ?? Infinity) };
    }
    case "open": case "code": return { ...common, kind, reference: textOf(json["reference"]) };
    default: throw new Error(say("unknownKind", { kind }));
  }
}

function readChoices(json: Json, kind: string, say: Say): { options: readonly string[]; key: Key } {
  const given = listOf(json["options"]).filter((option): option is string => typeof option === "string");
  const options = kind === "truefalse" ? [say("isTrue"), say("isFalse")] : given;
  if (options.length < 2) throw new Error(say("needsOptions"));
  const { hash } = json;
  if (hash !== undefined) {
    const salt = isObject(hash) ? textOf(hash["salt"]) : null;
    const digest = isObject(hash) ? textOf(hash["sha256"]) : null;
    if (salt === null || digest === null || !/^[0-9a-f]{64}$/i.test(digest)) throw new Error(say("needsHash"));
    return { options, key: { salt, sha256: digest.toLowerCase() } };
  }
  const { answer } = json;
  const choice = kind === "truefalse" ? (typeof answer === "boolean" ? [answer ? 0 : 1] : []) : kind === "multiple" ? listOf(answer) : [answer];
  const isOption = (x: unknown): x is number => typeof x === "number" && Number.isInteger(x) && x >= 0 && x < options.length;
  if (!choice.every(isOption) || (choice.length === 0 && kind !== "multiple")) throw new Error(say("needsAnswer"));
  return { options, key: { choice: [...choice].sort((a, b) => a - b) } };
}
