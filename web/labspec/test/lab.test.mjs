import assert from "node:assert/strict";
import { createRequire } from "node:module";
import test from "node:test";
import { Data, Expression, Lab, LabspecError, Model } from "labspec";
import { Lab as Checked } from "labspec/checker";
import { bits, drop, lab as json } from "./common.mjs";

const models = { drop };
const throws = (what, code, message = /./) => assert.throws(what, (e) => e instanceof LabspecError && e.code === code && message.test(e.message));

test("a lab opens, moves and plays", () => {
  const lab = new Lab(json, models);
  assert.deepEqual(lab.controls.map((c) => [c.kind, c.label]), [["slider", "gravity"], ["button", "kick"]]);
  assert.deepEqual(lab.shown, [{ label: "height (m)", unit: "m", digits: 3 }]);
  assert.equal(lab.playTo(0.2), 100);
  assert.ok(Math.abs(lab.numbers[0] - 0.806) < 0.001);
  lab.set("gravity", -1.6);
  assert.equal(lab.time, 0);
  assert.equal(lab.value("gravity"), -1.6);
  assert.equal(lab.value("gravty"), null);
  throws(() => lab.set("gravty", -1), "call", /gravity/);
  const rows = lab.record(10);
  assert.equal(rows.length, 22);
  assert.deepEqual([...lab.names("geom")], ["floor", "ball"]);
  assert.deepEqual([lab.poses.length, lab.poses[15], lab.poses === lab.poses], [32, 1, true]);
  assert.deepEqual([lab.data.qpos.shape, lab.model.geom_size.shape, lab.model.opt.timestep], [[7], [2, 3], 0.002]);
  assert.throws(() => { lab.data.qpos = [1]; }, /read-only here/);
  assert.equal(lab.toModel().opt.gravity[2], -1.6);
  assert.deepEqual(lab.writes, ["data.qvel", "model.opt.gravity"].sort((a, b) => lab.writes.indexOf(a) - lab.writes.indexOf(b)));
});

test("a lesson's lab opens by its address", () => {
  const block = (object) => `\`\`\`lab\n${JSON.stringify(object)}\n\`\`\`\n`;
  const lesson = block({ model: "none" }) + block(json);
  throws(() => Lab.ofLesson("a.md", lesson, "#2", models), "not-in-player", /labspec\/checker/);
  const lab = Checked.ofLesson("a.md", lesson, "#2", models);
  assert.equal(lab.controls.length, 2);
  assert.throws(() => Checked.ofLesson("a.md", "nothing", "#1", models), /no lab/);
});

test("CommonJS is ready at once and has the same numbers", () => {
  const required = createRequire(import.meta.url)("labspec");
  const [a, b] = [new Lab(json, models), new required.Lab(json, models)];
  assert.equal(bits(a.record(300)), bits(b.record(300)));
});

test("a state restores in mid contact, from bytes too, and goes on with the same bits", () => {
  const lab = new Lab(json, models);
  lab.playTo(0.1);
  lab.press("kick");
  lab.playTo(1.2);
  assert.ok(lab.contacts.length > 0);
  const state = lab.save();
  const bytes = state.toBytes();
  const first = bits(lab.record(1000));
  lab.restore(state);
  assert.equal(bits(lab.record(1000)), first);
  assert.equal(bits(Lab.resume(bytes, json, models).record(1000)), first);
  throws(() => Lab.resume(bytes, json, { drop: drop.replace("0 0 1", "0 0 2") }), "not-a-state", /another lab/);
  throws(() => Lab.resume(new TextEncoder().encode('{"labspec":{"format":2}}'), json, models), "not-a-state", /format 2/);
  throws(() => new Lab(json, models).restore(state), "call", /another lab/);
});

test("events come in the order of time", () => {
  const lab = new Lab({ ...json, stopAt: 2 }, models);
  const seen = [];
  lab.on("crossing", (e) => seen.push(["crossing", e.rising, e.time.toFixed(3)]), { number: "height (m)", level: 0.5 });
  lab.on("contact", (e) => seen.push(["contact", e.touching, e.time.toFixed(3)]));
  const off = lab.on("end", (e) => seen.push(["end", e.time.toFixed(3)]));
  lab.playTo(5);
  assert.deepEqual(seen.map(([what]) => what), ["crossing", "contact", "end"]);
  off();
  const plain = new Lab({ ...json, stopAt: 2 }, models);
  plain.playTo(5);
  assert.equal(bits(plain.numbers), bits(lab.numbers));
  throws(() => lab.on("crossing", () => 0, { number: "x", level: 0 }), "unknown-name");
});

