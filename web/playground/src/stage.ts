/** The running lab: it starts again when its text or its models change, and its controls keep what a reader chose. */
import { SimLab } from "labspec-elements";
import type { ControlValue } from "labspec/slim";
import { modelsOf, type Project } from "./project.js";
import { fitting } from "./values.js";

export class Stage {
  readonly #host: HTMLElement;
  readonly #lab = new SimLab();
  readonly #values = new Map<string, ControlValue>();
  #turn = 0;
  /** Whether a lab is open. */
  isOpen = false;

  /** The lab is shown in `host` when the first project is open. */
  constructor(host: HTMLElement) {
    this.#host = host;
    this.#lab.id = "lab";
    this.#lab.addEventListener("lab-change", (event) => {
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
    if (!this.#lab.isConnected) this.#host.append(this.#lab);
    await this.#lab.ready;
    if (turn !== this.#turn) return false;
    this.isOpen = true;
    for (const [label, value] of fitting(project.lab, this.#values)) await this.#lab.set(label, value).catch(() => this.#values.delete(label));
    if (wasPlaying && turn === this.#turn) this.#lab.play();
    return turn === this.#turn;
  }
}
