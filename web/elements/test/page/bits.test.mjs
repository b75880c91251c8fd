// Every lab of the corpus and of the example lessons, opened in a page, gives the numbers of the package in node, bit for bit.
//
//   CORPUS=../../../shared/corpus node --test test/page/bits.test.mjs
import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { Lab } from "labspec";
import { launch, pageOf, repository, serve, watchErrors } from "./site.mjs";

const corpus = process.env.CORPUS ?? join(repository, "../shared/corpus");
assert.ok(existsSync(corpus), "CORPUS is the folder with `labs` and `models`");
const STEPS = [1, 99, 200];

/** What a reader does with a control: presses it, chooses its last option, moves it to two thirds. `null` is a press. */
function actOf({ kind, label, min, max, step, options }) {
  if (kind === "button") return [label, null];
  return [label, kind === "select" ? options.at(-1)[1] : min + Math.round((2 * (max - min)) / 3 / step) * step];
}

function modelsOf(folder) {
  const files = readdirSync(folder).filter((file) => file.endsWith(".xml"));
  return Object.fromEntries(files.map((file) => [file.slice(0, -4), readFileSync(join(folder, file), "utf8")]));
}

const [theirs, ours] = [modelsOf(join(corpus, "models")), modelsOf(join(repository, "specs/models"))];
const labs = readdirSync(join(corpus, "labs")).filter((f) => f.endsWith(".json")).sort().map((name) => [name, readFileSync(join(corpus, "labs", name), "utf8"), theirs]);
for (const name of readdirSync(join(repository, "specs/lessons")).filter((f) => f.endsWith(".md")).sort()) {
  const fences = readFileSync(join(repository, "specs/lessons", name), "utf8").matchAll(/^```lab simlab\n([^]*?)\n```$/gm);
  for (const [i, [, text]] of [...fences].entries()) labs.push([`${name}#${i + 1}`, text, ours]);
}

const server = await serve({ "/page.html": pageOf("") });
const browser = await launch();
const page = await browser.newPage();
const errors = watchErrors(page);
await page.goto(`${server.url}/page.html`);
await page.waitForFunction(() => customElements.get("sim-lab") !== undefined);
after(async () => {
  await browser.close();
  server.close();
});

let count = 0;
// A lab that plays by itself would be ahead of the steps that are counted here.
for (const [name, written, models] of labs) {
  const text = written.replace(/"autoplay":\s*true/, '"autoplay": false');
  test(name, async () => {
    const lab = new Lab(text, models);
    const expected = [[lab.time, ...lab.numbers]];
    const play = (steps) => {
      for (let i = 0; i < steps && !lab.isOver; i++) lab.step();
      expected.push([lab.time, ...lab.numbers]);
    };
    STEPS.forEach(play);
    const acts = lab.controls.map(actOf);
    for (const [label, value] of acts) {
      if (value === null) lab.press(label);
      else lab.set(label, value);
      play(20);
    }
    lab.reset();
    play(20);
    const there = await page.evaluate(async ([json, own, parts, doing]) => {
      const element = document.createElement("sim-lab");
      element.lab = json;
      element.models = own;
      document.querySelector("main").append(element);
      await element.ready;
      const out = [[element.time, ...element.numbers]];
      const play = async (steps) => {
        await element.step(steps);
        out.push([element.time, ...element.numbers]);
      };
      for (const steps of parts) await play(steps);
      for (const [label, value] of doing) {
        if (value === null) await element.press(label);
        else await element.set(label, value);
        await play(20);
      }
      await element.reset();
      await play(20);
      const text = element.texts;
      element.remove();
      return { numbers: out.map((row) => row.map((x) => (Object.is(x, -0) ? "-0" : String(x)))), text };
    }, [text, models, STEPS, acts]);
    assert.deepEqual(there.numbers, expected.map((row) => row.map((x) => (Object.is(x, -0) ? "-0" : String(x)))));
    assert.deepEqual(there.text, [...lab.readoutTexts]);
    count += expected.flat().length;
  });
}

test("there are labs, and the page has no errors", () => {
  console.log(`${labs.length} labs, ${count} numbers with the same bits in node and in the page`);
  assert.ok(labs.length >= 30 && count > 300);
  errors.none();
});
