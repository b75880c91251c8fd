// Size of the 3D view, and the time that a frame of 200 geoms takes of the main thread, in Chromium: node bench/view.mjs
import { gzipSync } from "node:zlib";
import { bundle, openPage, recorded } from "../test/view/common.mjs";

const GEOMS = 200, FRAMES = 240;

/** In the page: a scene of `count` geoms of every primitive type, drawn `frames` times with new poses. */
async function measure([scene, count, frames]) {
  const { view, scene: base } = show(scene, { width: 640, height: 420 });
  const table = (width, value) => Float64Array.from({ length: width * count }, (_, i) => value(Math.floor(i / width), i % width));
  const row = Math.ceil(Math.sqrt(count));
  const model = {
    ...base.model, geom_type: Int32Array.from({ length: count }, (_, i) => 2 + (i % 5)), geom_bodyid: new Int32Array(count).fill(1),
    geom_group: new Int32Array(count), geom_matid: new Int32Array(count).fill(-1), geom_dataid: new Int32Array(count).fill(-1),
    geom_size: table(3, (i, k) => 0.03 + 0.01 * k), geom_rgba: table(4, (i, k) => (k === 3 ? 1 : ((i * (k + 3) * 37) % 100) / 100)),
  };
  const pose = t => ({
    ...base.frame, time: t,
    geom_xpos: table(3, (i, k) => (k === 0 ? (i % row) * 0.12 - 0.8 : k === 1 ? Math.floor(i / row) * 0.12 - 0.8 : 0.1 + 0.02 * Math.sin(t + i))),
    geom_xmat: table(9, (i, k) => (k % 4 === 0 ? 1 : 0)),
  });
  view.setModel(model);
  view.camera.distance = 3;
  const times = [];
  for (let n = 0; n < frames; n++) {
    const frame = pose(n / 60);
    await new Promise(resolve => requestAnimationFrame(resolve));
    const start = performance.now();
    view.setFrame(frame);
    view.draw();
    times.push(performance.now() - start);
  }
  view.dispose();
  return times.slice(30).sort((a, b) => a - b);
}

const script = await bundle(`export { createView } from "./index.ts";`, "iife");
console.log(`size: ${script.length} bytes minified, ${gzipSync(script, { level: 9 }).length} bytes gzip`);
const { page, stop } = await openPage();
const times = await page.evaluate(measure, [recorded("endless"), GEOMS, FRAMES]);
await stop();
const quantile = q => times[Math.floor(q * (times.length - 1))].toFixed(2);
console.log(`main thread, ${GEOMS} geoms with shadows: median ${quantile(0.5)} ms, 90 % ${quantile(0.9)} ms, least ${quantile(0)} ms`);
