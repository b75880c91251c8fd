// What a lab tells the page: each event with its own sentence, and a breakdown only where a number is bad.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { labOf, launch, newContext, opened, pageOf, serve, watchErrors } from "./site.mjs";

const many = `<mujoco><worldbody><geom name="floor" type="plane" size="2 2 1"/>${
  [0, 1, 2, 3, 4, 5].map((i) => `<body name="b${i}" pos="${i * 0.3} 0 .3"><freejoint/><geom size=".1"/></body>`).join("")}</worldbody></mujoco>`;
const server = await serve({ "/many.html": pageOf(labOf({ model: "many", stopAt: 0.3 }, { models: { many } })) });
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
