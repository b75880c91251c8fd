// Pictures in Chromium: the same silhouettes as MuJoCo's renderer, lights, overlays, themes, sizes.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { modules, NAMES, openPage, pixels, poseOf, recorded, scene, SIZE, TEXTURED } from "./common.mjs";

const { placeEye, rayGeom, rayThrough } = await modules("ray", "camera");

const [WIDTH, HEIGHT] = SIZE;
let chromium;
before(async () => { chromium = await openPage(); });
after(async () => {
  await chromium.stop();
  assert.deepEqual(chromium.errors, []);
});

/** The pixels of a scene's picture: RGBA, row by row from the top. */
const picture = (name, options = {}) => pictureOf(recorded(name), options);

async function pictureOf(recording, options = {}) {
  const text = await chromium.page.evaluate(([s, o]) => {
    const { canvas, view } = show(s, o), pixels = read(canvas);
    view.dispose();
    canvas.remove();
    return pixels;
  }, [recording, options]);
  return Buffer.from(text, "base64");
}

/** Number of pixels of which a test of red, green, blue and alpha holds. */
function count(rgba, holds) {
  let n = 0;
  for (let i = 0; i < rgba.length; i += 4) if (holds(rgba[i], rgba[i + 1], rgba[i + 2], rgba[i + 3])) n++;
  return n;
}

// Saturated colours that differ in whole channels: light changes how bright they are, not which channels they have.
const COLORS = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, 1], [0, 1, 1]];
const colorOf = id => COLORS[id % COLORS.length];

/** The model without tendons, and with a colour for each geom, which shines without light. */
function painted(model) {
  const count = model.geom_type.length;
  return {
    geom_rgba: Array.from({ length: count }, (_, id) => [...colorOf(id), 1]).flat(), geom_matid: Array(count).fill(0),
    tendon_width: Array.from(model.tendon_width, () => 0),
    mat_rgba: [1, 1, 1, 1], mat_emission: [1], mat_specular: [0], mat_shininess: [0], mat_reflectance: [0], mat_texid: Array(10).fill(-1),
    mat_texuniform: [0], mat_texrepeat: [1, 1], light_type: [], textures: [],
  };
}

function neighbours(ids, x, y, distance) {
  const near = [];
  for (let v = y - distance; v <= y + distance; v++) for (let u = x - distance; u <= x + distance; u++) near.push(ids[v * WIDTH + u]);
  return near;
}

/** Whether two surfaces are in one place at a pixel: either may be seen. */
function isCoplanar({ model, frame, camera }, x, y) {
  const eye = placeEye(poseOf(camera), model, frame), ray = rayThrough(eye, WIDTH / HEIGHT, (2 * x + 1) / WIDTH - 1, 1 - (2 * y + 1) / HEIGHT);
  const [first, second] = Array.from(model.geom_type, (_, id) => rayGeom(model, frame, id, ray)).sort((a, b) => a - b);
  return second - first < 1e-4 * model.extent;
}

for (const name of NAMES) {
  test(`silhouettes of every geom are MuJoCo's to a pixel: ${name}`, async () => {
    const recording = scene(name), { model, seen } = recording, ids = pixels(seen), rgba = await picture(name, { edit: painted(model) });
    const isPlane = id => id >= 0 && model.geom_type[id] === 0;
    const wrong = [];
    let drawn = 0;
    for (let y = 1; y < HEIGHT - 1; y++) {
      for (let x = 1; x < WIDTH - 1; x++) {
        const at = y * WIDTH + x, near = neighbours(ids, x, y, 1);
        // A plane is drawn with lines, fades far away, and may be all that is behind the scene; a tendon is as thin as a pixel.
        if (near.some(id => isPlane(id) || id >= model.geom_type.length)) continue;
        if (near.includes(-1) && model.geom_size[0] === 0) continue;
        const [r, g, b, a] = rgba.subarray(4 * at, 4 * at + 4), found = a < 128 ? null : [r, g, b].map(c => (c > 150 ? 1 : 0));
        // Antialiasing mixes colours at an edge, and there only.
        const isMixed = [r, g, b, a].some(c => c > 20 && c < 235);
        const fits = id => (id < 0 ? found === null : found?.join() === colorOf(id).join());
        if (ids[at] >= 0) drawn++;
        const isWrong = isMixed ? new Set(neighbours(ids, x, y, 2)).size === 1 : !near.some(fits);
        if (isWrong && ![x - 1, x, x + 1].some(u => isCoplanar(recording, u, y))) wrong.push(`(${x}, ${y}): ${[r, g, b, a]}, MuJoCo ${ids[at]}`);
      }
    }
    // Where two balls meet, MuJoCo's are coarser.
    assert.ok(wrong.length <= 2, `${wrong.length} pixels: ${wrong.slice(0, 4).join("; ")}`);
    assert.ok(drawn > 100 || name === "cameras", `${drawn} pixels`);
  });
}

