// <sim-lab> in Chromium: opened, played, moved, dragged, saved, broken.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test, { after } from "node:test";
import { Lab } from "labspec";
import { chromiumOnly, drop, dropLab, labOf, launch, launchWithoutWebGl, newContext, opened, pageOf, repository, serve, watchErrors } from "./site.mjs";

const boxes = Array.from({ length: 27 }, (_, i) => `<body pos='${(i % 3) * 0.19} ${(Math.floor(i / 3) % 3) * 0.19} ${0.11 + Math.floor(i / 9) * 0.21}'><freejoint/><geom type='box' size='.1 .1 .1'/></body>`).join("");
const pile = `<mujoco><option timestep='0.00005'/><worldbody><geom type='plane' size='5 5 1'/>${boxes}</worldbody></mujoco>`;
const server = await serve({
  "/drop.html": pageOf(labOf(dropLab, { models: { drop } })),
  "/frozen.html": pageOf(labOf({ ...dropLab, stopAt: 0.5, autoplay: true }, { models: { drop } })),
  "/empty.html": pageOf("<sim-lab></sim-lab>"),
  "/broken.html": pageOf(`${labOf({ model: "drop", readouts: [{ label: "x", expr: "data.joint('fal').qpos[2]" }] }, { id: "a", models: { drop } })}
    <sim-lab id="b"><script type="application/json">{"model": }</script></sim-lab><sim-lab id="c" src="/nowhere.json"></sim-lab>
    ${labOf({ model: "none" }, { id: "d" })}${labOf({ xml: "<mujoco><worldbody><geom size='x'/></worldbody></mujoco>" }, { id: "e" })}`),
  "/folder.html": pageOf('<sim-lab src="/lab.json" models="/models"></sim-lab>'),
  "/lab.json": JSON.stringify({ model: "pair", readouts: [{ label: "geoms", expr: "model.ngeom" }] }),
  "/models/pair.xml": "<mujoco><compiler meshdir='shapes'/><asset><mesh name='wedge' file='wedge.obj'/></asset><include file='parts/floor.xml'/><worldbody><geom type='mesh' mesh='wedge'/></worldbody></mujoco>",
  "/models/parts/floor.xml": "<mujoco><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>",
  "/models/shapes/wedge.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
  "/pile.html": pageOf(labOf({ model: "pile", height: 160, controls: [{ label: "gravity", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8 }] }, { models: { pile } })),
  "/order.html": pageOf(labOf({
    model: "drop", controls: [{ label: "a", param: "a", min: 0, max: 10, value: 1 }, { type: "button", label: "Copy", run: "ctx.seen = ctx.a" }],
    readouts: [{ label: "seen", expr: "ctx.seen || 0", digits: 0 }, { label: "a", expr: "ctx.a", digits: 0 }], plots: [{ ylabel: "h", traces: [{ label: "h", expr: "data.qpos[2]" }] }],
  }, { models: { drop } })),
  "/dark.html": pageOf(labOf(dropLab, { models: { drop }, attributes: 'theme="dark"' })),
  "/late.html": pageOf("<p>Nothing yet.</p>"),
});
const browser = await launch();
after(async () => {
  await browser.close();
  server.close();
});

/** A page with its errors, closed after the test. */
async function open(t, path, options = {}) {
  const context = await newContext(browser, options);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.goto(server.url + path);
  return { page, errors, lab: page.locator("sim-lab").first() };
}

const outputs = (page) => page.locator(".readout output").allTextContents();

test("a lab is opened, played, stepped and reset", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  assert.deepEqual(await outputs(page), ["1.000", "free"]);
  await page.getByRole("button", { name: "Play" }).click();
  await page.getByRole("button", { name: "Pause" }).waitFor();
  await page.waitForFunction(() => document.querySelector("sim-lab").time > 0.6);
  await page.getByRole("button", { name: "Pause" }).click();
  await page.waitForFunction(() => [...document.querySelector("sim-lab").shadowRoot.querySelectorAll(".readout output")].at(-1).textContent === "touching");
  await page.waitForFunction(() => /bob touches floor|ball touches floor/i.test(document.querySelector("sim-lab").shadowRoot.querySelector(".event-list").textContent));
  const time = await page.evaluate(() => document.querySelector("sim-lab").time);
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await page.waitForFunction((t) => Math.abs(document.querySelector("sim-lab").time - t - 0.002) < 1e-9, time);
  await page.getByRole("button", { name: "Reset" }).click();
  await page.waitForFunction(() => document.querySelector("sim-lab").time === 0);
  await page.waitForFunction(() => document.querySelector("sim-lab").shadowRoot.querySelector(".readout output").textContent === "1.000");
  errors.none();
});

