// Every method with wrong things: always an error of JavaScript, never a trap, and everything works afterwards.
import assert from "node:assert/strict";
import test from "node:test";
import { Data, Expression, Lab, LabspecError, Model } from "labspec";
import { Checker } from "labspec/checker";
import * as whole from "labspec/checker";
import { bits, drop, lab as json } from "./common.mjs";

let seed = 20261126;
const random = (n) => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return Math.floor((seed / 2 ** 32) * n);
};
const pick = (list) => list[random(list.length)];

/** Objects that something was taken from. */
const detached = new Float64Array(4);
structuredClone(detached, { transfer: [detached.buffer] });
const freed = new Lab(json, { drop });
const freedState = freed.save();
freed.free();
const hostile = { get drop() { throw new Error("no"); } };
const loop = {};
loop.loop = loop;
const VALUES = [
  undefined, null, NaN, Infinity, -Infinity, -1, 0, 1, 2, 0.5, 1e9, 4294967296, 2 ** 53, -0, true, false, "", "x", "gravity", "kick",
  "mj_step1", "mj_forward", "mj_resetData", "body", "geom", "#1", "\ud800", "\0", "a".repeat(100_000), Symbol("s"), 10n, {}, [], [1, 2, 3], [NaN], ["x"], () => 1,
  new Float64Array(3), new Float64Array(7), detached, new Uint8Array(64), new ArrayBuffer(8), new DataView(new ArrayBuffer(8)), new BigInt64Array(2),
  new Date(), /x/, freed, freedState, loop, hostile, new Proxy({}, { get() { throw new TypeError("no"); }, ownKeys() { throw new TypeError("no"); } }),
  { drop }, drop, "<mujoco", "<mujoco/>", JSON.stringify(json), "data.qpos[2]", "data.qpos[9999999999]", "ctx.a = 1", "(".repeat(5000),
  "<mujoco><size nuserdata='2000000000'/></mujoco>", "<mujoco><worldbody><replicate count='1000000000'><geom size='1'/></replicate></worldbody></mujoco>",
];

/** Members of an object and its classes. */
function members(object) {
  const names = new Set();
  for (let at = object; at !== null && at !== Object.prototype && at !== Function.prototype; at = Object.getPrototypeOf(at)) {
    for (const name of Reflect.ownKeys(at)) names.add(name);
  }
  return [...names].filter((name) => !["constructor", "free", "prototype", Symbol.dispose].includes(name));
}

/** Whatever happens is an error of JavaScript, and none of the module. */
function trap(e, what) {
  assert.ok(e instanceof Error, `${String(what)} threw ${typeof e}`);
  assert.ok(!(e instanceof WebAssembly.RuntimeError), `${String(what)}: ${e.message}`);
  assert.ok(!(e instanceof LabspecError && e.code === "internal"), `${String(what)}: ${e.message}`);
  assert.doesNotMatch(e.message, /recursive use|unreachable|null pointer/, String(what));
}

async function batter(object, make, calls) {
  const names = members(object);
  let thrown = 0;
  for (let i = 0; i < calls; i++) {
    const name = pick(names);
    const args = Array.from({ length: random(5) }, () => pick(VALUES));
    if (name === "record" || name === "step" || name === "play") args[0] = typeof args[0] === "number" && args[0] > 100 && args[0] < 1e8 ? args[0] % 100 : args[0];
    if (name === "playTo" || name === "play") args[0] = typeof args[0] === "number" && args[0] > 1 ? pick([Infinity, 1e300, 2]) : args[0];
    try {
      const member = Reflect.get(object, name, object);
      if (typeof member === "function") {
        const result = Reflect.apply(member, object, args);
        if (result instanceof Promise) await result;
      } else if (args.length > 0) object[name] = args[0];
      if (ArrayBuffer.isView(member) && member.length > 0 && args.length > 1) member[random(member.length)] = Number(typeof args[1] === "number" ? args[1] : NaN);
    } catch (e) {
      trap(e, name);
      thrown += 1;
    }
    if (i % 50 === 0) object = make();
  }
  return thrown;
}

const model = Model.fromXML(drop);
const scenes = {
  "a lab": () => new Lab(json, { drop }),
  "a model": () => Model.fromXML(drop),
  "options": () => Model.fromXML(drop).opt,
  "data": () => new Data(Model.fromXML(drop)),
  "an expression": () => new Expression(model, "data.qpos[2]"),
  "a state": () => new Lab(json, { drop }).save(),
  "a checker": () => new Checker({ drop }),
};
for (const [name, make] of Object.entries(scenes)) {
  test(`${name} with wrong arguments`, async () => {
    const thrown = await batter(make(), make, name === "a checker" ? 1000 : 4000);
    assert.ok(name === "a state" || thrown > 0);
  });
}

test("constructors and static methods with wrong arguments", () => {
  for (const Class of [Lab, Model, Data, Expression, whole.Lab, Checker]) {
    for (let i = 0; i < 600; i++) {
      const args = Array.from({ length: random(5) }, () => pick([...VALUES, model]));
      try { new Class(...args); } catch (e) { trap(e, Class.name); }
      for (const name of members(Class).filter((n) => typeof Class[n] === "function")) {
        try { Class[name](...args); } catch (e) { trap(e, name); }
      }
    }
  }
});

test("methods of another object", async () => {
  const lab = new Lab(json, { drop });
  for (const name of members(lab)) {
    for (const other of [{}, null, freed, model, Object.create(Lab.prototype)]) {
      try {
        const found = Object.getOwnPropertyDescriptor(Lab.prototype, name);
        await Reflect.apply(found?.get ?? found?.value, other, []);
      } catch (e) { trap(e, name); }
    }
  }
});

test("everything works afterwards", () => {
  const [a, b] = [new Lab(json, { drop }), new whole.Lab(json, { drop })];
  assert.equal(bits(a.record(600)), bits(b.record(600)));
  const data = new Data(a.toModel());
  data.step(600);
  assert.equal(data.xpos[5], a.numbers[0]);
});
