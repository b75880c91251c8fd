import * as check from "./arguments.js";
import { LabspecError, call } from "./error.js";
import { ready } from "./glue.js";
import { Data, Model } from "./model.js";
import { EXPRESSION, weight } from "./weight.js";
import type { RawExpression } from "#glue";

/** A value of an expression. */
export type ExpressionValue = number | string | boolean | null;

/** An expression or statements of the accessor language, compiled for a model: names, indexes and types are checked. */
export class Expression {
  #raw: RawExpression | undefined;
  #weight: ArrayBuffer | undefined = weight(EXPRESSION);
  readonly #texts: ReadonlyMap<string, string>;
  /** The number of texts that were compiled together. */
  readonly count: number;

  /** Compiles a text, or several that share their `ctx` variables. */
  constructor(model: Model, text: string | readonly string[], kind: "expression" | "statements" = "expression") {
    if (!(model instanceof Model)) throw new LabspecError("wrong-type", "an `Expression` must be created with a `Model`");
    const list = Array.isArray(text) ? (text as unknown[]).map((t) => check.text(t, "an expression")) : [check.text(text, "an expression")];
    if (kind !== "expression" && kind !== "statements") throw new LabspecError("wrong-type", "a text is an `expression` or `statements`");
    this.#texts = new Map(list.map((t, i) => [i === 0 ? "expression" : `expression ${i + 1}`, t]));
    this.count = list.length;
    const glue = ready();
    this.#raw = call(() => new glue.RawExpression(Model.use(model), list, kind === "statements"), this.#texts);
  }

  /** Its value now. */
  evaluate(data: Data, at = 0): ExpressionValue {
    return this.#with(data, at, (raw, d, m, i) => raw.value(m, d, i) as ExpressionValue);
  }

  /** Its value as a number; NaN for any other value. */
  number(data: Data, at = 0): number {
    return this.#with(data, at, (raw, d, m, i) => raw.number(m, d, i));
  }

  /** The values now and after each of a number of steps: a column for each text. */
  record(data: Data, steps: number): Float64Array[] {
    const most = check.count(steps, "the number of steps");
    const flat = this.#with(data, 0, (raw, d, m) => raw.record(m, d, most));
    return Array.from({ length: this.count }, (_, i) => flat.subarray(i * (most + 1), (i + 1) * (most + 1)));
  }

  /** Releases the memory. Otherwise the garbage collector does so later. */
  free(): void {
    this.#raw?.free();
    [this.#raw, this.#weight] = [undefined, undefined];
  }

  [Symbol.dispose](): void {
    this.free();
  }

  #with<T>(
    data: Data,
    at: number,
    what: (raw: RawExpression, d: Parameters<RawExpression["number"]>[1], m: Parameters<RawExpression["number"]>[0], i: number) => T,
  ): T {
    if (!(data instanceof Data)) throw new LabspecError("wrong-type", "an expression must be evaluated with `Data`");
    const index = check.count(at, "the number of an expression");
    const raw = this.#raw;
    if (raw === undefined) throw new LabspecError("freed", "this expression was freed");
    return call(() => Data.use(data, (d, m) => call(() => what(raw, d, m, index), this.#texts)), this.#texts);
  }
}
