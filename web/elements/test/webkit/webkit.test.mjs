// The elements in WebKit: a lab is opened, played, moved by keys and pressed; a question is answered and kept; numbers have the same bits as in node.
//
//   xvfb-run -a dbus-run-session node --test test/webkit/*.test.mjs
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { Lab } from "labspec";
import { drop, dropLab, labOf, pageOf, repository, serve } from "../page/site.mjs";
import { launchWebKit, webkitPath } from "./driver.mjs";

assert.ok(webkitPath() !== undefined, "WebKitGTK and its driver are installed");
const quiz = { id: "physics", questions: [{ q: "Which ball is heavier?", options: ["iron", "cork"], answer: 0 }] };
// What goes wrong in a page is collected by the page: WebDriver has no command for it.
const head = `<script>globalThis.errors = []; addEventListener("error", (e) => errors.push(e.message)); addEventListener("unhandledrejection", (e) => errors.push(String(e.reason)));
  for (const name of ["error", "warn"]) console[name] = (...args) => errors.push(args.join(" "));</script>`;
const server = await serve({
  "/drop.html": pageOf(labOf(dropLab, { models: { drop } }), { head }),
  "/files.html": pageOf(labOf(dropLab, { models: { drop } }), { head, script: "/web/elements/dist/elements.js" }),
  "/quiz.html": pageOf(`<lesson-quiz><script type="application/json">${JSON.stringify(quiz)}</script></lesson-quiz>`, { head }),
});
const page = await launchWebKit();
console.log(`WebKitGTK ${page.version}`);
after(async () => {
  await page.close();
  server.close();
});

/** Opens a page with a lab, and waits for the lab. */
async function open(path) {
  await page.goto(server.url + path);
  await page.waitFor(() => document.querySelector("sim-lab")?.shadowRoot?.querySelector("canvas, [part=error]") != null);
  await page.evaluate(() => document.querySelector("sim-lab").ready);
}

const button = (name) => [...document.querySelector("sim-lab").shadowRoot.querySelectorAll("button")].find((b) => (b.getAttribute("aria-label") ?? b.textContent).trim() === name) ?? null;
const none = async () => assert.deepEqual(await page.evaluate(() => globalThis.errors), []);

for (const path of ["/drop.html", "/files.html"]) {
  test(`a lab is drawn, played, paused, stepped and reset: ${path}`, async () => {
    await open(path);
    await page.waitFor(() => {
      const canvas = document.querySelector("sim-lab").shadowRoot.querySelector(".view canvas");
      const copy = new OffscreenCanvas(1, 1).getContext("2d");
      copy.drawImage(canvas, canvas.width >> 1, canvas.height - 4, 1, 1, 0, 0, 1, 1);
      return copy.getImageData(0, 0, 1, 1).data[3] > 0;
    });
    await page.click(button, "Play");
    await page.waitFor(() => document.querySelector("sim-lab").time > 0.6);
    await page.click(button, "Pause");
    await page.waitFor(() => !document.querySelector("sim-lab").playing);
    await page.waitFor(() => [...document.querySelector("sim-lab").shadowRoot.querySelectorAll(".readout output")].at(-1).textContent === "touching");
    await page.click(button, "Reset");
    await page.waitFor(() => document.querySelector("sim-lab").time === 0);
    await none();
  });
}

test("a slider by keys and a button act as the format says", async () => {
  await open("/drop.html");
  await page.evaluate(async () => {
    await document.querySelector("sim-lab").step(50);
    document.querySelector("sim-lab").shadowRoot.querySelector("input[type=range]").focus();
  });
  await page.keys("\uE014");
  await page.waitFor(() => document.querySelector("sim-lab").shadowRoot.querySelector("input[type=range]").getAttribute("aria-valuetext") === "−9.7 m/s²");
  await page.click(button, "Kick");
  const reference = new Lab(dropLab, { drop });
  reference.step(50);
  reference.set("gravity", -9.7);
  reference.press("Kick");
  reference.step(100);
  const numbers = await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    await lab.step(100);
    return lab.numbers.map(String);
  });
  assert.deepEqual(numbers, [...reference.numbers].map(String));
  await none();
});

test("a question is answered, and kept over a reload", async () => {
  await page.goto(`${server.url}/quiz.html`);
  const ready = () => document.querySelector("lesson-quiz")?.shadowRoot?.querySelector(".question") != null;
  await page.waitFor(ready);
  await page.click(() => document.querySelector("lesson-quiz").shadowRoot.querySelector("input[type=radio]"));
  await page.click(() => document.querySelector("lesson-quiz").shadowRoot.querySelector("button[type=submit]"));
  const isRight = () => /^Correct/.test(document.querySelector("lesson-quiz").shadowRoot.querySelector(".badge")?.textContent.trim() ?? "");
  await page.waitFor(isRight);
  await none();
  await page.reload();
  await page.waitFor(ready);
  await page.waitFor(isRight);
  await none();
});

/** The labs of the example lessons. */
function* labs() {
  const folder = join(repository, "specs/lessons");
  for (const name of readdirSync(folder).filter((file) => file.endsWith(".md")).sort()) {
    const fences = readFileSync(join(folder, name), "utf8").matchAll(/^```lab simlab\n([^]*?)\n```$/gm);
    for (const [i, [, text]] of [...fences].entries()) yield [`${name}#${i + 1}`, text.replace(/"autoplay":\s*true/, '"autoplay": false')];
  }
}

test("every lab of the example lessons has the same bits as in node", async () => {
  const folder = join(repository, "specs/models");
  const models = Object.fromEntries(readdirSync(folder).filter((file) => file.endsWith(".xml")).map((file) => [file.slice(0, -4), readFileSync(join(folder, file), "utf8")]));
  await open("/drop.html");
  let count = 0;
  for (const [name, text] of labs()) {
    const lab = new Lab(text, models);
    for (let i = 0; i < 300 && !lab.isOver; i++) lab.step();
    const there = await page.evaluate(async (json, own) => {
      const element = document.createElement("sim-lab");
      [element.lab, element.models] = [json, own];
      document.querySelector("main").append(element);
      await element.step(300);
      const out = [element.time, ...element.numbers].map((x) => (Object.is(x, -0) ? "-0" : String(x)));
      element.remove();
      return out;
    }, text, models);
    assert.deepEqual(there, [lab.time, ...lab.numbers].map((x) => (Object.is(x, -0) ? "-0" : String(x))), name);
    count += there.length;
  }
  assert.ok(count > 60);
  console.log(`${count} numbers with the same bits in node and in WebKit`);
  await none();
});
