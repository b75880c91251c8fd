// Texts: both languages say the same, and every text is said somewhere.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { load } from "./load.mjs";

const { english } = await load("text/en.ts");
const { german } = await load("text/de.ts");
const { OVERLAYS } = await load("spec.ts");
const root = join(dirname(fileURLToPath(import.meta.url)), "../src");
const names = (text) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort().join();

test("German and English have the same texts with the same names", () => {
  assert.deepEqual(Object.keys(german), Object.keys(english));
  for (const [key, text] of Object.entries(english)) assert.equal(names(german[key]), names(text), key);
});

test("every text is used", () => {
  const sources = readdirSync(root, { recursive: true }).filter((file) => file.endsWith(".ts") && !/^text[/\\](en|de)\.ts$/.test(file));
  const all = sources.map((file) => readFileSync(join(root, file), "utf8")).join("\n");
  for (const key of Object.keys(english)) assert.ok(OVERLAYS.includes(key) || all.includes(`"${key}"`), key);
});
