// A floor with a builtin checker beside MuJoCo's renderer, in light without direction: each pixel has the colour that a plain floor of the
// library's colour has in the view, to a few grey levels.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { load } from "../load.mjs";
import { openPage, pixels, SIZE } from "./common.mjs";

const { builtinTexture } = await load("texture/builtin.ts");
const floors = JSON.parse(readFileSync(new URL("golden/floor.json", import.meta.url), "utf8"));
const [WIDTH, HEIGHT] = SIZE;
const COLORS = [[0.7, 0.3, 0.2], [0.2, 0.4, 0.6]];
const LEVELS = 6;
const checker = builtinTexture({
  type: 0, builtin: 2, mark: 0, rgb1: COLORS[0], rgb2: COLORS[1], markrgb: [0, 0, 0], random: 0, width: 64, height: 64, channels: 3, files: [],
  gridsize: [1, 1], gridlayout: "", hflip: false, vflip: false,
});
const plain = (rgb) => ({ ...checker, width: 1, height: 1, data: rgb.map((x) => Math.floor(255 * x)) });
let chromium;
before(async () => { chromium = await openPage(); });
after(async () => {
  await chromium.stop();
  assert.deepEqual(chromium.errors, []);
});

/** The picture of a floor with a texture. */
async function draw(recording, texture) {
  const scene = { ...recording, model: { ...recording.model, textures: [{ ...texture, data: Array.from(texture.data) }] } };
  const text = await chromium.page.evaluate((s) => {
    const { canvas, view } = show(s, { overlays: { shadows: false } }), found = read(canvas);
    view.dispose();
    canvas.remove();
    return found;
  }, scene);
  return Buffer.from(text, "base64");
}

for (const [name, recording] of Object.entries(floors)) {
  test(`a checker floor has the library's colours where the library has them: ${name}`, async () => {
    const expected = pixels(recording.colors);
    const [rgba, ...colors] = [await draw(recording, checker), await draw(recording, plain(COLORS[0])), await draw(recording, plain(COLORS[1]))];
    let [compared, wrong] = [0, []];
    for (let y = 3; y < HEIGHT - 3; y++) {
      for (let x = 3; x < WIDTH - 3; x++) {
        const at = y * WIDTH + x, which = expected[at];
        // Edges of tiles are blended, in both renderers.
        const isInside = [-3, 0, 3].every((v) => [-3, 0, 3].every((u) => expected[at + v * WIDTH + u] === which));
        if (which === 0 || !isInside) continue;
        compared++;
        const other = [0, 1, 2].map((channel) => Math.abs(rgba[4 * at + channel] - colors[which - 1][4 * at + channel]));
        if (Math.max(...other) > LEVELS) wrong.push(`(${x}, ${y}): ${other}`);
      }
    }
    assert.ok(compared > 0.15 * WIDTH * HEIGHT, `${compared} pixels are compared`);
    assert.ok(wrong.length <= 0.002 * compared, `${wrong.length} of ${compared} pixels: ${wrong.slice(0, 4).join("; ")}`);
  });
}
