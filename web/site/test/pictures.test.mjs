// The pictures that `labspec build` draws, beside those that the elements draw: of every lab of the course, at its start.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after } from "node:test";
import { png } from "../../elements/test/page/png.mjs";
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
  // What has come into view is drawn in the next frame.
  for (let frame = 0; frame < 3; frame++) await new Promise(requestAnimationFrame);
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

/** Compares all labs of a page; gives their number. */
async function compareLabs(t, page, name) {
  await page.goto(name);
  const ids = await page.locator("sim-lab").evaluateAll((all) => all.map((lab) => lab.id));
  for (const id of ids) {
    await page.locator(`#${id}`).scrollIntoViewIfNeeded();
    await opened(page, `#${id}`);
    await page.waitForFunction((s) => document.getElementById(s).shadowRoot.querySelector(".poster") === null, id);
    const { share, size, poster } = await page.evaluate(`(${compare.toString()})(${JSON.stringify(id)}, ${MOST})`);
    t.diagnostic(`${name.split("/").at(-1)} ${id}: ${(100 * share).toFixed(2)} % of ${size.join(" × ")} pixels differ`);
    assert.ok(share < MOST_PIXELS, `${name} #${id}: ${100 * share} % of the pixels differ (${size.join(" × ")}, poster ${poster.join(" × ")})`);
  }
  return ids.length;
}

test("the poster of each lab is what the lab draws", async (t) => {
  const { page, none } = await open(t, browser, site);
  const names = await page.locator(".lessons h2 a").evaluateAll((links) => links.map((link) => link.href));
  let compared = 0;
  for (const name of names) compared += await compareLabs(t, page, name);
  assert.equal(compared, 19);
  none();
});

/**
 * A picture of smooth colours, so that the order of its rows and columns is seen everywhere. It is light: where black meets the page, the four
 * samples of a browser and the eight of the poster differ by more than 40 of 255.
 */
const shaded = (side) => png(Array.from({ length: side }, (_, y) => Array.from({ length: side }, (_, x) => [150 + 100 * x / side, 150 + 100 * y / side, x + y < side ? 150 : 250].map(Math.round))));

test("textures from files are on the poster as the lab draws them", async (t) => {
  const lessons = join(folder(t), "lessons");
  mkdirSync(join(lessons, "models/pictures"), { recursive: true });
  writeFileSync(join(lessons, "models/pictures/shaded.png"), shaded(64));
  // Six faces in three rows of four.
  writeFileSync(join(lessons, "models/pictures/cross.png"), png(Array.from({ length: 96 }, (_, y) => Array.from({ length: 128 }, (_, x) => [2 * x, y + 100, 60 * Math.floor(x / 32)]))));
  const flat = (attributes) => `<texture name="t" type="2d" file="shaded.png"/><material name="m" texture="t" specular="0" ${attributes}/>`;
  const cube = (attributes) => `<texture name="t" type="cube" file="cross.png" gridsize="3 4" gridlayout=".U..LFRB.D.." ${attributes}/><material name="m" texture="t" specular="0"/>`;
  const models = {
    floor: [flat('texrepeat="2 2"'), '<geom type="plane" size="0 0 1" material="m"/><geom size=".1" pos="0 0 .1"/>'],
    tiles: [flat('texrepeat="3 2" texuniform="true"'), '<geom type="plane" size="1 1 .1" material="m"/>'],
    box: [flat(""), '<geom type="box" size=".2 .3 .4" material="m"/>'],
    ball: [cube('hflip="true"'), '<geom size=".3" material="m"/><geom type="cylinder" size=".1 .3" pos="0 .6 0" material="m"/>'],
    sky: [cube("").replace('type="cube"', 'type="skybox"').replace(/<material.*/, ""), '<geom size=".1"/>'],
  };
  for (const [name, [asset, geoms]] of Object.entries(models)) {
    writeFileSync(join(lessons, `models/${name}.xml`), `<mujoco><compiler texturedir="pictures"/><asset>${asset}</asset><worldbody>${geoms}</worldbody></mujoco>`);
  }
  const labs = Object.keys(models).map((model) => `\`\`\`lab simlab\n{"model": "${model}"}\n\`\`\`\n`);
  writeFileSync(join(lessons, "a.md"), `# Textures\n\n${labs.join("\n")}`);
  const made = labspec("build", lessons, "--out", join(lessons, "../site"));
  assert.equal(made.status, 0, made.stdout + made.stderr);
  const { url } = await serve(t, join(lessons, "../site"));
  const { page, none } = await open(t, browser, url);
  assert.equal(await compareLabs(t, page, `${url}a.html`), labs.length);
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
  assert.match(await page.locator(".twin .events").first().textContent(), / touches .+ at \d\.\d{3} s\./);
});
