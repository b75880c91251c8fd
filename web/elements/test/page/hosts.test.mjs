// Where the elements run: both builds, strict policies, a widget, a page with forty labs; how much they weigh and how fast they draw.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { gzipSync } from "node:zlib";
import { drop, dropLab, isChromium, labOf, launch, newContext, opened, pageOf, root, serve, watchErrors } from "./site.mjs";

const POLICIES = {
  // As strict as a page with WebAssembly can be: workers from files only, no style of its own.
  "separate files": ["/web/elements/dist/elements.js", "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; worker-src 'self'; img-src data:"],
  "one file, workers from its own text": ["/web/elements/dist/labspec-elements.js", "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; img-src data:"],
  "one file, no workers": ["/web/elements/dist/labspec-elements.js", "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'none'; img-src data:"],
};
const page = (script) => pageOf(labOf(dropLab, { models: { drop } }), { script });
const many = Array.from({ length: 40 }, (_, i) => labOf({ ...dropLab, title: `Lab ${i}`, height: 160, autoplay: true }, { id: `lab${i}`, models: { drop } })).join("");
const served = await Promise.all(Object.values(POLICIES).map(([script, policy]) => serve({ "/page.html": page(script) }, { "content-security-policy": policy })));
const server = await serve({ "/many.html": pageOf(many), "/one.html": pageOf(labOf(dropLab, { models: { drop } })), "/widget.html": pageOf('<div id="host"></div>'), "/plot.html": pageOf("") });
const browser = await launch();
after(async () => {
  await browser.close();
  for (const each of [...served, server]) each.close();
});

async function open(t, url, options = {}) {
  const context = await newContext(browser, options);
  t.after(() => context.close());
  const page = await context.newPage();
  const errors = watchErrors(page);
  await page.goto(url);
  return { page, errors };
}

Object.keys(POLICIES).forEach((name, i) => {
  test(`a lab under a policy: ${name}`, async (t) => {
    const { page, errors } = await open(t, `${served[i].url}/page.html`);
    await opened(page);
    const numbers = await page.evaluate(async () => {
      const lab = document.querySelector("sim-lab");
      await lab.step(100);
      return lab.numbers;
    });
    // Poses are those before the last step, as after mj_step: 99 steps of 2 ms from 1 m, the sum of v h with v after each step.
    assert.ok(Math.abs(numbers[0] - (1 - 9.8 * 0.002 * 0.002 * (99 * 100) / 2)) < 1e-9, String(numbers));
    assert.equal(page.workers().length, name.endsWith("no workers") ? 0 : 1);
    const problems = errors.errors.filter((text) => !/worker/i.test(text) || !/Content Security Policy|worker-src/i.test(text));
    assert.deepEqual(problems, [], "only the refused worker is reported");
  });
});

test("the one file is a widget", async (t) => {
  const { page, errors } = await open(t, `${server.url}/widget.html`);
  const result = await page.evaluate(async ([json, xml]) => {
    const { default: widget } = await import("/web/elements/dist/labspec-elements.js");
    const traits = { lab: json, models: { drop: xml } };
    const listeners = {};
    const model = { get: (name) => traits[name], on: (event, f) => { listeners[event] = f; }, off: (event) => { delete listeners[event]; } };
    const el = document.querySelector("#host");
    const leave = widget.render({ model, el });
    const lab = el.querySelector("sim-lab");
    await lab.step(5);
    const first = lab.time;
    traits.lab = { ...json, title: "Another" };
    listeners["change:lab"]();
    await lab.ready;
    const title = lab.shadowRoot.querySelector("h3").textContent;
    leave();
    const traitsOfMyst = { xml, readouts: json.readouts, quiz: {} };
    widget.render({ model: { get: (name) => traitsOfMyst[name] }, el });
    await el.querySelector("sim-lab").ready;
    const throws = () => { throw new Error("off is not implemented"); };
    widget.render({ model: { get: (name) => traitsOfMyst[name], on: () => {}, off: throws }, el })();
    const afterMyst = el.childElementCount;
    const quiz = { questions: [{ q: "?", options: ["a", "b"], answer: 0 }] };
    // Notebooks load the module again for each class of widgets.
    const again = await import("/web/elements/dist/labspec-elements.js?again");
    again.default.render({ model: { get: (name) => ({ quiz })[name] }, el });
    if ("render" in again) throw new Error("anywidget warns of an export `render`");
    return { first, title, left: Object.keys(listeners).length, afterMyst, quiz: el.querySelectorAll("lesson-quiz").length };
  }, [dropLab, drop]);
  assert.ok(Math.abs(result.first - 0.01) < 1e-12);
  assert.deepEqual({ ...result, first: 0 }, { first: 0, title: "Another", left: 0, afterMyst: 0, quiz: 1 });
  errors.none();
});

