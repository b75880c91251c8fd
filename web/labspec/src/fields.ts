import { LabspecError, call } from "./error.js";
import { numbers } from "./arguments.js";
import { buffer, ready } from "./glue.js";

/** A field as a typed array, with its dimensions. */
export type FieldView<T> = T & { readonly shape: readonly number[] };

/** One row of the table of fields. */
export interface Field {
  readonly index: number;
  readonly object: "model" | "opt" | "stat" | "data";
  readonly name: string;
  readonly elem: "f64" | "i32" | "bool" | "size";
  readonly dims: readonly string[];
  /** Whether it is seen where it lies in the module's memory. */
  readonly live: boolean;
  readonly writable: boolean;
}

let table: readonly Field[] | undefined;

/** The table of fields. */
export function fields(): readonly Field[] {
  if (table === undefined) {
    const rows = JSON.parse(ready().fieldTable()) as [Field["object"], string, Field["elem"], string[], boolean, boolean][];
    table = rows.map(([object, name, elem, dims, live, writable], index) => ({ index, object, name, elem, dims, live, writable }));
  }
  return table;
}

/** What has fields: a model or data, with the module's object behind it. */
export interface FieldSource {
  /** Address and count of a live field; without it, all fields are seen as copies. */
  place?(index: number): Uint32Array;
  /** A copy of a field. */
  copy(index: number): unknown;
  number(index: number): number;
  write(index: number, from: number, values: Float64Array): void;
  /** A size of the model by name; `undefined` when it changes with the state. */
  size(name: string): number | undefined;
  /** Keeps the owner of a view alive as long as the view. */
  keep(view: object): void;
}

interface Cached {
  view: Float64Array | Int32Array | Uint8Array;
  address: number;
  /** For truth values: what they were when they were last the same in both places. */
  held?: Uint8Array;
}

/** The fields of one object: typed arrays that are made again when memory has grown. */
export class FieldCache {
  readonly #source: FieldSource;
  readonly #cached = new Map<number, Cached>();
  readonly #flags: [number, Cached][] = [];

  constructor(source: FieldSource) {
    this.#source = source;
  }

  shape(field: Field, length: number): number[] {
    const known = field.dims.map((dim) => (/^\d+$/.test(dim) ? Number(dim) : this.#source.size(dim)));
    const others = known.reduce<number>((product, dim) => product * (dim ?? 1), 1);
    return known.map((dim) => dim ?? (others > 0 ? length / others : 0));
  }

  get(field: Field): unknown {
    if (field.dims.length === 0) {
      const x = this.#source.number(field.index);
      return field.elem === "bool" ? x !== 0 : x;
    }
    const before = this.#cached.get(field.index);
    if (field.live && this.#source.place !== undefined) {
      const place = this.#source.place(field.index);
      const [address, length] = [place[0] ?? 0, place[1] ?? 0];
      if (before !== undefined && before.view.buffer === buffer() && before.address === address && before.view.length === length) {
        return before.view;
      }
      const make = field.elem === "f64" ? Float64Array : Int32Array;
      const view = new make(buffer(), address, length);
      this.#describe(field, view);
      this.#source.keep(view);
      this.#cached.set(field.index, { view, address });
      return view;
    }
    if (field.elem === "bool" && this.#source.place !== undefined) {
      if (before !== undefined) return before.view;
      const view = this.#source.copy(field.index) as Uint8Array;
      this.#describe(field, view);
      const cached = { view, address: 0, held: view.slice() };
      this.#cached.set(field.index, cached);
      if (field.writable) this.#flags.push([field.index, cached]);
      return view;
    }
    const view = this.#source.copy(field.index) as Float64Array | Int32Array;
    this.#describe(field, view);
    return view;
  }

  set(field: Field, value: unknown): void {
    if (this.#source.place === undefined) return this.#source.write(field.index, 0, new Float64Array(0));
    if (!field.writable) {
      throw new LabspecError("read-only", `\`${field.name}\` cannot be written: the engine computes it or indexes by it`);
    }
    const scalar = field.dims.length === 0;
    if (scalar && typeof value !== "number" && typeof value !== "boolean") {
      throw new LabspecError("wrong-type", `\`${field.name}\` is a number`);
    }
    const list = scalar ? Float64Array.of(Number(value)) : numbers(value, `\`${field.name}\``);
    if (!scalar) {
      const length = (this.get(field) as ArrayLike<number>).length;
      if (list.length !== length) {
        throw new LabspecError("wrong-length", `\`${field.name}\` must have ${length} numbers, not ${list.length}`);
      }
    }
    call(() => this.#source.write(field.index, 0, list));
    this.refresh();
  }

  /** Gives the module what was written into truth values. */
  flush(): void {
    for (const [index, { view, held }] of this.#flags) {
      for (let i = 0; held !== undefined && i < view.length; i++) {
        const now = view[i] === 0 ? 0 : 1;
        if (now !== held[i]) {
          this.#source.write(index, i, Float64Array.of(now));
          held[i] = now;
        }
      }
    }
  }

  /** Takes from the module what truth values are now. */
  refresh(): void {
    for (const [index, { view, held }] of this.#flags) {
      const now = this.#source.copy(index) as Uint8Array;
      if (now.length === view.length) {
        view.set(now);
        held?.set(now);
      }
    }
  }

  #describe(field: Field, view: object): void {
    const length = (view as ArrayLike<number>).length;
    Object.defineProperty(view, "shape", { value: Object.freeze(this.shape(field, length)) });
  }
}

/** Objects whose class has its fields as properties. */
const done = new WeakSet<object>();

/** Gives a class the fields of an object as properties. */
export function defineFields(prototype: object, object: Field["object"], cache: (of: never) => FieldCache): void {
  if (done.has(prototype)) return;
  done.add(prototype);
  for (const field of fields()) {
    if (field.object !== object || field.name in prototype) continue;
    Object.defineProperty(prototype, field.name, {
      configurable: true,
      enumerable: true,
      get(this: never) {
        const from = cache(this);
        return call(() => from.get(field));
      },
      set(this: never, value: unknown) {
        cache(this).set(field, value);
      },
    });
  }
}
