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
    ["2500 m/s²", "m/s^2", 2500], ["2500 m/s^2", "m/s²", 2500], ["2500m / s^2", "m/s^2", 2500], ["2,5·10^3", "", 2500], ["2.5 ⋅ 10^3", "", 2500], ["2,5×10³ m/s²", "m/s^2", 2500],
    ["2.5*10**3", "", 2500], ["2·10⁻³ s⁻¹", "s^-1", 2e-3], ["3 N·m", "N m", 3], ["3 N*m", "N·m", 3], ["5 \u00b5m", "\u03bcm", 5], ["5 eV", "eV", 5], ["+ 4", "", 4], ["−,5", "", -0.5],
    ["2500 m/s", "m/s^2", null], ["2,5·10", "", null], ["2 ² 3", "", null], ["25²", "", null], ["1e3.5", "", null], ["5 m", "", null],
    ["", "", null], ["abc", "", null], ["1,000,000", "", null], ["1.2.3", "", null], ["5 kg", "N", null], ["1e999", "", null], ["0x10", "", null], ["Infinity", "", null],
  ]) assert.equal(parseTyped(text, unit), value, text);
});

test("ticks, short numbers and units", () => {
  assert.equal(formatTick(0.30000000000000004, 0.1), "0.3");
  assert.equal(formatTick(-1e-17, 0.5), "0.0");
  assert.equal(formatTick(-2, 1), "−2");
  assert.equal(formatBrief(0.123456), "0.123");
  assert.equal(formatBrief(1234567), "1.23e+6");
  for (const [x, resolution, text] of [
    [1998, 1, "1998"], [1998, Infinity, "1998"], [12345, 50, "12345"], [1000.5, 0.01, "1000.5"], [1000.1234, 0.01, "1000.12"], [3.14159, 0.5, "3.14"], [3.14159, 0, "3.14159"],
    [123456, 1, "123456"], [123456, 5000, "1.23e+5"], [-1101325, 400, "-1.1013e+6"], [0.00012346, 1e-7, "1.235e-4"], [0, 0, "0"],
  ]) assert.equal(formatBrief(x, resolution), text, `${x} to ${resolution}`);
  for (const [values, spacing, texts] of [
    [[1.1e6, 1.11e6, 1.12e6], 1e4, "1.10e+6 1.11e+6 1.12e+6"], [[1e-4, 1.02e-4, 1.04e-4], 2e-6, "1.00e-4 1.02e-4 1.04e-4"], [[0, 2e-6], 2e-6, "0 2.0e-6"],
    [[1000, 1000.000002], 2e-6, "1000.000000 1000.000002"], [[-1e6, 0, 1e6], 1e6, "−1.0e+6 0 1.0e+6"], [[1e7, 1e7 + 0.5], 0.5, "10000000.0 10000000.5"],
  ]) assert.equal(values.map((x) => formatTick(x, spacing)).join(" "), texts);
  assert.equal(formatUnit("m/s^2"), "m/s²");
  assert.equal(formatUnit("s^-1"), "s⁻¹");
});
