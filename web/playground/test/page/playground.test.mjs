// The playground in a browser, under a policy that allows no style and no script but files.
import assert from "node:assert/strict";
import { mkdtempSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after } from "node:test";
import { deflateRawSync } from "node:zlib";
import { zipSync } from "fflate";
import { isChromium, launch, newContext, saveFile, serve, watchErrors } from "./site.mjs";

const server = await serve();
const browser = await launch();
const context = await newContext(browser, { permissions: ["clipboard-read", "clipboard-write"], viewport: { width: 1280, height: 1000 } });
const axe = readFileSync(new URL("../../../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
after(async () => {
  await browser.close();
  server.close();
});

const drop = "<mujoco>\n  <worldbody>\n    <geom type=\"plane\" size=\"1 1 1\"/>\n    <body name=\"bob\" pos=\"0 0 1\">\n      <freejoint/>\n      <geom name=\"ball\" size=\"0.1\"/>\n    </body>\n  </worldbody>\n</mujoco>\n";
const lab = JSON.stringify({
  title: "A drop", model: "drop",
  controls: [{ label: "gravity", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, digits: 1, reset: true }],
  readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }],
}, null, 2);
const link = (project) => `#play1=${deflateRawSync(JSON.stringify({ files: {}, ...project })).toString("base64url")}`;
const DROP = link({ lab, models: { drop }, model: "drop" });

/** A page of the playground with its errors. `DROP` is opened where no address is given. */
async function open(t, address = `/${DROP}`, options = null) {
  const own = options === null ? context : await newContext(browser, options);
  const page = await own.newPage();
  t.after(() => (options === null ? page.close() : own.close()));
  page.setDefaultTimeout(15_000);
  const errors = watchErrors(page);
  await page.goto(server.url + address);
  await page.waitForFunction(() => document.querySelector("#status").textContent !== "");
  return { page, errors };
}

const text = (page, id) => page.evaluate((id) => {
  const lines = document.querySelector(`#${id} .labspec-editor`).shadowRoot.querySelectorAll(".cm-line");
  return [...lines].map((line) => line.textContent).join("\n");
}, id);
const says = (page, pattern) => page.waitForFunction((source) => new RegExp(source).test(document.querySelector("#status").textContent), pattern.source);
const content = (page, id) => page.locator(`#${id} .cm-content`);
/** Replaces a whole text, as by pasting. */
async function write(page, id, now) {
  await content(page, id).click();
  await replace(page, now);
}
/** Replaces the text with the focus. Firefox pastes it: what a driver inserts there is not what a person does. */
async function replace(page, now) {
  await page.keyboard.press("Control+a");
  if (isChromium) return page.keyboard.insertText(now);
  await page.evaluate((text) => navigator.clipboard.writeText(text), now);
  return page.keyboard.press("Control+v");
}
/** The text of the clipboard, pasted into a field: Firefox asks before a page reads it. */
async function pasted(page) {
  await page.evaluate(() => document.body.append(Object.assign(document.createElement("textarea"), { id: "pasted" })));
  const field = page.locator("#pasted");
  await field.focus();
  await page.keyboard.press("Control+v");
  const text = await field.inputValue();
  await field.evaluate((field) => field.remove());
  return text;
}
const upToDate = (page) => says(page, /up to date/);

test("the first lab of the course is open, runs, and its claims are checked", async (t) => {
  const { page, errors } = await open(t, "/");
  await upToDate(page);
  assert.ok((await page.locator("#examples option").count()) > 10);
  assert.match(await text(page, "lab-text"), /"model": "drop"/);
  assert.match(await text(page, "model"), /<mujoco/);
  await page.waitForFunction(() => document.querySelectorAll("#claims li").length > 0);
  assert.match(await page.locator("#findings").textContent(), /None/);
  assert.match(await page.locator("#claims").textContent(), /verified/);
  // The numbers that the lesson quotes are found in it.
  assert.match(await page.locator("#claims-state").textContent(), /^\d+ true, 0 false, \d not checked/);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => document.querySelector("sim-lab").time > 0.05);
  errors.none();
});

