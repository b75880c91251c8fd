// Linked labs, programs that play and pause, the mark of proved claims, textures in Chromium.
import assert from "node:assert/strict";
import test, { after } from "node:test";
import { png } from "./png.mjs";
import { drop, dropLab, labOf, launch, newContext, opened, pageOf, serve, watchErrors } from "./site.mjs";
import { load } from "../load.mjs";

const { contentHash } = await load("proof/verified.ts");
const gravity = (extra = {}) => ({ label: "gravity", set: "model.opt.gravity[2]", min: -20, max: -1, step: 0.1, value: -9.8, ...extra });
const plain = { model: "drop", readouts: [{ label: "g", expr: "model.opt.gravity[2]" }, { label: "v", expr: "data.qvel[2]" }] };
const kick = { type: "button", label: "Kick", run: "data.qvel[2] = 3" };
const playing = {
  model: "drop", readouts: [{ label: "t", expr: "data.time" }],
  controller: "if (data.time > 0.0999 && data.time < 0.1001) { sim.pause(); }",
  controls: [
    { type: "button", label: "Go", run: "sim.play()" }, { type: "button", label: "Halt", run: "sim.pause()" }, { type: "button", label: "Other", run: "sim.toggle()" },
    { label: "start", min: 0, max: 1, step: 1, value: 0, apply: "if (value > 0.5) { sim.play(); }" },
  ],
};
const claimed = {
  xml: "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
  verify: { runs: { fall: { until: 0.2 } }, measure: { z: "final(data.qpos[2])" }, says: [["0.80", "z"]] }, title: "The ball is at 0.80 after 0.2 s",
};
const proof = (claims, content) => `verified='${JSON.stringify({ claims, version: "0.1.0", hash: contentHash(content) })}'`;
const checker = 'checker="/web/labspec/dist/checker/checker-browser.js"';
const server = await serve({
  "/linked.html": pageOf(`${labOf({ ...plain, controls: [gravity(), kick] }, { id: "a", models: { drop }, attributes: 'link="pair"' })}
    ${labOf({ ...plain, controls: [gravity(), kick] }, { id: "b", models: { drop }, attributes: 'link="pair"' })}
    ${labOf({ ...plain, controls: [gravity({ min: -10 })] }, { id: "c", models: { drop }, attributes: 'link="pair"' })}
    ${labOf({ ...plain, controls: [gravity()] }, { id: "d", models: { drop } })}`),
  "/playing.html": pageOf(labOf(playing, { models: { drop } })),
  "/proved.html": pageOf(`${labOf(claimed, { id: "a", attributes: `${proof(2, claimed)} ${checker}` })}
    ${labOf({ ...claimed, title: "Another" }, { id: "b", attributes: proof(2, claimed) })}
    ${labOf(dropLab, { id: "c", models: { drop }, attributes: 'verified="{&quot;claims&quot;: &quot;<b>&quot;}"' })}`),
  "/pictures.html": pageOf('<sim-lab src="/pictures.json" models="/pictures"></sim-lab>'),
  "/pictures.json": JSON.stringify({ model: "room" }),
  "/pictures/room.xml": "<mujoco><compiler texturedir='t'/><asset><texture name='floor' type='2d' file='floor.png'/><texture name='sky' type='skybox' file='sky.png' gridsize='3 4' gridlayout='.U..LFRB.D..'/><texture name='gone' type='2d' file='gone.png'/><material name='floor' texture='floor' specular='0'/><material name='gone' texture='gone'/></asset><worldbody><geom type='plane' size='2 2 .1' material='floor'/><geom size='.1' pos='0 0 .2' material='gone'/></worldbody></mujoco>",
  "/pictures/t/floor.png": png(Array.from({ length: 32 }, (_, y) => Array.from({ length: 32 }, (_, x) => ((x < 16) === (y < 16) ? [255, 0, 0] : [0, 255, 0])))),
  "/pictures/t/sky.png": png(Array.from({ length: 12 }, () => Array.from({ length: 16 }, () => [0, 0, 255]))),
  "/pictures/t/gone.png": "no picture",
  "/textured.html": pageOf(labOf({ model: "textured" }, { models: {
    textured: "<mujoco><asset><texture name='sky' type='skybox' builtin='gradient' rgb1='0 0 1' rgb2='0 0 0' width='64' height='384'/><texture name='floor' type='2d' builtin='checker' rgb1='1 0 0' rgb2='0 1 0' width='64' height='64'/><material name='floor' texture='floor' texrepeat='2 2' texuniform='true' specular='0'/></asset><worldbody><geom type='plane' size='2 2 .1' material='floor'/><body pos='0 0 .3'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
  } })),
});
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
  return { page, errors };
}

const texts = (page, id) => page.evaluate((i) => document.getElementById(i).texts, id);

