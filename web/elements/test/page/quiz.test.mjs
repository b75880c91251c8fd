// <lesson-quiz> in Chromium: every kind of question, attempts, predictions, what is kept.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import test, { after } from "node:test";
import { drop, launch, newContext, pageOf, serve, watchErrors } from "./site.mjs";

const digest = createHash("sha256").update("grain:1").digest("hex");
const quiz = {
  id: "physics", title: "Before you go on", questions: [
    { q: "Which ball is <b>heavier</b>?", options: ["iron", "cork"], answer: 0, explain: "<p>Iron: $\\rho_1 > \\rho_2$.</p>" },
    { kind: "multiple", q: "What stays?", options: ["momentum", "energy", "mass"], answer: [0, 2], attempts: 2 },
    { kind: "truefalse", q: "The balls land together.", answer: true },
    { kind: "numeric", q: "How fast, in m/s?", answer: 3.96, tol: 0.01, unit: "m/s", attempts: 2, explain: "<p>Because.</p>" },
    { kind: "open", q: "Why?", reference: "<p>Gravity.</p>" },
    { kind: "predict", q: "Where is the ball after 0.5 s?", options: ["In the air", "On the floor"], answer: 1, explain: "<p>It landed.</p>",
      sim: { model: "drop", stopAt: 0.5, plots: [{ ylabel: "height (m)", traces: [{ label: "ball", expr: "data.body('bob').xpos[2]" }] }], readouts: [{ label: "height (m)", expr: "data.body('bob').xpos[2]" }] } },
    { q: "A hidden one", options: ["a", "b"], hash: { salt: "grain", sha256: digest } },
    { q: "A broken one", options: ["a"] },
  ],
};
const slow = {
  id: "slow", questions: [
    { kind: "predict", q: "Up or down?", options: ["up", "down"], answer: 1, explain: "<p>Down.</p>", sim: { model: "drop", stopAt: 1.5, readouts: [{ label: "z", expr: "data.qpos[2]" }] } },
    { kind: "multiple", q: "Which of these?", options: ["a", "b", "c"], hash: { salt: "s", sha256: createHash("sha256").update("s:0,2").digest("hex") } },
    { q: "Which one?", options: ["a", "b", "c"], answer: 2, attempts: 3 },
    { kind: "numeric", q: "How fast does it get faster?", answer: 1998, tol: 1, unit: "m/s^2", attempts: 1 },
  ],
};
const server = await serve({
  "/slow.html": pageOf(`<lesson-quiz><script type="application/json">${JSON.stringify(slow).replaceAll("</", "<\\/")}</script><script type="model/mjcf" data-name="drop">${drop}</script></lesson-quiz>`),
  "/quiz.html": pageOf(`<lesson-quiz><script type="application/json">${JSON.stringify(quiz).replaceAll("</", "<\\/")}</script><script type="model/mjcf" data-name="drop">${drop}</script></lesson-quiz>`),
});
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
});

async function open(t, options = {}, path = "/quiz.html") {
  const context = await newContext(browser, options);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.addInitScript(() => {
    globalThis.answers = [];
    document.addEventListener("quiz-answer", (e) => globalThis.answers.push(e.detail));
  });
  await page.goto(server.url + path);
  await page.locator(".question").first().waitFor();
  return { page, errors, question: (i) => page.locator("article.quiz > .question, article.quiz > .broken").nth(i) };
}

test("one of several: an empty answer is no try, a wrong one is marked, the right one is shown", async (t) => {
  const { page, errors, question } = await open(t);
  const first = question(0);
  await first.getByRole("button", { name: "Check" }).click();
  assert.match(await first.locator(".remark").innerText(), /Choose an answer first/);
  await first.getByRole("radio", { name: "cork" }).check();
  await first.getByRole("button", { name: "Check" }).click();
  assert.match(await first.locator(".badge").innerText(), /Not correct/);
  assert.ok(await first.getByRole("radio", { name: "iron" }).isDisabled());
  assert.equal(await first.locator(".option.right").innerText(), "iron");
  assert.equal(await first.locator("math").count(), 1);
  assert.match(await page.locator(".score").innerText(), /0 of 6 correct/);
  assert.deepEqual((await page.evaluate(() => globalThis.answers))[0], { quiz: "physics", index: 0, kind: "mcq", answer: [1], correct: false, attempt: 1, done: true });
  errors.none();
});

