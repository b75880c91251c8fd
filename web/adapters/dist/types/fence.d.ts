/** What a fence of a lesson is, and its JSON without what only a check reads. */
/** An object of JSON. */
export type Json = Readonly<Record<string, unknown>>;
/** The kinds of fences that become elements. */
export type FenceKind = "lab" | "quiz";
/** A fence that cannot become an element. The message is a part of a sentence: lower case, without a full stop. */
export declare class FenceError extends Error {
}
/** Whether a value of JSON is an object. */
export declare function isObject(x: unknown): x is Json;
/**
 * The kind of a fence by its info string: `lab`, `lab simlab` and `quiz`, with attributes after them. `null` for any other fence, and for
 * labs of other widgets, which are left as they are.
 */
export declare function fenceKind(info: string): FenceKind | null;
/** Reads the JSON of a fence without `verify` and `lint`. Throws a `FenceError`. */
export declare function readFence(text: string): Json;
/** Changes each lab of a content: the content itself, or the labs of the questions of a quiz. */
export declare function mapLabs(kind: FenceKind, content: Json, change: (lab: Json) => Json): Json;
/** JSON on one line. Throws a `FenceError` for numbers that JSON cannot have. */
export declare function toJson(content: Json): string;
