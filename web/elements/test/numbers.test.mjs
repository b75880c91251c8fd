// Numbers: as the engine prints them, as readers type them.
import assert from "node:assert/strict";
import test from "node:test";
import { Lab } from "labspec";
import { load, random } from "./load.mjs";

const { formatBrief, formatNumber, formatTick, formatUnit, parseTyped } = await load("text/numbers.ts");

test("numbers are printed as the engine prints readouts", () => {
  const next = random(1);
  const values = [0, -0, 1e-3, 9.99e-4, -1e-4, 99999.4, 1e5, -123456, NaN, Infinity, -Infinity, 0.5, 2.5, 1e300];
  for (let i = 0; i < 200; i++) values.push((next() - 0.5) * 10 ** Math.floor(next() * 14 - 7));
  const readouts = values.map((x, i) => ({ label: `x${i}`, digits: i % 6, expr: Object.is(x, -0) ? "-0" : Number.isFinite(x) ? String(x) : Number.isNaN(x) ? "NaN" : x > 0 ? "Infinity" : "-Infinity" }));
  const lab = new Lab({ xml: "<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>", readouts });
  assert.deepEqual(values.map((x, i) => formatNumber(x, i % 6)), [...lab.readoutTexts]);
});

test("what readers type", () => {
  for (const [text, unit, value] of [
    ["0.25", "", 0.25], ["0,25", "", 0.25], [" −3 ", "", -3], ["5.886 N m", "N m", 5.886], ["1e-3", "s", 1e-3], ["2 × 10^-3", "", 2e-3], [".5", "", 0.5],
    ["", "", null], ["abc", "", null], ["1,000,000", "", null], ["1.2.3", "", null], ["5 kg", "N", null], ["1e999", "", null], ["0x10", "", null], ["Infinity", "", null],
  ]) assert.equal(parseTyped(text, unit), value, text);
});

test("ticks, short numbers and units", () => {
  assert.equal(formatTick(0.30000000000000004, 0.1), "0.3");
  assert.equal(formatTick(-1e-17, 0.5), "0.0");
  assert.equal(formatTick(-2, 1), "−2");
  assert.equal(formatBrief(0.123456), "0.123");
  assert.equal(formatBrief(1234567), "1.23e+6");
  assert.equal(formatUnit("m/s^2"), "m/s²");
  assert.equal(formatUnit("s^-1"), "s⁻¹");
});
