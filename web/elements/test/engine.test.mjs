// Engines of a page: which one a lab gets, what an engine that fails leaves behind, and labs that are opened together.
import assert from "node:assert/strict";
import test from "node:test";
import { load } from "./load.mjs";

/** The addresses of blobs that are not revoked. */
const addresses = new Set();
const [{ createObjectURL, revokeObjectURL }, workers] = [URL, []];
URL.createObjectURL = (blob) => {
  const address = createObjectURL.call(URL, blob);
  addresses.add(address);
  return address;
};
URL.revokeObjectURL = (address) => {
  addresses.delete(address);
  revokeObjectURL.call(URL, address);
};
/** A worker that opens every lab but "bad", and leaves other calls than `free` unanswered. */
globalThis.Worker = class {
  constructor(url) {
    assert.ok(addresses.has(url));
    Object.assign(this, { isEnded: false, open: new Set(), opened: 0 });
    workers.push(this);
  }
  postMessage({ module, id, lab, call, args }) {
    const reply = (data) => queueMicrotask(() => this.onmessage({ data }));
    if (module !== undefined) return reply("ready");
    if (call === "open" && args[0] === "bad") return reply({ id, problem: { code: "x", message: "a bad lab", findings: [] } });
    if (call === "open") {
      this.open.add(++this.opened);
      reply({ id, result: { id: this.opened } });
    }
    if (call === "free") {
      this.open.delete(lab);
      reply({ id, result: null });
    }
  }
  terminate() { this.isEnded = true; }
};
Object.defineProperty(globalThis, "navigator", { value: { hardwareConcurrency: 3 }, configurable: true });
const { openCompared, openRemote, setEngineSource } = await load("engine/client.ts", "engine/compared.ts");
let module = () => Promise.reject(new Error("no module"));
setEngineSource({ workerUrl: null, serve: () => undefined, module: () => module() });
const open = (json) => openRemote(json, {}, null);
const openLabs = () => workers.map(({ open }) => open.size);

test("a start that fails leaves no worker and no address, and the next lab tries again", async () => {
  await assert.rejects(open("{}"), /no module/);
  assert.deepEqual([workers.map(({ isEnded }) => isEnded), addresses.size], [[true], 0]);
  workers.length = 0;
  module = () => Promise.resolve({});
  await (await open("{}")).ask("free");
  assert.deepEqual([workers.map(({ isEnded }) => isEnded), addresses.size], [[false], 0]);
});

test("a lab is opened in the engine that has the fewest; closed labs and refused ones do not count", async () => {
  const labs = [await open("{}"), await open("{}"), await open("{}")];
  assert.deepEqual(openLabs(), [2, 1]);
  for (const lab of [labs[0], labs[2]]) await lab.ask("free");
  for (let i = 0; i < 2; i++) await assert.rejects(open("bad"), /a bad lab/);
  labs.push(await open("{}"));
  assert.deepEqual(openLabs(), [1, 1]);
  for (const lab of [labs[1], labs[3]]) await lab.ask("free");
});

test("a comparison that cannot open one of its labs closes the others", async () => {
  const compared = ["{}", "bad", "{}"].map((json, i) => ({ name: `lab ${i}`, json }));
  await assert.rejects(openCompared(compared, "integrator", {}, null), /a bad lab/);
  assert.deepEqual(openLabs(), [0, 0]);
});

test("an engine that fails rejects all calls, and the next lab gets another one", async () => {
  const lab = await open("{}");
  const waiting = assert.rejects(lab.ask("step", 1), { name: "EngineError", message: "out of memory" });
  workers[0].onerror({ message: "out of memory" });
  await waiting;
  await assert.rejects(lab.ask("step", 1), { name: "EngineError", message: "out of memory" });
  assert.equal(workers[0].isEnded, true);
  await Promise.all([open("{}"), open("{}")]);
  assert.deepEqual(openLabs(), [1, 1, 1]);
});
