import assert from "node:assert/strict";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { Worker } from "node:worker_threads";
import { Lab } from "labspec";
import { LabspecError, startWorker } from "labspec/worker";
import { bits, drop, lab as json } from "./common.mjs";

test("a worker has the same interface and the same numbers", async () => {
  const worker = startWorker();
  const lab = await worker.open(json, { drop });
  const here = new Lab(json, { drop });
  assert.deepEqual(await lab.controls, here.controls);
  await lab.set("gravity", -3);
  here.set("gravity", -3);
  assert.equal(await lab.playTo(0.5), here.playTo(0.5));
  const frame = await lab.frame;
  assert.equal(bits(frame.numbers), bits(here.numbers));
  assert.deepEqual([frame.poses.length, frame.time], [32, here.time]);
  assert.equal(bits(frame.poses), bits(here.poses));
  const state = await lab.save();
  const first = bits(await lab.record(100));
  await lab.restore(state);
  assert.equal(bits(await lab.record(100)), first);
  const resumed = Lab.resume(await state.toBytes(), json, { drop });
  assert.equal(bits(resumed.record(100)), first);
  await assert.rejects(lab.press("none"), (e) => e instanceof LabspecError && e.code === "call");
  await assert.rejects(lab.set(Symbol("x"), 1), (e) => e.code === "wrong-type");
  await assert.rejects(worker.open("{", { drop }), (e) => e instanceof LabspecError && e.findings.length > 0);
  const control = new AbortController();
  const run = lab.play(1e4, { signal: control.signal });
  assert.ok((await lab.time) >= 0, "other calls are answered meanwhile");
  control.abort();
  await assert.rejects(run, (e) => e.code === "aborted");
  await lab.reset();
  const { steps } = await lab.play(0.1);
  assert.equal(steps, 50);
  await lab.free();
  await assert.rejects(lab.time, (e) => e.code === "freed");
  worker.terminate();
  await assert.rejects(worker.open(json, { drop }), (e) => e.code === "worker");
});

test("a state is freed once, by itself or with its lab, and is unknown then", async () => {
  const worker = startWorker();
  const [lab, other] = [await worker.open(json, { drop }), await worker.open(json, { drop })];
  const [first, second] = [await lab.save(), await lab.save()];
  await first.free();
  const isFreed = (e) => e instanceof LabspecError && e.code === "freed" && e.message === "this state was freed";
  await assert.rejects(first.toBytes(), isFreed);
  await assert.rejects(lab.restore(first), isFreed);
  await assert.rejects(other.restore(second), (e) => e.code === "wrong-type");
  await lab.restore(second);
  await lab.free();
  await second.free();
  await assert.rejects(second.toBytes(), (e) => e.code === "freed");
  worker.terminate();
});

test("frames come through shared memory where there is any, and belong to the page", async () => {
  const worker = startWorker();
  const lab = await worker.open(json, { drop });
  assert.ok(lab.isShared);
  const first = await lab.frame;
  const [numbers, poses] = [bits(first.numbers), bits(first.poses)];
  assert.ok(!(first.poses.buffer instanceof SharedArrayBuffer));
  const here = new Lab(json, { drop });
  for (let i = 1; i <= 20; i++) {
    const [{ steps, ...frame }, asked] = await Promise.all([lab.play(i / 60), lab.frame]);
    assert.equal(steps, here.playTo(i / 60));
    assert.equal(bits([frame.time, ...frame.numbers, ...frame.poses]), bits([here.time, ...here.numbers, ...here.poses]));
    assert.equal(asked.poses.length, 32);
  }
  assert.deepEqual([bits(first.numbers), bits(first.poses)], [numbers, poses]);
  worker.terminate();
});

test("frames in shared memory are whole while they are written", async () => {
  // A worker writes frames of equal numbers without a pause.
  const code = `const { workerData } = require("node:worker_threads");
    import(workerData.file).then(({ SharedFrames }) => {
      const frames = new SharedFrames(workerData.memory);
      for (let i = 0; i < 300000; i++) frames.write({ time: i, numbers: new Float64Array(50).fill(i), poses: new Float32Array(64).fill(i) });
    });`;
  const { build } = await import("esbuild");
  const built = await build({ entryPoints: [fileURLToPath(new URL("../src/shared-frame.ts", import.meta.url))], bundle: true, format: "esm", write: false });
  const file = `data:text/javascript;base64,${Buffer.from(built.outputFiles[0].text).toString("base64")}`;
  const { SharedFrames } = await import(file);
  const frames = SharedFrames.like({ time: 0, numbers: new Float64Array(50), poses: new Float32Array(64) });
  const writer = new Worker(code, { eval: true, workerData: { file, memory: frames.memory } });
  let [done, different, last] = [false, 0, -1];
  writer.on("exit", () => { done = true; });
  while (!done) {
    for (let i = 0; i < 1000; i++) {
      const { time, numbers, poses } = frames.read();
      assert.ok(numbers.every((x) => x === time) && poses.every((x) => x === time) && time >= last);
      if (time !== last) different += 1;
      last = time;
    }
    await new Promise((resolve) => setImmediate(resolve));
  }
  assert.ok(different > 10 && frames.read().time === 299_999, `${different}`);
});
