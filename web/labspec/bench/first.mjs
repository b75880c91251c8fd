// Time to the first step in Chromium, by part, beside @mujoco/mujoco: medians of pages in turn.
//
//   node bench/first.mjs SHARED [--out ../../docs/measured/web.md]
//
// SHARED is the folder with `corpus`. The package must be built (`npm run build`).
import { mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, root, serve, web } from "../test/packed/server.mjs";
import { writeSection } from "./section.mjs";

const [shared, , out] = process.argv.slice(2);
if (shared === undefined) throw new Error("SHARED is missing: node bench/first.mjs SHARED [--out PAGE.md]");
const PAGES = 15;
const fall = JSON.stringify(readFileSync(join(shared, "corpus/models/free_fall.xml"), "utf8"));

/** A page that notes when what happens, from the first line of its script on. */
const page = (what) => `<!doctype html><link rel="icon" href="data:,"><script type="module">
const marks = {};
const mark = (name) => { marks[name] ??= performance.now() - begun; };
for (const name of ["compileStreaming", "instantiateStreaming"]) {
  const own = WebAssembly[name];
  WebAssembly[name] = (...args) => own.apply(WebAssembly, args).then((made) => { mark("compiled"); return made; });
}
const own = globalThis.fetch;
globalThis.fetch = (...args) => { mark("asked"); return own(...args); };
const begun = performance.now();
${what}
mark("step");
const [module] = performance.getEntriesByType("resource").filter((e) => e.name.endsWith(".wasm"));
if (module !== undefined) marks.fetched = module.responseEnd - begun;
globalThis.marks = marks;
</script>`;
const PAGES_OF = {
  ours: page(`const labspec = await import("/dist/browser.js");
mark("imported");
const lab = new labspec.Lab({ model: "m" }, { m: ${fall} });
mark("open");
lab.step();`),
  theirs: page(`const mj = await (await import("/official/mujoco.js")).default();
mark("imported");
const model = mj.MjModel.from_xml_string(${fall});
const data = new mj.MjData(model);
mark("open");
mj.mj_step(model, data);`),
  worker: page(`const { startWorker } = await import("/dist/worker-browser.js");
mark("imported");
const lab = await startWorker().open({ model: "m" }, { m: ${fall} });
mark("open");
await lab.step();`),
};

const site = mkdtempSync(join(tmpdir(), "labspec-first-"));
symlinkSync(join(root, "dist"), join(site, "dist"));
symlinkSync(join(web, "node_modules/@mujoco/mujoco"), join(site, "official"));
for (const [name, text] of Object.entries(PAGES_OF)) writeFileSync(join(site, `${name}.html`), text);
const server = await serve(site);
const browser = await chromium();
const all = { ours: {}, theirs: {}, worker: {} };
for (let i = 0; i < PAGES; i++) {
  for (const name of Object.keys(all)) {
    const tab = await browser.newPage();
    await tab.goto(`${server.url}/${name}.html`);
    await tab.waitForFunction("globalThis.marks !== undefined");
    for (const [mark, time] of Object.entries(await tab.evaluate("globalThis.marks"))) (all[name][mark] ??= []).push(time);
    await tab.close();
  }
}
await browser.close();
server.close();
rmSync(site, { recursive: true, force: true });

const cell = (name, mark) => {
  const list = (all[name][mark] ?? []).sort((a, b) => a - b);
  return list.length === 0 ? "" : `${list[list.length >> 1].toFixed(0)} (${list[0].toFixed(0)})`;
};
const ROWS = [
  ["asked", "the module is asked for"], ["fetched", "its last byte is there"], ["compiled", "it is compiled"], ["imported", "the import is done"],
  ["open", "the lab is open (the model and its data)"], ["step", "the first step is made"],
];
const lines = [
  "| ms from the page's script until | labspec | official | labspec in a worker |",
  "|---|---:|---:|---:|",
  ...ROWS.map(([mark, what]) => `| ${[what, cell("ours", mark), cell("theirs", mark), cell("worker", mark)].join(" | ")} |`),
];
console.log(lines.join("\n"));
if (out !== undefined) writeSection(out, "first.mjs", lines);
