// Grades by SCORM 2004: a page around the quiz has the API of a learning system, which keeps the rules of the standard and records every call.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { load } from "../load.mjs";
import { launch, newContext, pageOf, serve, watchErrors } from "./site.mjs";

const first = { id: "one", questions: [{ q: "A?", options: ["a", "b"], answer: 0 }, { kind: "numeric", q: "B?", answer: 2 }, { kind: "open", q: "C?" }] };
const second = { id: "two", questions: [{ kind: "truefalse", q: "D?", answer: false }] };
const quiz = (content, attributes = "") => `<lesson-quiz grades="scorm" ${attributes}><script type="application/json">${JSON.stringify(content)}</script></lesson-quiz>`;

/** A learning system. It forgets a state after an exit that is not a suspension, as the standard says. */
function learningSystem() {
  const read = (name) => JSON.parse(sessionStorage.getItem(name) ?? "null");
  const state = { phase: "new", error: "0", values: read("values") ?? {}, calls: [], faults: [] };
  globalThis.lms = state;
  const real = /^-?\d{1,10}(\.\d{1,7})?$/;
  const forms = {
    "cmi.completion_status": /^(completed|incomplete|not attempted|unknown)$/, "cmi.success_status": /^(passed|failed|unknown)$/,
    "cmi.exit": /^(suspend|normal|logout|time-out|)$/, "cmi.session_time": /^PT\d+(\.\d{1,2})?S$/,
    "cmi.score.scaled": real, "cmi.score.raw": real, "cmi.score.min": real, "cmi.score.max": real, "cmi.suspend_data": /^[^]{0,64000}$/,
  };
  const ofInteraction = {
    id: /^[\w.~%!'()*-]{1,4000}$/, type: /^(true-false|choice|fill-in|long-fill-in|numeric|other)$/, timestamp: /^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$/,
    result: /^(correct|incorrect|neutral)$/, learner_response: /^[^]{0,4000}$/,
  };
  const responses = { "true-false": /^(true|false)$/, choice: /^(\d+(\[,\]\d+)*)?$/, numeric: real, "long-fill-in": /^(\{lang=\w+\}[^]*|[^{][^]*|)$/ };
  const fault = (error, why) => {
    state.error = error;
    state.faults.push(why);
    return "false";
  };
  const setInteraction = (name, n, part, value) => {
    const at = Number(n), count = state.values["cmi.interactions._count"] ?? 0;
    if (at > count || (at === count && part !== "id")) return fault("351", `${name} before its id`);
    if (!ofInteraction[part]?.test(value)) return fault("406", `${name} = ${value}`);
    const type = state.values[`cmi.interactions.${n}.type`];
    if (part === "learner_response" && !responses[type]?.test(value)) return fault(type === undefined ? "408" : "406", `${name} = ${value} of ${type}`);
    if (at === count) state.values["cmi.interactions._count"] = count + 1;
    return null;
  };
  globalThis.API_1484_11 = {
    Initialize(x) {
      state.calls.push(["Initialize", x]);
      if (state.phase !== "new") return fault("103", "Initialize twice");
      state.phase = "open";
      return "true";
    },
    Terminate(x) {
      state.calls.push(["Terminate", x]);
      if (state.phase !== "open") return fault("112", "Terminate without a session");
      state.phase = "closed";
      const kept = state.values["cmi.exit"] === "suspend" ? state.values : {};
      sessionStorage.setItem("values", JSON.stringify({ ...kept, "cmi.exit": "" }));
      return "true";
    },
    GetValue(name) {
      state.calls.push(["GetValue", name]);
      if (state.phase !== "open") return fault("122", `GetValue ${name} without a session`) && "";
      return String(state.values[name] ?? (name.endsWith("_count") ? 0 : ""));
    },
    SetValue(name, value) {
      state.calls.push(["SetValue", name, value]);
      if (state.phase !== "open") return fault("132", `SetValue ${name} without a session`);
      if (typeof value !== "string") return fault("406", `${name} is no text`);
      const interaction = /^cmi\.interactions\.(\d+)\.(\w+)$/.exec(name);
      const refused = interaction === null ? null : setInteraction(name, interaction[1], interaction[2], value);
      if (refused !== null) return refused;
      if (interaction === null && !forms[name]?.test(value)) return fault("406", `${name} = ${value}`);
      state.values[name] = value;
      return "true";
    },
    Commit(x) {
      state.calls.push(["Commit", x]);
      sessionStorage.setItem("values", JSON.stringify(state.values));
      return "true";
    },
    GetLastError: () => state.error, GetErrorString: () => "", GetDiagnostic: () => "",
  };
}

const around = (script, frame = "/quiz.html") => `<!doctype html><title>Parent</title><link rel="icon" href="data:,"><script>${script}</script>${
  frame === null ? "" : `<iframe src="${frame}" width="800" height="800"></iframe>`}`;
const whole = `(${learningSystem})()`;
const server = await serve({
  "/quiz.html": pageOf(quiz(first) + quiz(second)), "/passing.html": pageOf(quiz(second, 'passing="0.5"')), "/alone.html": pageOf(quiz(first)),
  "/lms.html": around(whole), "/lms-passing.html": around(whole, "/passing.html"), "/opener.html": around(whole, null),
  "/outer.html": around(whole, "/inner.html"), "/inner.html": around(""),
  "/throws.html": around(`const f = () => { throw new Error("broken"); };
    globalThis.API_1484_11 = { Initialize: f, Terminate: f, GetValue: f, SetValue: f, Commit: f };`),
  "/late.html": around(`const f = () => { throw new Error("broken"); };
    globalThis.API_1484_11 = { Initialize: () => "true", Terminate: f, GetValue: f, SetValue: f, Commit: f };`),
  "/getter.html": around(`Object.defineProperty(globalThis, "API_1484_11", { get() { throw new Error("broken"); } });`),
  "/wrong.html": around(`globalThis.API_1484_11 = { Initialize: 5 };`),
  "/refuses.html": around(`globalThis.API_1484_11 = { Initialize: () => "false", Terminate: () => "", GetValue: () => "", SetValue: () => "", Commit: () => "" };`),
});
// The same pages from another origin.
const other = await serve({ "/far.html": around(whole, `${server.url}/alone.html`) });
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
  other.close();
});

