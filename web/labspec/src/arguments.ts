import { LabspecError } from "./error.js";

/** What a value is, for messages. */
function described(x: unknown): string {
  if (x === null) return "null";
  if (Array.isArray(x)) return "an array";
  if (typeof x === "number") return String(x);
  if (typeof x === "object") return `an object (${Object.prototype.toString.call(x).slice(8, -1)})`;
  return typeof x === "undefined" ? "undefined" : `a ${typeof x}`;
}

function wrong(what: string, expected: string, x: unknown): LabspecError {
  return new LabspecError("wrong-type", `${what} must be ${expected}, not ${described(x)}`);
}

export function text(x: unknown, what: string): string {
  if (typeof x !== "string") throw wrong(what, "a string", x);
  return x;
}

export function number(x: unknown, what: string): number {
  if (typeof x !== "number") throw wrong(what, "a number", x);
  return x;
}

export function boolean(x: unknown, what: string): boolean {
  if (typeof x !== "boolean") throw wrong(what, "true or false", x);
  return x;
}

/** A count or an index. */
export function count(x: unknown, what: string, limit = 0xffff_ffff): number {
  if (typeof x !== "number" || !Number.isInteger(x) || x < 0 || x > limit) {
    throw wrong(what, `a whole number from 0 to ${limit}`, x);
  }
  return x;
}

/** A list of numbers: an array or a typed array; with a length when it is given. */
export function numbers(x: unknown, what: string, length?: number): Float64Array {
  let list: Float64Array;
  if (x instanceof Float64Array) list = x;
  else if (ArrayBuffer.isView(x) && !(x instanceof DataView) && !(x instanceof BigInt64Array) && !(x instanceof BigUint64Array)) {
    list = Float64Array.from(x as unknown as ArrayLike<number>);
  } else if (Array.isArray(x)) {
    for (const y of x as unknown[]) if (typeof y !== "number") throw wrong(`an element of ${what}`, "a number", y);
    list = Float64Array.from(x as number[]);
  } else throw wrong(what, "an array of numbers", x);
  if (length !== undefined && list.length !== length) {
    throw new LabspecError("wrong-length", `${what} must have ${length} numbers, not ${list.length}`);
  }
  return list;
}

export function bytes(x: unknown, what: string): Uint8Array {
  if (!(x instanceof Uint8Array)) throw wrong(what, "a Uint8Array", x);
  return x;
}

export function callback(x: unknown, what: string): void {
  if (typeof x !== "function") throw wrong(what, "a function", x);
}

/** Models by name and files by path. */
export function models(x: unknown): Record<string, string | Uint8Array> {
  const expected = "an object: names with MJCF as text or with compiled models as Uint8Array, and paths with files as Uint8Array";
  if (typeof x !== "object" || x === null || Array.isArray(x)) throw wrong("`models`", expected, x);
  const out: Record<string, string | Uint8Array> = {};
  for (const [name, content] of Object.entries(x as Record<string, unknown>)) {
    if (typeof content !== "string" && !(content instanceof Uint8Array)) {
      throw wrong(`the model "${name}"`, "MJCF as a string, or a compiled model or a file as a Uint8Array", content);
    }
    out[name] = content;
  }
  return out;
}