test("a typo is marked at its place, quickly, and fixed by a click", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  await page.evaluate(() => {
    const editor = document.querySelector("#lab-text .labspec-editor").shadowRoot;
    globalThis.took = new Promise((resolve) => {
      let typed = 0;
      for (const kind of ["beforeinput", "paste"]) editor.addEventListener(kind, () => { typed ||= performance.now(); }, true);
      new MutationObserver(() => { if (editor.querySelector(".cm-lintRange-error") !== null && typed > 0) resolve(performance.now() - typed); }).observe(editor, { childList: true, subtree: true, attributes: true });
    });
  });
  await write(page, "lab-text", lab.replace("xpos", "xpso"));
  const mark = page.locator("#lab-text .cm-lintRange-error");
  await mark.waitFor();
  assert.equal(await mark.textContent(), "xpso");
  // The pause of 120 ms is part of it.
  const took = await page.evaluate(() => globalThis.took);
  t.diagnostic(`a finding ${took.toFixed(0)} ms after a change, the pause of 120 ms included`);
  assert.ok(took < 1000, `${took} ms`);
  const place = page.locator("#findings .place");
  await place.waitFor();
  assert.match(await place.textContent(), /^lab\.json, \d+:\d+$/);
  await says(page, /1 error: the scene is the last one/);
  assert.deepEqual(await page.evaluate(() => document.querySelector("sim-lab").texts), ["1.000"]);
  await page.locator("#findings").getByRole("button", { name: /^Fix: write `xpos`/ }).click();
  await upToDate(page);
  assert.equal(await text(page, "lab-text"), lab);
  assert.match(await page.locator("#findings").textContent(), /None/);
  errors.none();
});

test("completions are inserted in labs and in models", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  await content(page, "lab-text").getByText("xpos", { exact: false }).first().waitFor();
  await write(page, "lab-text", '{"model": "drop", "setup": "');
  await page.keyboard.type("data.qv");
  const option = page.locator("#lab-text .cm-tooltip-autocomplete li[aria-selected]");
  await option.waitFor();
  assert.match(await option.textContent(), /^qvel/);
  // A list that has just opened takes no key.
  await page.waitForTimeout(150);
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /data\.qvel/.test(document.querySelector("#lab-text .labspec-editor").shadowRoot.querySelector(".cm-content").textContent));
  await write(page, "model", "<mujoco><worldbody><geom ");
  await page.keyboard.type("ty");
  await page.locator("#model .cm-tooltip-autocomplete li[aria-selected]").waitFor();
  await page.waitForTimeout(150);
  await page.keyboard.press("Enter");
  // The values of the attribute follow at once.
  await page.locator("#model .cm-tooltip-autocomplete li", { hasText: "capsule" }).click();
  await page.waitForFunction(() => /<geom type="capsule"/.test(document.querySelector("#model .labspec-editor").shadowRoot.querySelector(".cm-content").textContent));
  errors.none();
});

test("the pointer explains a name, with its value at the start", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  const spot = await page.evaluate(() => {
    const walker = document.createTreeWalker(document.querySelector("#lab-text .labspec-editor").shadowRoot.querySelector(".cm-content"), NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const at = walker.currentNode.data.indexOf("xpos");
      if (at < 0) continue;
      walker.currentNode.parentElement.scrollIntoView({ block: "center" });
      const range = document.createRange();
      range.setStart(walker.currentNode, at + 1);
      range.setEnd(walker.currentNode, at + 2);
      const { x, y, width, height } = range.getBoundingClientRect();
      return [x + width / 2, y + height / 2];
    }
    return null;
  });
  await page.mouse.move(spot[0] - 5, spot[1]);
  await page.mouse.move(...spot);
  const tip = page.locator("#lab-text .lab-doc");
  await tip.waitFor();
  assert.match(await tip.textContent(), /xpos.*At the start of the lab/s);
  errors.none();
});