async function open(t, path) {
  const context = await newContext(browser);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.goto(path.startsWith("http") ? path : server.url + path);
  return { page, errors, frame: page.frameLocator("iframe") };
}

const values = (page) => page.evaluate(() => globalThis.lms.values);
const committed = (page, n) => page.waitForFunction((wanted) => globalThis.lms.calls.filter(([name]) => name === "Commit").length === wanted, n);
const check = async (question, name) => {
  await question.getByRole("radio", { name }).check();
  await question.getByRole("button", { name: "Check" }).click();
};

test("a learning system gets interactions, score, status and state, and gives the state back", async (t) => {
  const { page, errors, frame } = await open(t, "/lms.html");
  const question = (i) => frame.locator(".question").nth(i);
  await check(question(0), "a");
  await committed(page, 1);
  let found = await values(page);
  assert.deepEqual(["id", "type", "learner_response", "result"].map((part) => found[`cmi.interactions.0.${part}`]), ["one.1", "choice", "0", "correct"]);
  assert.deepEqual(["scaled", "raw", "min", "max"].map((part) => found[`cmi.score.${part}`]), ["0.3333333", "1", "0", "3"]);
  assert.deepEqual([found["cmi.completion_status"], found["cmi.success_status"], found["cmi.exit"]], ["incomplete", undefined, "suspend"]);
  await question(1).getByRole("textbox").fill("2,0");
  await question(1).getByRole("button", { name: "Check" }).click();
  await question(2).getByRole("textbox").fill("{lang=xx}because");
  await question(2).getByRole("button").click();
  await check(question(3), "True");
  await committed(page, 4);
  found = await values(page);
  assert.deepEqual(["type", "learner_response"].map((part) => found[`cmi.interactions.1.${part}`]), ["numeric", "2.0"]);
  assert.deepEqual(["type", "learner_response", "result"].map((part) => found[`cmi.interactions.2.${part}`]), ["long-fill-in", "{lang=en}{lang=xx}because", "neutral"]);
  assert.deepEqual(["type", "learner_response", "result"].map((part) => found[`cmi.interactions.3.${part}`]), ["true-false", "true", "incorrect"]);
  assert.deepEqual([found["cmi.completion_status"], found["cmi.score.scaled"]], ["completed", "0.6666667"]);
  // The page is left, and visited again.
  await page.evaluate(() => { document.querySelector("iframe").remove(); });
  await page.waitForFunction(() => globalThis.lms.phase === "closed");
  const calls = await page.evaluate(() => globalThis.lms.calls);
  assert.deepEqual([calls[0], calls.at(-2).slice(0, 2), calls.at(-1)], [["Initialize", ""], ["SetValue", "cmi.session_time"], ["Terminate", ""]]);
  assert.deepEqual(await page.evaluate(() => globalThis.lms.faults), []);
  await page.reload();
  await question(0).locator(".badge").waitFor();
  assert.match(await frame.locator(".score").first().innerText(), /2 of 2 correct/);
  assert.equal(await question(2).getByRole("textbox").inputValue(), "{lang=xx}because");
  assert.equal(await frame.locator("body").evaluate(() => localStorage.length), 0);
  // A reader who clears the answers has completed the lesson all the same.
  await frame.getByRole("button", { name: /clear/i }).first().click();
  await committed(page, 1);
  found = await values(page);
  assert.deepEqual([found["cmi.completion_status"], found["cmi.score.raw"], found["cmi.interactions._count"]], ["completed", "0", 4]);
  assert.deepEqual(await page.evaluate(() => globalThis.lms.faults), []);
  errors.none();
});

