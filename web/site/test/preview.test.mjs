// The preview in Chromium: it follows a file while another lab keeps its time, fixes by click, edits in place, survives a bad lesson.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { course, findings, launch, open, opened, preview } from "./pages.mjs";

const browser = await launch();
after(() => browser.close());

/** Changes a file as an editor does. */
function change(file, from, to) {
  const text = readFileSync(file, "utf8");
  assert.ok(text.includes(from), `${file} has ${from}`);
  writeFileSync(file, text.replace(from, to));
}

/** Waits until the page shows the checked text of the file. */
const checked = (page) => page.waitForFunction(() => document.querySelector("main").dataset.checked === "true");

/** Replaces what is in the editor, by keys. */
async function write(page, area, text) {
  await area.click();
  await page.keyboard.press("Control+a");
  await page.keyboard.type(text);
}

async function start(t, lesson) {
  const lessons = course(t);
  const url = await preview(t, lessons);
  const opened = await open(t, browser, `${url}${lesson.replace(".md", ".html")}`);
  await checked(opened.page);
  return { ...opened, url, file: join(lessons, lesson) };
}

test("a change of the text shows at once, and labs keep their times", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  await opened(page, "#lab-1");
  await opened(page, "#lab-2");
  const times = await page.evaluate(async () => {
    const [one, two] = [document.querySelector("#lab-1"), document.querySelector("#lab-2")];
    await Promise.all([one.step(100), two.step(50)]);
    globalThis.before = [one, two];
    return [one.time, two.time];
  });
  assert.ok(times[0] > 0 && times[1] > 0);
  // Text before the labs, and a new paragraph, so that everything after it moves.
  change(file, "each with one number to predict.", "each with a number to predict.\n\nA new paragraph.");
  await page.getByText("A new paragraph.").waitFor();
  await checked(page);
  // The second lab has another title now, and the same controls: a new element in the old state.
  change(file, '"title": "Small and wide"', '"title": "Another title"');
  await page.waitForFunction(() => document.querySelector("#lab-2").shadowRoot?.textContent.includes("Another title"));
  await page.waitForFunction((time) => document.querySelector("#lab-2").time === time, times[1]);
  const now = await page.evaluate(() => {
    const [one, two] = [document.querySelector("#lab-1"), document.querySelector("#lab-2")];
    return { times: [one.time, two.time], same: [one === globalThis.before[0], two === globalThis.before[1]] };
  });
  assert.deepEqual(now.same, [true, false]);
  assert.equal(now.times[0], times[0], "the first lab was not touched");
  none();
});

test("a wrong number is marked where it is read, and the mark \"verified\" vanishes", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  const lab = page.locator(".block.lab").first();
  assert.equal(await lab.locator(".verified").count(), 1);
  assert.ok((await page.locator("mark.claim-true").count()) > 5);
  change(file, "0.297 m. With less", "0.311 m. With less");
  change(file, '"0.297 m"', '"0.311 m"');
  await page.locator("mark.claim-false", { hasText: "0.311 m" }).first().waitFor();
  await checked(page);
  assert.equal(await lab.locator(".verified").count(), 0);
  assert.match(await page.locator(".status").textContent(), /wrong|refuted|false/);
  assert.ok((await lab.locator(".notes .error, .notes .claim-false").count()) > 0);
  assert.deepEqual(await findings(page), []);
  none();
});

test("a number without a claim is marked", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  change(file, "With less damping", "The floor is 3.7 m wide. With less damping");
  await page.locator("mark.claim-none", { hasText: "3.7 m" }).waitFor();
  assert.match(await page.locator(".status").textContent(), /1 number without a claim/);
  none();
});

test("a fix is one click", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  change(file, '"readouts": [{"label": "height (m)"', '"readout": [{"label": "height (m)"');
  const button = page.locator(".block.lab button[data-do=fix]").first();
  await button.waitFor();
  await checked(page);
  await page.locator(".block.lab button[data-do=fix]").first().click();
  await page.waitForFunction(() => document.querySelectorAll("button[data-do=fix]").length === 0);
  assert.ok(readFileSync(file, "utf8").includes('"readouts": [{"label": "height (m)"'));
  none();
});

