// The pictures that `labspec build` draws, beside those that the elements draw: of every lab of the course, at its start.
import assert from "node:assert/strict";
import { join } from "node:path";
import test, { after } from "node:test";
import { chromiumOnly, folder, labspec, launch, open, opened, repository, serve } from "./pages.mjs";

const suite = { after };
const browser = await launch();
after(() => browser.close());
const out = join(folder(suite), "site");
const built = labspec("build", join(repository, "specs/lessons"), "--out", out);
assert.equal(built.status, 0, built.stdout + built.stderr);
const site = (await serve(suite, out)).url;

/** A channel of a pixel may differ by this, of 255: JPEG, and soft edges of shadows. */
const MOST = 40;
/** Pixels of which no neighbour in the other picture is nearer than that. */
const MOST_PIXELS = 0.001;

/**
 * Compares the canvas of a lab with its poster: the share of pixels that have no similar one within a pixel of their place, and the size of both. The
 * poster is cut at both sides as the style sheet does.
 */
async function compare(id, most) {
  const lab = document.getElementById(id);
  const canvas = lab.shadowRoot.querySelector(".view canvas");
  const poster = new Image();
  poster.src = lab.getAttribute("poster");
  await poster.decode();
  const [width, height] = [canvas.width, canvas.height];
  const pixels = (draw) => {
    const context = new OffscreenCanvas(width, height).getContext("2d");
    draw(context);
    return context.getImageData(0, 0, width, height).data;
  };
  const drawn = pixels((context) => {
    context.fillStyle = getComputedStyle(canvas.parentElement).backgroundColor;
    context.fillRect(0, 0, width, height);
    context.drawImage(canvas, 0, 0);
  });
  const scale = Math.max(width / poster.naturalWidth, height / poster.naturalHeight);
  const [w, h] = [poster.naturalWidth * scale, poster.naturalHeight * scale];
  const given = pixels((context) => context.drawImage(poster, (width - w) / 2, (height - h) / 2, w, h));
  const differs = (a, b) => [0, 1, 2].some((k) => Math.abs(drawn[4 * a + k] - given[4 * b + k]) > most);
  let wrong = 0;
  for (let y = 1; y < height - 1; y++) {
    for (let x = 1; x < width - 1; x++) {
      const place = y * width + x;
      const around = [0, -1, 1, -width, width, -width - 1, -width + 1, width - 1, width + 1];
      if (around.every((step) => differs(place, place + step)) || around.every((step) => differs(place + step, place))) wrong += 1;
    }
  }
  return { share: wrong / (width * height), size: [width, height], poster: [poster.naturalWidth, poster.naturalHeight] };
}

test("the poster of each lab is what the lab draws", async (t) => {
  const { page, none } = await open(t, browser, site);
  const names = await page.locator(".lessons h2 a").evaluateAll((links) => links.map((link) => link.href));
  let compared = 0;
  for (const name of names) {
    await page.goto(name);
    for (const id of await page.locator("sim-lab").evaluateAll((all) => all.map((lab) => lab.id))) {
      await page.locator(`#${id}`).scrollIntoViewIfNeeded();
      await opened(page, `#${id}`);
      await page.waitForFunction((s) => document.getElementById(s).shadowRoot.querySelector(".poster") === null, id);
      const { share, size, poster } = await page.evaluate(`(${compare.toString()})(${JSON.stringify(id)}, ${MOST})`);
      t.diagnostic(`${name.split("/").at(-1)} ${id}: ${(100 * share).toFixed(2)} % of ${size.join(" × ")} pixels differ`);
      assert.ok(share < MOST_PIXELS, `${name} #${id}: ${100 * share} % of the pixels differ (${size.join(" × ")}, poster ${poster.join(" × ")})`);
      compared += 1;
    }
  }
  assert.equal(compared, 19);
  none();
});

test("on paper and without scripts, a lab has pictures of its run", chromiumOnly("Playwright cannot switch off scripts in Firefox"), async (t) => {
  const context = await browser.newContext({ javaScriptEnabled: false });
  t.after(() => context.close());
  const page = await context.newPage();
  await page.goto(`${site}01-what-a-step-computes.html`);
  const pictures = page.locator(".twin .moments img");
  assert.ok(await pictures.count() >= 3);
  for (const picture of await pictures.all()) {
    assert.equal(await picture.isVisible(), true);
    assert.match(await picture.getAttribute("alt"), /: (at|after) /);
    assert.ok((await picture.boundingBox()).height > 60);
  }
  assert.match(await page.locator(".twin .events").first().textContent(), / touches .+ at \d\.\d\d s\./);
});
