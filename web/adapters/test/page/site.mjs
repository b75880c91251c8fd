// What the trials in a browser share: servers, pages, and what a reader does with a lab and a quiz.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import * as driver from "../../../elements/test/browser.mjs";
import { root } from "../tools.mjs";

/** The one file of the elements. */
export const elements = join(root, "../elements/dist/labspec-elements.js");
const TYPES = {
  ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".json": "application/json", ".svg": "image/svg+xml", ".woff2": "font/woff2",
  ".png": "image/png", ".xml": "text/xml",
};

/** A folder that is removed after a test. */
export function folder(t) {
  const path = mkdtempSync(join(tmpdir(), "labspec-adapters-"));
  t.after(() => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** Serves folders as any host does; the first one that has a file counts. */
export async function serve(t, ...folders) {
  const server = createServer((request, response) => {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    const files = folders.flatMap((path) => [join(path, name), join(path, name, "index.html"), join(path, `${name}.html`)]);
    const file = files.find((path) => existsSync(path) && statSync(path).isFile());
    if (file === undefined) return response.writeHead(404).end();
    return response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  t.after(() => {
    server.closeAllConnections();
    server.close();
  });
  return `http://127.0.0.1:${server.address().port}/`;
}

/** Starts the browser of the tests. */
export async function launch(t) {
  const browser = await driver.launch();
  t.after(() => browser.close());
  return browser;
}

/** Opens a page and collects its errors; what a host itself reports is named by `expected`. */
export async function open(browser, url, expected = /(?!)/) {
  const page = await (await browser.newContext()).newPage();
  const errors = [];
  const report = (text) => {
    if (!text.includes("GL Driver Message") && !expected.test(text)) errors.push(text);
  };
  page.on("pageerror", (e) => report(e.message));
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) report(`${message.text()} (${message.location().url})`);
  });
  await page.goto(url);
  return { page, errors };
}

/** Opens the first lab of a page, plays it and pauses it; gives the seconds that it has played. */
export async function playLab(page, timeout = 30_000) {
  const lab = page.locator("sim-lab").first();
  await lab.waitFor({ state: "attached", timeout });
  await page.waitForFunction(() => customElements.get("sim-lab") !== undefined, null, { timeout });
  await lab.scrollIntoViewIfNeeded();
  await lab.evaluate((element) => element.ready);
  await lab.getByRole("button", { name: "Play", exact: true }).click();
  await waitFor(async () => (await lab.evaluate((element) => element.time)) > 0.2, timeout);
  await lab.evaluate((element) => element.pause());
  assert.equal(await lab.locator("[part=error]").count(), 0);
  assert.ok((await lab.locator("canvas").count()) > 0, "the lab is drawn");
  return lab.evaluate((element) => element.time);
}

/** Answers the first question of the knowledge check of the first lesson; gives the detail of the answer. */
export async function answerQuiz(page, timeout = 30_000) {
  const quiz = page.locator("lesson-quiz").last();
  await quiz.scrollIntoViewIfNeeded();
  await quiz.evaluate((element) => element.addEventListener("quiz-answer", (e) => (globalThis.answered = e.detail)));
  const question = quiz.locator(".question").first();
  await question.getByRole("radio", { name: /^Positions and velocities/ }).check({ timeout });
  await question.getByRole("button", { name: "Check" }).click();
  assert.match(await question.locator(".badge").innerText(), /^Correct/);
  return page.evaluate(() => globalThis.answered);
}

/** Waits until a condition holds. */
export async function waitFor(condition, timeout = 30_000) {
  const end = Date.now() + timeout;
  while (!(await condition())) {
    assert.ok(Date.now() < end, `after ${timeout} ms: ${condition}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** Does with a page of the first lesson what a reader does, without an error on the console. */
export async function readLesson(browser, url, expected) {
  const { page, errors } = await open(browser, url, expected);
  const time = await playLab(page);
  assert.ok(time > 0.2);
  const { quiz, correct } = await answerQuiz(page);
  assert.deepEqual([quiz, correct], ["01-check", true]);
  assert.deepEqual([await page.locator("sim-lab").count(), await page.locator("lesson-quiz").count()], [2, 2]);
  assert.deepEqual(errors, []);
  await page.context().close();
}