test("the share that passes is that of the learning system, or of the page", async (t) => {
  const { page, errors, frame } = await open(t, "/lms-passing.html");
  await check(frame.locator(".question"), "True");
  await committed(page, 1);
  assert.deepEqual([(await values(page))["cmi.success_status"], (await values(page))["cmi.completion_status"]], ["failed", "completed"]);
  await page.evaluate(() => sessionStorage.setItem("values", JSON.stringify({ "cmi.scaled_passing_score": "0" })));
  await page.goto(`${server.url}/alone.html`);
  await page.evaluate(() => sessionStorage.setItem("values", JSON.stringify({ "cmi.scaled_passing_score": "0" })));
  await page.goto(`${server.url}/lms-passing.html`);
  await check(frame.locator(".question"), "True");
  await committed(page, 1);
  assert.equal((await values(page))["cmi.success_status"], "passed");
  errors.none();
});

test("the API is found in an outer window and in the window that opened the page", async (t) => {
  const { page, errors } = await open(t, "/outer.html");
  await page.frameLocator("iframe").frameLocator("iframe").locator(".question").first().waitFor();
  assert.equal(await page.evaluate(() => globalThis.lms.phase), "open");
  await page.goto(`${server.url}/opener.html`);
  const [popup] = await Promise.all([page.waitForEvent("popup"), page.evaluate(() => { globalThis.open("/quiz.html"); })]);
  await popup.locator(".question").first().waitFor();
  assert.equal(await page.evaluate(() => globalThis.lms.phase), "open");
  await popup.close({ runBeforeUnload: true });
  await page.waitForFunction(() => globalThis.lms.phase === "closed");
  errors.none();
});

test("values of a hostile learning system are checked", async (t) => {
  const { page, errors, frame } = await open(t, "/lms.html");
  const states = [
    JSON.stringify({ quizzes: { one: [{ choice: ["<img src=x onerror=alert(1)>", -1, 1e9], tries: "x", isDone: "yes" }, 7, null, null, {}] } }),
    JSON.stringify({ quizzes: 5 }), "{", "null", `{"quizzes": {"one": "${"x".repeat(70_000)}"}}`, '{"quizzes": {"__proto__": [], "one": {"length": 1e9}}}',
  ];
  for (const state of states) {
    for (const count of ["-1", "1e9", "many", ""]) {
      const hostile = { "cmi.suspend_data": state, "cmi.interactions._count": count, "cmi.scaled_passing_score": "NaN", "cmi.completion_status": "<b>" };
      await page.evaluate((v) => {
        // The session that ends now stores nothing.
        Object.assign(globalThis.API_1484_11, { Terminate: () => "true" });
        sessionStorage.setItem("values", JSON.stringify(v));
      }, hostile);
      await page.reload();
      await frame.locator(".question").first().waitFor();
      assert.equal(await frame.locator(".badge").count(), 0, state.slice(0, 80));
      if (count !== "many") continue;
      await check(frame.locator(".question").first(), "b");
      await committed(page, 1);
      const found = await page.evaluate(() => globalThis.lms.calls.filter(([name, element]) => name === "SetValue" && element.startsWith("cmi.interactions")));
      assert.equal(found[0][1], "cmi.interactions.0.id");
    }
  }
  errors.none();
});

