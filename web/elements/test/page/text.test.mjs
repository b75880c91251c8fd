// HTML of authors and formulas, in a browser: nothing runs, nothing is loaded, text stays text.
import assert from "node:assert/strict";
import { join } from "node:path";
import test, { after } from "node:test";
import { build } from "esbuild";
import { random } from "../load.mjs";
import { launch, root, serve, watchErrors } from "./site.mjs";

const server = await serve({ "/page.html": "<!doctype html><title>x</title><link rel='icon' href='data:,'><body></body>" });
const browser = await launch();
const page = await browser.newPage();
const errors = watchErrors(page);
await page.goto(`${server.url}/page.html`);
const { outputFiles } = await build({ entryPoints: [join(root, "src/text/sanitize.ts")], bundle: true, write: false, format: "iife", globalName: "text" });
await page.evaluate(outputFiles[0].text.replace(/^"use strict";\s*var text/, "globalThis.text"));
after(async () => {
  await browser.close();
  server.close();
});

const safe = (html) => page.evaluate((text) => {
  const holder = document.createElement("div");
  holder.append(globalThis.text.safeHtml(text, document));
  document.body.replaceChildren(holder);
  return holder.innerHTML;
}, html);

test("what shows text stays", async () => {
  for (const html of ["<p>a <b>b</b> <code>$x$</code></p>", "<ul><li>one</li></ul>", '<a href="https://x.org/" rel="noopener noreferrer">x</a>', '<a href="#part" rel="noopener noreferrer">x</a>', "<table><tbody><tr><td colspan=\"2\">1</td></tr></tbody></table>"]) {
    assert.equal(await safe(html), html);
  }
});

test("what runs or loads is gone", async () => {
  await page.evaluate(() => { globalThis.ran = 0; });
  const requests = [];
  page.on("request", (request) => requests.push(request.url()));
  for (const [html, left] of [
    ["a<script>ran++</script>b", "ab"], ["<img src=x onerror=ran++>", ""], ["<img src='/pixel.png'>", ""], ["<b onclick='ran++'>x</b>", "<b>x</b>"],
    ["<a href='javascript:ran++'>x</a>", "<a rel=\"noopener noreferrer\">x</a>"], ["<a href=' java\nscript:ran++'>x</a>", "<a rel=\"noopener noreferrer\">x</a>"],
    ["<a href='data:text/html,x'>x</a>", "<a rel=\"noopener noreferrer\">x</a>"], ["<style>*{display:none}</style>x", "x"], ["<p style='position:fixed'>x</p>", "<p>x</p>"],
    ["<iframe src='/x'></iframe>", ""], ["<svg><script>ran++</script></svg>", ""], ["<math><mtext><img src=x onerror=ran++></mtext></math>", ""],
    ["<form action='/x'><button>x</button></form>", "x"], ["<template><img src=x onerror=ran++></template>", ""], ["<noscript><img src=x></noscript>", ""], ["<p id='x' class='hidden' part='view'>x</p>", "<p>x</p>"],
  ]) assert.equal(await safe(html), left, html);
  const next = random(9);
  const parts = ["<", ">", "script", "img", " src=x", " onerror=ran++", "/", "'", "\"", "<svg", "<math>", "<style>", "$", "\\frac{", "}", "&lt;", "<!--", "-->", "<a href=", "javascript:ran++", "<table>", "<p>", "\u0000"];
  for (let run = 0; run < 400; run++) {
    const html = Array.from({ length: 1 + Math.floor(next() * 14) }, () => parts[Math.floor(next() * parts.length)]).join("");
    const out = await safe(html);
    assert.doesNotMatch(out, /<(script|img|iframe|svg|style)|<[^>]*\son\w+=|href="?\s*javascript/i, html);
  }
  await page.waitForTimeout(100);
  assert.equal(await page.evaluate(() => globalThis.ran), 0);
  assert.deepEqual(requests, []);
  errors.none();
});

test("formulas become MathML, and stay readable where they are not understood", async () => {
  const bare = async (tex) => (await safe(`$${tex}$`)).replace(/<annotation[^]*?<\/annotation>|<\/?semantics>|<\/?math>/g, "");
  assert.equal(await bare("\\tau = m g c"), "<mrow><mi>τ</mi><mo>=</mo><mi>m</mi><mi>g</mi><mi>c</mi></mrow>");
  assert.equal(await bare("\\tfrac12 g h t^2"), "<mrow><mfrac><mn>1</mn><mn>2</mn></mfrac><mi>g</mi><mi>h</mi><msup><mi>t</mi><mn>2</mn></msup></mrow>");
  assert.equal(await bare("2\\pi\\sqrt{l/g}"), "<mrow><mn>2</mn><mi>π</mi><msqrt><mrow><mi>l</mi><mo>/</mo><mi>g</mi></mrow></msqrt></mrow>");
  assert.equal(await bare("x_i^{n+1}"), "<msubsup><mi>x</mi><mi>i</mi><mrow><mi>n</mi><mo>+</mo><mn>1</mn></mrow></msubsup>");
  assert.equal(await bare("\\strange"), "<mtext>\\strange</mtext>");
  assert.equal(await safe("It costs $5."), "It costs $5.");
  const next = random(4);
  const parts = ["{", "}", "^", "_", "\\frac", "\\sqrt", "\\left", "\\text{", "x", "12", "\\", "\\vec", " ", "&amp;", "\\,"];
  for (let run = 0; run < 300; run++) assert.match(await safe(`$x${Array.from({ length: Math.floor(next() * 30) }, () => parts[Math.floor(next() * parts.length)]).join("")}$`), /^<math>/);
  assert.match(await safe(`$${"\\sqrt{".repeat(2000)}$`), /^<math>/);
});
