// Frames of the corpus labs beside a page that evaluates their texts as JavaScript over `@mujoco/mujoco`, in one run in node and one in
// Chromium.
//
//   node bench/frames.mjs SHARED [--out ../../docs/measured/web.md]
//
// SHARED is the folder with `corpus`. The package must be built (`npm run build`).
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { root, web } from "../test/packed/server.mjs";
import { chromiumPage } from "../test/page.mjs";
import { measureFrames } from "./frame.mjs";
import { writeSection } from "./section.mjs";

const [shared, , out] = process.argv.slice(2);
if (shared === undefined) throw new Error("SHARED is missing: node bench/frames.mjs SHARED [--out PAGE.md]");
const corpus = join(shared, "corpus");
const labs = readdirSync(join(corpus, "labs")).filter((f) => f.endsWith(".json")).sort();
const texts = labs.map((name) => readFileSync(join(corpus, "labs", name), "utf8"));
const files = readdirSync(join(corpus, "models")).filter((f) => f.endsWith(".xml"));
const models = Object.fromEntries(files.map((file) => [file.slice(0, -4), readFileSync(join(corpus, "models", file), "utf8")]));
const official = join(web, "node_modules/@mujoco/mujoco");
const mount = (mj, all) => Object.entries(all).forEach(([name, text]) => mj.FS.writeFile(`/${name}.xml`, text));

async function inNode() {
  const { Lab } = await import("labspec");
  const mj = await (await import(pathToFileURL(join(official, "mujoco.js")).href)).default();
  mount(mj, models);
  return texts.map((text) => measureFrames(Lab, mj, text, models));
}

async function inChromium() {
  const { evaluate, close } = await chromiumPage(`
import { Lab } from "/dist/browser.js";
import { measureFrames } from "/bench/frame.mjs";
const mj = await (await import("/official/mujoco.js")).default();
(${mount})(mj, ${JSON.stringify(models)});
globalThis.measure = (text) => measureFrames(Lab, mj, text, ${JSON.stringify(models)});`, { links: { bench: join(root, "bench"), official } });
  try {
    const rows = [];
    for (const text of texts) rows.push(await evaluate((t) => globalThis.measure(t), text));
    return rows;
  } finally {
    await close();
  }
}

const [node, page] = [await inNode(), await inChromium()];
const ratio = ([ours, theirs]) => theirs / ours;
const cells = ([ours, theirs]) => [`1/${(theirs / ours).toFixed(1)}`, ours.toFixed(2), theirs.toFixed(1)];
const mean = (rows, what) => Math.exp(rows.reduce((sum, row) => sum + Math.log(ratio(row[what])), 0) / rows.length).toFixed(1);
const table = (where, rows) => [
  `| ${where}: lab | steps | shown | frame | ours, µs | official, µs | without steps | ours, µs | official, µs |`,
  "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
  ...labs.map((name, i) => {
    const { steps, shown, frame, sample } = rows[i];
    return `| ${[name.replace(/_simlab|_sim|\.json/g, ""), steps, shown, ...cells(frame), ...cells(sample)].join(" | ")} |`;
  }),
  `| geometric mean | | | 1/${mean(rows, "frame")} | | | 1/${mean(rows, "sample")} | | |`,
];
const lines = [...table("node", node), "", ...table("Chromium", page)];
console.log(lines.join("\n"));
if (out !== undefined) writeSection(out, "frames.mjs", lines);
