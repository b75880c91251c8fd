/** The samples of a plot: times, and for each trace its values. Bounded: the older samples of a long run are thinned out. */

export interface Series {
  readonly traces: number;
  /** The latest seconds, which stay as dense as there is room. */
  readonly window: number;
  /** Samples that are held. */
  length: number;
  times: Float64Array;
  values: Float64Array[];
}

const START = 1024;
const MOST = 1 << 15;

export function createSeries(traces: number, window = Infinity): Series {
  return { traces, window, length: 0, times: new Float64Array(START), values: Array.from({ length: traces }, () => new Float64Array(START)) };
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

/** Twice the room, or half of the samples before the window; while these are few, half of the older ones in the window. */
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
  const { length } = series;
  const begin = indexAt(series, (series.times[length - 1] ?? 0) - series.window);
  if (begin >= MOST / 4) thinOut(series, 0, begin);
  else thinOut(series, begin, begin + ((length - begin) >> 1));
}

/**
 * Keeps at most half of the samples between two places, and the first sample of the run. Their time is divided into equal parts; of each, the
 * lowest and the highest value of each trace are kept, and others evenly as far as there is room.
 */
function thinOut(series: Series, begin: number, end: number): void {
  const lists = [series.times, ...series.values];
  const room = 2 * Math.max(1, series.traces);
  let from = Math.max(1, begin), kept = from;
  const [first, last] = [series.times[from] ?? 0, series.times[end - 1] ?? 0];
  const parts = Math.max(1, Math.floor((end - from) / 2 / room));
  for (let part = 1; part <= parts; part++) {
    const to = part === parts ? end : Math.min(end, Math.max(from, indexAt(series, first + ((last - first) * part) / parts, from)));
    const places = new Set(series.values.flatMap((list) => extremePlaces(list, from, to)));
    const stride = Math.max(1, (to - from) / room);
    for (let place = from; place < to && places.size < room; place += stride) places.add(Math.floor(place));
    for (const place of [...places].filter((one) => one < to).sort((x, y) => x - y)) {
      for (const list of lists) list[kept] = list[place] ?? NaN;
      kept++;
    }
    from = to;
  }
  for (const list of lists) list.copyWithin(kept, end, series.length);
  series.length += kept - end;
}

/** Where the lowest and the highest value of a part are; the first sample of the part where it has no numbers. */
function extremePlaces(list: Float64Array, from: number, end: number): [number, number] {
  let [low, high, lowest, highest] = [Infinity, -Infinity, from, from];
  for (let i = from; i < end; i++) {
    const value = list[i] ?? NaN;
    if (value < low) [low, lowest] = [value, i];
    if (value > high) [high, highest] = [value, i];
  }
  return [lowest, highest];
}

/** The first sample at or after a time. */
export function indexAt(series: Series, time: number, from = 0): number {
  let [low, high] = [from, series.length];
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
