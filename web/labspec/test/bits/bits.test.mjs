// Every lab of the corpus gives the same bits in the native program, in node and in Chromium.
//
//   LABSPEC=target/debug/labspec CORPUS=../shared/corpus node --test test/bits/bits.test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after } from "node:test";
import { Lab } from "labspec";
import { chromium, root, serve } from "../packed/server.mjs";

const { LABSPEC: program, CORPUS: corpus } = process.env;
assert.ok(program !== undefined && corpus !== undefined, "LABSPEC is the program, CORPUS the folder with `labs` and `models`");
const models = {};
for (const file of readdirSync(join(corpus, "models")).filter((f) => f.endsWith(".xml"))) models[file.slice(0, -4)] = readFileSync(join(corpus, "models", file), "utf8");

/** NaN has many bits: one of them stands for all. */
const hash = (rows) => {
  const list = Float64Array.from(rows, (x) => (Number.isNaN(x) ? NaN : x));
  return createHash("sha256").update(new Uint8Array(list.buffer)).digest("hex");
};

/** The rows of the native program; texts are NaN, as in `record`. */
function native(file) {
  const args = ["run", file, "--models", join(corpus, "models"), "--format", "json"];
  const report = JSON.parse(execFileSync(program, args, { maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] }));
  const rows = report.rows.map((row) => row.map((x) => (typeof x === "number" ? x : x === null ? NaN : Number(x))));
  for (const [row, column, name] of report.nonfinite?.rows ?? []) rows[row][column] = Number(name);
  const texts = (report.types ?? []).map((type) => type === "text" || type === "string");
  return { steps: rows.length - 1, texts, rows };
}

const site = mkdtempSync(join(tmpdir(), "labspec-bits-"));
symlinkSync(join(root, "dist"), join(site, "dist"));
writeFileSync(join(site, "index.html"), `<!doctype html><link rel="icon" href="data:,"><script type="module">import * as labspec from "/dist/browser.js"; globalThis.labspec = labspec;</script>`);
const server = await serve(site);
const browser = await chromium();
const page = await browser.newPage();
await page.goto(`${server.url}/index.html`);
await page.waitForFunction("globalThis.labspec !== undefined");
after(async () => {
  await browser.close();
  server.close();
  rmSync(site, { recursive: true, force: true });
});

let count = 0;
for (const name of readdirSync(join(corpus, "labs")).filter((f) => f.endsWith(".json")).sort()) {
  test(name, async () => {
    const file = join(corpus, "labs", name);
    const text = readFileSync(file, "utf8");
    const { steps, texts, rows } = native(file);
    const width = rows[0].length;
    const masked = (list) => Array.from(list, (x, i) => (texts[i % width] ? 0 : x));
    const here = masked(new Lab(text, models).record(steps));
    const there = await page.evaluate(([json, all, n]) => Array.from(new globalThis.labspec.Lab(json, all).record(n), (x) => String(Object.is(x, -0) ? "-0" : x)), [text, models, steps]);
    const expected = masked(rows.flat());
    assert.equal(here.length, expected.length);
    assert.equal(hash(here), hash(expected), "node");
    assert.equal(hash(masked(there.map(Number))), hash(expected), "Chromium");
    count += expected.length;
  });
}
test("there are labs", () => {
  assert.ok(count > 10_000);
  console.log(`${count} numbers with the same bits natively, in node and in Chromium`);
});
