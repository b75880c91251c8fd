/** Readouts as `output` elements with their labels. */
import type { Shown } from "labspec/slim";
import { h, setText } from "../dom.js";

export interface Readouts {
  readonly element: HTMLElement | null;
  show(texts: readonly string[]): void;
  /** The readouts with these texts as one sentence. */
  describe(texts: readonly string[]): string;
}

export function createReadouts(shown: readonly Shown[], title: string): Readouts {
  const labels = shown.filter((one) => one.plot === undefined).map((one) => one.label);
  const outputs = labels.map((label) => h("output", { "aria-label": label, "aria-live": "off", part: "readout-value" }));
  const items = labels.map((label, i) => h("div", { class: "readout", part: "readout" }, h("span", { class: "readout-label", "aria-hidden": "true" }, label), outputs[i]));
  const printed = (texts: readonly string[]): string[] => labels.map((_, i) => (texts[i] ?? "").replace(/^-(?=\d)/, "−"));
  return {
    element: items.length > 0 ? h("div", { class: "readouts", part: "readouts", role: "group", "aria-label": title }, ...items) : null,
    show(texts) {
      const all = printed(texts);
      outputs.forEach((output, i) => setText(output, all[i] ?? ""));
    },
    describe(texts) {
      const all = printed(texts);
      return labels.map((label, i) => `${label}: ${all[i] ?? ""}`).join("; ");
    },
  };
}
