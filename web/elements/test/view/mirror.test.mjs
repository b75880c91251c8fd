// Mirrors beside MuJoCo's renderer: the image of what is in front of a mirror is in the same pixels, and is added with the weight
// `reflectance`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { openPage, pixels, SIZE } from "./common.mjs";

const mirrors = JSON.parse(readFileSync(new URL("golden/mirror.json", import.meta.url), "utf8"));
const [WIDTH, HEIGHT] = SIZE;
let chromium;
before(async () => { chromium = await openPage(); });
after(async () => {
  await chromium.stop();
  assert.deepEqual(chromium.errors, []);
});

/** The picture of a recording with another reflectance and opacity of the mirror. */
async function draw({ model, ...recording }, reflectance, alpha = 1) {
  const mat_rgba = model.mat_rgba.map((x, i) => (i === 3 ? alpha : x));
  const scene = { ...recording, model: { ...model, mat_rgba, mat_reflectance: [reflectance, ...model.mat_reflectance.slice(1)] } };
  const text = await chromium.page.evaluate((s) => {
    const { canvas, view } = show(s, { overlays: { shadows: false } }), found = read(canvas);
    view.dispose();
    canvas.remove();
    return found;
  }, scene);
  return Buffer.from(text, "base64");
}

/** What each channel of a pixel has more than in another picture. */
const gain = (a, b, at) => [0, 1, 2].map((channel) => a[4 * at + channel] - b[4 * at + channel]);

for (const [name, recording] of Object.entries(mirrors)) {
  test(`the image in a mirror is where MuJoCo shows it: ${name}`, async () => {
    const expected = pixels(recording.added), [plain, half, full] = [await draw(recording, 0), await draw(recording, 0.25), await draw(recording, 0.5)];
    let [shown, wrong, uneven] = [0, [], []];
    for (let y = 1; y < HEIGHT - 1; y++) {
      for (let x = 1; x < WIDTH - 1; x++) {
        const at = y * WIDTH + x, near = [-1, 0, 1].flatMap((v) => [-1, 0, 1].map((u) => expected[at + v * WIDTH + u]));
        const [red, green, blue] = gain(full, plain, at);
        if (near.every((inside) => inside === expected[at]) && red > 30 !== (expected[at] === 1)) wrong.push(`(${x}, ${y}): ${red}`);
        if (red <= 30) continue;
        shown++;
        // What is mirrored is orange. A share is rounded once in each picture.
        const [less] = gain(half, plain, at), isFull = full[4 * at] === 255;
        if (!isFull && (Math.abs(red - 2 * less) > 3 || !(red > green && green >= blue))) uneven.push(`(${x}, ${y}): ${[red, green, blue]}, ${less}`);
      }
    }
    const count = expected.reduce((sum, x) => sum + x, 0);
    assert.equal(count > 1000, name !== "below", `${count} pixels have an image`);
    assert.ok(wrong.length <= 0.002 * count, `${wrong.length} pixels: ${wrong.slice(0, 5).join("; ")}`);
    assert.ok(uneven.length <= 0.01 * shown, `${uneven.length} of ${shown} pixels: ${uneven.slice(0, 5).join("; ")}`);
  });
}

test("what is transparent is no mirror, and the first mirror is the only one", async () => {
  const { floor } = mirrors;
  assert.ok((await draw(floor, 0, 0.5)).equals(await draw(floor, 0.5, 0.5)));
  // Without reflectance, the first one is the box of the other material.
  const without = { ...floor, model: { ...floor.model, mat_reflectance: [0, 0, 0] } };
  const [none, box] = [await draw(without, 0), await draw(floor, 0)];
  let changed = 0;
  for (let at = 0; at < WIDTH * HEIGHT; at++) if (gain(box, none, at).some((x) => x > 5)) changed++;
  assert.ok(changed > 0 && changed < 2000, `${changed} pixels`);
});
