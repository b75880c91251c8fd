/** Ranges and ticks of axes. */
import type { PlotSpec } from "../spec.js";
import { extremes, indexAt, type Series } from "./series.js";

export interface Range {
  readonly min: number;
  readonly max: number;
}

/** The seconds that a plot shows: its window, which begins at zero or at an earlier first sample, and moves when it is full. */
export function timeRange(series: Series, window: number): Range {
  const last = series.length > 0 ? (series.times[series.length - 1] ?? 0) : 0;
  const first = series.length > 0 ? (series.times[0] ?? 0) : 0;
  const max = Math.max(Math.min(0, first) + window, last);
  return { min: max - window, max };
}

/** The values that a plot shows: as its author says, else all that is in its window and its reference lines. */
export function valueRange(series: Series, spec: PlotSpec, times: Range): Range {
  const [from, to] = [Math.max(0, indexAt(series, times.min) - 1), series.length];
  let [low, high] = [Infinity, -Infinity];
  for (let trace = 0; trace < series.traces; trace++) {
    const found = extremes(series, trace, from, to);
    if (found === null) continue;
    low = Math.min(low, found.min);
    high = Math.max(high, found.max);
  }
  for (const { y } of spec.refLines) [low, high] = [Math.min(low, y), Math.max(high, y)];
  if (low > high) [low, high] = [spec.ymin ?? 0, spec.ymax ?? 1];
  const room = high > low ? 0.06 * (high - low) : Math.abs(high) > 0 ? 0.1 * Math.abs(high) : 1;
  let [min, max] = [spec.ymin ?? low - room, spec.ymax ?? high + room];
  if (!(max > min)) [min, max] = [Math.min(min, low - room), Math.max(max, high + room)];
  return max > min ? { min, max } : { min: min - 1, max: min + 1 };
}

/** The distance of round ticks, of which about `count` fit into a range. */
export function tickSpacing(range: Range, count: number): number {
  const rough = (range.max - range.min) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const factor = rough / power;
  return power * (factor <= 1 ? 1 : factor <= 2.5 ? 2 : factor <= 6 ? 5 : 10);
}

/** Round ticks inside a range. */
export function ticks(range: Range, spacing: number): number[] {
  const out: number[] = [];
  const first = Math.ceil(range.min / spacing - 1e-9);
  for (let i = first; i * spacing <= range.max + 1e-9 * spacing && out.length < 50; i++) out.push(i * spacing);
  return out;
}