test("a changed model is another scene; the slider stays", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  const slider = page.getByRole("slider", { name: "gravity" });
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector("sim-lab").shadowRoot.querySelector("input[type=range]").value === "-9.7");
  await write(page, "model", drop.replace("0 0 1\">", "0 0 2.5\">"));
  await page.waitForFunction(() => document.querySelector("sim-lab").texts[0] === "2.500");
  await upToDate(page);
  await page.waitForFunction(() => document.querySelector("sim-lab").shadowRoot.querySelector("input[type=range]").value === "-9.7");
  await page.evaluate(() => document.querySelector("sim-lab").step(10));
  // What is wrong in the model is marked there.
  await write(page, "model", drop.replace("size=\"0.1\"", "size=\"x\""));
  const mark = page.locator("#model .cm-lintRange-error");
  await mark.waitFor();
  assert.equal(await mark.textContent(), "x");
  await page.locator("#findings").getByRole("button", { name: /^drop\.xml, 6:/ }).click();
  assert.equal(await page.evaluate(() => document.activeElement.closest("#model") !== null), true);
  errors.none();
});

test("a click that begins before the list of findings is renewed is a click", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  await write(page, "model", drop.replace("size=\"0.1\"", "size=\"x\""));
  const place = page.locator("#findings").getByRole("button", { name: /^drop\.xml, 6:/ });
  await place.hover();
  await page.evaluate(() => {
    globalThis.renewed = false;
    new MutationObserver(() => { globalThis.renewed ||= document.querySelector("#claims-state").textContent !== "Checking…"; })
      .observe(document.querySelector("#claims-state"), { childList: true });
  });
  await page.mouse.down();
  // The claims are checked a while after a change, and the list is shown again then.
  await page.waitForFunction(() => globalThis.renewed);
  await page.mouse.up();
  assert.equal(await page.evaluate(() => document.activeElement.closest("#model") !== null), true);
  errors.none();
});

test("files are dropped, chosen, and taken from archives and folders", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  await page.evaluate((xml) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([xml], "tower.xml", { type: "text/xml" }));
    document.querySelector("#lab-text").dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
  }, drop.replace("0 0 1\">", "0 0 3\">"));
  await page.waitForFunction(() => document.querySelector("#models").value === "tower");
  await upToDate(page);
  assert.match(await text(page, "lab-text"), /"model": "tower"/);
  const obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const scene = "<mujoco><compiler meshdir='shapes'/><asset><mesh name='wedge' file='wedge.obj'/></asset><include file='parts/floor.xml'/><worldbody><geom type='mesh' mesh='wedge'/></worldbody></mujoco>";
  const parts = { "robot/scene.xml": scene, "robot/parts/floor.xml": "<mujoco><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>", "robot/shapes/wedge.obj": obj, "robot/lab.json": '{"model": "scene", "readouts": [{"label": "geoms", "expr": "model.ngeom", "digits": 0}]}' };
  const archive = zipSync(Object.fromEntries(Object.entries(parts).map(([path, content]) => [path, new TextEncoder().encode(content)])));
  await page.setInputFiles("#files", { name: "robot.mjz", mimeType: "application/zip", buffer: Buffer.from(archive) });
  await page.waitForFunction(() => document.querySelector("sim-lab").texts[0] === "2");
  const folder = join(mkdtempSync(join(tmpdir(), "playground-")), "robot");
  for (const [path, content] of Object.entries(parts)) {
    const file = join(folder, "..", path);
    mkdirSync(join(file, ".."), { recursive: true });
    writeFileSync(file, content.replaceAll('"geoms"', '"all geoms"'));
  }
  // The protocol that drives Firefox has no folders.
  if (isChromium) {
    await page.setInputFiles("#folder", folder);
    await page.waitForFunction(() => document.querySelector("sim-lab").shown[0]?.label === "all geoms" && document.querySelector("sim-lab").texts[0] === "2");
  }
  await page.setInputFiles("#files", { name: "a.zip", mimeType: "application/zip", buffer: Buffer.from("no archive") });
  await says(page, /archive cannot be read/);
  errors.none();
});

