// The connection of an editor with its worker: what is sent, what waits, and what fails.
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const root = join(dirname(fileURLToPath(import.meta.url)), "..");
const { outputFiles } = await build({ entryPoints: [join(root, "src/client.ts")], bundle: true, write: false, format: "esm", target: "es2022" });
const { CheckerClient, CheckerError } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);

/** A worker that records what it gets. */
class FakeWorker {
  static all = [];
  sent = [];
  isTerminated = false;
  constructor() { FakeWorker.all.push(this); }
  postMessage(message) { this.sent.push(message); }
  terminate() { this.isTerminated = true; }
  say(data) { this.onmessage({ data }); }
}
const start = () => {
  FakeWorker.all.length = 0;
  return new CheckerClient(() => new FakeWorker());
};

test("questions wait until the worker is ready; models are sent when they change", async () => {
  const client = start();
  client.models = { drop: "<mujoco/>", "a.obj": new Uint8Array(3) };
  const first = client.ask("findings", "a.md", "text");
  const [worker] = FakeWorker.all;
  assert.deepEqual(worker.sent, []);
  worker.say({ ready: true });
  assert.deepEqual(worker.sent.map(({ question, path, text, models }) => [question, path, text, Object.keys(models)]), [["findings", "a.md", "text", ["drop", "a.obj"]]]);
  worker.say({ id: worker.sent[0].id, answer: [] });
  assert.deepEqual(await first, []);
  void client.ask("hover", "a.md", "text", 3).catch(() => undefined);
  assert.deepEqual([worker.sent[1].models, worker.sent[1].offset], [{}, 3]);
  client.models = { drop: "<mujoco></mujoco>" };
  void client.ask("complete", "a.md", "text", 3).catch(() => undefined);
  assert.deepEqual(worker.sent[2].models, { drop: "<mujoco></mujoco>", "a.obj": null });
  assert.equal(FakeWorker.all.length, 1);
  client.dispose();
  assert.ok(worker.isTerminated);
});

test("an answer that is an error is one; a worker that cannot load says so, and the next question starts another one", async () => {
  const client = start();
  const asked = client.ask("format", "a.md", "x");
  const [worker] = FakeWorker.all;
  worker.say({ ready: true });
  worker.say({ id: worker.sent[0].id, error: "a text can have at most 16 MB" });
  await assert.rejects(asked, (e) => e instanceof CheckerError && /16 MB/.test(e.message));
  const lost = client.ask("findings", "a.md", "x");
  worker.onerror({ message: "no script", preventDefault() {} });
  await assert.rejects(lost, /does not answer: no script/);
  void client.ask("findings", "a.md", "x").catch(() => undefined);
  assert.equal(FakeWorker.all.length, 2);
  client.dispose();
});

test("a newer check ends the one that runs; questions while typing have a worker of their own", async () => {
  const client = start();
  const old = client.check("a.md", "1");
  void client.ask("findings", "a.md", "1").catch(() => undefined);
  const [first] = FakeWorker.all;
  const refused = assert.rejects(old, /newer text/);
  const now = client.check("a.md", "2");
  await refused;
  assert.ok(first.isTerminated);
  const last = FakeWorker.all.at(-1);
  last.say({ ready: true });
  assert.equal(last.sent[0].text, "2");
  last.say({ id: last.sent[0].id, answer: { outcome: "clean", findings: [], entries: [] } });
  assert.equal((await now).outcome, "clean");
  const again = client.check("a.md", "3");
  assert.equal(last.sent[1].text, "3");
  last.say({ id: last.sent[1].id, answer: { outcome: "clean", findings: [], entries: [] } });
  await again;
  client.dispose();
});

test("listeners hear of new models until they leave", () => {
  const client = start();
  let heard = 0;
  const leave = client.watch(() => { heard += 1; });
  client.models = {};
  leave();
  client.models = {};
  assert.equal(heard, 1);
});
