// Every lab of the corpus and of the example lessons gives the same bits over 10 s in the native program, in node, in Chromium, and in
// Firefox where it is installed.
//
//   LABSPEC=target/debug/labspec CORPUS=../shared/corpus node --test test/bits/bits.test.mjs
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { Lab } from "labspec";
import { root } from "../packed/server.mjs";
import { chromiumPage, firefoxPage, firefoxPath } from "../page.mjs";

const { LABSPEC: program, CORPUS: corpus } = process.env;
assert.ok(program !== undefined && corpus !== undefined, "LABSPEC is the program, CORPUS the folder with `labs` and `models`");
const specs = join(root, "../../specs");

/** The models of a folder by name. */
function modelsOf(folder) {
  const files = readdirSync(folder).filter((file) => file.endsWith(".xml"));
  return Object.fromEntries(files.map((file) => [file.slice(0, -4), readFileSync(join(folder, file), "utf8")]));
}

/** Labs: what the native program calls them, their JSON, and the folder of their models. */
function* labs() {
  for (const name of readdirSync(join(corpus, "labs")).filter((f) => f.endsWith(".json")).sort()) {
    const file = join(corpus, "labs", name);
    yield { name, address: file, text: readFileSync(file, "utf8"), folder: join(corpus, "models") };
  }
  for (const name of readdirSync(join(specs, "lessons")).filter((f) => f.endsWith(".md")).sort()) {
    const file = join(specs, "lessons", name);
    const fences = readFileSync(file, "utf8").matchAll(/^```lab simlab\n([^]*?)\n```$/gm);
    for (const [i, [, text]] of [...fences].entries()) yield { name: `${name}#${i + 1}`, address: `${file}#${i + 1}`, text, folder: join(specs, "models") };
  }
}

/** NaN has many bits: one of them stands for all. */
const hash = (rows) => {
  const list = Float64Array.from(rows, (x) => (Number.isNaN(x) ? NaN : x));
  return createHash("sha256").update(new Uint8Array(list.buffer)).digest("hex");
};

/** The rows of the native program; texts are NaN, as in `record`. */
function native(address, folder) {
  const args = ["run", address, "--models", folder, "--until", "10", "--format", "json"];
  // A run with findings ends with 1.
  const done = spawnSync(program, args, { encoding: "utf8", maxBuffer: 1 << 28 });
  assert.ok(done.status === 0 || done.status === 1, done.stderr);
  const report = JSON.parse(done.stdout);
  const rows = report.rows.map((row) => row.map((x) => (typeof x === "number" ? x : x === null ? NaN : Number(x))));
  for (const [row, column, name] of report.nonfinite?.rows ?? []) rows[row][column] = Number(name);
  const texts = (report.types ?? []).map((type) => type === "text" || type === "string");
  return { steps: rows.length - 1, texts, rows };
}

const script = `import * as labspec from "/dist/browser.js"; globalThis.labspec = labspec;`;
const hasFirefox = firefoxPath() !== undefined;
assert.ok(hasFirefox || process.env.LABSPEC_REQUIRE !== "all", "Firefox is not installed");
const pages = { Chromium: await chromiumPage(script), ...(hasFirefox ? { Firefox: await firefoxPage(script) } : {}) };
after(() => Promise.all(Object.values(pages).map((page) => page.close())));
const inPage = ([json, all, n]) => Array.from(new globalThis.labspec.Lab(json, all).record(n), (x) => String(Object.is(x, -0) ? "-0" : x));

let count = 0;
for (const { name, address, text, folder } of labs()) {
  test(name, async () => {
    const models = modelsOf(folder);
    const { steps, texts, rows } = native(address, folder);
    const width = rows[0].length;
    const masked = (list) => Array.from(list, (x, i) => (texts[i % width] ? 0 : x));
    const lab = new Lab(text, models);
    const here = masked(lab.record(steps));
    // `--until` goes on where a page stops.
    const expected = masked(rows.flat()).slice(0, lab.isOver ? here.length : undefined);
    assert.equal(here.length, expected.length);
    assert.equal(hash(here), hash(expected), "node");
    for (const [browser, page] of Object.entries(pages)) {
      const there = await page.evaluate(inPage, [text, models, steps]);
      assert.equal(hash(masked(there.map(Number))), hash(expected), browser);
    }
    count += expected.length;
  });
}
test("there are labs", () => {
  assert.ok(count > 100_000);
  console.log(`${count} numbers with the same bits natively, in node, ${Object.keys(pages).join(" and ")}`);
});
