// States in addresses: the same bits come back, and what is no state is refused.
import assert from "node:assert/strict";
import test from "node:test";
import { Lab } from "labspec";
import { load, random } from "./load.mjs";

const { checkState, decodeState, encodeState, fragmentWith, stateInFragment, StateError } = await load("state/fragment.ts");
const bits = (list) => [...new BigUint64Array(Float64Array.from(list).buffer)].join();
const models = { drop: "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body name='bob' pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>" };
const json = { model: "drop", controls: [{ label: "gravity", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, reset: true }], readouts: [{ label: "z (m)", expr: "data.qpos[2]" }] };

test("a state goes through an address with the same bits, forces of a drag included", async () => {
  const lab = new Lab(json, models);
  lab.set("gravity", -3.7);
  lab.step(200);
  lab.applyForce(1, [1 / 3, 0, 50, 0, 0.01, 0]);
  lab.step(50);
  lab.applyForce(1, [0, 0, 0, 0, 0, 0]);
  lab.step(100);
  const fragment = fragmentWith("#lab.other=abc&section", "drop 1", await encodeState(lab.save().toBytes()));
  assert.equal(stateInFragment(fragment, "other"), "abc");
  assert.ok(!fragment.includes("section") && fragmentWith("#play1=xyz", "drop", "a").startsWith("#play1=xyz&lab.drop=a"));
  const back = Lab.resume(await decodeState(stateInFragment(fragment, "drop 1")), json, models);
  for (const each of [lab, back]) each.step(77);
  assert.equal(bits(back.data.qpos), bits(lab.data.qpos));
  assert.equal(bits(back.data.qvel), bits(lab.data.qvel));
  assert.equal(back.time, lab.time);
});

test("a state that is too long for a link is not put into one", async () => {
  const next = random(5);
  const actions = Array.from({ length: 2000 }, () => ["set", "gravity", next()]);
  assert.equal(await encodeState(new TextEncoder().encode(JSON.stringify({ labspec: { format: 1, lab: "", actions } }))), null);
});

test("hostile states are refused", () => {
  const state = (actions) => new TextEncoder().encode(JSON.stringify({ labspec: { format: 1, lab: "x", actions } }));
  for (const actions of [[["play", 1e9]], [["play", 1e6], ["play", 1.5e6]], Array.from({ length: 60_000 }, () => ["reset"])]) {
    assert.throws(() => checkState(state(actions)), (e) => e instanceof StateError && e.reason === "too-long");
  }
  for (const bytes of [state([["play", -1]]), state([["play", 0.5]]), state([["play", null]]), state([1]), state({}), new TextEncoder().encode("null"), new TextEncoder().encode("{"), Uint8Array.of(255)]) {
    assert.throws(() => checkState(bytes), (e) => e instanceof StateError && e.reason === "damaged");
  }
});

test("fragments of any kind: a state or a refusal, never anything else", async () => {
  const next = random(11);
  const good = await encodeState(new Lab(json, models).save().toBytes());
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=&%+/#.<>\u0000ü";
  for (let run = 0; run < 2000; run++) {
    const kind = next();
    let text = good;
    if (kind < 0.4) {
      const at = Math.floor(next() * text.length);
      text = text.slice(0, at) + letters[Math.floor(next() * letters.length)] + text.slice(at + 1);
    } else if (kind < 0.6) text = text.slice(0, Math.floor(next() * text.length));
    else text = Array.from({ length: Math.floor(next() * 80) }, () => letters[Math.floor(next() * letters.length)]).join("");
    try {
      const bytes = await decodeState(text);
      try {
        Lab.resume(bytes, json, models);
      } catch (e) {
        assert.equal(e.name, "LabspecError");
      }
    } catch (e) {
      assert.ok(e instanceof StateError, `${text}: ${e}`);
    }
    assert.ok(stateInFragment(`#${text}`, "1") === null || typeof text === "string");
  }
});

test("a small link that unpacks to much is refused", async () => {
  const bomb = new Blob([new Uint8Array(64 << 20)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const text = Buffer.from(await new Response(bomb).arrayBuffer()).toString("base64url");
  await assert.rejects(decodeState(text.slice(0, 5999)), StateError);
});
