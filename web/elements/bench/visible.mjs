// From navigation to the first picture of a lab, with its parts, in Chromium: `node bench/visible.mjs [SCRIPT…] [--site=FOLDER] [--runs=9]`. The pages are the
// first labs of the example lessons with the one file, or those of a site that `labspec build` has written into a folder of this repository. Every run has a new browser context, so that nothing is cached; several scripts take turns. Medians are
// printed. The parts overlap: each is the time at which something is done, in ms after the navigation.
import { readFileSync, readdirSync } from "node:fs";
import { join, relative, resolve } from "node:path";
import { launch, pageOf, repository, serve } from "../test/page/site.mjs";

const given = process.argv.slice(2);
const runs = Number(given.find((argument) => argument.startsWith("--runs="))?.slice(7) ?? 9);
const named = given.filter((argument) => !argument.startsWith("--"));
const scripts = named.length > 0 ? named : ["/web/elements/dist/labspec-elements.js"];

/** Marks of a page: functions of the browser that the elements call are wrapped. */
function watch() {
  const marks = globalThis.marks = {};
  const mark = (name) => { marks[name] ??= performance.now(); };
  const { define } = customElements;
  customElements.define = function (...args) {
    mark("script runs");
    return define.apply(this, args);
  };
  const { compileStreaming } = WebAssembly;
  WebAssembly.compileStreaming = (response) => {
    mark("compiling begins");
    return compileStreaming(response).finally(() => mark("module compiled"));
  };
  const { Worker } = globalThis;
  globalThis.Worker = class extends Worker {
    constructor(...args) {
      super(...args);
      mark("worker asked for");
      this.addEventListener("message", ({ data }) => mark(data === "ready" ? "engine ready" : "lab opened"));
    }
  };
  const wait = () => {
    const lab = document.querySelector("sim-lab")?.shadowRoot;
    if (lab?.querySelector("article.lab")) mark("outline on the page");
    const poster = lab?.querySelector(".poster");
    if (poster?.complete && !poster.hidden) mark("poster on the page");
    if (marks["lab on the page"] === undefined) requestAnimationFrame(wait);
  };
  requestAnimationFrame(wait);
  addEventListener("lab-ready", () => {
    mark("lab on the page");
    requestAnimationFrame(look);
  });
  // A copy is read: reading a canvas itself would change how the browser draws it.
  const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const look = () => {
    const canvas = document.querySelector("sim-lab").shadowRoot.querySelector(".view canvas");
    if (canvas.width > 0) copy.drawImage(canvas, canvas.width >> 1, canvas.height - 4, 1, 1, 0, 0, 1, 1);
    if (copy.getImageData(0, 0, 1, 1).data[3] === 0) return requestAnimationFrame(look);
    mark("picture");
    const script = performance.getEntriesByType("resource").find(({ name }) => name.endsWith("elements.js"));
    marks["script fetched"] = script.responseEnd;
  };
}

const models = Object.fromEntries(readdirSync(join(repository, "specs/models")).filter((name) => name.endsWith(".xml")).map((name) => [name.slice(0, -4), readFileSync(join(repository, "specs/models", name), "utf8")]));
const lessons = readdirSync(join(repository, "specs/lessons")).filter((name) => name.endsWith(".md")).sort();
const labs = lessons.flatMap((name) => /^```lab simlab\n([^]*?)\n```$/m.exec(readFileSync(join(repository, "specs/lessons", name), "utf8"))?.[1] ?? []);
const used = (text) => Object.entries(models).filter(([name]) => text.includes(`"${name}"`));
const element = (text) => `<sim-lab><script type="application/json">${text.replaceAll("</", "<\\/")}</script>${used(text).map(([name, xml]) => `<script type="model/mjcf" data-name="${name}">${xml}</script>`).join("")}</sim-lab>`;
const site = given.find((argument) => argument.startsWith("--site="))?.slice(7);
const lessonsOfSite = site === undefined ? [] : readdirSync(site).filter((name) => name.endsWith(".html") && readFileSync(join(site, name), "utf8").includes("<sim-lab id=\"lab-1\""));
const pages = Object.fromEntries(labs.flatMap((text, i) => scripts.map((script, j) => [`/${i}-${j}.html`, pageOf(element(text), { script })])));
const server = await serve(pages);
const browser = await launch();
const found = scripts.map(() => ({}));
const paths = site === undefined ? Object.keys(pages) : lessonsOfSite.map((name) => `/${relative(repository, resolve(site, name))}#lab-1`);
for (let run = 0; run <= runs; run++) {
  for (const path of paths) {
    const context = await browser.newContext();
    const page = await context.newPage();
    await page.addInitScript(watch);
    await page.goto(server.url + path);
    await page.waitForFunction(() => globalThis.marks["script fetched"] !== undefined);
    const marks = await page.evaluate(() => globalThis.marks);
    const list = found[site === undefined ? Number(path.split("-")[1][0]) : 0];
    // The first run warms up the browser.
    if (run > 0) for (const [name, time] of Object.entries(marks)) (list[name] ??= []).push(time);
    await context.close();
  }
}
const median = (list) => list.toSorted((a, b) => a - b)[list.length >> 1];
const smallest = (list) => Math.min(...list);
scripts.forEach((script, i) => {
  console.log(`${site ?? script}: ${site === undefined ? labs.length : paths.length} labs, ${runs} runs`);
  const rows = Object.entries(found[i]).sort((a, b) => median(a[1]) - median(b[1]));
  for (const [name, list] of rows) console.log(`  ${median(list).toFixed(0).padStart(5)} ms (${smallest(list).toFixed(0)})  ${name}`);
});
await browser.close();
server.close();
