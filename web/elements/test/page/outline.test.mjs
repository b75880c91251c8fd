// A lab before its engine is there: its outline and its poster.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { drop, dropLab, labOf, launch, newContext, opened, pageOf, serve, watchErrors } from "./site.mjs";

/** A picture of one red pixel. */
const RED = "data:image/gif;base64,R0lGODlhAQABAIAAAP8AAAAAACwAAAAAAQABAAACAkQBADs=";
const server = await serve({
  "/lab.html": pageOf(labOf(dropLab, { models: { drop } })),
  "/poster.html": pageOf(labOf(dropLab, { models: { drop }, attributes: `poster="${RED}"` })),
  "/dark.html": pageOf(labOf(dropLab, { models: { drop }, attributes: `poster="${RED}" theme="dark"` })),
  "/missing.html": pageOf(labOf(dropLab, { models: { drop }, attributes: 'poster="data:image/gif;base64,AAAA"' })),
  "/autoplay.html": pageOf(`${labOf({ ...dropLab, autoplay: true }, { models: { drop } })}<div style="height: 5000px"></div>`),
  "/strange.html": pageOf(labOf({ controls: [null, 3, { label: 4 }, { type: "select" }], plots: [{}], readouts: [[]], toggles: 3, note: 5, model: "drop" }, { models: { drop } })),
});
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
});

/** A page whose engine does not start before `letGo()` is called there. */
async function openHeld(t, path) {
  const context = await newContext(browser);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.addInitScript(() => {
    const free = new Promise((resolve) => { globalThis.letGo = resolve; });
    globalThis.Worker = class extends Worker {
      postMessage(...message) { void free.then(() => super.postMessage(...message)); }
    };
  });
  await page.goto(server.url + path);
  await page.locator("sim-lab .outline").waitFor();
  return { page, errors };
}

const PARTS = [".title", ".view", ".toolbar .primary", ".toolbar .clock", ".toggle", "input[type=range]", ".control select", ".action", ".readout", ".plot-stage", ".legend", ".note"];
/** The place of each part, in pixels. */
const places = (page) => page.evaluate((parts) => {
  const { shadowRoot } = document.querySelector("sim-lab");
  return Object.fromEntries(parts.map((part) => [part, [...shadowRoot.querySelectorAll(part)].map((element) => {
    const { x, y, width, height } = element.getBoundingClientRect();
    return part === ".toolbar .clock" ? [y] : [x, y, width, height];
  })]));
}, PARTS);

test("the outline has the parts of the lab where they stay, and cannot be used", async (t) => {
  const { page, errors } = await openHeld(t, "/lab.html");
  const before = await places(page);
  assert.ok(PARTS.every((part) => before[part].length > 0), JSON.stringify(before));
  await page.locator("sim-lab [part=status]").getByText("The lab is loading…").waitFor({ state: "attached" });
  const state = await page.evaluate(() => {
    const { shadowRoot } = document.querySelector("sim-lab");
    globalThis.regions = shadowRoot.querySelectorAll("[role=status]:not([inert] *)");
    const inputs = [...shadowRoot.querySelectorAll("input, select, button, [tabindex], summary")];
    return {
      // Assistive technology may hold back what is in a busy element.
      busy: shadowRoot.querySelectorAll("[aria-busy]").length, regions: regions.length, isOutside: regions[0].parentNode === shadowRoot,
      usable: inputs.filter((input) => input.closest("[inert]") === null).length, isOpen: document.querySelector("sim-lab").time,
    };
  });
  assert.deepEqual(state, { busy: 0, regions: 1, isOutside: true, usable: 0, isOpen: 0 });
  await page.evaluate(() => globalThis.letGo());
  await opened(page);
  const now = await places(page);
  for (const part of PARTS) {
    for (const [i, place] of before[part].entries()) {
      for (const [k, value] of place.entries()) assert.ok(Math.abs(value - now[part][i][k]) <= 1, `${part}: ${JSON.stringify([before[part], now[part]])}`);
    }
  }
  assert.equal(await page.locator("sim-lab .outline").count(), 0);
  const region = await page.evaluate(() => {
    const status = document.querySelector("sim-lab").shadowRoot.querySelector("[part=status]");
    return [status === globalThis.regions[0], status.textContent];
  });
  assert.deepEqual(region, [true, ""], "the live region is the same, and empty");
  errors.none();
});

test("the poster is seen until the lab has drawn its picture", async (t) => {
  const { page, errors } = await openHeld(t, "/poster.html");
  const poster = page.locator("sim-lab .poster");
  await poster.waitFor({ state: "visible" });
  const covered = await page.evaluate(() => {
    const { shadowRoot } = document.querySelector("sim-lab");
    const [view, picture] = [".view", ".poster"].map((part) => shadowRoot.querySelector(part).getBoundingClientRect());
    return [view.width - picture.width, view.height - picture.height];
  });
  assert.ok(covered.every((difference) => difference >= 0 && difference <= 1), JSON.stringify(covered));
  await page.evaluate(() => globalThis.letGo());
  await opened(page);
  await poster.waitFor({ state: "detached" });
  errors.none();
});

test("a dark lab shows no light poster, and a damaged poster is not seen", async (t) => {
  for (const path of ["/dark.html", "/missing.html"]) {
    const { page } = await openHeld(t, path);
    await page.waitForFunction(() => document.querySelector("sim-lab").shadowRoot.querySelector(".poster").complete);
    await page.waitForTimeout(100);
    assert.equal(await page.locator("sim-lab .poster").isVisible(), false, path);
  }
});

test("a lab that opens in a saved state does not show its start", async (t) => {
  const { page } = await openHeld(t, "/poster.html#lab.lab=AAAA");
  assert.equal(await page.locator("sim-lab .poster").count(), 0);
});

test("a lab that leaves the window while it opens does not play before it is back", async (t) => {
  const { page, errors } = await openHeld(t, "/autoplay.html");
  await page.evaluate(() => scrollTo(0, 4000));
  await page.waitForTimeout(200);
  await page.evaluate(() => globalThis.letGo());
  await opened(page);
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => document.querySelector("sim-lab").time), 0);
  await page.evaluate(() => scrollTo(0, 0));
  await page.waitForFunction(() => document.querySelector("sim-lab").time > 0);
  errors.none();
});

test("keys of wrong types do not break the outline", async (t) => {
  const { page, errors } = await openHeld(t, "/strange.html");
  await page.evaluate(() => globalThis.letGo());
  await page.waitForFunction(() => document.querySelector("sim-lab").shadowRoot.querySelector(".outline") === null);
  errors.none();
});
