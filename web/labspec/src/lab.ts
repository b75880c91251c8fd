import * as check from "./arguments.js";
import { contactsOf, type ContactInfo } from "./contact.js";
import { LabspecError, asLabspecError, call, locate, type Finding } from "./error.js";
import type { DataFields, ModelFields, OptionFields, StatisticFields } from "./field-types.js";
import { FieldCache, defineFields, type FieldSource, fields } from "./fields.js";
import { ready } from "./glue.js";
import { Model, type ObjectKind } from "./model.js";
import { LAB, STATE, weight } from "./weight.js";
import type { Lab as RawLab, State as RawState } from "#glue";

/** Models by name (MJCF), and files that they name, by path. */
export type Models = Readonly<Record<string, string | Uint8Array>>;

/** What a control can be set to. */
export type ControlValue = number | string | boolean;

/** A slider, a select or a button. */
export interface Control {
  readonly kind: "slider" | "select" | "button";
  readonly label: string;
  readonly start: ControlValue | null;
  readonly min?: number;
  readonly max?: number;
  readonly step?: number;
  readonly unit?: string;
  readonly digits?: number;
  /** Text and value of each option. */
  readonly options?: readonly (readonly [string, ControlValue | null])[];
}

/** A trace of a plot, or a readout. */
export interface Shown {
  readonly label: string;
  readonly unit: string;
  /** The plot of a trace, from 0. */
  readonly plot?: number;
  /** The decimals of a readout. */
  readonly digits?: number;
}

/** What `lab.on` reports, by type. */
export interface LabEvents {
  /** Two geoms begin or cease to touch. */
  contact: { readonly time: number; readonly geom1: number; readonly geom2: number; readonly touching: boolean };
  /** A shown number crosses a level. */
  crossing: { readonly time: number; readonly index: number; readonly level: number; readonly value: number; readonly rising: boolean };
  /** Something broke. */
  finding: Finding;
  /** The lab has stopped by itself. */
  end: { readonly time: number };
}

/** The number and level of a crossing: the number by its place in `shown`, or by its label. */
export interface Crossing {
  readonly number: number | string;
  readonly level: number;
}

/** Options of `play`. */
export interface PlayOptions {
  /** Cancels: the lab then stands where it got to. */
  readonly signal?: AbortSignal;
  /** Milliseconds of work before the page gets its turn; 8 when not given. */
  readonly budget?: number;
  /** Called after each piece of work. */
  readonly onProgress?: (time: number) => void;
}

/** What a student did, so that it can be done again. */
type Action = readonly ["play", number] | readonly ["set", string, ControlValue] | readonly ["press", string] | readonly ["reset"]
  | readonly ["force", number, readonly number[]];

interface Watch {
  readonly index: number;
  readonly level: number;
  readonly listener: (event: LabEvents["crossing"]) => void;
  over: boolean;
}

/** Most steps of one call of the module in a loop. */
const PIECE = 100_000;
const FORMAT = 1;

/** A state of a lab, to come back to. */
export class LabState {
  readonly #raw: RawState;
  readonly #actions: readonly Action[];
  readonly #lab: string;
  readonly #weight = weight(STATE);

