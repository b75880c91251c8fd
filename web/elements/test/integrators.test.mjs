// Labs that compare integrators: the lab of each, the samples of all, their states.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { load, random } from "./load.mjs";

const { comparedIntegrators, INTEGRATORS, labOfIntegrator, readSpec } = await load("lab/integrators.ts");
const { createQueue, mergeRows, pushRows } = await load("engine/merge.ts");
const { joinStates, splitState } = await load("engine/compared.ts");
const { driftOf } = await load("lab/comparison.ts");
const { addRows, createSeries } = await load("plot/series.ts");
// A test of the checker reads the same file, so that a page and a check run the same programs.
const { lab, apply, drift } = JSON.parse(readFileSync(new URL("integrators.json", import.meta.url), "utf8"));

test("each integrator is a lab with a select that sets it last, and with the plot of the energy first", () => {
  const names = comparedIntegrators(lab);
  assert.deepEqual(names, ["RK4", "Euler"]);
  const own = labOfIntegrator(lab, names, "Euler");
  assert.deepEqual(Object.keys(own).filter((key) => !(key in lab)), []);
  assert.equal(own.integrators, undefined);
  assert.equal(own.timestep, undefined);
  assert.deepEqual(own.controls[0], lab.controls[0]);
  assert.deepEqual(own.controls[1], {
    type: "select", label: "integrator", options: [["RK4", "RK4"], ["Euler", "Euler"]], value: "Euler", apply, init: true, reset: true,
  });
  assert.deepEqual(own.plots[0], { ylabel: "energy drift", window: 10, traces: [{ label: "energy drift", expr: drift }] });
  assert.deepEqual(own.plots[1], lab.plots[0]);
});

test("without a list, with an empty one and with unknown names", () => {
  assert.deepEqual(comparedIntegrators({ model: "a" }), []);
  assert.deepEqual(comparedIntegrators({ integrators: "Euler" }), []);
  for (const integrators of [[], ["rk4"], [1, null, {}]]) assert.deepEqual(comparedIntegrators({ integrators }), INTEGRATORS);
  assert.deepEqual(comparedIntegrators({ integrators: ["RK4", "RK4", "x"] }), ["RK4"]);
  for (const timestep of [0, -1, "0.1", NaN, Infinity]) {
    assert.ok(labOfIntegrator({ timestep }, INTEGRATORS, "RK4").controls[0].apply.startsWith("model.opt.integrator = "), `${timestep}`);
  }
});

test("a page shows a curve for each integrator, and any other lab as it is", () => {
  const spec = readSpec(lab, JSON.stringify(lab));
  assert.deepEqual(spec.plots.map(({ traces }) => traces.map(({ label }) => label)), [["RK4", "Euler"], ["RK4", "Euler"]]);
  assert.deepEqual(spec.compared.map(({ name }) => name), ["RK4", "Euler"]);
  assert.equal(JSON.parse(spec.compared[1].json).controls[1].value, "Euler");
  const two = { ...lab, plots: [{ traces: [{ label: "a", expr: "1" }, { label: "b", expr: "2" }] }] };
  assert.deepEqual(readSpec(two, "").plots[1].traces.map(({ label }) => label), ["a, RK4", "a, Euler", "b, RK4", "b, Euler"]);
  assert.deepEqual(readSpec({ model: "a" }, "{}").compared, []);
});

test("rows of all labs are merged up to the time that all have reached", () => {
  const queues = [createQueue(), createQueue()];
  const rows = (times, f) => Float64Array.from(times.flatMap((t) => [t, f(t)]));
  pushRows(queues[0], rows([0, 1, 2, 3], (t) => t), 2);
  pushRows(queues[1], rows([0, 2], (t) => 10 * t), 2);
  assert.deepEqual([...mergeRows(queues, 2)], [0, 0, 0, 1, 1, 10, 2, 2, 20]);
  assert.deepEqual([...mergeRows(queues, 2)], [], "nothing is merged twice");
  pushRows(queues[1], rows([4], (t) => 10 * t), 2);
  assert.deepEqual([...mergeRows(queues, 2)], [3, 3, 30]);
  pushRows(queues[0], rows([4], (t) => t), 2);
  assert.deepEqual([...mergeRows(queues, 2)], [4, 4, 40]);
  // A broken lab has no values, and the others do not wait for it.
  pushRows(queues[0], rows([5], (t) => t), 2);
  const [five, value, none] = mergeRows([queues[0], null], 2);
  assert.deepEqual([five, value], [5, 5]);
  assert.ok(Number.isNaN(none));
  // After a reset, all begin again.
  for (const queue of queues) pushRows(queue, rows([0], () => 7), 2);
  assert.deepEqual([...mergeRows(queues, 2)], [0, 7, 7]);
  assert.deepEqual([...mergeRows([null, null], 2)], []);
});

test("merged rows have every time once, and the samples of the labs at their times", () => {
  const next = random(3);
  for (let run = 0; run < 100; run++) {
    const queues = [createQueue(), createQueue(), createQueue()];
    const [seen, at] = [[], [0, 0, 0]];
    for (let frame = 0; frame < 20; frame++) {
      queues.forEach((queue, k) => {
        const rows = [];
        for (let i = 0; i < 1 + next() * 5; i++) rows.push(at[k]++, 100 * k + at[k]);
        pushRows(queue, Float64Array.from(rows), 2);
      });
      const merged = mergeRows(queues, 2);
      for (let i = 0; i < merged.length; i += 4) {
        seen.push(merged[i]);
        for (const k of [0, 1, 2]) assert.equal(merged[i + 1 + k], 100 * k + merged[i] + 1);
      }
    }
    assert.deepEqual(seen, Array.from({ length: Math.min(...at) }, (_, i) => i));
  }
});

test("the states of all labs are one state, and what is none is refused", () => {
  const states = [3, 4].map((n) => new TextEncoder().encode(JSON.stringify({ labspec: { actions: [["play", n]], seed: n / 3 } })));
  const joined = joinStates(states);
  assert.deepEqual(splitState(joined, 2), states);
  const bytes = (value) => new TextEncoder().encode(JSON.stringify(value));
  const long = { labspec: { actions: [["play", 3_000_000]] } };
  for (const [state, count] of [
    [joined, 3], [states[0], 2], [bytes({}), 2], [bytes(null), 2], [bytes({ labspec: { actions: [], states: [1, null] } }), 2],
    [bytes({ labspec: { actions: [], states: [long, long] } }), 2], [joinStates([bytes(long), bytes(long)]), 2], [new Uint8Array([255]), 2],
  ]) assert.throws(() => splitState(state, count), { name: "Error" });
});

test("the drift at the end and the largest one", () => {
  const series = createSeries(2);
  addRows(series, Float64Array.of(0, 0, NaN, 1, -0.5, NaN, 2, 0.25, NaN), 3, [0, 1]);
  assert.deepEqual(driftOf(series, 0), { last: 0.25, largest: 0.5 });
  assert.deepEqual(driftOf(series, 1), { last: NaN, largest: NaN });
  assert.deepEqual(driftOf(createSeries(1), 0), { last: NaN, largest: NaN });
});