test("findings of a run arrive as events", () => {
  const lab = new Lab({ model: "drop", controller: "if (data.time > 0.05) { throw 'no'; }", readouts: json.readouts }, models);
  const before = lab.findings.length;
  const seen = [];
  lab.on("finding", (f) => seen.push(f));
  try { lab.playTo(1); } catch (e) { assert.ok(e instanceof LabspecError); }
  assert.equal(seen.length, lab.findings.length - before);
});

test("long work gives the page its turn and can be cancelled", async () => {
  const lab = new Lab(json, models);
  const control = new AbortController();
  let turns = 0;
  const timer = setInterval(() => { if (++turns === 3) control.abort(); }, 1);
  await assert.rejects(lab.play(1e4, { signal: control.signal, budget: 4 }), (e) => e.code === "aborted");
  clearInterval(timer);
  assert.ok(turns >= 3 && lab.time > 0);
  lab.reset();
  const plain = new Lab(json, models);
  assert.equal(await lab.play(0.5), plain.playTo(0.5));
  assert.equal(bits(lab.numbers), bits(plain.numbers));
});

test("fields are typed views with shape, made again when memory has grown", () => {
  const model = Model.fromXML(drop);
  const data = new Data(model);
  const { qpos } = data;
  assert.deepEqual([qpos.constructor, qpos.shape, data.xpos.shape, model.geom_type.shape], [Float64Array, [7], [2, 3], [2]]);
  data.step(50);
  assert.equal(qpos, data.qpos);
  qpos[2] = 3;
  data.forward();
  assert.equal(data.xpos[5], 3);
  const kept = [];
  const grown = () => { for (let i = 0; i < 400 && qpos.length > 0; i++) kept.push(new Data(model)); };
  grown();
  for (let i = 0; qpos.length > 0 && i < 60; i++) grown();
  assert.equal(qpos.length, 0, "memory has grown");
  assert.deepEqual([data.qpos.length, data.qpos[2], data.xpos[5]], [7, 3, 3]);
  for (const d of kept) d.free();
  throws(() => { data.qpos = [1, 2]; }, "wrong-length", /7 numbers, not 2/);
  throws(() => { data.xpos = new Float64Array(6); }, "read-only");
  throws(() => { data.ctrl = "x"; }, "wrong-type");
  assert.throws(() => { model.nq = 3; }, LabspecError);
});

test("what is written into views of a model acts", () => {
  const model = Model.fromXML(drop);
  const [a, b] = [new Data(model), new Data(model)];
  a.step(10);
  model.opt.gravity[2] = -1;
  b.step(10);
  a.reset();
  a.step(10);
  assert.equal(bits(a.qpos), bits(b.qpos));
  assert.ok(Math.abs(b.qvel[2] + 0.02) < 1e-12);
  model.opt.timestep = 0.001;
  b.step();
  assert.ok(Math.abs(b.time - 0.021) < 1e-12);
  model.geom_contype[1] = 0;
  model.geom_conaffinity[1] = 0;
  b.reset();
  b.step(3000);
  assert.ok(b.qpos[2] < 0, "it falls through the floor");
});

test("truth values are written as bytes of the page", () => {
  const model = Model.fromXML("<mujoco><option gravity='0 0 -10'/><worldbody><body name='a' pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody><equality><weld body1='a'/></equality></mujoco>");
  const data = new Data(model);
  data.step(100);
  assert.ok(data.qpos[2] > 0.9 && data.eq_active[0] === 1);
  data.eq_active[0] = 0;
  data.step(100);
  assert.ok(data.qpos[2] < 0.9);
  data.reset();
  assert.equal(data.eq_active[0], 1);
});

