// Labs and quizzes of any JSON: they open or say what is wrong, and the page has no errors. Labs that come and go leave no memory behind.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { random } from "../load.mjs";
import { chromiumOnly, drop, dropLab, launch, pageOf, serve, watchErrors } from "./site.mjs";

const server = await serve({ "/page.html": pageOf("") });
const browser = await launch({ args: ["--enable-unsafe-swiftshader", "--js-flags=--expose-gc", "--enable-precise-memory-info"] });
const page = await browser.newPage();
const errors = watchErrors(page);
await page.goto(`${server.url}/page.html`);
await page.waitForFunction(() => customElements.get("lesson-quiz") !== undefined);
after(async () => {
  await browser.close();
  server.close();
});

const next = random(21);
const pick = (list) => list[Math.floor(next() * list.length)];
const junk = () => pick([null, true, -1, 0, 1e308, 1e-320, "", "x", "<b>", "\u202e", [], [[]], {}, [null], "data.qpos[2]", "data.", ["free", 1], { y: 1 }, -0.5, "1"]);

/** A copy with some values replaced, taken away or added. */
function damaged(value) {
  if (next() < 0.06) return junk();
  if (Array.isArray(value)) return value.flatMap((x) => (next() < 0.05 ? [] : next() < 0.05 ? [damaged(x), damaged(x)] : [damaged(x)]));
  if (typeof value !== "object" || value === null) return value;
  const entries = Object.entries(value).filter(() => next() > 0.04).map(([key, x]) => [key, damaged(x)]);
  if (next() < 0.1) entries.push([pick(["height", "camera", "overlays", "toggles", "trail", "speeds", "stopAt", "plots", "window", "kind", "options", "answer"]), junk()]);
  return Object.fromEntries(entries);
}

const lab = { ...dropLab, camera: { azimuth: 10, elevation: 20, distance: 3, target: [0, 0, 1] }, overlays: { contacts: true }, trail: "none", speeds: [0.5, 1], forceScale: 0.1, stopAt: 2, dock: true };
const quiz = {
  id: "q", title: "t", questions: [
    { q: "a $x$", options: ["a", "b"], answer: 0, explain: "<p>x</p>" }, { kind: "multiple", q: "b", options: ["a", "b"], answer: [0] }, { kind: "truefalse", q: "c", answer: true },
    { kind: "numeric", q: "d", answer: 1, tol: 0.1, unit: "N" }, { kind: "open", q: "e", reference: "r" }, { kind: "predict", q: "f", options: ["a", "b"], answer: 0, sim: { model: "drop" } },
    { q: "g", options: ["a", "b"], hash: { salt: "s", sha256: "0".repeat(64) } },
  ],
};

test("damaged labs open, or say what is wrong", async () => {
  let open = 0;
  for (let run = 0; run < 50; run++) {
    const json = damaged(lab);
    const text = await page.evaluate(async ([content, xml]) => {
      const element = document.createElement("sim-lab");
      element.lab = content;
      element.models = { drop: xml };
      document.querySelector("main").replaceChildren(element);
      const isOpen = await element.ready.then(() => true, () => false);
      if (isOpen) await element.step(3);
      await new Promise((resolve) => requestAnimationFrame(resolve));
      const { textContent } = element.shadowRoot.querySelector("article");
      return isOpen ? `open ${textContent}` : textContent;
    }, [json, drop]);
    if (text.startsWith("open")) open++;
    assert.ok(text.length > 10, JSON.stringify(json));
  }
  assert.ok(open > 5 && open < 45, `${open} of 50 are open`);
  errors.none();
});

test("damaged quizzes ask what is left of them", async () => {
  for (let run = 0; run < 120; run++) {
    const json = damaged(quiz);
    const text = await page.evaluate(async (content) => {
      const element = document.createElement("lesson-quiz");
      element.quiz = content;
      element.setAttribute("store", "off");
      document.querySelector("main").replaceChildren(element);
      while (element.shadowRoot.querySelector("article") === null) await new Promise((resolve) => setTimeout(resolve, 2));
      for (const form of element.shadowRoot.querySelectorAll("form")) form.requestSubmit();
      for (const input of element.shadowRoot.querySelectorAll("input, textarea")) {
        if (input.type === "radio" || input.type === "checkbox") input.click();
        else input.value = "1";
      }
      for (const form of element.shadowRoot.querySelectorAll("form")) form.requestSubmit();
      return element.shadowRoot.textContent;
    }, json);
    assert.ok(text.length > 5, JSON.stringify(json));
  }
  errors.none();
});

test("labs that come and go leave no memory behind", chromiumOnly("a page of Firefox cannot ask for its memory"), async () => {
  const sizes = await page.evaluate(async ([json, xml]) => {
    const out = [];
    const main = document.querySelector("main");
    for (let i = 0; i < 40; i++) {
      const element = document.createElement("sim-lab");
      element.lab = json;
      element.models = { drop: xml };
      main.replaceChildren(element);
      await element.step(20);
      if (i % 10 === 9) {
        main.replaceChildren();
        await new Promise((resolve) => setTimeout(resolve, 50));
        globalThis.gc();
        out.push(performance.memory.usedJSHeapSize / 2 ** 20);
      }
    }
    return out;
  }, [dropLab, drop]);
  console.log(`memory after each 10 labs: ${sizes.map((size) => size.toFixed(1)).join(", ")} MB`);
  assert.ok(sizes[3] - sizes[1] < 3, sizes.join());
  errors.none();
});
