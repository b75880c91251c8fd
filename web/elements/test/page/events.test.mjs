// What a lab tells the page: each event with its own sentence, and a breakdown only where a number is bad.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { labOf, launch, newContext, opened, pageOf, serve, watchErrors } from "./site.mjs";

const many = `<mujoco><worldbody><geom name="floor" type="plane" size="2 2 1"/>${
  [0, 1, 2, 3, 4, 5].map((i) => `<body name="b${i}" pos="${i * 0.3} 0 .3"><freejoint/><geom size=".1"/></body>`).join("")}</worldbody></mujoco>`;
const slider = "<mujoco><worldbody><body><joint name='s' type='slide' axis='1 0 0'/><geom size='.1'/></body></worldbody></mujoco>";
const reset = (controller, more = {}) => pageOf(labOf({
  model: "slider", controller, plots: [{ ylabel: "t", traces: [{ label: "time", expr: "data.time" }] }], readouts: [{ label: "t", expr: "data.time" }], ...more,
}, { models: { slider } }));
const integrators = { integrators: ["Euler", "RK4"] };
const [byLab, byEngine, bad] = ["sim.reset()", "mj.mj_resetData(model, data)", "data.qvel[0] = 1e12"].map((text) => `if (data.time > 0.2) { ${text} }`);
const server = await serve({
  "/lab.html": reset(byLab), "/engine.html": reset(byEngine), "/bad.html": reset(bad), "/first.html": reset("data.qvel[0] = 1e12"),
  "/compared-lab.html": reset(byLab, integrators), "/compared-bad.html": reset(bad, integrators),
  "/many.html": pageOf(labOf({ model: "many", stopAt: 0.3 }, { models: { many } })),
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
  await opened(page);
  await page.evaluate(() => {
    globalThis.told = [];
    document.addEventListener("lab-event", ({ detail }) => globalThis.told.push([detail.type, detail.text]));
  });
  return { page, errors };
}

const step = (page, steps) => page.evaluate((n) => document.querySelector("sim-lab").step(n), steps);
const told = (page) => page.evaluate(() => globalThis.told);
const listed = (page) => page.evaluate(() => document.querySelector("sim-lab").events);

test("many contacts are one line of the list, and each event has its own sentence", async (t) => {
  const { page, errors } = await open(t, "/many.html");
  await step(page, 1000);
  const events = await told(page);
  assert.equal(events.length, 7);
  events.slice(0, 6).forEach(([type, text], i) => assert.match(`${type}: ${text}`, new RegExp(`^contact: B${i} touches floor at 0\\.\\d+ s\\.$`)));
  assert.match(events[6].join(": "), /^stop: The lab stops at 0\.3\d* s\.$/);
  assert.match((await listed(page)).join("\n"), /^6 contacts begin or end from .*\nThe lab stops at 0\.3\d* s\.$/);
  errors.none();
});

for (const path of ["/lab.html", "/engine.html", "/compared-lab.html"]) {
  test(`a program that resets the lab breaks nothing: ${path}`, async (t) => {
    const { page, errors } = await open(t, path);
    for (let i = 0; i < 13; i++) await step(page, 10);
    const { time, length, first, numbers } = await page.evaluate(() => {
      const { time, traces, numbers } = document.querySelector("sim-lab");
      const { series } = traces.at(-1);
      return { time, length: series.length, first: series.times[0], numbers };
    });
    assert.ok(time > 0.05 && time < 0.07, `back at the start after 0.2 s: ${time}`);
    assert.deepEqual(await told(page), []);
    assert.deepEqual(await listed(page), []);
    assert.ok(first < 0.01 && length <= 31, `the plot begins again: ${length} samples from ${first}`);
    assert.ok(numbers.every(Number.isFinite), `${numbers}`);
    // A reset that lies inside one call, which ends at a later time than it began.
    await step(page, 60);
    await step(page, 90);
    assert.deepEqual(await told(page), []);
    errors.none();
  });
}

for (const path of ["/bad.html", "/first.html", "/compared-bad.html"]) {
  test(`a bad number is a breakdown: ${path}`, async (t) => {
    const { page, errors } = await open(t, path);
    await step(page, 120);
    assert.match((await told(page)).map((event) => event.join(": ")).join("\n"), /^restart: The simulation breaks down at 0\.\d+ s.*a number became too large/m);
    errors.none();
  });
}