test("several of several, true or false, a number: attempts and feedback", async (t) => {
  const { errors, question } = await open(t);
  const several = question(1);
  await several.getByRole("checkbox", { name: "momentum" }).check();
  await several.getByRole("button", { name: "Check" }).click();
  assert.match(await several.locator(".verdict").innerText(), /Not correct[^]*Attempt 1 of 2/);
  await several.getByRole("checkbox", { name: "mass" }).check();
  await several.getByRole("button", { name: "Check" }).click();
  assert.match(await several.locator(".badge").innerText(), /^Correct/);
  await question(2).getByRole("radio", { name: "True" }).check();
  await question(2).getByRole("button", { name: "Check" }).click();
  assert.match(await question(2).locator(".badge").innerText(), /^Correct/);
  const number = question(3);
  const input = number.getByRole("textbox");
  await input.fill("fast");
  await input.press("Enter");
  assert.match(await number.locator(".remark").innerText(), /Type a number/);
  await input.fill("4,5");
  await input.press("Enter");
  assert.match(await number.locator(".verdict").innerText(), /Not correct[^]*Attempt 1 of 2/);
  assert.equal(await number.locator(".explain").count(), 0);
  await input.fill("3,97 m/s");
  await input.press("Enter");
  assert.match(await number.locator(".verdict").innerText(), /Correct[^]*Because/);
  const text = question(4);
  await text.getByRole("textbox").fill("It pulls.");
  await text.getByRole("button").click();
  assert.match(await text.locator(".verdict").innerText(), /Gravity/);
  errors.none();
});

test("a prediction is locked, the lab runs, the verdict stands beside what was said", async (t) => {
  const { page, errors, question } = await open(t);
  const predict = question(5);
  assert.equal(await predict.locator("sim-lab").count(), 0);
  await predict.getByRole("radio", { name: "In the air" }).check();
  await predict.getByRole("button", { name: "Commit" }).click();
  assert.ok(await predict.getByRole("radio", { name: "On the floor" }).isDisabled());
  assert.equal(await predict.locator(".badge").count(), 0, "no verdict before the lab has run");
  await predict.locator(".badge").waitFor();
  const verdict = await predict.locator(".verdict").innerText();
  assert.match(verdict, /Not correct[^]*You predicted: In the air[^]*What the simulation shows at 0\.50\d s[^]*height \(m\)[^]*0\.(09|10|11)\d[^]*It landed/);
  assert.match(await predict.locator(".curve").getAttribute("aria-label"), /ball falls from 1/);
  assert.match(await predict.locator(".evidence-events").innerText(), /touches floor at 0\.4/i);
  const [said, shown] = [await predict.locator(".said").boundingBox(), await predict.locator(".evidence").boundingBox()];
  assert.ok(shown.x > said.x + said.width / 2 && Math.abs(shown.y - said.y) < 10, "the evidence is beside what was said");
  assert.deepEqual((await page.evaluate(() => globalThis.answers)).map(({ index, correct }) => [index, correct]), [[5, false]]);
  errors.none();
});

test("answers are kept over a reload, graded anew, and cleared", async (t) => {
  const { page, errors, question } = await open(t);
  await question(0).getByRole("radio", { name: "iron" }).check();
  await question(0).getByRole("button", { name: "Check" }).click();
  await question(4).getByRole("textbox").fill("It pulls.");
  await question(4).getByRole("button").click();
  await page.reload();
  await page.locator(".badge").waitFor();
  assert.match(await question(0).locator(".badge").innerText(), /^Correct/);
  assert.equal(await question(4).getByRole("textbox").inputValue(), "It pulls.");
  await page.getByRole("button", { name: "Clear my answers" }).click();
  await page.waitForFunction(() => document.querySelector("lesson-quiz").shadowRoot.querySelector(".badge") === null);
  await page.reload();
  await page.locator(".question").first().waitFor();
  assert.equal(await page.locator(".badge").count(), 0);
  errors.none();
});

test("a hidden answer is graded, and is not in the page", async (t) => {
  const { page, errors, question } = await open(t);
  assert.doesNotMatch(await page.content(), /"answer":\s*1,"hash"|grain:1/);
  await question(6).getByRole("radio", { name: "b" }).check();
  await question(6).getByRole("button", { name: "Check" }).click();
  assert.match(await question(6).locator(".badge").innerText(), /^Correct/);
  assert.match(await question(7).innerText(), /Question 8 needs two or more "options"/);
  errors.none();
});

test("by keyboard alone, in German", async (t) => {
  const { page, errors, question } = await open(t);
  await page.evaluate(() => document.querySelector("lesson-quiz").setAttribute("lang", "de"));
  await page.getByText("Frage 1 von 8").waitFor();
  await question(0).getByRole("radio", { name: "iron" }).focus();
  await page.keyboard.press("Space");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  assert.match(await question(0).locator(".badge").innerText(), /^Richtig/);
  errors.none();
});

test("a prediction counts when its verdict is shown, and not before", async (t) => {
  const { page, errors, question } = await open(t, {}, "/slow.html");
  const predict = question(0);
  const commit = async () => {
    await predict.getByRole("radio", { name: "down" }).check();
    await predict.getByRole("button", { name: "Commit" }).click();
  };
  await commit();
  await page.waitForTimeout(200);
  assert.equal(await page.locator(".score").innerText(), "");
  assert.deepEqual(await page.evaluate(() => globalThis.answers), []);
  // It is committed all the same: a reload does not take it back, and the lab runs again.
  await page.reload();
  await predict.getByText("Watch what happens").waitFor();
  assert.ok(await predict.getByRole("radio", { name: "up" }).isDisabled());
  assert.equal(await page.locator(".score").innerText(), "");
  await predict.locator(".badge").waitFor();
  assert.match(await page.locator(".score").innerText(), /1 of 4 correct/);
  assert.deepEqual((await page.evaluate(() => globalThis.answers)).map(({ index, correct }) => [index, correct]), [[0, true]]);
  await page.reload();
  await predict.locator(".badge").waitFor();
  assert.deepEqual(await page.evaluate(() => globalThis.answers), [], "the answer is not given again");
  errors.none();
});

