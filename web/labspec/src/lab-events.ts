import * as check from "./arguments.js";
import { LabspecError, type Finding } from "./error.js";
import type { Crossing, LabEvents, Shown, WarningKind } from "./lab-types.js";

/** The parts of a lab in which events are found. */
export interface Watched {
  readonly time: number;
  readonly isOver: boolean;
  readonly shown: readonly Shown[];
  readonly numbers: Float64Array;
  readonly findings: readonly Finding[];
  /** Pairs of geoms that touch, one after the other. */
  touching(): Uint32Array;
  /** The time before the last step, then count and index of each warning. */
  warnings(): Float64Array;
}

interface Watch {
  readonly index: number;
  readonly level: number;
  readonly listener: (event: LabEvents["crossing"]) => void;
  over: boolean;
}

const TYPES = ["contact", "finding", "warning", "end"] as const;
/** The warnings of the engine, in its order. */
const WARNINGS: readonly WarningKind[] = ["inertia", "contactfull", "cnstrfull", "badqpos", "badqvel", "badqacc", "badctrl"];

/** The listeners of a lab, and the events that were reported to them. */
export class Events {
  readonly #lab: Watched;
  readonly #listeners = new Map<string, Set<(event: never) => void>>();
  readonly #watches = new Set<Watch>();
  #touching = new Set<string>();
  #warned = { time: 0, counts: WARNINGS.map(() => 0) };
  #reported = 0;
  #ended = false;

  constructor(lab: Watched) {
    this.#lab = lab;
  }

  /** Whether there are no listeners. */
  get isEmpty(): boolean {
    return this.#listeners.size === 0 && this.#watches.size === 0;
  }

  has(type: (typeof TYPES)[number]): boolean {
    return this.#listeners.has(type);
  }

  /** The levels of crossings: index and level of each. */
  get levels(): Float64Array {
    return Float64Array.from([...this.#watches].flatMap(({ index, level }) => [index, level]));
  }

  /** Adds a listener; returns a function that removes it. */
  add(type: keyof LabEvents, listener: (event: never) => void, crossing?: Crossing): () => void {
    check.callback(listener, "a listener");
    if (type === "crossing") return this.#watch(listener as Watch["listener"], crossing);
    if (!TYPES.includes(type)) throw new LabspecError("unknown-name", `unknown type of event: use one of crossing, ${TYPES.join(", ")}`);
    if (type === "finding" && !this.has("finding")) this.#reported = this.#lab.findings.length;
    const list = this.#listeners.get(type) ?? new Set();
    this.#listeners.set(type, list.add(listener));
    if (type === "contact") this.#touching = this.#pairs();
    if (type === "warning") this.#warned = this.#warnings();
    return () => {
      list.delete(listener);
      if (list.size === 0) this.#listeners.delete(type);
    };
  }

  #watch(listener: Watch["listener"], crossing: Crossing | undefined): () => void {
    const { shown, numbers } = this.#lab;
    const number = crossing?.number;
    const index = typeof number === "string" ? shown.findIndex((s) => s.label === number) : number;
    if (index === undefined || !Number.isInteger(index) || index < 0 || index >= shown.length) {
      const labels = shown.map((s) => `"${s.label}"`).join(", ");
      throw new LabspecError("unknown-name", `a crossing needs the label of a number that the lab displays: ${labels === "" ? "it displays none" : labels}`);
    }
    const level = check.number(crossing?.level, "a level");
    const watch: Watch = { index, level, listener, over: (numbers[index] ?? NaN) > level };
    this.#watches.add(watch);
    return () => void this.#watches.delete(watch);
  }

  /** The lab starts again. */
  restarted(): void {
    this.#ended = false;
  }

  /** The lab was restored to another state, with earlier findings. */
  moved(): void {
    this.#ended = false;
    if (this.has("finding")) this.#reported = this.#lab.findings.length;
    if (this.has("warning")) this.#warned = this.#warnings();
  }

  /** Reports all changes since the last report. */
  report(): void {
    if (this.isEmpty) return;
    if (this.#watches.size > 0) this.#reportCrossings();
    if (this.has("warning")) this.#reportWarnings();
    if (this.has("contact")) this.#reportContacts();
    if (this.has("finding")) {
      const found = this.#lab.findings;
      const fresh = found.slice(this.#reported);
      this.#reported = found.length;
      for (const finding of fresh) this.#emit("finding", finding);
    }
    if (this.has("end") && this.#lab.isOver && !this.#ended) {
      this.#ended = true;
      this.#emit("end", { time: this.#lab.time });
    }
  }

  #emit<T extends keyof LabEvents>(type: T, event: LabEvents[T]): void {
    for (const listener of this.#listeners.get(type) ?? []) (listener as (event: LabEvents[T]) => void)(event);
  }

  #reportCrossings(): void {
    const { time, numbers } = this.#lab;
    for (const watch of this.#watches) {
      const value = numbers[watch.index] ?? NaN;
      const over = value > watch.level;
      if (over === watch.over) continue;
      watch.over = over;
      watch.listener({ time, index: watch.index, level: watch.level, value, rising: over });
    }
  }

  #reportContacts(): void {
    const [before, now] = [this.#touching, this.#pairs()];
    this.#touching = now;
    const report = (pair: string, touching: boolean): void => {
      const [geom1 = -1, geom2 = -1] = pair.split(" ").map(Number);
      this.#emit("contact", { time: this.#lab.time, geom1, geom2, touching });
    };
    for (const pair of now) if (!before.has(pair)) report(pair, true);
    for (const pair of before) if (!now.has(pair)) report(pair, false);
  }

  #reportWarnings(): void {
    const [before, now] = [this.#warned, this.#warnings()];
    this.#warned = now;
    const list = this.#lab.warnings();
    // A bad number resets the data and the counts.
    const isReset = now.time < before.time;
    WARNINGS.forEach((kind, i) => {
      const count = now.counts[i] ?? 0;
      if (count <= (isReset ? 0 : (before.counts[i] ?? 0))) return;
      this.#emit("warning", { time: isReset ? (list[0] ?? NaN) : now.time, kind, index: list[2 + 2 * i] ?? -1, count });
    });
  }

  #pairs(): Set<string> {
    const list = this.#lab.touching();
    return new Set(Array.from({ length: list.length / 2 }, (_, i) => `${list[2 * i]} ${list[2 * i + 1]}`));
  }

  #warnings(): { time: number; counts: number[] } {
    const list = this.#lab.warnings();
    return { time: this.#lab.time, counts: WARNINGS.map((_, i) => list[1 + 2 * i] ?? 0) };
  }
}
