// An hour of simulated use of the corpus labs in Chromium, and the memory that it takes.
//
//   node bench/hour.mjs SHARED [--out ../../docs/measured/web.md]
//
// SHARED is the folder with `corpus`. The package must be built (`npm run build`).
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { chromiumPage, exposeHeap } from "../test/page.mjs";
import { root } from "../test/packed/server.mjs";
import { writeSection } from "./section.mjs";

const [shared, , out] = process.argv.slice(2);
if (shared === undefined) throw new Error("SHARED is missing: node bench/hour.mjs SHARED [--out PAGE.md]");
const [MINUTES, PART] = [60, 5];
const folder = join(shared, "corpus");
const models = Object.fromEntries(readdirSync(join(folder, "models")).filter((f) => f.endsWith(".xml")).map((f) => [f.slice(0, -4), readFileSync(join(folder, "models", f), "utf8")]));
const labs = readdirSync(join(folder, "labs")).filter((f) => f.endsWith(".json")).map((f) => ({ json: readFileSync(join(folder, "labs", f), "utf8"), models }));

const { page, close } = await chromiumPage(`
const Instance = WebAssembly.Instance;
WebAssembly.Instance = class extends Instance { constructor(...args) { super(...args); globalThis.memory = this.exports.memory; } };
globalThis.labspec = await import("/dist/browser.js");
globalThis.use = (await import("/test/use.mjs")).useLabs;`, { links: { test: join(root, "test") } });
await exposeHeap(page);
const begun = performance.now();
const sizes = await page.evaluate(([all, minutes, part]) => globalThis.use(globalThis.labspec, all, minutes, part, async () => [globalThis.memory.buffer.byteLength, await globalThis.heapSize()]), [labs, MINUTES, PART]);
const seconds = (performance.now() - begun) / 1000;
await close();
const row = (name, list) => `| ${[name, ...list].join(" | ")} |`;
const mb = (bytes) => (bytes / 2 ** 20).toFixed(1);
const lines = [
  row("minutes", sizes.map((_, i) => (i + 1) * PART)),
  row("---", sizes.map(() => "---:")),
  row("memory of the module, MB", sizes.map(([memory]) => mb(memory))),
  row("objects of JavaScript, MB", sizes.map(([, heap]) => mb(heap))),
  "",
  `${labs.length} labs, ${(MINUTES * 3600).toLocaleString("en")} frames, in ${seconds.toFixed(0)} s.`,
];
console.log(lines.join("\n"));
if (out !== undefined) writeSection(out, "hour.mjs", lines);
