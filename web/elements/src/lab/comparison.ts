/** The readouts of a lab that compares integrators: a table with a row for each of them. */
import type { Shown } from "labspec/slim";
import { h, setText } from "../dom.js";
import { extremes, type Series } from "../plot/series.js";
import type { Say } from "../text/messages.js";
import { formatNumber } from "../text/numbers.js";
import { ENERGY_DRIFT } from "./integrators.js";
import type { Readouts } from "./readouts.js";

/** The decimals of the drift. */
const DIGITS = 4;

/** The drift at the last sample of a series, and the largest one of all samples; NaN where there is none. */
export function driftOf(series: Series, trace: number): { readonly last: number; readonly largest: number } {
  const found = extremes(series, trace, 0, series.length);
  const last = series.values[trace]?.[series.length - 1] ?? NaN;
  return { last: series.length > 0 ? last : NaN, largest: found === null ? NaN : Math.max(Math.abs(found.min), Math.abs(found.max)) };
}

/**
 * The table. `drift` has the samples of the energy, one trace for each integrator; the readouts of `shown` follow each other by integrator
 * within each readout.
 */
export function createComparison(names: readonly string[], shown: readonly Shown[], drift: Series, say: Say): Readouts {
  const readouts = shown.filter((one) => one.plot === undefined).filter((_, i) => i % names.length === 0);
  const labels = readouts.map(({ label }) => label.slice(0, -`, ${names[0] ?? ""}`.length));
  const heads = [ENERGY_DRIFT, say("largestDrift"), ...labels];
  const cells = names.map(() => heads.map(() => h("td", { part: "readout-value" })));
  const rows = names.map((name, k) => h("tr", { part: "readout" }, h("th", { scope: "row" }, name), ...(cells[k] ?? [])));
  const head = h("tr", {}, h("th", { scope: "col" }, say("integrator")), ...heads.map((text) => h("th", { scope: "col" }, text)));
  /** The cells of each row. */
  const printed = (texts: readonly string[]): string[][] => names.map((_, k) => {
    const { last, largest } = driftOf(drift, k);
    const values = [formatNumber(last, DIGITS), formatNumber(largest, DIGITS), ...labels.map((_label, i) => texts[i * names.length + k] ?? "")];
    return values.map((value) => value.replace(/^-(?=\d)/, "−"));
  });
  const table = h("table", { class: "comparison" }, h("caption", { class: "hidden" }, say("readouts")), h("thead", {}, head), h("tbody", {}, ...rows));
  return {
    element: h("div", { class: "readouts compared", part: "readouts", role: "group", tabindex: 0, "aria-label": say("readouts") }, table),
    show(texts) {
      printed(texts).forEach((row, k) => row.forEach((value, i) => {
        const cell = cells[k]?.[i];
        if (cell !== undefined) setText(cell, value);
      }));
    },
    describe(texts) {
      const rows = printed(texts);
      return names.map((name, k) => `${name}: ${heads.map((text, i) => `${text} ${rows[k]?.[i] ?? ""}`).join(", ")}`).join("; ");
    },
  };
}