test("all labs and questions of a lesson can be chosen", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  const choice = page.getByRole("combobox", { name: "Of the lesson" });
  assert.equal(await choice.isVisible(), false);
  const question = { kind: "predict", q: "Higher?", options: ["yes", "no"], answer: 0, sim: { title: "A question", model: "drop", setup: "data.qpos[2] = 2", readouts: [{ label: "height (m)", expr: "data.qpos[2]" }] } };
  const lesson = `# L\n\n\`\`\`lab simlab\n${lab}\n\`\`\`\n\n\`\`\`lab simlab\n${lab.replace("A drop", "Another").replace("xpos[2]", "xpos[2] + 1")}\n\`\`\`\n\n\`\`\`quiz\n${JSON.stringify({ id: "q", questions: [question] })}\n\`\`\`\n`;
  await page.setInputFiles("#files", [
    { name: "lesson.md", mimeType: "text/markdown", buffer: Buffer.from(lesson) }, { name: "drop.xml", mimeType: "text/xml", buffer: Buffer.from(drop) },
  ]);
  await choice.waitFor();
  assert.deepEqual(await choice.locator("option").allTextContents(), ["A drop (lesson.md#1)", "Another (lesson.md#2)", "A question (lesson.md#q.1)"]);
  await page.waitForFunction(() => document.querySelector("sim-lab").texts[0] === "1.000");
  for (const [place, height] of [["lesson.md#2", "2.000"], ["lesson.md#q.1", "2.000"], ["lesson.md#1", "1.000"]]) {
    await choice.selectOption(place);
    await upToDate(page);
    await page.waitForFunction((text) => document.querySelector("sim-lab").texts[0] === text, height);
    assert.equal(await choice.inputValue(), place);
  }
  // The choice belongs to these files.
  await page.getByRole("combobox", { name: "Example" }).selectOption({ index: 1 });
  await upToDate(page);
  assert.equal(await choice.isVisible(), false);
  errors.none();
});

test("a link holds what is written; the lesson that is downloaded is opened again", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  const changed = lab.replace("A drop", "A drop 😀 <b>&amp;</b>");
  await write(page, "lab-text", changed);
  await upToDate(page);
  await page.getByRole("button", { name: "Copy link" }).click();
  await says(page, /copied/);
  const address = await pasted(page);
  const { bytes: lesson } = await saveFile(page, () => page.getByRole("button", { name: "Download lesson" }).click());
  const { page: other, errors: none } = await open(t, address.slice(server.url.length));
  await upToDate(other);
  assert.deepEqual([await text(other, "lab-text"), await text(other, "model")], [changed, drop.trimEnd() + "\n"]);
  await other.setInputFiles("#files", { name: "lesson.md", mimeType: "text/markdown", buffer: lesson });
  await says(other, /1 file opened|up to date/);
  await upToDate(other);
  assert.equal(await text(other, "lab-text"), changed);
  errors.none();
  none.none();
});

test("a link to a state of the scene holds the project as well, until it changes", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    await lab.step(100);
    [...lab.shadowRoot.querySelectorAll("button")].find((button) => button.textContent.includes("Copy a link to this state")).click();
  });
  await page.waitForFunction(() => /play1=.*&lab\.lab=|lab\.lab=.*&play1=/.test(location.hash));
  const { page: other, errors: none } = await open(t, page.url().slice(server.url.length));
  await other.waitForFunction(() => Math.abs((document.querySelector("sim-lab")?.time ?? 0) - 0.2) < 1e-9);
  await write(other, "model", drop.replace("0 0 1\">", "0 0 2\">"));
  await upToDate(other);
  assert.deepEqual(await other.evaluate(() => [document.querySelector("sim-lab").time, /lab\.lab/.test(location.hash)]), [0, false]);
  errors.none();
  none.none();
});