test("a slider, a select and a button act as the format says, and the page is told", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  await page.evaluate(() => {
    globalThis.changes = [];
    document.addEventListener("lab-change", (e) => globalThis.changes.push(e.detail));
  });
  await page.evaluate(() => document.querySelector("sim-lab").step(50));
  const slider = page.getByRole("slider", { name: "gravity" });
  assert.equal(await slider.getAttribute("aria-valuetext"), "−9.8 m/s²");
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => globalThis.changes.length === 1);
  assert.equal(await slider.getAttribute("aria-valuetext"), "−9.7 m/s²");
  await page.getByRole("combobox", { name: "start" }).selectOption("low");
  await page.waitForFunction(() => globalThis.changes.length === 2);
  await page.waitForFunction(() => document.querySelector("sim-lab").texts[0] === "0.500");
  await page.getByRole("button", { name: "Kick" }).click();
  await page.waitForFunction(() => globalThis.changes.length === 3);
  const reference = new Lab(dropLab, { drop });
  reference.step(50);
  reference.set("gravity", -9.7);
  reference.set("start", 0.5);
  reference.press("Kick");
  reference.step(100);
  await page.evaluate(() => document.querySelector("sim-lab").step(100));
  assert.deepEqual(await page.evaluate(() => document.querySelector("sim-lab").numbers), [...reference.numbers]);
  assert.deepEqual((await page.evaluate(() => globalThis.changes)).map(({ label, value }) => [label, value]), [["gravity", -9.7], ["start", 0.5], ["Kick", null]]);
  errors.none();
});

test("a slider that is moved does not jump back to the value of an older frame", async (t) => {
  const { page, errors } = await open(t, "/pile.html");
  await opened(page);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => document.querySelector("sim-lab").time > 0);
  const jumps = await page.evaluate(async () => {
    const input = document.querySelector("sim-lab").shadowRoot.querySelector("input[type=range]"), jumps = [];
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    for (let value = -15; value < -5; value += 0.5) {
      input.value = value;
      input.dispatchEvent(new Event("input"));
      // The answer comes within some of these frames.
      for (let i = 0; i < 8; i++) {
        await frame();
        await new Promise((resolve) => setTimeout(resolve, 0));
        if (input.valueAsNumber !== value) jumps.push([value, input.valueAsNumber]);
      }
    }
    return jumps;
  });
  assert.deepEqual(jumps, []);
  errors.none();
});

test("the note is text: its script is gone", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  assert.equal(await page.locator(".note").innerHTML(), "Moving the slider drops the ball again. ");
  errors.none();
});

test("a lab with an end plays to it, and is played again from its start", async (t) => {
  const { page, errors } = await open(t, "/frozen.html");
  await opened(page);
  await page.waitForFunction(() => document.querySelector("sim-lab").isOver);
  assert.ok((await page.evaluate(() => document.querySelector("sim-lab").time)) >= 0.5);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => !document.querySelector("sim-lab").isOver);
  errors.none();
});

test("a body follows the pointer, and is let go", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    await lab.set("gravity", -1);
    await lab.step(1);
  });
  const box = await page.locator(".view canvas").boundingBox();
  const actions = async () => JSON.parse(await page.evaluate(async () => new TextDecoder().decode(await document.querySelector("sim-lab").saveState()))).labspec.actions;
  const middle = box.x + box.width / 2;
  let isHeld = false;
  // The ball is small, and in the middle of the picture: it is looked for from above.
  for (let y = box.y + 10; y < box.y + box.height - 10 && !isHeld; y += 4) {
    await page.mouse.move(middle, y);
    await page.mouse.down();
    isHeld = (await actions()).some(([what]) => what === "force");
    if (isHeld) {
      await page.mouse.move(middle + 60, y - 40, { steps: 4 });
      await page.evaluate(() => document.querySelector("sim-lab").step(100));
    }
    await page.mouse.up();
  }
  assert.ok(isHeld, "no point of the picture held the ball");
  const forces = (await actions()).filter(([what]) => what === "force");
  assert.ok(forces.some(([, body, force]) => body === 1 && force[0] !== 0 && force[2] > 0), "the spring pulls aside and upwards");
  assert.deepEqual(forces.at(-1), ["force", 1, [0, 0, 0, 0, 0, 0]]);
  errors.none();
});

