// Samples of a frame are thinned out without losing a peak.
import assert from "node:assert/strict";
import test from "node:test";
import { load, random } from "./load.mjs";

const { decimate } = await load("engine/decimate.ts");
const rowsOf = (count, value) => Array.from({ length: count }, (_, i) => [i * 1e-3, ...value(i)]);

test("few samples are kept as they are", () => {
  const rows = rowsOf(128, (i) => [i]);
  assert.equal(decimate(rows, [0]), rows);
});

test("a spike of one step stays, upwards and downwards, in every column", () => {
  for (const count of [129, 1000, 20_001]) {
    for (const at of [0, 1, 77, 128, count - 2, count - 1].filter((i) => i < count)) {
      const rows = rowsOf(count, (i) => [i === at ? 5 : 0, i === at ? -3 : 1]);
      const kept = decimate(rows, [0, 1]);
      assert.ok(kept.some((row) => row[1] === 5 && row[2] === -3), `${at} of ${count}`);
      assert.ok(kept.length <= 32 * 6, String(kept.length));
      assert.deepEqual([kept[0], kept.at(-1)], [rows[0], rows.at(-1)]);
    }
  }
});

test("rows stay in order and none is invented; what is no number is no peak", () => {
  const next = random(4);
  for (let run = 0; run < 40; run++) {
    const rows = rowsOf(129 + Math.floor(2000 * next()), () => [next() < 0.1 ? NaN : next(), next() < 0.5 ? NaN : Infinity, 7]);
    const kept = decimate(rows, [0, 1]);
    assert.ok(kept.every((row, i) => rows.includes(row) && (i === 0 || kept[i - 1][0] < row[0])));
    const finite = (list) => list.map((row) => row[1]).filter(Number.isFinite);
    assert.equal(Math.max(...finite(kept)), Math.max(...finite(rows)));
    assert.equal(Math.min(...finite(kept)), Math.min(...finite(rows)));
  }
});
