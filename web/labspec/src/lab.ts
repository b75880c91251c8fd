import * as check from "./arguments.js";
import { contactsOf, type ContactInfo } from "./contact.js";
import { LabspecError, asLabspecError, call, locate, type Finding } from "./error.js";
import { ready } from "./glue.js";
import { Events } from "./lab-events.js";
import { dataOfLab, modelOfLab, type LabData, type LabModel } from "./lab-fields.js";
import { FORMAT, LabState, fingerprint, type Action } from "./lab-state.js";
import type { Control, ControlValue, Crossing, LabEvents, Models, PlayOptions, Playback, Shown, TextureDeclaration } from "./lab-types.js";
import { Model, type ObjectKind } from "./model.js";
import { LAB, weight } from "./weight.js";
import type { Lab as RawLab } from "#glue";

/** Most steps of one call of the module in a loop. */
const PIECE = 100_000;

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
  readonly #events: Events;
  #poses: Float32Array | undefined;
  #data: LabData | undefined;
  #model: LabModel | undefined;
  #weight: ArrayBuffer | undefined = weight(LAB);

  /**
   * Opens a lab from its JSON (text, or the object itself). `models` are the models that it names: MJCF, or the bytes of
   * `Model.toBytes`. The module of `labspec/compiled` takes bytes only.
   */
  constructor(json: string | object, models: Models = {}) {
    if (json instanceof Opened) {
      [this.#json, this.#models, this.#texts, this.#raw] = [json.text, json.models, json.texts, json.raw];
      this.#events = this.#watched();
      return;
    }
    const text = typeof json === "object" && json !== null ? call(() => JSON.stringify(json)) : check.text(json, "a lab");
    const own = check.models(models);
    const texts = new Map<string, string>([["lab.json", text]]);
    for (const [name, content] of Object.entries(own)) if (typeof content === "string") texts.set(name, content);
    [this.#json, this.#models, this.#texts] = [text, own, texts];
    const glue = ready();
    this.#raw = call(() => new glue.Lab(text, own), texts);
    this.#events = this.#watched();
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
      throw new LabspecError("wrong-type", "the value of a control must be a number, a string, true or false");
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
    this.#events.restarted();
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
    if (this.#events.isEmpty) {
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
    if (typeof options !== "object" || options === null) throw new LabspecError("wrong-type", "the options must be an object");
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
    this.#events.report();
    return rows;
  }

  /** The state, to come back to. */
  save(): LabState {
    return call(() => new LabState(this.#lab().save(), this.#actions.slice(), fingerprint(this.#json, this.#models)));
  }

  /** Back to a saved state of this lab: from there on every number is the same, to the bit. */
  restore(state: LabState): void {
    if (!(state instanceof LabState)) throw new LabspecError("wrong-type", "`restore` takes a state that `save` returned");
    const { raw, actions } = LabState.parts(state);
    call(() => this.#lab().restore(raw));
    this.#actions = actions.slice();
    this.#events.moved();
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
    return (this.#data ??= dataOfLab(() => this.#lab()));
  }

  /** The fields of the model as controls and programs left it, as copies: `lab.model.geom_size`. */
  get model(): LabModel {
    this.#lab();
    return (this.#model ??= modelOfLab(() => this.#lab()));
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

  /** The textures of the model as it declares them, by id. The engine does not draw: a view computes the pixels. */
  get textures(): readonly TextureDeclaration[] {
    return call(() => this.#lab().textures());
  }

  /** What programs have asked of the page since the last call; `null` where they asked nothing. */
  takePlayback(): Playback | null {
    return call(() => (this.#lab().takePlayback() as Playback | undefined) ?? null);
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
    this.#lab();
    return this.#events.add(type, listener, crossing);
  }

  /** Releases the memory. Otherwise the garbage collector does so later. */
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

  /** What events are found in. */
  #watched(): Events {
    const lab = this;
    return new Events({
      get time() { return lab.time; },
      get isOver() { return lab.isOver; },
      get shown() { return lab.shown; },
      get numbers() { return lab.numbers; },
      get findings() { return lab.findings; },
      touching: () => call(() => lab.#lab().touching()),
      warnings: () => call(() => lab.#lab().warnings()),
    });
  }

  #do(action: Action, what: (raw: RawLab) => void): void {
    const raw = this.#lab();
    call(() => what(raw), this.#texts);
    this.#note(action);
    this.#events.report();
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
      this.#events.report();
    }
  }

  #advance(until: number, most: number): [made: number, done: boolean] {
    const events = this.#events;
    const made = this.#played(() => this.#lab().advance(until, most, events.levels, events.has("contact"), events.has("warning")));
    const done = made === 0 || this.isOver || this.time >= until;
    return [made, done];
  }
}