test("a state comes back from its link and from bytes, to the bit; a damaged one is refused in words", async (t) => {
  const { page, errors } = await open(t, "/drop.html", { permissions: ["clipboard-read", "clipboard-write"] });
  await opened(page);
  await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    await lab.set("gravity", -3.7);
    await lab.step(333);
  });
  const numbers = await page.evaluate(() => document.querySelector("sim-lab").numbers);
  await page.locator(".menu summary").click();
  await page.getByRole("button", { name: "Copy a link to this state" }).click();
  await page.waitForFunction(() => location.hash.startsWith("#lab.lab="));
  const link = page.url();
  await page.goto("about:blank");
  await page.goto(link);
  await opened(page);
  assert.deepEqual(await page.evaluate(() => document.querySelector("sim-lab").numbers), numbers);
  assert.equal(await page.getByRole("slider", { name: "gravity" }).inputValue(), "-3.7");
  const same = await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    const bytes = await lab.saveState();
    await lab.step(50);
    const after = lab.numbers.join();
    await lab.openState(bytes);
    await lab.step(50);
    return lab.numbers.join() === after;
  });
  assert.ok(same);
  await page.goto("about:blank");
  await page.goto(`${link.slice(0, -9)}xxxxxxxxx`);
  await opened(page);
  await page.waitForFunction(() => /cannot be opened/.test(document.querySelector("sim-lab").shadowRoot.querySelector("[role=status].hidden:not(figure *)").textContent));
  assert.equal(await page.evaluate(() => document.querySelector("sim-lab").time), 0);
  errors.none();
});

test("the focus stays in a lab that is opened again", chromiumOnly("Playwright chooses no file in Firefox"), async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  const focused = () => page.evaluate(() => document.activeElement.shadowRoot?.activeElement?.textContent ?? document.activeElement.localName);
  const state = await page.evaluate(async () => new TextDecoder().decode(await document.querySelector("sim-lab").saveState()));
  assert.equal(await focused(), "body");
  const reopen = () => page.evaluate((text) => document.querySelector("sim-lab").openState(new TextEncoder().encode(text)), state);
  await reopen();
  assert.equal(await focused(), "body");
  await page.getByRole("slider", { name: "gravity" }).focus();
  await reopen();
  assert.equal(await focused(), "Play");
  const before = await page.locator("sim-lab article").elementHandle();
  await page.locator(".menu summary").press("Enter");
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.getByRole("button", { name: "Open a saved state" }).press("Enter")]);
  await chooser.setFiles({ name: "state.json", mimeType: "application/json", buffer: Buffer.from(state) });
  await page.waitForFunction((article) => !article.isConnected, before);
  await opened(page);
  assert.equal(await focused(), "Play");
  errors.none();
});

test("a link and a picture that cannot be made are reported", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  await page.evaluate(() => {
    history.replaceState = () => { throw new Error("no history"); };
    HTMLCanvasElement.prototype.toBlob = (take) => take(null);
  });
  for (const [name, why] of [["Copy a link to this state", "no history"], ["Save a picture", "the picture is too large"]]) {
    await page.locator(".menu summary").click();
    await page.getByRole("button", { name }).click();
    await page.locator(".failure").getByText(why).waitFor();
  }
  errors.none();
});

test("what is wrong with a lab is said in its place", async (t) => {
  const { page } = await open(t, "/broken.html");
  const textOf = async (id) => {
    await page.locator(`#${id}`).scrollIntoViewIfNeeded();
    await page.evaluate((i) => document.getElementById(i).ready.catch(() => undefined), id);
    return page.locator(`#${id}`).locator("article").innerText();
  };
  assert.match(await textOf("a"), /no joint named "fal"[^]*Did you mean "fall"\?/i);
  assert.match(await textOf("b"), /not valid JSON/);
  assert.match(await textOf("c"), /"\/nowhere.json" cannot be loaded: 404/);
  assert.match(await textOf("d"), /There is no model `none`\. Pass it/);
  assert.match(await textOf("e"), /size/);
  await page.goto(`${server.url}/empty.html`);
  await page.evaluate(() => document.querySelector("sim-lab").ready.catch(() => undefined));
  assert.match(await page.locator("sim-lab article").innerText(), /no content: give it/);
});