test("data are saved as bytes, mid contact", () => {
  const model = Model.fromXML(drop);
  const data = new Data(model);
  data.step(400);
  assert.ok(data.contacts.length > 0 && data.contacts[0].force[0] > 0);
  const bytes = data.save();
  data.step(1000);
  const after = bits(data.qpos) + bits(data.qvel);
  const other = new Data(model);
  other.restore(bytes);
  other.step(1000);
  assert.equal(bits(other.qpos) + bits(other.qvel), after);
  throws(() => other.restore(bytes.slice(0, 40)), "not-a-state");
  const again = Model.fromBytes(model.toBytes());
  assert.equal(again.nq, 7);
  throws(() => Model.fromBytes(new Uint8Array(100)), "not-a-model");
});

test("expressions compile against a model and give values and columns", () => {
  const model = Model.fromXML(drop);
  const data = new Data(model);
  const one = new Expression(model, ["data.qpos[2] * 2", "data.ncon > 0", "'a' + 1"]);
  data.forward();
  assert.deepEqual([one.evaluate(data), one.evaluate(data, 1), one.evaluate(data, 2)], [2, false, "a1"]);
  const [height, touches] = one.record(data, 500);
  assert.deepEqual([height.length, height[0], touches[0], touches[500]], [501, 2, 0, 1]);
  const act = new Expression(model, "data.qvel[2] = 5; model.opt.gravity[2] = 0", "statements");
  act.evaluate(data);
  assert.deepEqual([data.qvel[2], model.opt.gravity[2]], [5, 0]);
  assert.throws(() => new Expression(model, "'é😀' + data.qpso[2]"), (e) => e.findings[0]?.start === 13 && e.findings[0].column === 14 && e.findings[0].startByte > e.findings[0].start);
  throws(() => one.evaluate(new Data(Model.fromXML(drop))), "call-failed", /compiled for something else/);
});

test("mistakes are findings with UTF-16 places", () => {
  assert.throws(() => Model.fromXML("<mujoco>\n<!-- é😀 --><worldbody><geom sise='1'/></worldbody></mujoco>"), (e) => {
    const finding = e.findings.find((f) => f.code === "mjcf-unknown-attribute");
    return finding.file === "model.xml" && finding.line === 2 && finding.column === 30;
  });
  const lab = new Lab({ model: "drop", readouts: [{ label: "é", expr: "data.qpso[2]" }] }, models);
  const text = JSON.stringify({ model: "drop", readouts: [{ label: "é", expr: "data.qpso[2]" }] });
  const finding = lab.findings.find((f) => f.code === "unknown-field");
  assert.equal(text.slice(finding.start, finding.end), "qpso");
});

test("what was freed says so", () => {
  const lab = new Lab(json, models);
  lab.free();
  lab[Symbol.dispose]();
  throws(() => lab.time, "freed");
  const model = Model.fromXML(drop);
  const data = new Data(model);
  const { qpos } = data;
  data.free();
  throws(() => data.step(), "freed");
  qpos.fill(1);
  model.free();
  throws(() => new Data(model), "freed");
});

test("a force acts on a body until it is set again or the lab is reset, and is part of a state", () => {
  const drawn = new Lab(json, { drop });
  assert.deepEqual(drawn.readoutTexts, ["1.000"]);
  const mass = drawn.model.body_mass[1];
  drawn.applyForce(1, [0, 0, 19.8 * mass, 0, 0, 0]);
  drawn.step(100);
  assert.ok(Math.abs(drawn.data.qvel[2] - 2) < 1e-9, String(drawn.data.qvel[2]));
  const back = Lab.resume(drawn.save().toBytes(), json, { drop });
  for (const each of [drawn, back]) each.step(50);
  assert.equal(bits(back.data.qpos), bits(drawn.data.qpos));
  for (const [body, force] of [[0, [1, 0, 0, 0, 0, 0]], [7, [1, 0, 0, 0, 0, 0]], [1, [NaN, 0, 0, 0, 0, 0]], [1, [1]], [1, "up"]]) {
    assert.throws(() => drawn.applyForce(body, force), { name: "LabspecError" });
  }
  drawn.reset();
  drawn.step();
  const plain = new Lab(json, { drop });
  plain.step();
  assert.equal(bits(drawn.data.qpos), bits(plain.data.qpos));
});
