/** The samples of several labs as rows with one time. */

/** The samples of one lab that are not merged yet. The first row is the last one that was merged, if there is one. */
export interface RowQueue {
  /** The rows: time, then numbers. */
  rows: Float64Array[];
  /** Whether the first row has been merged. */
  isMerged: boolean;
}

export function createQueue(): RowQueue {
  return { rows: [], isMerged: false };
}

/** Adds the rows of a frame. A sample at the time of the last row replaces it, and time that goes back empties the queue. */
export function pushRows(queue: RowQueue, rows: Float64Array, width: number): void {
  for (let at = 0; at + width <= rows.length; at += width) {
    const row = rows.slice(at, at + width);
    const last = queue.rows[queue.rows.length - 1];
    if (last !== undefined && timeOf(row) < timeOf(last)) [queue.rows, queue.isMerged] = [[], false];
    if (last !== undefined && timeOf(row) === timeOf(last)) {
      queue.rows.pop();
      if (queue.rows.length === 0) queue.isMerged = false;
    }
    queue.rows.push(row);
  }
}

/**
 * Merges the rows of all queues up to the time that all have reached; `null` stands for a lab that has broken and has no values. A row has the
 * time, then for each number its value in every lab. A frame may have thinned out the rows of a lab, so that values between rows are interpolated.
 */
export function mergeRows(queues: readonly (RowQueue | null)[], width: number): Float64Array {
  const active = queues.filter((queue) => queue !== null);
  const end = Math.min(...active.map(({ rows }) => timeOf(rows[rows.length - 1])));
  const pending = active.flatMap(({ rows, isMerged }) => rows.slice(isMerged ? 1 : 0).map(timeOf));
  const times = [...new Set(pending)].filter((time) => time <= end).sort((a, b) => a - b);
  const merged = new Float64Array(times.length * (1 + (width - 1) * queues.length));
  let at = 0;
  for (const time of times) {
    merged[at++] = time;
    const values = queues.map((queue) => (queue === null ? null : rowAt(queue.rows, time)));
    for (let i = 1; i < width; i++) for (const row of values) merged[at++] = row?.(i) ?? NaN;
  }
  for (const queue of active) forget(queue, end);
  return merged;
}

const timeOf = (row: Float64Array | undefined): number => row?.[0] ?? NaN;

/** The values at a time, by their place in a row. */
function rowAt(rows: readonly Float64Array[], time: number): (i: number) => number {
  const place = rows.findIndex((row) => timeOf(row) >= time);
  const [after, before] = [rows[place], rows[place - 1]];
  if (after === undefined) return () => NaN;
  if (timeOf(after) === time) return (i) => after[i] ?? NaN;
  // A lab that a program has reset later than the others has no row of this time.
  if (before === undefined) return () => NaN;
  const part = (time - timeOf(before)) / (timeOf(after) - timeOf(before));
  return (i) => (before[i] ?? NaN) + part * ((after[i] ?? NaN) - (before[i] ?? NaN));
}

/** Drops the rows before the last one that was merged. */
function forget(queue: RowQueue, end: number): void {
  const kept = queue.rows.filter((row) => timeOf(row) <= end).length - 1;
  if (kept < 0) return;
  queue.rows = queue.rows.slice(kept);
  queue.isMerged = true;
}