test("a lab from a script of the page: properties before and after it is in the page, moved and taken away", async (t) => {
  const { page, errors } = await open(t, "/late.html");
  const time = await page.evaluate(async ([json, xml]) => {
    const lab = document.createElement("sim-lab");
    lab.lab = JSON.stringify(json);
    lab.models = { drop: xml };
    document.querySelector("main").append(lab);
    await lab.step(10);
    document.querySelector("main").prepend(lab);
    await new Promise((resolve) => setTimeout(resolve, 50));
    const { time } = lab;
    lab.remove();
    await new Promise((resolve) => setTimeout(resolve, 50));
    document.querySelector("main").append(lab);
    await lab.step(1);
    return [time, lab.time];
  }, [dropLab, drop]);
  assert.ok(Math.abs(time[0] - 0.02) < 1e-12 && Math.abs(time[1] - 0.002) < 1e-12, String(time));
  errors.none();
});

test("the speed is chosen; a model slower than real time says so, and its controls answer", async (t) => {
  const { page, errors } = await open(t, "/pile.html");
  await opened(page);
  await page.getByRole("combobox", { name: "Speed" }).selectOption({ label: "\u20664×\u2069" });
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => /runs at 0\.\d+ times real time/.test(document.querySelector("sim-lab").shadowRoot.querySelector(".slow").textContent));
  const [answer, longest] = await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    let [last, most] = [performance.now(), 0];
    const timer = setInterval(() => {
      most = Math.max(most, performance.now() - last);
      last = performance.now();
    }, 1);
    const begun = performance.now();
    await lab.set("gravity", -5);
    const took = performance.now() - begun;
    await new Promise((resolve) => setTimeout(resolve, 1000));
    clearInterval(timer);
    return [took, most];
  });
  console.log(`slower than real time: a slider is answered after ${answer.toFixed(0)} ms; the page waits at most ${longest.toFixed(0)} ms`);
  assert.ok(answer < 1000);
  errors.none();
});

test("a call that is refused is refused to its caller, is said, and the lab goes on", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  const said = await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    const messages = [];
    for (const call of [() => lab.set("gravity", 5), () => lab.set("nothing", 1), () => lab.press("gravity")]) await call().catch((e) => messages.push(e.message));
    await lab.set("gravity", -5);
    await lab.step(1);
    return [messages, lab.time, lab.shadowRoot.querySelector(".failure").textContent];
  });
  assert.equal(said[0].length, 3);
  assert.match(said[0][0], /"gravity" goes from -20 to -1: 5 cannot be chosen/);
  assert.equal(said[1], 0.002);
  assert.match(said[2], /gravity/);
  errors.none();
});

test("print shows the lab without what only a screen can use", chromiumOnly("WebDriver BiDi cannot emulate print"), async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await opened(page);
  await page.emulateMedia({ media: "print" });
  assert.deepEqual(await Promise.all([".toolbar", ".view-bar", ".view", ".readouts", ".plot", ".note"].map((part) => page.locator(part).isVisible())), [false, false, true, true, true, true]);
  errors.none();
});

test("without WebGL, a lab says so and works", async (t) => {
  const blind = await launchWithoutWebGl();
  t.after(() => blind.close());
  const page = await blind.newPage();
  const errors = watchErrors(page);
  await page.goto(`${server.url}/drop.html`);
  await opened(page);
  assert.match(await page.locator(".view").innerText(), /shows no 3D view/);
  await page.evaluate(() => document.querySelector("sim-lab").step(400));
  await page.getByText("touching").waitFor();
  assert.equal(await page.locator(".view-bar").count(), 0);
  errors.none();
});

test("a model of a folder brings the files that it names", async (t) => {
  const { page, errors } = await open(t, "/folder.html");
  await opened(page);
  assert.equal(await page.evaluate(() => document.querySelector("sim-lab").numbers[0]), 2);
  errors.none();
});