test("what cannot be opened says why, and the page works", async (t) => {
  for (const [address, why] of [
    ["/#play9=abc", /newer version/], ["/#play1=AAAA", /damaged/], ["/?lab=../secret.md%231", /is not the address of a lab/], ["/?lab=01-what-a-step-computes.md%2399", /has no lab #99; it has #1/],
  ]) {
    const { page, errors } = await open(t, address);
    await says(page, why);
    await page.locator("sim-lab").getByRole("button", { name: "Play" }).waitFor();
    errors.none();
  }
});

test("a lab of the course is opened by its place", async (t) => {
  const { page, errors } = await open(t, "/?lab=02-bounce-and-swing.md%231");
  await upToDate(page);
  assert.match(await text(page, "model"), /<mujoco/);
  await page.getByRole("combobox", { name: "Example" }).selectOption({ index: 1 });
  await upToDate(page);
  assert.match(page.url(), /\?lab=01-[^#]*#play1=/);
  errors.none();
});

test("texts of others are text", async (t) => {
  const evil = "<img src=x onerror=\"globalThis.hacked=1\">";
  const hostile = JSON.stringify({ title: evil, model: `${evil}`, controls: [{ label: evil, min: 0, max: 1, value: 2, set: evil }], readouts: [{ label: evil, expr: evil }], note: evil, [evil]: 1 });
  const { page } = await open(t, `/${link({ lab: hostile, models: { [evil.replace("/", "")]: `<mujoco model='${evil.replaceAll("<", "&lt;")}'><${evil}/></mujoco>` }, model: evil })}`);
  await page.locator("#findings li.error").first().waitFor();
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => globalThis.hacked), undefined);
  assert.equal(await page.locator("#findings img, #claims img").count(), 0);
});

test("everything by keyboard: complete, next finding, fix, leave, play", async (t) => {
  const { page, errors } = await open(t);
  await upToDate(page);
  const inside = () => page.evaluate(() => document.activeElement?.closest(".editor")?.id ?? document.activeElement?.id ?? "");
  await page.locator("#examples").focus();
  for (let i = 0; i < 30 && (await inside()) !== "lab-text"; i++) await page.keyboard.press("Tab");
  assert.equal(await inside(), "lab-text");
  await replace(page, lab.replace("xpos", "xpso"));
  await page.locator("#lab-text .cm-lintRange-error").waitFor();
  await page.keyboard.press("Control+Home");
  await page.keyboard.press("F8");
  await page.keyboard.press("Control+.");
  await upToDate(page);
  assert.equal(await text(page, "lab-text"), lab);
  // The explanation at the cursor is shown and read out.
  await page.keyboard.press("Control+k");
  await page.keyboard.press("Control+i");
  await page.locator("#lab-text .lab-doc").waitFor();
  assert.match(await page.locator("#lab-text [role=status]").textContent(), /xpos/);
  await page.keyboard.press("Escape");
  await page.locator("#lab-text .lab-doc").waitFor({ state: "detached" });
  // Tab leaves the editor; the scene is played.
  const isPlay = () => page.evaluate(() => document.activeElement?.shadowRoot?.activeElement?.getAttribute("aria-label")?.includes("Play") === true || /Play/.test(document.activeElement?.shadowRoot?.activeElement?.textContent ?? ""));
  for (let i = 0; i < 12 && !(await isPlay()); i++) await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("sim-lab").time > 0.02);
  errors.none();
});

for (const [name, options] of [["light", {}], ["dark", { colorScheme: "dark" }], ["a phone", { viewport: { width: 320, height: 700 }, hasTouch: true }]]) {
  test(`axe finds nothing: ${name}`, async (t) => {
    const { page, errors } = await open(t, `/${link({ lab: lab.replace("xpos", "xpso"), models: { drop }, model: "drop" })}`, options);
    await page.locator("#findings li.error").first().waitFor();
    await page.locator("#lab-text .cm-lintRange-error").first().waitFor();
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
    assert.deepEqual(violations.map(({ id, impact, nodes }) => `${impact}: ${id} at ${nodes.map((n) => n.target.join(" ")).join(", ")}: ${nodes[0].failureSummary}`), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page does not scroll sideways");
    errors.none();
  });
}