test("tendons are where MuJoCo draws them", async () => {
  const { model, seen } = scene("wrap_cylinder"), ids = pixels(seen), first = model.geom_type.length;
  const rgba = await picture("wrap_cylinder", { edit: { geom_rgba: Array.from(model.geom_rgba, () => 0) } });
  const opacity = Array.from({ length: WIDTH * HEIGHT }, (_, i) => rgba[4 * i + 3]);
  let found = 0, all = 0;
  for (let y = 1; y < HEIGHT - 1; y++) {
    for (let x = 1; x < WIDTH - 1; x++) {
      if (ids[y * WIDTH + x] < first) continue;
      all++;
      if (neighbours(opacity, x, y, 1).some(a => a > 60)) found++;
    }
  }
  assert.ok(all > 150 && found > 0.97 * all, `${found} of ${all} pixels`);
});

test("the background is transparent, or that of the theme", async () => {
  const size = WIDTH * HEIGHT;
  assert.ok(count(await picture("pendulum"), (r, g, b, a) => a === 0) > size / 2);
  const dark = await picture("pendulum", { theme: { background: "rgb(10, 20, 30)", highContrast: false } });
  assert.ok(count(dark, (r, g, b, a) => r === 10 && g === 20 && b === 30 && a === 255) > size / 2);
  assert.equal(count(dark, (r, g, b, a) => a < 255), 0);
});

test("overlays are drawn in their colours, and only when they are switched on", async () => {
  const orange = (r, g, b, a) => a > 200 && r > 200 && g > 70 && g < 190 && b < 60;
  const green = (r, g, b, a) => a > 200 && g > r + 60 && g > b + 15;
  const { model } = scene("cube_table"), edit = { geom_rgba: Array.from(model.geom_rgba, (_, i) => (i % 4 === 3 ? 1 : 0.4)) };
  const without = await picture("cube_table", { edit }), withBoth = await picture("cube_table", { edit, overlays: { contacts: true, forces: true }, forceScale: 0.04 });
  assert.equal(count(without, orange) + count(without, green), 0);
  assert.ok(count(withBoth, orange) > 20 && count(withBoth, green) > 3, `${count(withBoth, orange)} orange, ${count(withBoth, green)} green pixels`);
});

test("every overlay changes the picture", async () => {
  const names = { frames: "arm2", joints: "arm2", com: "arm2", sites: "arm2", cameras: "gantry_gripper", contacts: "cube_table", forces: "cube_table", shadows: "arm2" };
  for (const [overlay, name] of Object.entries(names)) {
    const [off, on] = [await picture(name, { overlays: { [overlay]: false } }), await picture(name, { overlays: { [overlay]: true } })];
    let changed = 0;
    for (let i = 0; i < on.length; i += 4) if (Math.abs(on[i] - off[i]) + Math.abs(on[i + 1] - off[i + 1]) + Math.abs(on[i + 2] - off[i + 2]) > 24) changed++;
    assert.ok(changed > 15, `${overlay}: ${changed} pixels`);
  }
});

test("a shadow is darker than the floor and keeps its colour", async () => {
  const options = { edit: { geom_matid: [-1, -1, -1, -1, -1, -1] } };
  const [off, on] = [await picture("endless", { ...options, overlays: { shadows: false } }), await picture("endless", { ...options, overlays: { shadows: true } })];
  let darker = 0, lighter = 0;
  for (let i = 0; i < on.length; i += 4) {
    if (on[i] < off[i] - 20) darker++;
    if (on[i] > off[i] + 4) lighter++;
  }
  assert.ok(darker > 800 && lighter < 20, `${darker} darker, ${lighter} lighter`);
});

test("a spot light lights what is inside its cone", async () => {
  const light = {
    light_type: [0], light_castshadow: [0], light_active: [1], light_attenuation: [1, 0, 0], light_cutoff: [20], light_exponent: [0],
    light_ambient: [0, 0, 0], light_diffuse: [0.8, 0, 0], light_specular: [0, 0, 0],
  };
  const above = { ...recorded("endless"), camera: { azimuth: 90, elevation: -89.9, distance: 4, target: [3, 0, 0] } };
  Object.assign(above.frame = { ...above.frame }, { light_xpos: [3, 0, 2], light_xdir: [0, 0, -1] });
  const [lit, unlit] = [await pictureOf(above, { edit: light }), await pictureOf(above, { edit: { ...light, light_active: [0], light_type: [0] } })];
  const redness = (rgba, x) => { const at = 4 * (WIDTH * (HEIGHT / 2 + 3) + x); return rgba[at] - rgba[at + 2]; };
  const radius = Math.round((2 * Math.tan(Math.PI / 9) * HEIGHT) / 2 / (4 * Math.tan(Math.PI / 8)));
  const inside = WIDTH / 2 + Math.round(0.7 * radius), outside = WIDTH / 2 + Math.round(1.15 * radius);
  assert.ok(redness(lit, inside) > redness(lit, outside) + 15, `${redness(lit, inside)} inside, ${redness(lit, outside)} outside`);
  assert.ok(Math.abs(redness(unlit, inside) - redness(unlit, outside)) < 6);
});