test("the example page opens its labs without an error", async (t) => {
  const { page, errors } = await open(t, "/web/elements/example/index.html");
  for (const id of ["drop", "pendulum", "crate"]) {
    await page.locator(`#${id}`).scrollIntoViewIfNeeded();
    await opened(page, `#${id}`);
  }
  assert.match(readFileSync(`${repository}/web/elements/example/index.html`, "utf8"), /labspec-elements\.js/);
  errors.none();
});

test("a trace can be heard while it is played, and not after the lab is closed", async (t) => {
  const { page, errors } = await open(t, "/drop.html");
  await page.evaluate(() => {
    const { AudioContext } = globalThis;
    globalThis.contexts = [];
    globalThis.AudioContext = class extends AudioContext {
      constructor() {
        super();
        globalThis.contexts.push(this);
      }
    };
  });
  await opened(page);
  await page.locator(".plot-data summary").click();
  const button = page.getByRole("button", { name: "Sound of ball" });
  await button.click();
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  await page.evaluate(() => document.querySelector("sim-lab").step(50));
  await button.click();
  assert.equal(await button.getAttribute("aria-pressed"), "false");
  await button.click();
  await page.evaluate(() => document.querySelector("sim-lab").remove());
  await page.waitForFunction(() => globalThis.contexts.length === 2 && globalThis.contexts.every((context) => context.state === "closed"));
  errors.none();
});

test("what is done after a control was moved comes after it", async (t) => {
  const { page, errors } = await open(t, "/order.html");
  await opened(page);
  const seen = await page.evaluate(async () => {
    const lab = document.querySelector("sim-lab");
    const all = [];
    for (const value of [2, 5]) {
      for (const next of [value, value + 1, value + 2]) lab.set("a", next);
      await lab.press("Copy");
      all.push(lab.texts.join());
    }
    for (const next of [7, 8, 9]) lab.set("a", next);
    const { actions } = JSON.parse(new TextDecoder().decode(await lab.saveState())).labspec;
    all.push(actions.at(-1).join());
    const last = lab.set("a", 3);
    await Promise.all([lab.set("a", 4), lab.step(2), last]);
    return [...all, lab.texts.join()];
  });
  assert.deepEqual(seen, ["4,4", "7,7", "set,a,9", "7,4"]);
  errors.none();
});

test("a theme that is set on an open lab is that of its plots and its picture", async (t) => {
  // The pixels of its file: a browser may write one picture as two different files. Reading the canvas itself would change how it is drawn.
  const plot = (page) => page.locator(".plot canvas").evaluate(async (canvas) => {
    const picture = new Image();
    picture.src = canvas.toDataURL();
    await picture.decode();
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(picture, 0, 0);
    return copy.getImageData(0, 0, canvas.width, canvas.height).data.join();
  });
  const dark = await open(t, "/dark.html");
  const { page, errors } = await open(t, "/drop.html");
  for (const one of [dark.page, page]) {
    await opened(one);
    await one.waitForTimeout(1000);
  }
  const [light, picture] = [await plot(page), await page.locator(".view").screenshot()];
  await page.evaluate(() => document.querySelector("sim-lab").setAttribute("theme", "dark"));
  // The plot is drawn in the next frame, which a machine that is busy draws late.
  const expected = await plot(dark.page);
  for (let wait = 0; wait < 100 && (await plot(page)) !== expected; wait++) await page.waitForTimeout(100);
  assert.notEqual(await plot(page), light);
  assert.equal(await plot(page), expected);
  assert.notDeepEqual(await page.locator(".view").screenshot(), picture);
  errors.none();
});

test("a promise of an opening that was replaced is that of the next one", async (t) => {
  const { page, errors } = await open(t, "/late.html");
  const outcome = await page.evaluate(async ([lab, drop]) => {
    await customElements.whenDefined("sim-lab");
    const element = document.createElement("sim-lab");
    element.lab = lab;
    document.querySelector("main").append(element);
    const { ready } = element;
    element.models = { drop };
    return Promise.race([ready.then(() => element.texts[0]), new Promise((resolve) => setTimeout(resolve, 5000, "not settled"))]);
  }, [dropLab, drop]);
  assert.equal(outcome, "1.000");
  errors.none();
});
