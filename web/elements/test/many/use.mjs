// A page with 40 labs in Chromium, used like a page: all labs play, one model is slower than real time and stays in the window, and the reader
// scrolls from lab to lab and moves a slider of each.
import { readFileSync } from "node:fs";
import { drop, labOf, launch, opened, pageOf, serve, watchErrors } from "../page/site.mjs";

export const LABS = 40;

/** A chain of capsules with a step so short that no computer reaches real time. */
const chain = (links) => `<mujoco><option timestep="2e-6"/><worldbody><light pos="0 0 3"/><geom type="plane" size="2 2 1"/>
  ${Array.from({ length: links }, (_, i) => `<body pos="${i === 0 ? "0 0 2" : "0.04 0 0"}"><joint axis="0 1 0" damping="1e-4"/><geom type="capsule" size="0.01" fromto="0 0 0 0.04 0 0" contype="0" conaffinity="0"/>`).join("")}
  ${"</body>".repeat(links)}</worldbody></mujoco>`;
const gravity = { label: "gravity", unit: "m/s²", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, digits: 1 };
const readouts = [{ label: "g", expr: "model.opt.gravity[2]" }, { label: "t (s)", expr: "data.time" }];
const slow = { title: "A slow chain", model: "chain", height: 160, autoplay: true, controls: [gravity], readouts, plots: [{ ylabel: "angle (rad)", height: 70, traces: [{ label: "first", expr: "data.qpos[0]" }] }] };
const quick = (i) => ({
  title: `Lab ${i}`, model: "drop", height: 200, autoplay: true, overlays: { contacts: i % 3 === 0, forces: i % 5 === 0 }, controls: [gravity, { type: "button", label: "Kick", run: "data.joint('fall').qvel[2] = 3" }],
  readouts, plots: [{ ylabel: "height (m)", height: 90, traces: [{ label: "ball", expr: "data.body('bob').xpos[2]" }] }],
});
const others = Array.from({ length: LABS - 1 }, (_, i) => labOf(quick(i + 1), { id: `lab-${i + 1}`, models: i === 0 ? { drop } : {} })).join("\n");
const style = "<style>#slow { position: sticky; top: 0; z-index: 1; display: block; width: 380px; }</style>";
// The model of the first lab is on the page for all of them.
const models = `<script type="model/mjcf" data-name="drop">${drop}</script>`;
const html = pageOf(`${models}${labOf(slow, { id: "slow", models: { chain: chain(60) } })}${others}`, { head: style });

/** Before any script of the page: counts WebGL contexts, and those that are lost. */
function countContexts() {
  globalThis.contexts = { made: 0, lost: 0 };
  for (const type of [OffscreenCanvas, HTMLCanvasElement]) {
    const { getContext } = type.prototype;
    type.prototype.getContext = function (kind, ...more) {
      const had = this.counted === true, context = getContext.call(this, kind, ...more);
      if (kind === "webgl2" && context !== null && !had) {
        this.counted = true;
        globalThis.contexts.made++;
        this.addEventListener("webglcontextlost", () => globalThis.contexts.lost++);
      }
      return context;
    };
  }
}

/** In the page: focuses the slider of a lab, and waits for the next key and for the readout that follows it. */
function watchSlider(id) {
  const { shadowRoot } = document.getElementById(id), input = shadowRoot.querySelector("input[type=range]"), output = shadowRoot.querySelector("output[part=readout-value]");
  input.focus({ preventScroll: true });
  globalThis.answer = new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`${id} did not answer: ${output.textContent} for ${input.value}`)), 10_000);
    let pressed = null;
    // The time stamp is that of the browser: it counts the time for which the page was busy.
    input.addEventListener("keydown", ({ timeStamp }) => { pressed = timeStamp; }, { once: true });
    const look = () => {
      if (pressed === null || Math.abs(Number(output.textContent.replace("−", "-")) - input.valueAsNumber) > 0.05) return;
      clearTimeout(timer);
      observer.disconnect();
      resolve(performance.now() - pressed);
    };
    const observer = new MutationObserver(look);
    observer.observe(output, { childList: true, characterData: true, subtree: true });
  });
}

/** Moves the slider of a lab with a key; gives the milliseconds until its readout has the new value. */
async function moveSlider(page, id, key) {
  await page.evaluate(watchSlider, id);
  await page.keyboard.press(key);
  return page.evaluate(() => globalThis.answer);
}

/** Memory of the process of the page (its workers and the module included), from the system, and of JavaScript's objects after garbage is collected, bytes. */
async function memoryOf(browserSession, pageSession) {
  await pageSession.send("HeapProfiler.collectGarbage");
  const { usedSize } = await pageSession.send("Runtime.getHeapUsage");
  const { processInfo } = await browserSession.send("SystemInfo.getProcessInfo");
  const sizes = processInfo.filter(({ type }) => type === "renderer").map(({ id }) => {
    const found = /^RssAnon:\s+(\d+) kB/m.exec(readFileSync(`/proc/${id}/status`, "utf8"));
    return Number(found?.[1] ?? 0) * 1024;
  });
  return { process: Math.max(...sizes), objects: usedSize };
}

/**
 * Uses the page for some seconds, in parts. Gives the times of answers, ms, the memory at the end of each part, bytes, the contexts, and the
 * share of real time that the slow lab reached.
 */
export async function useManyLabs(seconds, parts, report = () => undefined) {
  const server = await serve({ "/many.html": html });
  const browser = await launch();
  try {
    const page = await browser.newPage({ viewport: { width: 900, height: 800 } });
    const watched = watchErrors(page);
    await page.addInitScript(countContexts);
    await page.goto(`${server.url}/many.html`);
    await opened(page, "#slow");
    const sessions = [await browser.newBrowserCDPSession(), await page.context().newCDPSession(page)];
    const begun = performance.now(), [answers, memory] = [[], []];
    const slowAtStart = await page.evaluate(() => document.getElementById("slow").time);
    for (let n = 0, part = 1; part <= parts; n++) {
      const id = `lab-${1 + (n % (LABS - 1))}`;
      // At the edge of the window a lab is still opening when it comes into view, as for a reader who scrolls.
      await page.evaluate((which) => document.getElementById(which).scrollIntoView({ block: "end" }), id);
      await opened(page, `#${id}`);
      await page.waitForTimeout(150);
      // One way in one round, and back in the next.
      const key = Math.floor(n / (LABS - 1)) % 2 === 0 ? "PageUp" : "PageDown";
      answers.push(await moveSlider(page, id, key));
      if (n % 4 === 0) answers.push(await moveSlider(page, "slow", n % 8 === 0 ? "PageUp" : "PageDown"));
      if (performance.now() - begun < (part * seconds * 1000) / parts) continue;
      memory.push(await memoryOf(...sessions));
      report(part, answers, memory.at(-1));
      part++;
    }
    const passed = (performance.now() - begun) / 1000;
    const [slowTime, contexts, open] = await page.evaluate(() => [document.getElementById("slow").time, globalThis.contexts, [...document.querySelectorAll("sim-lab")].filter((lab) => lab.time > 0).length]);
    return { answers, memory, contexts, open, realTime: (slowTime - slowAtStart) / passed, errors: watched.errors };
  } finally {
    await browser.close();
    server.close();
  }
}

/** The value below which a share of sorted numbers lies. */
export function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}