  /** @internal */
  constructor(raw: RawState, actions: readonly Action[], lab: string) {
    [this.#raw, this.#actions, this.#lab] = [raw, actions, lab];
  }

  /** @internal */
  static parts(state: LabState): { raw: RawState; actions: readonly Action[] } {
    return { raw: state.#raw, actions: state.#actions };
  }

  /** The state as bytes, for `Lab.resume`: what was done to the lab since it was opened. */
  toBytes(): Uint8Array {
    const content = { format: FORMAT, lab: this.#lab, actions: this.#actions };
    void this.#weight;
    return new TextEncoder().encode(JSON.stringify({ labspec: content }));
  }
}

/** A number for the texts of a lab. */
function fingerprint(json: string, models: Models): string {
  let [a, b] = [0x811c9dc5, 0x1b873593];
  const take = (code: number): void => {
    a = Math.imul(a ^ code, 0x01000193);
    b = Math.imul(b + code, 0x85ebca6b) ^ (b >>> 13);
  };
  const feed = (part: string | Uint8Array): void => {
    if (typeof part === "string") for (let i = 0; i < part.length; i++) take(part.charCodeAt(i));
    else part.forEach(take);
    take(0x10000);
  };
  feed(json);
  Object.keys(models).sort().forEach((name) => {
    feed(name);
    feed(models[name] ?? "");
  });
  return (a >>> 0).toString(16).padStart(8, "0") + (b >>> 0).toString(16).padStart(8, "0");
}

/** The fields of the data of a lab, as copies. */
export interface LabData extends Readonly<DataFields> {}
/** The fields of the model of a lab, as copies. */
export interface LabModel extends Readonly<ModelFields> {
  readonly opt: Readonly<OptionFields>;
  readonly stat: Readonly<StatisticFields>;
}

class LabFields {
  readonly cache: FieldCache;

  constructor(cache: FieldCache) {
    this.cache = cache;
  }
}
class DataOfLab extends LabFields {}
class OptionsOfLab extends LabFields {}
class StatisticOfLab extends LabFields {}
class ModelOfLab extends LabFields {
  readonly opt: OptionsOfLab;
  readonly stat: StatisticOfLab;

  constructor(cache: FieldCache) {
    super(cache);
    [this.opt, this.stat] = [new OptionsOfLab(cache), new StatisticOfLab(cache)];
  }
}

/** Gives the event loop its turn: timers and input alike, which `scheduler.yield` lets wait. */
function turn(): Promise<void> {
  const immediate = (globalThis as { setImmediate?: (resolve: () => void) => void }).setImmediate;
  return new Promise((resolve) => {
    if (immediate !== undefined) return immediate(resolve);
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(0);
  });
}

/** A lab that the module has opened already. */
class Opened {
  constructor(
    readonly raw: RawLab,
    readonly text: string,
    readonly models: Models,
    readonly texts: ReadonlyMap<string, string>,
  ) {}
}

/** A lab that is open on a page. */
export class Lab {
  #raw: RawLab | undefined;
  readonly #json: string;
  readonly #models: Models;
  readonly #texts: ReadonlyMap<string, string>;
  #actions: Action[] = [];
  readonly #listeners = new Map<string, Set<(event: never) => void>>();
  readonly #watches = new Set<Watch>();
  #touching = new Set<string>();
  #reported = 0;
  #ended = false;
  #poses: Float32Array | undefined;
  #data: LabData | undefined;
  #model: LabModel | undefined;
  #weight: ArrayBuffer | undefined = weight(LAB);

  /** Opens a lab from its JSON (text, or the object itself). `models` are the models that it names. */
  constructor(json: string | object, models: Models = {}) {
    if (json instanceof Opened) {
      [this.#json, this.#models, this.#texts, this.#raw] = [json.text, json.models, json.texts, json.raw];
      this.#reported = this.findings.length;
      return;
    }
    const text = typeof json === "object" && json !== null ? call(() => JSON.stringify(json)) : check.text(json, "a lab");
    const own = check.models(models);
    const texts = new Map<string, string>([["lab.json", text]]);
    for (const [name, content] of Object.entries(own)) if (typeof content === "string") texts.set(name, content);
    [this.#json, this.#models, this.#texts] = [text, own, texts];
    const glue = ready();
    this.#raw = call(() => new glue.Lab(text, own), texts);
    this.#reported = this.findings.length;
  }

  /**
   * Opens a lab of a lesson (Markdown or JSON, by the ending of `path`): `#2` is the second one, `#quiz-id.1` that of a question.
   * Of `labspec/checker`: the player does not read Markdown.
   */
  static ofLesson(path: string, lesson: string, address: string, models: Models = {}): Lab {
    const [where, content, which] = [check.text(path, "a path"), check.text(lesson, "a lesson"), check.text(address, "an address")];
    const own = check.models(models);
    const texts = new Map<string, string>([[where, content]]);
    const { ofLesson } = ready().Lab as unknown as { ofLesson?: (...args: unknown[]) => RawLab };
    if (ofLesson === undefined) {
      throw new LabspecError("not-in-player", "the player does not read lessons: import Lab from \"labspec/checker\", or pass the JSON of the lab");
    }
    const raw = call(() => ofLesson(where, content, which, own), texts);
    return new Lab(new Opened(raw, content, own, texts) as unknown as string);
  }

  /** The controls, in the order in which they are drawn. */
  get controls(): readonly Control[] {
    return call(() => this.#lab().controls) as readonly Control[];
  }

  /** The traces of the plots, then the readouts: what `numbers` holds, in its order. */
  get shown(): readonly Shown[] {
    return call(() => this.#lab().shown);
  }

  /** Simulated time, s. */
  get time(): number {
    return this.#lab().time;
  }

  /** Length of a step now, s. */
  get timestep(): number {
    return this.#lab().timestep;
  }

  /** Whether the lab stands still until it is reset. */
  get isOver(): boolean {
    return this.#lab().isOver;
  }

  /** What every trace and readout shows now; NaN where it is not a number. A copy. */
  get numbers(): Float64Array {
    return call(() => this.#lab().numbers.slice());
  }

  /** What each readout shows now, as the page prints it. */
  get readoutTexts(): readonly string[] {
    return call(() => this.#lab().readoutTexts);
  }

  /** What was found when the lab was opened, and what broke since. */
  get findings(): readonly Finding[] {
    return call(() => locate(this.#lab().findings, this.#texts));
  }

  /** The current value of a control; `null` for a button, or where there is no such control. */
  value(label: string): ControlValue | null {
    const which = check.text(label, "a label");
    return call(() => this.#lab().value(which) as ControlValue | null);
  }

  /** Moves a slider, or chooses an option by its value or its text. */
  set(label: string, value: ControlValue): void {
    const which = check.text(label, "a label");
    if (typeof value !== "number" && typeof value !== "string" && typeof value !== "boolean") {
      throw new LabspecError("wrong-type", "a control takes a number, a string, true or false");
    }
    this.#do(["set", which, value], (raw) => raw.set(which, value));
  }

  /** Presses a button. */
  press(label: string): void {
    const which = check.text(label, "a label");
    this.#do(["press", which], (raw) => raw.press(which));
  }

  /**
   * Sets the force (N) and the torque (N m) at the centre of mass of a body, six numbers in world axes: its row of `xfrc_applied`. They
   * act in every step until they are set again or the lab is reset.
   */
  applyForce(body: number, force: ArrayLike<number>): void {
    const [which, given] = [check.count(body, "a body"), Array.from(check.numbers(force, "a force", 6))];
    this.#do(["force", which, given], (raw) => raw.applyForce(which, Float64Array.from(given)));
  }

  /** Back to the start, as the page's button does it: controls and model keep what they hold. */
  reset(): void {
    this.#ended = false;
    this.#do(["reset"], (raw) => raw.reset());
  }

  /** One step, or several. */
  step(steps = 1): void {
    const most = check.count(steps, "the number of steps", 100_000_000);
    for (let i = 0; i < most; i++) this.#do(["play", 1], (raw) => raw.step());
  }

  /** Plays until a time (s), or until the lab stops by itself; returns the number of steps. */
  playTo(time: number): number {
    const until = check.number(time, "a time");
    if (this.#listeners.size === 0 && this.#watches.size === 0) {
      return this.#played(() => call(() => this.#lab().playTo(until)));
    }
    let made = 0;
    for (;;) {
      const [more, done] = this.#advance(until, PIECE);
      made += more;
      if (done) return made;
    }
  }

  /** The same in pieces, between which the page gets its turn. */
  async play(time: number, options: PlayOptions = {}): Promise<number> {
    const until = check.number(time, "a time");
    if (typeof options !== "object" || options === null) throw new LabspecError("wrong-type", "options are an object");
    const { signal, budget = 8, onProgress } = options;
    check.number(budget, "a budget");
    if (onProgress !== undefined) check.callback(onProgress, "`onProgress`");
    let [made, piece] = [0, 16];
    for (;;) {
      const deadline = performance.now() + Math.max(budget, 1);
      for (;;) {
        if (signal?.aborted === true) throw new LabspecError("aborted", `the run was cancelled at ${this.time} s`);
        const before = performance.now();
        const [more, done] = this.#advance(until, piece);
        made += more;
        if (done) {
          onProgress?.(this.time);
          return made;
        }
        const now = performance.now();
        // Half of what is left, as fast as the last steps were.
        const speed = more / Math.max(now - before, 0.01);
        piece = Math.min(PIECE, Math.max(1, Math.floor((speed * Math.max(budget, 1)) / 4)));
        if (now >= deadline) break;
      }
      onProgress?.(this.time);
      await turn();
    }
  }

  /** Makes so many steps, and gives a row for the start and for every step: time, then `numbers`. Ends early when the lab does. */
  record(steps: number): Float64Array {
    const most = check.count(steps, "the number of steps");
    const width = this.shown.length + 1;
    let rows = new Float64Array(0);
    this.#played(() => {
      rows = call(() => this.#lab().record(most).slice());
      return rows.length / width - 1;
    });
    this.#report();
    return rows;
  }

  /** The state, to come back to. */
  save(): LabState {
    return call(() => new LabState(this.#lab().save(), this.#actions.slice(), fingerprint(this.#json, this.#models)));
  }

  /** Back to a saved state of this lab: from there on every number is the same, to the bit. */
  restore(state: LabState): void {
    if (!(state instanceof LabState)) throw new LabspecError("wrong-type", "a state is what `save` gave");
    const { raw, actions } = LabState.parts(state);
    call(() => this.#lab().restore(raw));
    this.#actions = actions.slice();
    this.#ended = false;
    this.#reported = this.findings.length;
  }

  /** Opens a lab in a state that was saved as bytes: all that was done to it is done again. */
  static resume(bytes: Uint8Array, json: string | object, models: Models = {}): Lab {
    const wrong = (why: string): LabspecError => new LabspecError("not-a-state", why);
    let content: unknown;
    try {
      content = (JSON.parse(new TextDecoder().decode(check.bytes(bytes, "a state"))) as { labspec?: unknown } | null)?.labspec;
    } catch (e) {
      throw e instanceof LabspecError ? e : wrong("these bytes are not a state of a lab");
    }
    const { format, lab: of, actions } = (content ?? {}) as { format?: unknown; lab?: unknown; actions?: unknown };
    if (format !== FORMAT) throw wrong(format === undefined ? "these bytes are not a state of a lab" : `this state has the format ${String(format)}; this version reads ${FORMAT}`);
    const lab = new Lab(json, models);
    if (of !== fingerprint(lab.#json, lab.#models) || !Array.isArray(actions)) throw wrong("this state belongs to another lab");
    for (const action of actions as unknown[]) {
      const [what, a, b] = Array.isArray(action) ? (action as unknown[]) : [];
      if (what === "play") {
        let left = check.count(a, "a number of steps", 100_000_000);
        while (left > 0) {
          const most = Math.min(left, PIECE);
          const [made] = lab.#advance(lab.time + 2 * most * lab.timestep, most);
          if (made === 0) throw wrong("this state was saved by another version of the engine");
          left -= made;
        }
      } else if (what === "set") lab.set(a as string, b as ControlValue);
      else if (what === "press") lab.press(a as string);
      else if (what === "reset") lab.reset();
      else if (what === "force") lab.applyForce(a as number, b as number[]);
      else throw wrong("these bytes are not a state of a lab");
    }
    return lab;
  }

  /**
   * The poses of all geoms for drawing: for each a matrix of 4 x 4, column after column, as WebGL and three.js take them. The
   * array is the same one in every call, filled again.
   */
  get poses(): Float32Array {
    return call(() => {
      const now = this.#lab().poses();
      if (this.#poses?.length !== now.length) this.#poses = new Float32Array(now.length);
      this.#poses.set(now);
      return this.#poses;
    });
  }

  /** The contacts at the present state, with their forces. */
  get contacts(): readonly ContactInfo[] {
    return call(() => contactsOf(this.#lab().contacts()));
  }

  /**
   * The fields of the data as copies: `lab.data.qpos`. All of them are of the present state, as `mj_forward` computes it; the steps of
   * the lab itself compute what its programs read.
   */
  get data(): LabData {
    this.#lab();
    defineFields(DataOfLab.prototype, "data", (of: DataOfLab) => of.cache);
    return (this.#data ??= new DataOfLab(new FieldCache(this.#source())) as unknown as LabData);
  }

  /** The fields of the model as controls and programs left it, as copies: `lab.model.geom_size`. */
  get model(): LabModel {
    this.#lab();
    defineFields(ModelOfLab.prototype, "model", (of: ModelOfLab) => of.cache);
    defineFields(OptionsOfLab.prototype, "opt", (of: OptionsOfLab) => of.cache);
    defineFields(StatisticOfLab.prototype, "stat", (of: StatisticOfLab) => of.cache);
    return (this.#model ??= new ModelOfLab(new FieldCache(this.#source())) as unknown as LabModel);
  }

  /** The model as it is now, as one of its own. */
  toModel(): Model {
    return call(() => Model.adopt(this.#lab().model()));
  }

  /** The names of all objects of a kind, by id. */
  names(kind: ObjectKind): readonly string[] {
    const which = check.text(kind, "a kind");
    return call(() => this.#lab().names(which));
  }

  /** The fields that the programs of the lab read. */
  get reads(): readonly string[] {
    return call(() => this.#lab().reads());
  }

  /** The fields that the programs of the lab write. */
  get writes(): readonly string[] {
    return call(() => this.#lab().writes());
  }

  /** Calls `listener` at each event of a type; returns a function that ends this. */
  on<T extends Exclude<keyof LabEvents, "crossing">>(type: T, listener: (event: LabEvents[T]) => void): () => void;
  on(type: "crossing", listener: (event: LabEvents["crossing"]) => void, crossing: Crossing): () => void;
  on(type: keyof LabEvents, listener: (event: never) => void, crossing?: Crossing): () => void {
    check.callback(listener, "a listener");
    this.#lab();
    if (type === "crossing") {
      const shown = this.shown;
      const number = crossing?.number;
      const index = typeof number === "string" ? shown.findIndex((s) => s.label === number) : number;
      if (index === undefined || !Number.isInteger(index) || index < 0 || index >= shown.length) {
        const labels = shown.map((s) => `"${s.label}"`).join(", ");
        throw new LabspecError("unknown-name", `a crossing is of a number that the lab shows: ${labels === "" ? "it shows none" : labels}`);
      }
      const level = check.number(crossing?.level, "a level");
      const watch: Watch = { index, level, listener: listener as Watch["listener"], over: (this.numbers[index] ?? NaN) > level };
      this.#watches.add(watch);
      return () => void this.#watches.delete(watch);
    }
    if (type !== "contact" && type !== "finding" && type !== "end") {
      throw new LabspecError("unknown-name", "the types of events are contact, crossing, finding and end");
    }
    const list = this.#listeners.get(type) ?? new Set();
    this.#listeners.set(type, list.add(listener));
    if (type === "contact") this.#touching = this.#pairs();
    return () => {
      list.delete(listener);
      if (list.size === 0) this.#listeners.delete(type);
    };
  }

  /** Gives the memory back. Without it, the garbage collector does, later. */
  free(): void {
    this.#raw?.free();
    [this.#raw, this.#weight] = [undefined, undefined];
  }

  [Symbol.dispose](): void {
    this.free();
  }

  #lab(): RawLab {
    if (this.#raw === undefined) throw new LabspecError("freed", "this lab was freed");
    return this.#raw;
  }

  #source(): FieldSource {
    const fail = (): never => {
      throw new LabspecError("read-only", "the fields of a lab are read here; controls write them, or a model of one's own (`toModel`)");
    };
    const copy = (index: number): unknown => call(() => this.#lab().field(index));
    const number = (index: number): number => (copy(index) as ArrayLike<number>)[0] ?? NaN;
    return {
      copy,
      number,
      write: fail,
      size: (name) => {
        const size = fields().find((f) => f.elem === "size" && f.name === name);
        return size === undefined ? undefined : number(size.index);
      },
      keep: () => undefined,
    };
  }

  #do(action: Action, what: (raw: RawLab) => void): void {
    const raw = this.#lab();
    call(() => what(raw), this.#texts);
    this.#note(action);
    this.#report();
  }

  #note(action: Action): void {
    const last = this.#actions[this.#actions.length - 1];
    if (action[0] === "play" && last?.[0] === "play") this.#actions[this.#actions.length - 1] = ["play", last[1] + action[1]];
    else if (action[0] !== "play" || action[1] > 0) this.#actions.push(action);
  }

  /** Notes steps that are made, also those before something broke. */
  #played(what: () => number): number {
    const before = this.time;
    try {
      const made = what();
      this.#note(["play", made]);
      return made;
    } catch (e) {
      this.#note(["play", Math.max(0, Math.round((this.time - before) / this.timestep))]);
      throw asLabspecError(e, this.#texts);
    } finally {
      this.#report();
    }
  }

  #advance(until: number, most: number): [made: number, done: boolean] {
    const levels = Float64Array.from([...this.#watches].flatMap(({ index, level }) => [index, level]));
    const contacts = this.#listeners.has("contact");
    const made = this.#played(() => this.#lab().advance(until, most, levels, contacts));
    const done = made === 0 || this.isOver || this.time >= until;
    return [made, done];
  }

  #pairs(): Set<string> {
    const list = call(() => this.#lab().touching());
    return new Set(Array.from({ length: list.length / 2 }, (_, i) => `${list[2 * i]} ${list[2 * i + 1]}`));
  }

  #emit<T extends keyof LabEvents>(type: T, event: LabEvents[T]): void {
    for (const listener of this.#listeners.get(type) ?? []) (listener as (event: LabEvents[T]) => void)(event);
  }

  /** Reports what is different since the last report. */
  #report(): void {
    if (this.#listeners.size === 0 && this.#watches.size === 0) return;
    const time = this.time;
    if (this.#watches.size > 0) {
      const now = this.numbers;
      for (const watch of this.#watches) {
        const value = now[watch.index] ?? NaN;
        const over = value > watch.level;
        if (over === watch.over) continue;
        watch.over = over;
        watch.listener({ time, index: watch.index, level: watch.level, value, rising: over });
      }
    }
    if (this.#listeners.has("contact")) {
      const [before, now] = [this.#touching, this.#pairs()];
      this.#touching = now;
      const report = (pair: string, touching: boolean): void => {
        const [geom1 = -1, geom2 = -1] = pair.split(" ").map(Number);
        this.#emit("contact", { time, geom1, geom2, touching });
      };
      for (const pair of now) if (!before.has(pair)) report(pair, true);
      for (const pair of before) if (!now.has(pair)) report(pair, false);
    }
    if (this.#listeners.has("finding")) {
      const found = this.findings;
      const fresh = found.slice(this.#reported);
      this.#reported = found.length;
      for (const finding of fresh) this.#emit("finding", finding);
    }
    if (this.#listeners.has("end") && this.isOver && !this.#ended) {
      this.#ended = true;
      this.#emit("end", { time });
    }
  }
}
