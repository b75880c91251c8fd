import { LabspecError, type Finding } from "./error.js";
import type { ContactInfo } from "./contact.js";
import type { Control, ControlValue, Models, Playback, Shown, TextureDeclaration } from "./lab-types.js";
import type { ObjectKind } from "./model.js";
import { SharedFrames, type Frame } from "./shared-frame.js";
import type { OpenedLab, Port, Reply } from "./worker-protocol.js";

export type { Frame } from "./shared-frame.js";

/** A state that is kept in the worker. */
export interface WorkerState {
  /** The state as bytes: see `LabState`. */
  toBytes(): Promise<Uint8Array>;
  /** Deletes it in the worker. */
  free(): Promise<void>;
}

type Ask = (call: string, ...args: readonly unknown[]) => Promise<unknown>;

/** A lab in a worker: the interface of `Lab`, as promises. */
export class Lab {
  readonly #ask: Ask;
  readonly #cancel: (run: number) => void;
  readonly #states = new WeakMap<WorkerState, number>();
  readonly #frames: SharedFrames | undefined;
  static #runs = 0;

  /** @internal */
  constructor(ask: Ask, cancel: (run: number) => void, frames: SharedFrames | undefined) {
    [this.#ask, this.#cancel, this.#frames] = [ask, cancel, frames];
  }

  /** Whether frames are in shared memory: in a page that is isolated from other origins, and in node. */
  get isShared(): boolean {
    return this.#frames !== undefined;
  }

  #get<T>(call: string, ...args: readonly unknown[]): Promise<T> {
    return this.#ask(call, ...args) as Promise<T>;
  }

  /** A frame that was sent, or the one in shared memory. */
  #framed(sent: Frame | null): Frame {
    const frame = sent ?? this.#frames?.read();
    if (frame === undefined) throw new LabspecError("internal", "the worker sent no frame");
    return frame;
  }

  get controls(): Promise<readonly Control[]> { return this.#get("controls"); }
  get shown(): Promise<readonly Shown[]> { return this.#get("shown"); }
  get time(): Promise<number> { return this.#get("time"); }
  get timestep(): Promise<number> { return this.#get("timestep"); }
  get isOver(): Promise<boolean> { return this.#get("isOver"); }
  get numbers(): Promise<Float64Array> { return this.#get("numbers"); }
  get findings(): Promise<readonly Finding[]> { return this.#get("findings"); }
  get contacts(): Promise<readonly ContactInfo[]> { return this.#get("contacts"); }
  get reads(): Promise<readonly string[]> { return this.#get("reads"); }
  get textures(): Promise<readonly TextureDeclaration[]> { return this.#get("textures"); }
  get writes(): Promise<readonly string[]> { return this.#get("writes"); }
  /** Time, numbers and poses at once. */
  get frame(): Promise<Frame> { return this.#get<Frame | null>("frame").then((frame) => this.#framed(frame)); }

  value(label: string): Promise<ControlValue | null> { return this.#get("value", label); }
  set(label: string, value: ControlValue): Promise<void> { return this.#get("set", label, value); }
  press(label: string): Promise<void> { return this.#get("press", label); }
  reset(): Promise<void> { return this.#get("reset"); }
  step(steps = 1): Promise<void> { return this.#get("step", steps); }
  playTo(time: number): Promise<number> { return this.#get("playTo", time); }
  record(steps: number): Promise<Float64Array> { return this.#get("record", steps); }
  names(kind: ObjectKind): Promise<readonly string[]> { return this.#get("names", kind); }
  takePlayback(): Promise<Playback | null> { return this.#get("takePlayback"); }
  free(): Promise<void> { return this.#get("free"); }

  /** Plays in pieces. The worker answers other calls between them, and a signal cancels the run. Returns the last frame. */
  async play(time: number, options: { readonly signal?: AbortSignal; readonly budget?: number } = {}): Promise<Frame & { readonly steps: number }> {
    const run = ++Lab.#runs;
    const cancel = (): void => this.#cancel(run);
    if (options.signal?.aborted === true) throw new LabspecError("aborted", "the run was cancelled before it began");
    options.signal?.addEventListener("abort", cancel, { once: true });
    try {
      const { steps, frame } = await this.#get<{ steps: number; frame: Frame | null }>("play", time, run, options.budget);
      return { steps, ...this.#framed(frame) };
    } finally {
      options.signal?.removeEventListener("abort", cancel);
    }
  }

  async save(): Promise<WorkerState> {
    const id = await this.#get<number>("save");
    const state: WorkerState = {
      toBytes: () => this.#get<Uint8Array>("stateBytes", id),
      free: () => this.#get<void>("forget", id),
    };
    this.#states.set(state, id);
    return state;
  }

  async restore(state: WorkerState): Promise<void> {
    const id = this.#states.get(state);
    if (id === undefined) throw new LabspecError("wrong-type", "`restore` takes a state that `save` of this lab returned");
    await this.#get("restore", id);
  }
}

/** A worker in which labs run. */
export class LabWorker {
  readonly #port: Port;
  readonly #end: () => void;
  readonly #waiting = new Map<number, { resolve: (value: unknown) => void; reject: (e: Error) => void }>();
  #next = 1;
  #failed: LabspecError | undefined;

  /** @internal */
  constructor(port: Port, end: () => void) {
    [this.#port, this.#end] = [port, end];
    port.listen((message) => {
      const { id, result, error } = message as Reply;
      const waiting = this.#waiting.get(id);
      this.#waiting.delete(id);
      if (error === undefined) waiting?.resolve(result);
      else waiting?.reject(new LabspecError(error.code, error.message, error.findings as readonly Finding[]));
    });
  }

  /** @internal */
  fail(why: string): void {
    this.#failed ??= new LabspecError("worker", why);
    for (const { reject } of this.#waiting.values()) reject(this.#failed);
    this.#waiting.clear();
  }

  /** Opens a lab from its JSON. */
  async open(json: string | object, models: Models = {}): Promise<Lab> {
    return this.#opened(await this.#ask(0, "open", typeof json === "string" ? json : JSON.stringify(json), models));
  }

  /** Opens a lab of a lesson: see `Lab.ofLesson`. */
  async openLesson(path: string, lesson: string, address: string, models: Models = {}): Promise<Lab> {
    return this.#opened(await this.#ask(0, "open", path, lesson, address, models));
  }

  /** Ends the worker and all of its labs. */
  terminate(): void {
    this.fail("the worker was terminated");
    this.#end();
  }

  #opened(opened: unknown): Lab {
    const { id, memory } = opened as OpenedLab;
    const cancel = (run: number): void => void this.#ask(0, "cancel", run).catch(() => undefined);
    return new Lab((call, ...args) => this.#ask(id, call, ...args), cancel, memory && new SharedFrames(memory));
  }

  #ask(lab: number, call: string, ...args: readonly unknown[]): Promise<unknown> {
    return new Promise((resolve, reject) => {
      if (this.#failed !== undefined) return reject(this.#failed);
      const id = this.#next++;
      this.#waiting.set(id, { resolve, reject });
      try {
        this.#port.post({ id, lab, call, args }, []);
      } catch (e) {
        this.#waiting.delete(id);
        reject(new LabspecError("wrong-type", `this cannot be sent to a worker: ${e instanceof Error ? e.message : String(e)}`));
      }
    });
  }
}
