/** The samples of a plot: times, and for each trace its values. Bounded: older samples than anybody looks at are dropped. */

export interface Series {
  readonly traces: number;
  /** Samples that are held. */
  length: number;
  times: Float64Array;
  values: Float64Array[];
}

const START = 1024;
const MOST = 1 << 15;

export function createSeries(traces: number): Series {
  return { traces, length: 0, times: new Float64Array(START), values: Array.from({ length: traces }, () => new Float64Array(START)) };
}

/** Forgets all samples. */
export function clearSeries(series: Series): void {
  series.length = 0;
}

/** Adds rows of `width` numbers: time first, then `columns` of each trace. Time that goes backwards clears the plot. */
export function addRows(series: Series, rows: Float64Array, width: number, columns: readonly number[]): void {
  for (let at = 0; at + width <= rows.length; at += width) {
    const time = rows[at] ?? NaN;
    const last = series.length > 0 ? (series.times[series.length - 1] ?? NaN) : -Infinity;
    if (time < last) clearSeries(series);
    // What is sampled again without a step replaces the sample.
    const index = time === last ? series.length - 1 : series.length;
    if (index === series.times.length) makeRoom(series);
    const to = Math.min(index, series.length);
    series.times[to] = time;
    columns.forEach((column, trace) => {
      const list = series.values[trace];
      if (list !== undefined) list[to] = rows[at + 1 + column] ?? NaN;
    });
    series.length = to + 1;
  }
}

/** Twice the room, or half of the samples. */
function makeRoom(series: Series): void {
  if (series.times.length < MOST) {
    const grow = (list: Float64Array): Float64Array => {
      const larger = new Float64Array(2 * list.length);
      larger.set(list);
      return larger;
    };
    series.times = grow(series.times);
    series.values = series.values.map(grow);
    return;
  }
  const half = series.length >> 1;
  for (const list of [series.times, ...series.values]) list.copyWithin(0, half, series.length);
  series.length -= half;
}

/** The first sample at or after a time. */
export function indexAt(series: Series, time: number): number {
  let [low, high] = [0, series.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((series.times[middle] ?? 0) < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The sample nearest to a time; -1 where there is none. */
export function nearestIndex(series: Series, time: number): number {
  if (series.length === 0) return -1;
  const after = Math.min(indexAt(series, time), series.length - 1);
  const before = Math.max(after - 1, 0);
  return Math.abs((series.times[before] ?? 0) - time) < Math.abs((series.times[after] ?? 0) - time) ? before : after;
}

/** The least and the greatest value of a trace from one sample to another, and when; `null` where it has no number. */
export interface Extremes {
  readonly min: number;
  readonly minTime: number;
  readonly max: number;
  readonly maxTime: number;
}

export function extremes(series: Series, trace: number, from: number, to: number): Extremes | null {
  const list = series.values[trace];
  if (list === undefined) return null;
  let [min, max, minAt, maxAt] = [Infinity, -Infinity, -1, -1];
  for (let i = from; i < to; i++) {
    const y = list[i] ?? NaN;
    if (!Number.isFinite(y)) continue;
    if (y < min) [min, minAt] = [y, i];
    if (y > max) [max, maxAt] = [y, i];
  }
  if (minAt < 0) return null;
  return { min, minTime: series.times[minAt] ?? 0, max, maxTime: series.times[maxAt] ?? 0 };
}

/** The difference of values that a text about a trace must show: a hundredth of their range. */
export function resolutionOf(series: Series, trace: number): number {
  const found = extremes(series, trace, 0, series.length);
  if (found === null) return Infinity;
  const range = found.max - found.min;
  // A range of this size is rounding.
  return range > 1e-9 * Math.abs(found.max) ? range / 100 : Infinity;
}

/** All samples as comma-separated values: numbers in full. */
export function toCsv(series: Series, labels: readonly string[], timeLabel: string): string {
  const quote = (text: string): string => {
    // A cell that begins like a formula is text for spreadsheets, too.
    const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
    return /[",\n\r]/.test(safe) ? `"${safe.replaceAll("\"", "\"\"")}"` : safe;
  };
  const lines = [[timeLabel, ...labels].map(quote).join(",")];
  for (let i = 0; i < series.length; i++) {
    lines.push([series.times[i], ...series.values.map((list) => list[i])].map((x) => (Number.isNaN(x) ? "" : String(x))).join(","));
  }
  return `${lines.join("\n")}\n`;
}
