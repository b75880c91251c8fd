// Steps of labs beside those of @mujoco/mujoco, in one run in node and one in Chromium; time to the first step; sizes of the modules.
//
//   node bench/steps.mjs SHARED [--out ../../docs/measured/web.md]
//
// SHARED is the folder with `corpus`, `bench` and `conformance`. The package must be built (`npm run build`). With `--out`, the tables
// between the marks of that page are written anew.
import { mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { chromium, root, serve, web } from "../test/packed/server.mjs";

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
  const site = mkdtempSync(join(tmpdir(), "labspec-bench-"));
  symlinkSync(join(root, "dist"), join(site, "dist"));
  symlinkSync(official, join(site, "official"));
  const first = (what) => `<!doctype html><link rel="icon" href="data:,"><script type="module">
const begun = performance.now();
${what}
globalThis.first = performance.now() - begun;
</script>`;
  const fall = JSON.stringify(scenes[0].xml);
  writeFileSync(join(site, "ours.html"), first(`const labspec = await import("/dist/browser.js");
new labspec.Lab({ model: "m" }, { m: ${fall} }).step();
globalThis.Lab = labspec.Lab;`));
  writeFileSync(join(site, "theirs.html"), first(`const mj = await (await import("/official/mujoco.js")).default();
const model = mj.MjModel.from_xml_string(${fall});
mj.mj_step(model, new mj.MjData(model));
globalThis.mj = mj;`));
  const server = await serve(site);
  const browser = await chromium();
  const opened = async (path) => {
    const page = await browser.newPage();
    await page.goto(`${server.url}/${path}`);
    await page.waitForFunction("globalThis.first !== undefined");
    return page;
  };
  const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1];
  const times = { "ours.html": [], "theirs.html": [] };
  for (let round = 0; round < 5; round++) {
    for (const path of Object.keys(times)) {
      const page = await opened(path);
      times[path].push(await page.evaluate("globalThis.first"));
      await page.close();
    }
  }
  const page = await opened("ours.html");
  await page.evaluate(`import("/official/mujoco.js").then((m) => m.default()).then((mj) => { globalThis.mj = mj; })`);
  await page.evaluate(`globalThis.measure = ${measure.toString()}`);
  const rows = [];
  for (const { xml, before, steps } of scenes) {
    rows.push(await page.evaluate(([a, b, c]) => globalThis.measure(globalThis.Lab, globalThis.mj, a, b, c), [xml, before, steps]));
  }
  await browser.close();
  server.close();
  rmSync(site, { recursive: true, force: true });
  return { rows, first: [middle(times["ours.html"]), middle(times["theirs.html"])] };
}

const size = (path) => {
  const bytes = readFileSync(path);
  const brotli = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } });
  return [bytes.length, gzipSync(bytes, { level: 9 }).length, brotli.length].map((n) => n.toLocaleString("en"));
};

const node = await inNode();
const { rows: page, first } = await inChromium();
const cells = ([ours, theirs]) => [`1/${(theirs / ours).toFixed(2)}`, ours.toFixed(2)];
const lines = [
  "| scene | node | µs | Chromium | µs | aim |",
  "|---|---:|---:|---:|---:|---:|",
  ...scenes.map(({ name, aim }, i) => `| ${[name, ...cells(node[i]), ...cells(page[i]), `1/${aim}`].join(" | ")} |`),
  "",
  `The first step is ${first[0].toFixed(0)} ms after the import in Chromium, and ${first[1].toFixed(0)} ms with the official package (medians of five pages).`,
  "",
  "| module | bytes | `gzip -9` | brotli 11 | aim, gzip |",
  "|---|---:|---:|---:|---:|",
  `| player | ${size(join(root, "dist/labspec.wasm")).join(" | ")} | 840,000 |`,
  `| checker, which contains the player | ${size(join(root, "dist/checker/labspec.wasm")).join(" | ")} | 1,300,000 |`,
  `| official | ${size(join(official, "mujoco.wasm")).join(" | ")} | |`,
];
console.log(lines.join("\n"));
if (out !== undefined) {
  const text = readFileSync(out, "utf8");
  const [begin, end] = ["<!-- steps.mjs -->\n", "<!-- end -->"];
  const at = text.indexOf(begin) + begin.length;
  if (at < begin.length || !text.includes(end)) throw new Error(`${out} has no ${begin.trim()} … ${end}`);
  writeFileSync(out, text.slice(0, at) + lines.join("\n") + "\n" + text.slice(text.indexOf(end)));
}
