// Plots as data: samples, ranges, ticks, tables.
import assert from "node:assert/strict";
import test from "node:test";
import { load, random } from "./load.mjs";

const { addRows, createSeries, extremes, nearestIndex, toCsv } = await load("plot/series.ts");
const { tickSpacing, ticks, timeRange, valueRange } = await load("plot/scale.ts");
const { describeTrace, tableRows } = await load("plot/summary.ts");
const { english } = await load("text/en.ts");
const say = (name, values = {}) => english[name].replace(/\{(\w+)\}/g, (_, key) => String(values[key]));
const spec = { ylabel: "", xlabel: null, window: 5, ymin: null, ymax: null, height: 140, refLines: [], traces: [] };
const fill = (series, count, f) => addRows(series, Float64Array.from(Array.from({ length: count }, (_, i) => [i * 0.01, f(i * 0.01)]).flat()), 2, [0]);

test("samples are kept in order, and time that goes back clears them", () => {
  const series = createSeries(2);
  addRows(series, Float64Array.of(0, 1, 2, 0.1, 3, 4), 3, [1, 0]);
  assert.deepEqual([series.length, series.values[0][1], series.values[1][1]], [2, 4, 3]);
  addRows(series, Float64Array.of(0.1, 5, 6), 3, [1, 0]);
  assert.deepEqual([series.length, series.values[0][1]], [2, 6], "the same time is the same sample");
  addRows(series, Float64Array.of(0, 7, 8), 3, [1, 0]);
  assert.deepEqual([series.length, series.values[0][0]], [1, 8]);
});

/** A long run with peaks; `longest` is the longest time between two samples that are kept, by the place of the later one. */
function longRun(count, window) {
  const series = createSeries(2, window);
  const peaks = [1000, 20_001, 40_002, count - 30_000, count - 10];
  const value = (i) => (peaks.includes(i) ? 9 : Math.sin(i));
  for (let i = 0; i < count; i++) addRows(series, Float64Array.of(i, value(i), -value(i)), 3, [0, 1]);
  assert.ok(series.length >= 1 << 14 && series.length <= 1 << 15);
  const times = Array.from(series.times.subarray(0, series.length));
  assert.deepEqual([times[0], times.at(-1)], [0, count - 1]);
  times.forEach((time, i) => assert.ok(i === 0 || time > times[i - 1]));
  times.forEach((time, i) => assert.deepEqual([series.values[0][i], series.values[1][i]], [value(time), -value(time)]));
  assert.deepEqual(times.filter((_, i) => series.values[1][i] === -9), peaks);
  return (after) => Math.max(...times.slice(1).map((time, i) => (time > after ? time - times[i] : 0)));
}

test("a long run is thinned out without losing a peak, and evenly", () => {
  const longest = longRun(400_000, Infinity);
  assert.equal(longest(390_000), 1);
  // 2048 parts of 195 s: two samples next to each other are at most two parts apart.
  assert.ok(longest(0) < 400, `${longest(0)}`);
});

test("what is in the window of a plot stays dense", () => {
  assert.equal(longRun(400_000, 5000)(395_000), 1);
  const longest = longRun(400_000, 40_000);
  assert.ok(longest(360_000) < 20 && longest(390_000) === 1, `${longest(360_000)}`);
});

test("a plot begins at its first sample where times are negative", () => {
  const series = createSeries(1);
  assert.deepEqual(timeRange(series, 2), { min: 0, max: 2 });
  addRows(series, Float64Array.of(-1, 5, -0.9, 6), 2, [0]);
  assert.deepEqual(timeRange(series, 2), { min: -1, max: 1 });
  addRows(series, Float64Array.of(1.5, 5), 2, [0]);
  assert.deepEqual(timeRange(series, 2), { min: -0.5, max: 1.5 });
});

test("ranges hold what is drawn", () => {
  const next = random(7);
  for (let run = 0; run < 200; run++) {
    const series = createSeries(1);
    const scale = 10 ** (next() * 12 - 6);
    fill(series, 1 + Math.floor(next() * 900), () => (next() - 0.5) * scale);
    const times = timeRange(series, spec.window);
    assert.ok(times.max - times.min - 5 < 1e-9 && times.max >= series.times[series.length - 1]);
    const range = valueRange(series, spec, times);
    const { min, max } = extremes(series, 0, 0, series.length);
    assert.ok(range.min < range.max && (times.min > 0 || (range.min <= min && range.max >= max)));
    const spacing = tickSpacing(range, 4);
    const marks = ticks(range, spacing);
    assert.ok(marks.length >= 1 && marks.length <= 7, `${marks}`);
  }
  for (const y of [0, 5, NaN]) {
    const series = createSeries(1);
    fill(series, 3, () => y);
    const range = valueRange(series, spec, timeRange(series, 5));
    assert.ok(range.max > range.min);
  }
});

test("the nearest sample, a table and a file", () => {
  const series = createSeries(1);
  fill(series, 500, (t) => Math.sin(t));
  assert.equal(nearestIndex(series, 1.004), 100);
  assert.equal(nearestIndex(series, 99), 499);
  const rows = tableRows(series);
  assert.equal(rows.length, 60);
  assert.deepEqual(rows[59], ["4.990", "-0.962"]);
  const lines = toCsv(series, ["=x, \"quoted\""], "time (s)").trimEnd().split("\n");
  assert.equal(lines[0], "time (s),\"'=x, \"\"quoted\"\"\"");
  lines.slice(1).forEach((line, i) => assert.deepEqual(line.split(",").map(Number), [series.times[i], series.values[0][i]]));
});

test("a trace in words", () => {
  const series = createSeries(1);
  fill(series, 201, (t) => t * (2 - t));
  assert.equal(describeTrace(series, 0, "height (m)", say), "height (m) goes from 0 to 0, highest 1 at 1.000 s.");
  const high = createSeries(1);
  fill(high, 101, (t) => 1000 + t);
  assert.equal(describeTrace(high, 0, "x", say), "x rises from 1000 to 1001.");
  fill(high, 51, (t) => 1000 + t);
  assert.equal(describeTrace(high, 0, "x", say), "x rises from 1000 to 1000.5.");
  assert.equal(new Set(tableRows(high).map((row) => row[1])).size, 51);
  const flat = createSeries(1);
  fill(flat, 5, () => 2);
  assert.equal(describeTrace(flat, 0, "x", say), "x stays at 2.");
});

test("the pitch of a value: from low to high, in equal intervals, and never outside", async () => {
  const { pitchOf } = await load("plot/sound.ts");
  assert.deepEqual([pitchOf(0, 0, 1), pitchOf(1, 0, 1)].map(Math.round), [220, 880]);
  assert.equal(Math.round(pitchOf(0.5, 0, 1)), 440);
  assert.deepEqual([pitchOf(-5, 0, 1), pitchOf(9, 0, 1), pitchOf(3, 3, 3)].map(Math.round), [220, 880, 440]);
});
