/** What a fence of a lesson is, and its JSON without what only a check reads. */

/** An object of JSON. */
export type Json = Readonly<Record<string, unknown>>;

/** The kinds of fences that become elements. */
export type FenceKind = "lab" | "quiz";

/** A fence that cannot become an element. The message is a part of a sentence: lower case, without a full stop. */
export class FenceError extends Error {}

/** Whether a value of JSON is an object. */
export function isObject(x: unknown): x is Json {
  return typeof x === "object" && x !== null && !Array.isArray(x);
}

/**
 * The kind of a fence by its info string: `lab`, `lab simlab`, `lab integrators` and `quiz`, with attributes after them. `null` for any other
 * fence, and for labs of other widgets, which are left as they are.
 */
export function fenceKind(info: string): FenceKind | null {
  const [first, second = "simlab"] = info.trim().split(/\s+/);
  if (first === "quiz") return "quiz";
  return first === "lab" && (second === "simlab" || second === "integrators" || second.startsWith("{")) ? "lab" : null;
}

/** The content of a fence as the elements need it: they recognize a comparison by its list of integrators, and an empty list names all. */
export function withComparison(info: string, content: Json): Json {
  const compares = /^\s*lab\s+integrators(?:\s|$)/.test(info);
  return compares && !Array.isArray(content["integrators"]) ? { ...content, integrators: [] } : content;
}

/** Reads the JSON of a fence without `verify` and `lint`. Throws a `FenceError`. */
export function readFence(text: string): Json {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch (e) {
    throw new FenceError(`invalid JSON (${messageOf(e)})`);
  }
  if (!isObject(value)) throw new FenceError("its JSON is not an object");
  return withoutClaims(value);
}

/** A lab or a quiz without the objects that only a check reads: its own and those of its questions and their labs. */
function withoutClaims(content: Json): Json {
  const kept = Object.entries(content).filter(([key]) => key !== "verify" && key !== "lint");
  return Object.fromEntries(kept.map(([key, value]) => [key, key === "questions" && Array.isArray(value) ? value.map(questionWithoutClaims) : value]));
}

function questionWithoutClaims(question: unknown): unknown {
  if (!isObject(question)) return question;
  const kept = Object.entries(withoutClaims(question));
  return Object.fromEntries(kept.map(([key, value]) => [key, key === "sim" && isObject(value) ? withoutClaims(value) : value]));
}

/** Changes each lab of a content: the content itself, or the labs of the questions of a quiz. */
export function mapLabs(kind: FenceKind, content: Json, change: (lab: Json) => Json): Json {
  if (kind === "lab") return change(content);
  const questions = content["questions"];
  if (!Array.isArray(questions)) return content;
  const changed = (questions as unknown[]).map((question) => {
    if (!isObject(question)) return question;
    const sim = question["sim"];
    return isObject(sim) ? { ...question, sim: change(sim) } : question;
  });
  return { ...content, questions: changed };
}

/** JSON on one line. Throws a `FenceError` for numbers that JSON cannot have. */
export function toJson(content: Json): string {
  const finite = (_: string, value: unknown): unknown => {
    if (typeof value === "number" && !Number.isFinite(value)) throw new FenceError("a number is out of range");
    return value;
  };
  try {
    return JSON.stringify(content, finite);
  } catch (e) {
    // A text with a hundred thousand brackets exhausts the stack.
    throw e instanceof FenceError ? e : new FenceError(`the JSON cannot be written (${messageOf(e)})`);
  }
}

/** The message of an error on one line: those of JSON quote the text. */
function messageOf(e: unknown): string {
  return (e instanceof Error ? e.message : String(e)).replace(/\s+/g, " ");
}