test("a slider moves in all labs that are linked and can take its value; a button is pressed in all", async (t) => {
  const { page, errors } = await open(t, "/linked.html");
  for (const id of ["a", "b", "c", "d"]) await opened(page, `#${id}`);
  await page.evaluate(() => {
    globalThis.changes = [];
    document.addEventListener("lab-change", (e) => globalThis.changes.push([e.target.id, e.detail.label, e.detail.value]));
  });
  const slider = page.locator("#a").getByRole("slider", { name: "gravity" });
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => globalThis.changes.length === 3);
  for (const id of ["a", "b", "c"]) assert.equal((await texts(page, id))[0], "-9.700", id);
  assert.equal((await texts(page, "d"))[0], "-9.800");
  await page.waitForFunction(() => document.querySelector("#b").shadowRoot.querySelector("input[type=range]").value === "-9.7");
  await page.evaluate(() => document.querySelector("#b").set("gravity", -15));
  await page.waitForFunction(() => document.querySelector("#a").texts[0] === "-15.000");
  assert.equal((await texts(page, "c"))[0], "-9.700");
  await page.locator("#a").getByRole("button", { name: "Kick" }).click();
  await page.waitForFunction(() => document.querySelector("#a").texts[1] === "3.000" && document.querySelector("#b").texts[1] === "3.000");
  errors.none();
});

test("a lab that is linked later takes the values of the others", async (t) => {
  const { page, errors } = await open(t, "/linked.html");
  await opened(page, "#a");
  await page.evaluate(() => document.querySelector("#a").set("gravity", -5));
  await opened(page, "#d");
  await page.evaluate(() => document.querySelector("#d").setAttribute("link", "pair"));
  await page.waitForFunction(() => document.querySelector("#d").texts[0] === "-5.000");
  await page.evaluate(async () => {
    document.querySelector("#d").removeAttribute("link");
    await document.querySelector("#a").set("gravity", -6);
  });
  assert.equal((await texts(page, "d"))[0], "-5.000");
  errors.none();
});

test("programs play and pause the page, at the very step", async (t) => {
  const { page, errors } = await open(t, "/playing.html");
  await opened(page);
  const isPlaying = () => page.evaluate(() => document.querySelector("sim-lab").playing);
  const press = (label) => page.evaluate((name) => document.querySelector("sim-lab").press(name), label);
  await press("Go");
  assert.equal(await isPlaying(), true);
  await page.waitForFunction(() => !document.querySelector("sim-lab").playing);
  assert.ok(Math.abs((await page.evaluate(() => document.querySelector("sim-lab").time)) - 0.102) < 1e-9);
  await page.evaluate(() => document.querySelector("sim-lab").set("start", 1));
  assert.equal(await isPlaying(), true);
  await press("Halt");
  assert.equal(await isPlaying(), false);
  await press("Other");
  assert.equal(await isPlaying(), true);
  await press("Other");
  assert.equal(await isPlaying(), false);
  errors.none();
});

test("proved claims have a mark, are checked again on demand, and changed content is told", async (t) => {
  const { page, errors } = await open(t, "/proved.html");
  for (const id of ["a", "b", "c"]) await opened(page, `#${id}`);
  const mark = page.locator("#a .proof");
  assert.match(await mark.locator("summary").innerText(), /Verified claims: 2/);
  await mark.locator("summary").click();
  assert.match(await mark.innerText(), /labspec 0\.1\.0/);
  await mark.getByRole("button", { name: "Run the claims again" }).click();
  await page.waitForFunction(() => /claims are true/.test(document.querySelector("#a").shadowRoot.querySelector(".proof-result").textContent), null, { timeout: 60_000 });
  assert.equal(await mark.locator(".proof-result").innerText(), "All claims are true here too: 2.");
  assert.match(await page.locator("#b .proof summary").innerText(), /Changed since it was verified/);
  assert.equal(await page.locator("#c .proof").count(), 0);
  errors.none();
});

for (const [path, name] of [["/textured.html", "builtin textures are drawn: a sky, and a floor of two colours"], ["/pictures.html", "textures of files are drawn, and one that is no picture is left out"]]) {
  test(name, async (t) => {
    const { page, errors } = await open(t, path);
    await opened(page);
    await page.waitForFunction(() => {
      const canvas = document.querySelector("sim-lab").shadowRoot.querySelector(".view canvas");
      // The browser warns when a canvas without this option is read several times.
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
      copy.drawImage(canvas, 0, 0);
      const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
      let [red, green, blue] = [0, 0, 0];
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = data.subarray(i, i + 3);
        if (r > 60 && g < r / 3 && b < r / 3) red++;
        if (g > 60 && r < g / 3 && b < g / 3) green++;
        if (b > 60 && r < b / 3 && g < b / 3) blue++;
      }
      return red > 500 && green > 500 && blue > 500;
    });
    errors.none();
  });
}
