/** The running lab: it starts again when its text or its models change, and its controls keep what a reader chose. */
import type { SimLab } from "labspec-elements";
import type { ControlValue } from "labspec/slim";
import { modelsOf, readObject, type Project } from "./project.js";

export class Stage {
  readonly #lab: SimLab;
  readonly #values = new Map<string, ControlValue>();
  #turn = 0;
  /** Whether a lab is open. */
  isOpen = false;

  constructor(lab: SimLab) {
    this.#lab = lab;
    lab.addEventListener("lab-change", (event) => {
      const { label, value } = (event as CustomEvent<{ label: string; value: ControlValue | null }>).detail;
      if (value !== null) this.#values.set(label, value);
    });
  }

  /** Forgets what was chosen, for another project. */
  forget(): void {
    this.#values.clear();
  }

  /** Opens a project in place of the one before; false where another one was opened meanwhile. Refused with the reason where it cannot be opened. */
  async open(project: Project): Promise<boolean> {
    const turn = ++this.#turn;
    const wasPlaying = this.#lab.playing;
    this.#lab.models = modelsOf(project);
    this.#lab.lab = project.lab;
    this.isOpen = false;
    await this.#lab.ready;
    if (turn !== this.#turn) return false;
    this.isOpen = true;
    for (const [label, value] of fitting(project.lab, this.#values)) await this.#lab.set(label, value).catch(() => this.#values.delete(label));
    if (wasPlaying && turn === this.#turn) this.#lab.play();
    return turn === this.#turn;
  }
}

/** The values that the controls of a lab can have. */
export function fitting(lab: string, values: ReadonlyMap<string, ControlValue>): [string, ControlValue][] {
  const controls = readObject(lab)?.["controls"];
  const fits = (control: unknown): [string, ControlValue][] => {
    if (typeof control !== "object" || control === null) return [];
    const { label, min, max, options } = control as { label?: unknown; min?: unknown; max?: unknown; options?: unknown };
    const value = typeof label === "string" ? values.get(label) : undefined;
    if (typeof label !== "string" || value === undefined) return [];
    const inRange = typeof min === "number" && typeof max === "number" && typeof value === "number" && min <= value && value <= max;
    const isOption = Array.isArray(options) && (options as unknown[]).some((option) => Array.isArray(option) && option[1] === value);
    return inRange || isOption ? [[label, value]] : [];
  };
  return Array.isArray(controls) ? (controls as unknown[]).flatMap(fits) : [];
}