test("a quiz that is cleared or taken away while its lab runs stops watching", async (t) => {
  for (const leave of [
    (page) => page.evaluate(() => document.querySelector("lesson-quiz").remove()),
    (page) => page.evaluate(() => document.querySelector("lesson-quiz").setAttribute("lang", "de")),
  ]) {
    const { page, errors, question } = await open(t, {}, "/slow.html");
    await question(0).getByRole("radio", { name: "down" }).check();
    await question(0).getByRole("button", { name: "Commit" }).click();
    await question(0).locator("sim-lab").evaluate((lab) => lab.ready);
    await leave(page);
    await page.waitForTimeout(500);
    const looks = await page.evaluate(async () => {
      // What is taken away now was the last quiz of the page.
      document.querySelector("lesson-quiz")?.remove();
      await new Promise((resolve) => setTimeout(resolve, 400));
      let looks = 0;
      const { prototype } = customElements.get("sim-lab");
      const { get } = Object.getOwnPropertyDescriptor(prototype, "isOver");
      Object.defineProperty(prototype, "isOver", { configurable: true, get() {
        looks++;
        return get.call(this);
      } });
      await new Promise((resolve) => setTimeout(resolve, 800));
      return looks;
    });
    assert.equal(looks, 0);
    errors.none();
  }
});

test("marks: none on an option that may be right, and none after another choice", async (t) => {
  const { errors, question } = await open(t, {}, "/slow.html");
  const marks = (i) => question(i).locator(".option").evaluateAll((rows) => rows.map((row) => `${row.classList.contains("right") ? "right" : row.classList.contains("wrong") ? "wrong" : ""}${row.querySelectorAll(".icon").length}`));
  for (const name of ["a", "b"]) await question(1).getByRole("checkbox", { name, exact: true }).check();
  await question(1).getByRole("button", { name: "Check" }).click();
  assert.match(await question(1).locator(".badge").innerText(), /Not correct/);
  assert.deepEqual(await marks(1), ["0", "0", "0"], "a is right, and b is not: the hash does not tell which");
  await question(2).getByRole("radio", { name: "a", exact: true }).check();
  await question(2).getByRole("button", { name: "Check" }).click();
  assert.deepEqual(await marks(2), ["wrong1", "0", "0"]);
  await question(2).getByRole("radio", { name: "c", exact: true }).check();
  assert.deepEqual(await marks(2), ["0", "0", "0"]);
  await question(2).getByRole("button", { name: "Check" }).click();
  assert.deepEqual(await marks(2), ["0", "0", "right1"]);
  errors.none();
});

test("the focus stays in the quiz when a control of it goes", async (t) => {
  const { page, errors, question } = await open(t);
  const focus = () => page.evaluate(() => {
    const { activeElement } = document.querySelector("lesson-quiz").shadowRoot;
    return activeElement === null ? "nothing" : activeElement.matches("input") ? `input ${activeElement.type}` : activeElement.className;
  });
  await question(0).getByRole("radio", { name: "cork" }).check();
  await question(0).getByRole("button", { name: "Check" }).press("Enter");
  assert.equal(await focus(), "verdict-area");
  for (const text of ["1", "2"]) {
    await question(3).getByRole("textbox").fill(text);
    await question(3).getByRole("textbox").press("Enter");
    assert.equal(await focus(), text === "1" ? "input text" : "verdict-area", "a further try keeps the focus on the input");
  }
  await question(5).getByRole("radio", { name: "On the floor" }).check();
  await question(5).getByRole("button", { name: "Commit" }).press("Enter");
  assert.equal(await focus(), "verdict-area");
  await question(5).getByRole("button", { name: "Show the verdict" }).press("Enter");
  await question(5).locator(".badge").waitFor();
  assert.equal(await focus(), "verdict-area");
  await page.getByRole("button", { name: "Clear my answers" }).press("Enter");
  await page.waitForFunction(() => document.querySelector("lesson-quiz").shadowRoot.querySelector(".badge") === null);
  assert.equal(await focus(), "input radio");
  errors.none();
});

test("a number is shown with its digits and its unit as people write it", async (t) => {
  const { errors, question } = await open(t, {}, "/slow.html");
  assert.equal(await question(3).locator(".unit").innerText(), "m/s²");
  await question(3).getByRole("textbox", { name: "in m/s²" }).fill("2,0·10³ m/s²");
  await question(3).getByRole("button", { name: "Check" }).click();
  assert.match(await question(3).locator(".verdict").innerText(), /Correct answer: 1998 m\/s²/);
  errors.none();
});
