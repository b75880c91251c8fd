// 10,000 labs are opened and dropped.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { drop, lab as json } from "./common.mjs";
import { Data, Lab, Model, init } from "labspec/slim";

const wasm = readFileSync(new URL("../dist/labspec.wasm", import.meta.url));
const grown = [];
const memories = [];
const Instance = WebAssembly.Instance;
WebAssembly.Instance = class extends Instance {
  constructor(...args) {
    super(...args);
    memories.push(this.exports.memory);
  }
};
await assert.rejects(init(new Uint8Array(10)), (e) => e.code === "not-ready");
assert.throws(() => new Lab(json), (e) => e.code === "not-ready" && /init/.test(e.message));
await init(wasm, { maximumMemory: 256 << 20 });
const size = () => memories[0].buffer.byteLength;

test("memory starts at 16 MB", () => assert.equal(size(), 16 << 20));

test("10,000 labs that are dropped leave memory flat", async () => {
  for (let i = 0; i < 10_000; i++) {
    const lab = new Lab(json, { drop });
    lab.step();
    if (i % 25 === 0) await new Promise((resolve) => setImmediate(resolve));
    if (i % 1000 === 0) grown.push(size());
  }
  console.log(`memory after each 1,000 labs: ${grown.map((b) => b >> 20).join(" ")} MB`);
  assert.ok(size() <= 96 << 20, `${size()}`);
});

test("10,000 labs that are freed leave memory as it is", () => {
  const before = size();
  for (let i = 0; i < 10_000; i++) {
    const lab = new Lab(json, { drop });
    lab.step();
    lab.free();
  }
  assert.equal(size(), before);
});

test("1,000 models with views leave memory flat", async () => {
  for (let i = 0; i < 1000; i++) {
    const model = Model.fromXML(drop);
    const data = new Data(model);
    data.qpos[2] = 2;
    data.step();
    if (i % 10 === 0) await new Promise((resolve) => setImmediate(resolve));
  }
  assert.ok(size() <= 96 << 20, `${size()}`);
});