test("a transparent geom shows what is behind it", async () => {
  // The box at the front becomes glass; the cylinder behind it is green.
  const { model } = scene("ortho"), rgba = Array.from(model.geom_rgba);
  rgba.splice(4 * 3, 4, 1, 0, 0, 0.5);
  const [solid, glass] = [await picture("ortho"), await picture("ortho", { edit: { geom_rgba: rgba } })];
  const isGreen = (r, g, b) => g > r + 30 && g > b + 30, isMixed = (r, g) => r > g + 15;
  assert.ok(count(solid, isGreen) > 1000);
  assert.equal(count(glass, isGreen), 0);
  assert.ok(count(glass, isMixed) > 1000);
});

test("the colours of a page are light or dark, in whatever way they are written", async () => {
  const dark = ["#101418", "rgb(10 20 30)", "rgba(0, 0, 0, 0.9)", "hsl(210 30% 12%)", "oklch(0.2 0.02 250)", "color(display-p3 0.1 0.1 0.1)", "black"];
  const light = ["#fff", "rgb(250 250 240)", "oklch(0.95 0.01 100)", "color(srgb 0.9 0.9 0.9)", "white"];
  const found = await chromium.page.evaluate(colors => colors.map(c => view.brightness(c)), [...dark, ...light, "transparent", "rgba(0, 0, 0, 0)"]);
  found.slice(0, dark.length).forEach((b, i) => assert.ok(b !== null && b < 0.2, `${dark[i]}: ${b}`));
  found.slice(dark.length, -2).forEach((b, i) => assert.ok(b > 0.8, `${light[i]}: ${b}`));
  assert.deepEqual(found.slice(-2), [null, null]);
});

test("high contrast and dark themes change lines, not geoms", async () => {
  const plain = await picture("endless", { theme: { background: "#ffffff", highContrast: false } });
  const contrast = await picture("endless", { theme: { background: "#ffffff", highContrast: true } });
  const darkest = rgba => Math.min(...Array.from({ length: WIDTH }, (_, x) => rgba[4 * (WIDTH * (HEIGHT - 20) + x)]));
  assert.ok(darkest(contrast) < darkest(plain) - 40, `${darkest(contrast)} against ${darkest(plain)}`);
});

for (const [name, recording] of Object.entries(TEXTURED)) {
  test(`textures lie as MuJoCo draws them: ${name}`, async () => {
    const expected = pixels(recording.colors), rgba = await pictureOf(recording, { overlays: { shadows: false } });
    let compared = 0, wrong = [];
    for (let y = 2; y < HEIGHT - 2; y++) {
      for (let x = 2; x < WIDTH - 2; x++) {
        const at = y * WIDTH + x, [r, g, b] = rgba.subarray(4 * at, 4 * at + 3), half = Math.max(0.5 * Math.max(r, g, b), 10);
        if (new Set(neighbours(expected, x, y, 2)).size > 1) continue;
        compared++;
        const bright = 4 * Number(r > half) + 2 * Number(g > half) + Number(b > half);
        if (bright !== expected[at]) wrong.push(`(${x}, ${y}): ${[r, g, b]}, MuJoCo ${expected[at]}`);
      }
    }
    assert.ok(compared > 0.4 * WIDTH * HEIGHT, `${compared} pixels are compared`);
    // The renderers blend neighbouring colours of a texture differently.
    assert.ok(wrong.length <= 0.01 * compared, `${wrong.length} of ${compared} pixels: ${wrong.slice(0, 4).join("; ")}`);
  });
}

test("a tile of a plane begins at its upper left corner", async () => {
  const rgba = await picture("looks", { camera: { azimuth: 90, elevation: -89.9, distance: 3, target: [0, 0, 0] }, overlays: { shadows: false } });
  // Three columns and two rows of tiles with a white edge: bright columns at the edges of tiles, dark between them.
  const brightness = (x, y) => rgba[4 * (WIDTH * y + x)];
  const pixelsPerMetre = HEIGHT / 2 / (3 * Math.tan(Math.PI / 8)), column = metres => Math.round(WIDTH / 2 + metres * pixelsPerMetre);
  const y = HEIGHT / 2 - Math.round(0.4 * pixelsPerMetre);
  for (const edge of [-1 / 3, 1 / 3]) assert.ok(brightness(column(edge), y) > 200, `an edge at ${edge}: ${brightness(column(edge), y)}`);
  for (const middle of [-0.55, 0.55]) assert.ok(brightness(column(middle), y) < 180, `a tile at ${middle}: ${brightness(column(middle), y)}`);
});
