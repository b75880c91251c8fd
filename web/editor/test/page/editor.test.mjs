// The editor alone, with a lesson in Markdown, under the policy of the playground. The playground has to be built: it has the worker.
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import test, { after } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { launch, serve, watchErrors } from "../../../playground/test/page/site.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const { outputFiles } = await build({ entryPoints: [join(here, "mount.js")], bundle: true, write: false, format: "esm", target: "es2022", logLevel: "warning" });
const server = await serve({
  "/editor.html": '<!doctype html><html lang="en"><meta charset="utf-8"><title>Test</title><link rel="icon" href="data:,"><script type="module" src="/mount.js"></script><main id="host"></main></html>',
  "/mount.js": outputFiles[0].contents,
});
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
});

const lesson = (expr) => `# Ein Würfel 😀\n\nHe falls.\n\n\`\`\`lab simlab\n{"model": "drop", "readouts": [{"label": "x", "expr": "${expr}"}]}\n\`\`\`\n`;

async function open(t, text, options = {}) {
  const page = await browser.newPage();
  t.after(() => page.close());
  page.setDefaultTimeout(15_000);
  const errors = watchErrors(page);
  await page.goto(`${server.url}/editor.html`);
  await page.waitForFunction(() => globalThis.isReady);
  await page.evaluate(([text, options]) => globalThis.mount(text, options), [text, options]);
  return { page, errors };
}

test("a lesson: findings, a fix by click in the text, completion, saving, formatting, models", async (t) => {
  const { page, errors } = await open(t, lesson("data.qpso[2]"));
  const mark = page.locator(".cm-lintRange-error");
  await mark.waitFor();
  assert.equal(await mark.textContent(), "qpso");
  assert.equal(await page.getByRole("textbox", { name: "The lesson" }).count(), 1);
  await mark.hover();
  await page.locator(".cm-tooltip-lint .cm-diagnosticAction").first().click();
  await page.waitForFunction(() => globalThis.editor.text.includes("data.qpos[2]"));
  await page.waitForFunction(() => globalThis.editor.findings.length === 0);
  await page.keyboard.press("Control+s");
  assert.deepEqual(await page.evaluate(() => globalThis.told.saved), [lesson("data.qpos[2]")]);
  // A name of the model in code, in a string of JSON, in a fence.
  await page.evaluate(() => {
    const { editor } = globalThis;
    editor.text = editor.text.replace("data.qpos[2]", "data.body('').xpos[2]+1");
    editor.select(editor.text.indexOf("('") + 2, editor.text.indexOf("('") + 2);
  });
  await page.keyboard.press("Control+Space");
  await page.locator(".cm-tooltip-autocomplete li", { hasText: "bob" }).click();
  await page.waitForFunction(() => globalThis.editor.text.includes("data.body('bob').xpos[2]+1"));
  await page.evaluate(() => globalThis.editor.format());
  assert.match(await page.evaluate(() => globalThis.editor.text), /data\.body\('bob'\)\.xpos\[2\] \+ 1/);
  // Another model: the same text is checked again.
  await page.evaluate(() => { globalThis.editor.checker.models = { drop: "<mujoco/>" }; });
  await mark.waitFor();
  assert.ok((await page.evaluate(() => globalThis.told.texts.length)) >= 3);
  errors.none();
});

test("an editor that is taken away leaves nothing behind", async (t) => {
  const { page, errors } = await open(t, lesson("data.qpos[2]"));
  await page.waitForFunction(() => globalThis.editor.findings.length === 0);
  await page.evaluate(() => globalThis.editor.checker.ask("labs", "lesson.md", globalThis.editor.text));
  assert.equal(page.workers().length, 1);
  await page.evaluate(() => {
    globalThis.editor.text += "more";
    globalThis.editor.dispose();
  });
  await page.waitForTimeout(300);
  assert.deepEqual([page.workers().length, await page.evaluate(() => document.querySelector("#host").childElementCount)], [0, 0]);
  errors.none();
});

test("without its worker, the editor says so and edits", async (t) => {
  const { page } = await open(t, lesson("data.qpos[2]"), { worker: "/nowhere.js" });
  await page.waitForFunction(() => globalThis.told.failures.length > 0);
  assert.match(await page.evaluate(() => globalThis.told.failures[0]), /the checker does not answer/);
  await page.locator(".cm-content").click();
  await page.keyboard.type("x");
  await page.waitForFunction(() => globalThis.told.texts.length > 0);
});

test("a long lesson: a finding comes within 100 ms of the pause", async (t) => {
  const labs = Array.from({ length: 30 }, (_, i) => lesson(`data.qpos[2] + ${i}`).replace("# Ein Würfel", `## ${i}`)).join("\n");
  const { page, errors } = await open(t, labs);
  await page.waitForFunction(() => globalThis.editor.checker !== undefined && document.querySelector("#host *") !== null);
  await page.evaluate(() => globalThis.editor.checker.ask("findings", "lesson.md", globalThis.editor.text));
  const took = await page.evaluate(async () => {
    const { editor } = globalThis;
    const times = [];
    for (let i = 0; i < 9; i++) {
      const text = editor.text.replace("data.qpos[2] + 14", `data.qpos[2] + 14 * ${i}`);
      const start = performance.now();
      await editor.checker.ask("findings", "lesson.md", text);
      times.push(performance.now() - start);
    }
    return times.sort((a, b) => a - b)[4];
  });
  t.diagnostic(`thirty labs: the findings of a changed text after ${took.toFixed(1)} ms (median of 9)`);
  assert.ok(took < 100, `${took} ms`);
  errors.none();
});