test("a widget has meshes and pictures as anywidget passes bytes: as a DataView of a message", async (t) => {
  const { page, errors } = await open(t, `${server.url}/widget.html`);
  const wedge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const xml = "<mujoco><compiler meshdir='shapes'/><asset><mesh name='wedge' file='wedge.obj'/></asset><worldbody><body name='bob' pos='0 0 1'><freejoint name='fall'/><geom type='mesh' mesh='wedge'/></body></worldbody></mujoco>";
  const masses = await page.evaluate(async ([json, xml, wedge]) => {
    const { default: widget } = await import("/web/elements/dist/labspec-elements.js");
    const bytes = new TextEncoder().encode(wedge);
    const message = Uint8Array.from([...new TextEncoder().encode("other "), ...bytes, 0, 255]);
    const lab = { ...json, readouts: [{ label: "mass (kg)", expr: "model.body_mass[1]" }] };
    const kinds = { DataView: new DataView(message.buffer, 6, bytes.length), Uint8Array: bytes, ArrayBuffer: bytes.slice().buffer, Uint16Array: new Uint16Array(bytes.slice().buffer) };
    const found = {};
    for (const [kind, content] of Object.entries(kinds)) {
      const traits = { lab, models: { drop: xml, "shapes/wedge.obj": content } };
      const el = document.querySelector("#host");
      const leave = widget.render({ model: { get: (name) => traits[name] }, el });
      const element = el.querySelector("sim-lab");
      await element.step(5);
      found[kind] = [element.numbers.at(-1), element.models["shapes/wedge.obj"].byteLength, element.models["shapes/wedge.obj"].buffer.byteLength];
      leave();
    }
    return found;
  }, [{ ...dropLab, plots: [] }, xml, wedge]);
  const bytes = wedge.length;
  // A tetrahedron of 1/6 m³ with the density of water; a message is not kept.
  for (const [kind, [mass, length, kept]] of Object.entries(masses)) {
    assert.ok(Math.abs(mass - 1000 / 6) < 1e-6, `${kind}: ${mass}`);
    assert.deepEqual([length, kept], [bytes, bytes], kind);
  }
  assert.equal(Object.keys(masses).length, 4);
  errors.none();
});

test("forty labs on a page: those that are seen play, the others wait, none loses its picture", async (t) => {
  const { page, errors } = await open(t, `${server.url}/many.html`);
  await opened(page, "#lab0");
  await page.waitForFunction(() => document.querySelector("#lab0").time > 0.1);
  assert.equal(await page.evaluate(() => document.querySelector("#lab30").shadowRoot.querySelector("canvas")), null, "a lab far away is not opened");
  for (let i = 0; i < 40; i += 1) {
    await page.evaluate((id) => document.querySelector(id).scrollIntoView(), `#lab${i}`);
    await opened(page, `#lab${i}`);
  }
  await page.waitForFunction(() => document.querySelector("#lab39").time > 0.05);
  const before = await page.evaluate(() => [0, 39].map((i) => document.querySelector(`#lab${i}`).time));
  await page.waitForTimeout(400);
  const later = await page.evaluate(() => [0, 39].map((i) => document.querySelector(`#lab${i}`).time));
  assert.equal(later[0], before[0], "off screen, it stands");
  assert.ok(later[1] > before[1], "on screen, it plays");
  await page.evaluate(() => document.querySelector("#lab0").scrollIntoView());
  await page.waitForFunction((time) => document.querySelector("#lab0").time > time, before[0]);
  errors.none();
});

test("a frame of a plot with six traces takes less than 2 ms", async (t) => {
  const { build } = await import("esbuild");
  const { outputFiles } = await build({ entryPoints: [join(root, "src/plot/plot.ts")], bundle: true, write: false, format: "iife", globalName: "plots" });
  const { page } = await open(t, `${server.url}/plot.html`);
  await page.evaluate(outputFiles[0].text.replace(/^"use strict";\s*var plots/, "globalThis.plots"));
  const times = await page.evaluate(() => {
    const labels = ["a", "b", "c", "d", "e", "f"];
    const spec = { ylabel: "y", xlabel: null, window: 10, ymin: null, ymax: null, height: 140, refLines: [{ y: 0, label: "zero" }], traces: labels.map((label, i) => ({ label, dash: i % 2 === 1 })) };
    const plot = globalThis.plots.createPlot(spec, labels.map((_, i) => i), "t", (name) => name);
    document.body.append(plot.element);
    return new Promise((resolve) => requestAnimationFrame(() => setTimeout(() => {
      const took = [];
      for (let frame = 0; frame < 600; frame++) {
        const rows = [];
        for (let step = 0; step < 8; step++) {
          const time = (8 * frame + step) * 0.002;
          rows.push(time, ...labels.map((_, i) => Math.sin(3 * time + i) * (1 + i)));
        }
        const begun = performance.now();
        plot.add(Float64Array.from(rows), 7);
        plot.draw();
        took.push(performance.now() - begun);
      }
      resolve(took.sort((a, b) => a - b));
    }, 100)));
  });
  const [median, most] = [times[300], times[594]];
  console.log(`a frame of six traces: median ${median.toFixed(2)} ms, 99 % below ${most.toFixed(2)} ms`);
  // Chromium records what it draws; Firefox rasterizes it at once, here without a graphics card.
  assert.ok(median < (isChromium ? 2 : 50), `${median} ms`);
});

test("a lab is visible soon after its script", async (t) => {
  const { page } = await open(t, `${server.url}/one.html`);
  const times = [];
  for (let run = 0; run < 5; run++) {
    await page.reload();
    times.push(await page.evaluate(async () => {
      await document.querySelector("sim-lab").ready;
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      const script = performance.getEntriesByType("resource").find((entry) => entry.name.endsWith("labspec-elements.js"));
      return performance.now() - script.responseEnd;
    }));
  }
  console.log(`a lab is visible ${times.map((time) => time.toFixed(0)).join(", ")} ms after its script has arrived`);
  assert.ok(Math.min(...times) < 2000);
});

test("weights", () => {
  const size = (name) => gzipSync(readFileSync(join(root, "dist", name)), { level: 9 }).length;
  const [one, code, module] = ["labspec-elements.js", "elements.js", "labspec.wasm"].map(size);
  console.log(`by gzip: one file ${(one / 1024).toFixed(0)} kB, of which the module ${(module / 1024).toFixed(0)} kB; elements without it ${(code / 1024).toFixed(0)} kB`);
  assert.ok(code < 80 * 1024, `${code}`);
  assert.ok(one < module + 96 * 1024, "one file is the module and the elements, and nothing else");
});
