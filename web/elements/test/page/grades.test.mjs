// Grades: a page around the quiz records the messages of SPLICE that it gets, and gives a state back.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { launch, newContext, pageOf, serve, watchErrors } from "./site.mjs";
import { load } from "../load.mjs";

const first = { id: "one", questions: [{ q: "A?", options: ["a", "b"], answer: 0 }, { kind: "numeric", q: "B?", answer: 2 }, { kind: "open", q: "C?" }] };
const second = { id: "two", questions: [{ kind: "truefalse", q: "D?", answer: false }] };
const quiz = (content) => `<lesson-quiz grades="splice"><script type="application/json">${JSON.stringify(content)}</script></lesson-quiz>`;
const parent = (answers) => `<!doctype html><title>Parent</title><link rel="icon" href="data:,"><script>
  globalThis.messages = [];
  addEventListener("message", ({ data, source }) => {
    globalThis.messages.push(data);
    const state = JSON.parse(sessionStorage.getItem("state") ?? "null");
    if (data.subject === "SPLICE.reportScoreAndState") sessionStorage.setItem("state", JSON.stringify(data.state));
    if (data.subject === "SPLICE.getState" && ${answers}) source.postMessage({ subject: "SPLICE.getState.response", message_id: data.message_id, state }, "*");
  });
</script><iframe src="/quiz.html" width="800" height="800"></iframe>`;
const server = await serve({
  "/quiz.html": pageOf(quiz(first) + quiz(second)), "/parent.html": parent(true), "/silent.html": parent(false),
  "/alone.html": pageOf(quiz(first)),
});
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
});

async function open(t, path) {
  const context = await newContext(browser);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.goto(server.url + path);
  return { page, errors, frame: page.frameLocator("iframe") };
}

const reports = (page) => page.evaluate(() => globalThis.messages.filter((m) => m.subject === "SPLICE.reportScoreAndState"));

test("the learning system gets score and state, and gives the state back", async (t) => {
  const { page, errors, frame } = await open(t, "/parent.html");
  const question = (i) => frame.locator(".question").nth(i);
  await question(0).getByRole("radio", { name: "a" }).check();
  await question(0).getByRole("button", { name: "Check" }).click();
  await page.waitForFunction(() => globalThis.messages.filter((m) => m.subject === "SPLICE.reportScoreAndState").length === 1);
  const [report] = await reports(page);
  assert.equal(report.score, 1 / 3);
  assert.equal(typeof report.message_id, "string");
  assert.deepEqual(report.state.quizzes.one[0].choice, [0]);
  await question(3).getByRole("radio", { name: "False" }).check();
  await question(3).getByRole("button", { name: "Check" }).click();
  await page.waitForFunction(() => globalThis.messages.filter((m) => m.subject === "SPLICE.reportScoreAndState").length === 2);
  assert.equal((await reports(page))[1].score, 2 / 3);
  const events = await page.evaluate(() => globalThis.messages.filter((m) => m.subject === "SPLICE.sendEvent"));
  assert.deepEqual(events.map((event) => [event.name, event.data.quiz, event.data.correct]), [["quiz-answer", "one", true], ["quiz-answer", "two", true]]);
  const ids = await page.evaluate(() => globalThis.messages.map((m) => m.message_id));
  assert.equal(new Set(ids).size, ids.length);
  await page.reload();
  await question(0).locator(".badge").waitFor();
  assert.match(await frame.locator(".score").first().innerText(), /1 of 2 correct/);
  assert.equal(await page.evaluate(() => globalThis.messages.filter((m) => m.subject === "SPLICE.getState").length), 1);
  assert.equal(await frame.locator("body").evaluate(() => localStorage.length), 0);
  errors.none();
});

test("a hostile state is no state; a system that does not answer is not waited for", async (t) => {
  const { page, errors, frame } = await open(t, "/parent.html");
  for (const state of [{ quizzes: { one: [{ choice: ["<img src=x onerror=alert(1)>", -1, 1e9], tries: "x", isDone: "yes" }, 7, null, null, {}] } }, { quizzes: 5 }, "text", [1]]) {
    await page.evaluate((s) => sessionStorage.setItem("state", JSON.stringify(s)), state);
    await page.reload();
    await frame.locator(".question").first().waitFor();
    assert.equal(await frame.locator(".badge").count(), 0);
  }
  await page.goto(`${server.url}/silent.html`);
  await frame.locator(".question").first().waitFor();
  await page.goto(`${server.url}/alone.html`);
  await page.locator(".question").first().waitFor();
  errors.none();
});

test("statements of xAPI say what was answered, and not what is right", async () => {
  const { toXapi } = await load("grades/xapi.ts");
  const options = { actor: { mbox: "mailto:a@b.c" }, activity: "https://x.org/lesson#part", timestamp: "2026-01-01T00:00:00Z", name: "A?" };
  const detail = { quiz: "one two", index: 0, kind: "multiple", answer: [0, 2], correct: false, attempt: 2, done: true };
  const statement = toXapi(detail, options);
  assert.equal(statement.verb.id, "http://adlnet.gov/expapi/verbs/answered");
  assert.equal(statement.object.id, "https://x.org/lesson#one%20two.1");
  assert.deepEqual(statement.result, { response: "0[,]2", completion: true, success: false, score: { scaled: 0 } });
  assert.deepEqual([statement.object.definition.interactionType, statement.timestamp], ["choice", "2026-01-01T00:00:00Z"]);
  assert.ok(!JSON.stringify(statement).includes("correctResponsesPattern"));
  const response = (kind, answer) => toXapi({ ...detail, kind, answer, correct: null }, options).result;
  assert.deepEqual(response("truefalse", [1]), { response: "false", completion: true });
  assert.equal(response("numeric", " 0,25 ").response, "0.25");
  assert.equal(response("open", "text").response, "text");
});
