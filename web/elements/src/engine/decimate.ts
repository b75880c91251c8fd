/** Thins out samples so that no peak is lost. */

/** More samples of one frame than this are thinned out. */
const MOST_ROWS = 128;
/** Parts into which they are divided then. */
const PARTS = 32;

/**
 * The rows (time, then numbers) that a plot needs of many. The rows are divided into parts; of each part its first and its last row are kept,
 * and, for each of the `columns`, the rows with the lowest and with the highest value. Columns are counted after the time.
 */
export function decimate(rows: readonly (readonly number[])[], columns: readonly number[]): readonly (readonly number[])[] {
  if (rows.length <= MOST_ROWS) return rows;
  const kept: (readonly number[])[] = [];
  for (let part = 0; part < PARTS; part++) {
    const from = Math.floor((part * rows.length) / PARTS), end = Math.floor(((part + 1) * rows.length) / PARTS);
    const places = new Set([from, end - 1]);
    for (const column of columns) {
      const { lowest, highest } = extremePlaces(rows, 1 + column, from, end);
      places.add(lowest).add(highest);
    }
    for (const place of [...places].sort((a, b) => a - b)) {
      const row = rows[place];
      if (row !== undefined) kept.push(row);
    }
  }
  return kept;
}

/** Where a column is lowest and highest; NaN is neither. */
function extremePlaces(rows: readonly (readonly number[])[], column: number, from: number, end: number): { lowest: number; highest: number } {
  let [lowest, highest, low, high] = [from, from, Infinity, -Infinity];
  for (let i = from; i < end; i++) {
    const value = rows[i]?.[column] ?? NaN;
    if (value < low) [low, lowest] = [value, i];
    if (value > high) [high, highest] = [value, i];
  }
  return { lowest, highest };
}
