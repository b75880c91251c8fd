// The time that a page asks for, as whole steps.
import assert from "node:assert/strict";
import test from "node:test";
import { load } from "./load.mjs";

const { createBudget } = await load("engine/session.ts");

/** Uses up a time, and returns the number of steps and what is left. */
function play(seconds, timestep) {
  const budget = createBudget(seconds);
  let steps = 0;
  for (; budget.allows(timestep); steps++) budget.use(timestep);
  return { steps, left: budget.left() };
}

test("a time that is a whole number of steps gives that number", () => {
  for (const [seconds, timestep, steps] of [[0.1, 0.002, 50], [0.3, 0.1, 3], [0.1, 1e-6, 100_000], [1, 0.001, 1000], [0.1, 0.003, 33], [0.001, 0.002, 0]]) {
    assert.equal(play(seconds, timestep).steps, steps, `${seconds} s of ${timestep} s`);
  }
});

test("what is left of many frames does not drift", () => {
  for (const timestep of [0.001, 0.002, 0.0007]) {
    let [carry, made] = [0, 0];
    for (let frame = 1; frame <= 60_000; frame++) {
      const { steps, left } = play(carry + 1 / 60, timestep);
      [carry, made] = [left, made + steps];
      assert.ok(Math.abs(frame / 60 - made * timestep - carry) < 1e-9);
    }
    assert.ok(carry < timestep);
  }
});

test("a step of another length is taken from what is left", () => {
  const budget = createBudget(0.1);
  for (let i = 0; i < 25; i++) budget.use(0.002);
  assert.ok(Math.abs(budget.left() - 0.05) < 1e-15);
  let steps = 0;
  for (; budget.allows(0.001); steps++) budget.use(0.001);
  assert.equal(steps, 50);
});
