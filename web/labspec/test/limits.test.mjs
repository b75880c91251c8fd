// Warnings of the engine, and limits of work.
import assert from "node:assert/strict";
import test from "node:test";
import { Data, Lab, LabspecError, Model } from "labspec";
import { bits, drop, lab as json } from "./common.mjs";

test("warnings of the engine are events, at the step in which they are raised", () => {
  const blow = { type: "button", label: "blow", run: "data.qvel[2] = 1e20" };
  const lab = new Lab({ ...json, controls: [...json.controls, blow] }, { drop });
  const seen = [];
  const off = lab.on("warning", ({ time, kind, index, count }) => seen.push([kind, index, count, Number(time.toFixed(3)), lab.time < 0.01]));
  lab.playTo(0.1);
  assert.deepEqual(seen, []);
  lab.press("blow");
  lab.playTo(0.3);
  lab.press("blow");
  lab.step();
  assert.deepEqual(seen, [["badqvel", 2, 1, 0.1, true], ["badqvel", 2, 1, 0.3, true]]);
  const state = lab.save();
  lab.playTo(1);
  lab.restore(state);
  lab.playTo(0.1);
  assert.equal(seen.length, 2, "a state that holds a warning raises none");
  off();
  lab.press("blow");
  lab.playTo(0.2);
  assert.equal(seen.length, 2);
});

test("steps that need more work than they may are undone", () => {
  const model = Model.fromXML(drop);
  const [data, plain] = [new Data(model), new Data(model)];
  data.step(200);
  plain.step(200);
  const before = bits(data.qpos);
  assert.throws(() => data.step(10_000, { work: 20_000 }), (e) => e instanceof LabspecError && e.code === "too-much-work");
  assert.equal(bits(data.qpos), before);
  data.step(300, { work: 1e9 });
  plain.step(300);
  assert.equal(bits([...data.qpos, ...data.qvel, data.time]), bits([...plain.qpos, ...plain.qvel, plain.time]));
  assert.throws(() => data.step(1, { work: -1 }), (e) => e.code === "wrong-type");
});

test("a scene that needs too much work is an error, and the lab goes on", () => {
  // The distances of all pairs of geoms of two bodies, which the lab does not read.
  const geoms = Array.from({ length: 600 }, (_, i) => `<geom size='.01' mass='0' pos='${i % 20} ${Math.floor(i / 20)} 0' contype='0' conaffinity='0'/>`).join("");
  const body = (name, z) => `<body name='${name}' pos='0 0 ${z}'><freejoint/><geom size='.1'/>${geoms}</body>`;
  const sensors = "<distance body1='a' body2='b' cutoff='1000'/>".repeat(900);
  const big = `<mujoco><worldbody>${body("a", 20)}${body("b", 30)}</worldbody><sensor>${sensors}</sensor></mujoco>`;
  const lab = new Lab({ model: "big", readouts: [{ label: "h", expr: "data.qpos[2]" }] }, { big });
  lab.step();
  for (let i = 0; i < 2; i++) assert.throws(() => lab.poses, (e) => e instanceof LabspecError && /more work than a page allows/.test(e.message));
  lab.playTo(0.1);
  assert.ok(lab.numbers[0] < 20 && !lab.isOver);
});
