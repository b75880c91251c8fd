// Time from the script of the elements to a lab on the page and to its first picture, in Chromium: `node bench/first.mjs [SCRIPT…]`. Every run
// has a new browser context, so that nothing is cached; several scripts take turns. The median, the smallest and the largest of ten are printed.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { drop, dropLab, labOf, launch, pageOf, repository, serve } from "../test/page/site.mjs";

const RUNS = 10;
const given = process.argv.slice(2);
const scripts = given.length > 0 ? given : ["/web/elements/dist/labspec-elements.js", "/web/elements/dist/elements.js"];
const look = `<script>
  // The callback runs in the frame in which the page paints the lab, after the callbacks of the lab.
  addEventListener("lab-ready", () => requestAnimationFrame(() => { globalThis.readyAt = performance.now(); }));
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) if (entry.name.endsWith("elements.js")) globalThis.scriptAt = entry.responseEnd;
  }).observe({ type: "resource", buffered: true });
  // A copy is read: reading a canvas itself would change how the browser draws it.
  const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const look = () => {
    const canvas = document.querySelector("sim-lab").shadowRoot.querySelector(".view canvas");
    if (canvas.width > 0) copy.drawImage(canvas, canvas.width >> 1, canvas.height - 4, 1, 1, 0, 0, 1, 1);
    if (copy.getImageData(0, 0, 1, 1).data[3] > 0) globalThis.seenAt = performance.now();
    else requestAnimationFrame(look);
  };
  addEventListener("lab-ready", () => requestAnimationFrame(look));
</script>`;
const pendulum = readFileSync(join(repository, "specs/models/pendulum.xml"), "utf8");
const labs = {
  drop: labOf(dropLab, { models: { drop } }),
  pendulum: labOf({ model: "pendulum", readouts: [{ label: "angle", expr: "data.qpos[0]" }] }, { models: { pendulum } }),
};
const cases = Object.keys(labs).flatMap((lab) => scripts.map((script, i) => ({ lab, script, path: `/${lab}${i}.html`, pictures: [], readies: [] })));
const server = await serve(Object.fromEntries(cases.map(({ lab, script, path }) => [path, pageOf(labs[lab], { script, head: look })])));
const browser = await launch();
for (let run = 0; run <= RUNS; run++) {
  for (const { path, pictures, readies } of cases) {
    const context = await browser.newContext();
    const page = await context.newPage();
    await page.goto(server.url + path);
    await page.waitForFunction(() => globalThis.readyAt !== undefined && globalThis.seenAt !== undefined && globalThis.scriptAt !== undefined);
    const [picture, ready] = await page.evaluate(() => [globalThis.seenAt - globalThis.scriptAt, globalThis.readyAt - globalThis.scriptAt]);
    if (process.env.MARKS && run === RUNS) {
      console.log(await page.evaluate(() => performance.getEntriesByType("mark").map((m) => `${m.name} ${(m.startTime - globalThis.scriptAt).toFixed(0)}`).join(", ")), `seen ${picture.toFixed(0)}`);
    }
    // The first run warms up the browser.
    if (run > 0) {
      pictures.push(picture);
      readies.push(ready);
    }
    await context.close();
  }
}
const middle = (list) => {
  const sorted = list.toSorted((a, b) => a - b);
  return `${sorted[RUNS >> 1].toFixed(0)} ms (${sorted[0].toFixed(0)} to ${sorted[RUNS - 1].toFixed(0)})`;
};
for (const { lab, script, pictures, readies } of cases) console.log(`${lab}, ${script}: lab ${middle(readies)}, picture ${middle(pictures)}`);
await browser.close();
server.close();