test("a block is edited in place, and a change from elsewhere is not overwritten", async (t) => {
  const { page, file, errors } = await start(t, "02-bounce-and-swing.md");
  const block = page.locator(".block.text").nth(1);
  await block.getByRole("button", { name: /^Edit/ }).click();
  const area = page.getByRole("textbox", { name: "Source of this block" });
  assert.match(await area.innerText(), /^A contact can be made/);
  await write(page, area, "Other first words.");
  await page.getByRole("button", { name: "Save" }).click();
  await page.locator("p", { hasText: "Other first words." }).first().waitFor();
  assert.match(readFileSync(file, "utf8"), /^# Bounce and swing\n\nOther first words\.\n\n## A ball/);
  await checked(page);
  await block.getByRole("button", { name: /^Edit/ }).click();
  await write(page, area, "Mine.");
  change(file, "Other first words.", "Theirs.");
  await page.locator("p", { hasText: "Theirs." }).first().waitFor();
  // What was typed is still there, and is not written over the other change.
  assert.equal(await area.innerText(), "Mine.");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("the file has changed since this page was shown").waitFor();
  assert.ok(!readFileSync(file, "utf8").includes("Mine."));
  await page.getByRole("button", { name: "Cancel" }).click();
  assert.equal(await page.locator(".stale").count(), 0);
  // The browser reports the refused request.
  assert.deepEqual(errors.filter((error) => !error.includes("409 (Conflict)")), []);
});

test("while a block is edited, findings and completions are those of the lesson", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  const lab = page.locator(".block.lab").first();
  await lab.getByRole("button", { name: /^Edit/ }).click();
  const area = page.getByRole("textbox", { name: "Source of this block" });
  await area.waitFor();
  // Behind the first `data.` of the lab.
  const source = readFileSync(file, "utf8").split("```lab")[1];
  await area.click();
  await page.keyboard.press("Control+Home");
  for (let i = "```lab".length + source.indexOf("data.") + "data.".length; i > 0; i--) await page.keyboard.press("ArrowRight");
  const typed = Date.now();
  await page.keyboard.type("zz");
  await page.locator(".cm-lintRange-error").first().waitFor();
  assert.ok(Date.now() - typed < 5000);
  await page.keyboard.press("Backspace");
  await page.keyboard.press("Backspace");
  await page.locator(".cm-lintRange-error").first().waitFor({ state: "detached" });
  await page.keyboard.type("qpo");
  await page.locator(".cm-tooltip-autocomplete li", { hasText: "qpos" }).first().waitFor();
  await page.keyboard.press("Escape");
  assert.deepEqual(await findings(page), []);
  const before = readFileSync(file, "utf8");
  await page.getByRole("button", { name: "Cancel" }).click();
  assert.equal(readFileSync(file, "utf8"), before);
  none();
});

test("a proposal is accepted by a click", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  const text = readFileSync(file, "utf8");
  // The first lab without what it claims.
  const at = text.indexOf(',\n "verify": {');
  writeFileSync(file, `${text.slice(0, at)}}\n${text.slice(text.indexOf("```\n", at))}`);
  await page.waitForFunction(() => document.querySelector(".block.lab").querySelector(".verified") === null);
  await checked(page);
  const lab = page.locator(".block.lab").first();
  await lab.getByRole("button", { name: /^Propose/ }).click();
  const proposal = lab.locator(".proposals li", { hasText: "lab #1" });
  await proposal.waitFor({ timeout: 60_000 });
  await proposal.getByRole("button", { name: "Accept" }).click();
  await lab.locator(".verified").waitFor({ timeout: 60_000 });
  assert.match(readFileSync(file, "utf8"), /"verify"/);
  none();
});

test("a bad lesson never breaks the page", async (t) => {
  const { page, file, none } = await start(t, "02-bounce-and-swing.md");
  const good = readFileSync(file, "utf8");
  change(file, '{"title": "Rebound", "model"', '{"title": "Rebound" "model"');
  await page.getByText("This lab cannot be read.").waitFor();
  await page.locator(".block.broken .notes .error").first().waitFor();
  await opened(page, "#lab-2");
  for (const text of ["", "```lab simlab\n{", "\u0000<script>alert(1)</script>", "$".repeat(5000), "> ".repeat(3000), good]) {
    writeFileSync(file, text);
    await page.waitForTimeout(700);
    assert.equal(await page.locator("main .status").count(), 1);
  }
  await page.locator("mark.claim-true").first().waitFor();
  none();
});