for (const path of ["/alone.html", "/throws.html", "/getter.html", "/wrong.html", "/refuses.html"]) {
  test(`without a learning system that answers, the browser keeps the answers: ${path}`, async (t) => {
    const { page, errors, frame } = await open(t, path);
    const inside = path === "/alone.html" ? page : frame;
    await check(inside.locator(".question").first(), "a");
    await inside.locator(".badge").waitFor();
    await page.reload();
    await inside.locator(".badge").waitFor();
    assert.ok((await inside.locator("body").evaluate(() => localStorage.length)) > 0);
    errors.none();
  });
}

test("a learning system that breaks later, or is of another origin, does not stop the page", async (t) => {
  for (const path of ["/late.html", `${other.url}/far.html`]) {
    const { errors, frame } = await open(t, path);
    await check(frame.locator(".question").first(), "a");
    await frame.locator(".badge").waitFor();
    assert.match(await frame.locator(".score").first().innerText(), /1 of 2 correct/);
    errors.none();
  }
});

test("values have the forms of the data model, whatever a quiz is called and a learner writes", async () => {
  const { durationOf, interactionOf, readStates, realOf, scoreOf, shareOf, statusOf, writeStates } = await load("grades/cmi.ts");
  const detail = { quiz: "\ud800 /?#\u202e<b>é", index: 0, kind: "numeric", answer: "1e-9", correct: false, attempt: 1, done: false };
  const of = (more) => Object.fromEntries(interactionOf({ ...detail, ...more }, 3, new Date("2026-01-02T03:04:05.678Z")).map(([name, value]) => [name.slice(19), value]));
  assert.deepEqual(of({}), {
    id: "%EF%BF%BD%20%2F%3F%23%E2%80%AE%3Cb%3E%C3%A9.1", type: "long-fill-in", timestamp: "2026-01-02T03:04:05Z", learner_response: "1e-9", result: "incorrect",
  });
  assert.deepEqual([of({ answer: " -0,5 " }).type, of({ answer: " -0,5 " }).learner_response], ["numeric", "-0.5"]);
  assert.equal(of({ kind: "multiple", answer: [0, 2], correct: true }).learner_response, "0[,]2");
  assert.equal(of({ kind: "code", answer: "x".repeat(99_999), correct: null }).learner_response.length, 4000);
  assert.ok(of({ quiz: "💥".repeat(9999) }).id.length <= 4000);
  assert.deepEqual([realOf(1 / 3), realOf(0), durationOf(-1), durationOf(3661.239)], ["0.3333333", "0", "PT0.00S", "PT3661.24S"]);
  assert.deepEqual(["0.5", "", " ", "2", "-1", "x", null].map(shareOf), [0.5, null, null, null, null, null, null]);
  const totals = { right: 0, count: 0, isAnswered: true, states: {} };
  assert.deepEqual([scoreOf(totals), statusOf(totals, true, 0.5)], [[], [["cmi.completion_status", "completed"]]]);
  // Long texts are shortened until the state fits.
  const long = { one: Array.from({ length: 30 }, () => ({ choice: [], text: "\u0001".repeat(20_000), tries: 1, isRight: null, isDone: true })) };
  const stored = writeStates(long);
  assert.ok(stored.length <= 64_000 && readStates(stored).one.every(({ text }) => text.length === 100), String(stored.length));
  assert.equal(writeStates({ one: Array.from({ length: 9000 }, () => ({ choice: [1] })) }), null);
});
