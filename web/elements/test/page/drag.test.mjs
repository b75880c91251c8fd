// Bodies that are dragged: every way out of a drag lets go of the body.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { chromiumOnly, labOf, launch, newContext, opened, pageOf, serve, watchErrors } from "./site.mjs";

const box = "<mujoco><worldbody><light pos='0 0 3'/><geom type='plane' size='2 2 1'/><body name='big_box' pos='0 0 .4'><freejoint/><geom type='box' size='.4 .4 .4'/></body></worldbody></mujoco>";
const lab = { title: "A box", model: "box", camera: { distance: 3, target: [0, 0, 0.5] } };
const two = "<mujoco><worldbody><body name='a_b' pos='0 0 1'><freejoint/><geom size='.1'/></body><body pos='1 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
const server = await serve({
  "/box.html": pageOf(`${labOf(lab, { models: { box } })}<button type="button" id="outside">Outside</button>`),
  "/two.html": pageOf(labOf({ model: "two" }, { models: { two } })),
});
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
});

async function open(t, options = {}, path = "/box.html") {
  const context = await newContext(browser, options);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.goto(server.url + path);
  await opened(page);
  // The body is picked in the first picture.
  await page.waitForTimeout(1000);
  const { x, y, width, height } = await page.locator(".view canvas").boundingBox();
  return { page, errors, middle: [x + width / 2, y + height / 2] };
}

/** Whether a force acts on the body. */
const isHeld = (page) => page.evaluate(async () => {
  const { actions } = JSON.parse(new TextDecoder().decode(await document.querySelector("sim-lab").saveState())).labspec;
  return actions.filter(([what]) => what === "force").at(-1)?.[2].some((force) => force !== 0) ?? false;
});

const ways = {
  "the pointer is up": (page) => page.mouse.up(),
  "the capture is lost": async (page) => {
    await page.locator(".view canvas").evaluate((canvas) => {
      for (let id = 0; id < 20; id++) if (canvas.hasPointerCapture(id)) canvas.releasePointerCapture(id);
    });
    // The browser tells it with the next move.
    await page.mouse.move(5, 5);
  },
  "the pointer is cancelled": (page) => page.locator(".view canvas").evaluate((canvas) => {
    for (let id = 0; id < 20; id++) if (canvas.hasPointerCapture(id)) canvas.dispatchEvent(new PointerEvent("pointercancel", { pointerId: id, pointerType: "mouse" }));
  }),
  "the focus leaves the lab": (page) => page.locator("#outside").focus(),
  "the lab is reset": (page) => page.evaluate(() => document.querySelector("sim-lab").reset()),
  "the lab is moved in its page": (page) => page.evaluate(() => document.querySelector("main").append(document.querySelector("sim-lab"))),
};
for (const [name, leave] of Object.entries(ways)) {
  test(`a body is let go: ${name}`, async (t) => {
    const { page, errors, middle: [x, y] } = await open(t);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 30, y - 60, { steps: 3 });
    await page.evaluate(() => document.querySelector("sim-lab").step(20));
    assert.ok(await isHeld(page));
    await leave(page);
    await page.evaluate(() => document.querySelector("sim-lab").step(20));
    assert.equal(await isHeld(page), false);
    // Moves of the pointer after that do not hold it again.
    await page.mouse.move(x, y - 80, { steps: 2 });
    assert.equal(await isHeld(page), false);
    await page.mouse.up();
    errors.none();
  });
}

test("a pinch that begins on a body lets go of it", chromiumOnly("the protocol of Chromium has two fingers"), async (t) => {
  const { page, errors, middle: [x, y] } = await open(t, { viewport: { width: 400, height: 700 }, hasTouch: true, isMobile: true });
  await page.touchscreen.tap(x, y);
  const protocol = await page.context().newCDPSession(page);
  const touch = (type, points) => protocol.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([left, top], id) => ({ x: left, y: top, id })) });
  await touch("touchStart", [[x, y]]);
  await touch("touchMove", [[x, y - 60]]);
  await page.evaluate(() => document.querySelector("sim-lab").step(20));
  assert.ok(await isHeld(page));
  await touch("touchStart", [[x, y - 60], [x + 60, y]]);
  await touch("touchMove", [[x, y - 70], [x + 70, y]]);
  assert.equal(await isHeld(page), false);
  await touch("touchEnd", []);
  await page.evaluate(() => document.querySelector("sim-lab").step(20));
  assert.equal(await isHeld(page), false);
  errors.none();
});

test("a body is chosen by arrow keys and taken by Enter; what is said names it", async (t) => {
  const { page, errors } = await open(t, {}, "/two.html");
  const state = () => page.evaluate(() => {
    const { activeElement } = document.querySelector("sim-lab").shadowRoot;
    return `${activeElement?.className}: ${document.querySelector("sim-lab").shadowRoot.querySelector("select.drag").selectedOptions[0].textContent}`;
  });
  const says = (text) => page.waitForFunction((t) => document.querySelector("sim-lab").shadowRoot.querySelector("[part=status]").textContent.startsWith(t), text);
  await page.locator(".menu summary").click();
  await page.getByRole("combobox", { name: "Drag a body" }).focus();
  await page.keyboard.press("ArrowDown");
  assert.equal(await state(), "drag: a b");
  assert.equal(await isHeld(page), false);
  await page.keyboard.press("ArrowDown");
  assert.equal(await state(), "drag: Body 2");
  await page.keyboard.press("Enter");
  assert.match(await state(), /^view.*: Body 2$/);
  await says("Body 2 is held.");
  await page.keyboard.press("Escape");
  await says("Body 2 is released.");
  assert.match(await state(), /^view.*: No body$/);
  // What was only looked at is not taken.
  await page.locator(".menu summary").click();
  await page.getByRole("combobox", { name: "Drag a body" }).focus();
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Tab");
  assert.match(await state(), /: No body$/);
  errors.none();
});
