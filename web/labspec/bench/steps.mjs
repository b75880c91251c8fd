// Steps of labs beside those of @mujoco/mujoco, in one run in node and one in Chromium; sizes of the modules.
//
//   node bench/steps.mjs SHARED [--out ../../docs/measured/web.md]
//
// SHARED is the folder with `corpus`, `bench` and `conformance`. The package must be built (`npm run build`). With `--out`, the tables
// between the marks of that page are written anew.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { root, web } from "../test/packed/server.mjs";
import { chromiumPage } from "../test/page.mjs";
import { writeSection } from "./section.mjs";

const [shared, , out] = process.argv.slice(2);
if (shared === undefined) throw new Error("SHARED is missing: node bench/steps.mjs SHARED [--out PAGE.md]");

// Name, model, seconds before, steps in a round, aim.
const SCENES = [
  ["free fall", "corpus/models/free_fall.xml", 0.1, 20000, 4],
  ["pendulum", "bench/pendulum.xml", 0.1, 20000, 4],
  ["double pendulum", "bench/double_pendulum.xml", 0.1, 20000, 4],
  ["cart and pole", "bench/cartpole.xml", 0.1, 20000, 3.5],
  ["balls at rest", "corpus/models/ball_drop.xml", 3, 10000, 4],
  ["cube on a table", "corpus/models/cube_table.xml", 1, 10000, 3.5],
  ["gripper", "corpus/models/gripper.xml", 1, 10000, 2.5],
  ["chain of 100 hinges", "bench/chain100.xml", 0.1, 1000, 4],
  ["humanoid on the floor", "conformance/models/benchmark__humanoid.xml", 1, 2000, 2],
  ["27 boxes piled", "bench/boxes27.xml", 1, 500, 3.5],
];

/** Microseconds of a step of both, medians of five rounds in turn. Runs in node and, as text, in a page. */
function measure(Lab, mj, xml, before, steps) {
  const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1];
  const lab = new Lab(JSON.stringify({ model: "m", readouts: [{ label: "q", expr: "data.qpos[0]" }] }), { m: xml });
  const model = mj.MjModel.from_xml_string(xml);
  const data = new mj.MjData(model);
  const h = model.opt.timestep;
  lab.playTo(before);
  for (let i = 0; i < before / h; i++) mj.mj_step(model, data);
  const [ours, theirs] = [[], []];
  for (let round = 0; round < 5; round++) {
    let start = performance.now();
    const made = lab.playTo(lab.time + steps * h);
    ours.push(((performance.now() - start) / made) * 1e3);
    start = performance.now();
    for (let i = 0; i < steps; i++) mj.mj_step(model, data);
    theirs.push(((performance.now() - start) / steps) * 1e3);
  }
  data.delete();
  model.delete();
  return [middle(ours), middle(theirs)];
}

const official = join(web, "node_modules/@mujoco/mujoco");
const scenes = SCENES.map(([name, file, before, steps, aim]) => ({ name, xml: readFileSync(join(shared, file), "utf8"), before, steps, aim }));

async function inNode() {
  const { Lab } = await import("labspec");
  const mj = await (await import(pathToFileURL(join(official, "mujoco.js")).href)).default();
  return scenes.map(({ xml, before, steps }) => measure(Lab, mj, xml, before, steps));
}

async function inChromium() {
  const { evaluate, close } = await chromiumPage(`
globalThis.Lab = (await import("/dist/browser.js")).Lab;
globalThis.mj = await (await import("/official/mujoco.js")).default();
globalThis.measure = ${measure}`, { links: { official } });
  try {
    const rows = [];
    for (const { xml, before, steps } of scenes) {
      rows.push(await evaluate(([a, b, c]) => globalThis.measure(globalThis.Lab, globalThis.mj, a, b, c), [xml, before, steps]));
    }
    return rows;
  } finally {
    await close();
  }
}

const size = (path) => {
  const bytes = readFileSync(path);
  const brotli = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } });
  return [bytes.length, gzipSync(bytes, { level: 9 }).length, brotli.length].map((n) => n.toLocaleString("en"));
};

const node = await inNode();
const page = await inChromium();
const cells = ([ours, theirs]) => [`1/${(theirs / ours).toFixed(2)}`, ours.toFixed(2)];
const lines = [
  "| scene | node | µs | Chromium | µs | aim |",
  "|---|---:|---:|---:|---:|---:|",
  ...scenes.map(({ name, aim }, i) => `| ${[name, ...cells(node[i]), ...cells(page[i]), `1/${aim}`].join(" | ")} |`),
  "",
  "| module | bytes | `gzip -9` | brotli 11 | aim, gzip |",
  "|---|---:|---:|---:|---:|",
  `| player | ${size(join(root, "dist/labspec.wasm")).join(" | ")} | 840,000 |`,
  `| checker, which contains the player | ${size(join(root, "dist/checker/labspec.wasm")).join(" | ")} | 1,300,000 |`,
  `| player in scripts: packed | ${size(join(root, "generated/player/labspec_bg.packed")).join(" | ")} | |`,
  `| checker in scripts: packed | ${size(join(root, "generated/checker/labspec_bg.packed")).join(" | ")} | |`,
  `| official | ${size(join(official, "mujoco.wasm")).join(" | ")} | |`,
];
console.log(lines.join("\n"));
if (out !== undefined) writeSection(out, "steps.mjs", lines);
