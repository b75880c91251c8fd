/** A plot in words and in a table. */
import type { Say } from "../text/messages.js";
import { formatBrief, formatTime } from "../text/numbers.js";
import { extremes, resolutionOf, type Series } from "./series.js";

/** What a trace does: from where to where, and its turning values where they are not at the ends. */
export function describeTrace(series: Series, trace: number, label: string, say: Say): string | null {
  const list = series.values[trace];
  const found = extremes(series, trace, 0, series.length);
  if (list === undefined || found === null) return null;
  const finite = Array.from(list.subarray(0, series.length)).filter(Number.isFinite);
  const [first, last] = [finite[0] ?? NaN, finite[finite.length - 1] ?? NaN];
  const small = 0.02 * (found.max - found.min);
  const resolution = resolutionOf(series, trace);
  const brief = (value: number): string => formatBrief(value, resolution);
  const values = { label, first: brief(first), last: brief(last) };
  const isFlat = found.max - found.min <= 1e-9 * Math.max(1, Math.abs(found.max));
  const name = isFlat ? "stays" : last > first + small ? "rises" : last < first - small ? "falls" : "returns";
  const parts = [say(name, values)];
  if (found.max > Math.max(first, last) + small) parts.push(say("peak", { value: brief(found.max), time: formatTime(found.maxTime) }));
  if (found.min < Math.min(first, last) - small) parts.push(say("trough", { value: brief(found.min), time: formatTime(found.minTime) }));
  return `${parts.join(", ")}.`;
}

const MOST_ROWS = 60;

/** The samples of a table: all of them, or as many as one reads, evenly spread. */
export function tableRows(series: Series): string[][] {
  const count = Math.min(series.length, MOST_ROWS);
  const resolutions = series.values.map((_, trace) => resolutionOf(series, trace));
  const rows: string[][] = [];
  for (let i = 0; i < count; i++) {
    const index = count === 1 ? 0 : Math.round((i * (series.length - 1)) / (count - 1));
    rows.push([formatTime(series.times[index] ?? NaN), ...series.values.map((list, trace) => formatBrief(list[index] ?? NaN, resolutions[trace]))]);
  }
  return rows;
}
