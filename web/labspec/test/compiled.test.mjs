// `labspec/compiled`: labs on models that were compiled before, in a module without the MJCF compiler and without convex shapes.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { readFileSync, statSync } from "node:fs";
import test from "node:test";
import * as full from "labspec";
import { Data, Expression, Lab, LabspecError, Model } from "labspec/compiled";
import { bits, drop, lab as json } from "./common.mjs";

const bytes = full.Model.fromXML(drop).toBytes();
const throws = (what, code, message = /./) => assert.throws(what, (e) => e instanceof LabspecError && e.code === code && message.test(e.message));

test("a lab has the same bits as on the text, in both modules", () => {
  const labs = [new full.Lab(json, { drop }), new full.Lab(json, { drop: bytes }), new Lab(json, { drop: bytes })];
  const rows = labs.map((lab) => {
    lab.playTo(0.3);
    lab.press("kick");
    lab.set("gravity", -3);
    const saved = lab.save();
    lab.playTo(1);
    lab.restore(saved);
    return bits(lab.record(1000));
  });
  assert.equal(rows[1], rows[0]);
  assert.equal(rows[2], rows[0]);
  assert.deepEqual(labs[2].shown, labs[0].shown);
  assert.deepEqual([...labs[2].names("geom")], ["floor", "ball"]);
  const state = labs[2].save().toBytes();
  assert.equal(bits(Lab.resume(state, json, { drop: bytes }).record(100)), bits(labs[2].record(100)));
});

test("models, data and expressions", () => {
  const height = (of) => {
    const model = of.Model.fromBytes(bytes);
    const data = new of.Data(model);
    data.step(500);
    return new of.Expression(model, "data.body('bob').xpos[2] * 2").evaluate(data);
  };
  assert.equal(height({ Data, Expression, Model }), height(full));
});

test("a model as text is refused with the next step", () => {
  throws(() => Model.fromXML(drop), "mjcf-not-supported", /does not contain the MJCF compiler/);
  throws(() => new Lab(json, { drop }), "mjcf-not-supported");
  const { model, ...rest } = json;
  throws(() => new Lab({ ...rest, xml: drop }), "mjcf-not-supported");
});

test("bytes that are not a model of this version, and models that need convex shapes, are refused", () => {
  const damaged = Uint8Array.from(bytes, (byte, i) => (i === 200 ? byte ^ 1 : byte));
  for (const wrong of [damaged, bytes.subarray(0, 100), new Uint8Array()]) {
    throws(() => Model.fromBytes(wrong), "not-a-model", /not a compiled model of this version/);
    throws(() => new Lab(json, { drop: wrong }), "model-unreadable", /not a compiled model of this version/);
    assert.throws(() => new full.Lab(json, { drop: wrong }), (e) => e instanceof full.LabspecError && e.code === "model-unreadable");
  }
  const cylinders = full.Model.fromXML("<mujoco><worldbody><geom type='box' size='1 1 .1'/><body name='bob' pos='0 0 1'><freejoint/><geom type='cylinder' size='.1 .1'/></body></worldbody></mujoco>").toBytes();
  throws(() => new Lab(json, { drop: cylinders }), "model-unreadable", /convex/);
  throws(() => Model.fromBytes(cylinders), "no-convex-shapes", /convex/);
  assert.equal(new full.Lab(json, { drop: cylinders }).playTo(0.1), 50);
});

test("CommonJS, and the bytes of a page", () => {
  const require = createRequire(import.meta.url);
  const [required, slim] = [require("labspec/compiled"), require("labspec/compiled/slim")];
  slim.initSync(readFileSync(require.resolve("labspec/compiled.wasm")));
  for (const of of [required, slim]) assert.equal(new of.Lab(json, { drop: bytes }).playTo(0.2), 100);
});

test("the module is smaller by more than a sixth", () => {
  const size = (entry) => statSync(createRequire(import.meta.url).resolve(entry)).size;
  assert.ok(size("labspec/compiled.wasm") < size("labspec/labspec.wasm") * 5 / 6);
});
