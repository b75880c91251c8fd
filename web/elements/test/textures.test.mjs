// Builtin textures have the pixels of the real library.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { load } from "./load.mjs";

const { builtinTexture } = await load("texture/builtin.ts");
const { builtinTextures } = await load("texture/textures.ts");
const { countPixels } = await load("texture/files.ts");
const golden = JSON.parse(readFileSync(new URL("view/golden/builtin.json", import.meta.url), "utf8"));
const numbers = (text, otherwise) => (text === undefined ? otherwise : text.split(" ").map(Number));
const declaration = (a) => ({
  type: ["2d", "cube", "skybox"].indexOf(a.type), builtin: ["none", "gradient", "checker", "flat"].indexOf(a.builtin),
  mark: ["none", "edge", "cross", "random"].indexOf(a.mark ?? "none"), rgb1: numbers(a.rgb1, [0.8, 0.8, 0.8]), rgb2: numbers(a.rgb2, [0.5, 0.5, 0.5]),
  markrgb: numbers(a.markrgb, [0, 0, 0]), random: Number(a.random ?? 0.01), width: Number(a.width), height: Number(a.height), channels: 3, files: [],
  gridsize: [1, 1], gridlayout: "", hflip: false, vflip: false,
});

for (const [name, { attributes, texture }] of Object.entries(golden)) {
  test(`the texture ${name} is that of the library, to one level of a channel`, () => {
    const made = builtinTexture(declaration(attributes));
    assert.deepEqual([made.type, made.width, made.height, made.channels], [texture.type, texture.width, texture.height, texture.channels]);
    const differing = texture.data.filter((value, i) => Math.abs(value - made.data[i]) > 1);
    assert.equal(differing.length, 0);
    // Single precision may round the other way now and then.
    const other = texture.data.filter((value, i) => value !== made.data[i]).length;
    assert.ok(other <= 0.02 * texture.data.length, `${other} of ${texture.data.length}`);
  });
}

test("random marks are as frequent as asked, the same in every run, and other on each face", () => {
  const given = declaration({ type: "cube", builtin: "flat", mark: "random", random: "0.1", markrgb: "1 1 1", rgb1: "0 0 0", rgb2: "0 0 0", width: "100" });
  const [first, second] = [builtinTexture(given), builtinTexture(given)];
  assert.deepEqual(first.data, second.data);
  const share = first.data.filter((value) => value === 255).length / first.data.length;
  assert.ok(Math.abs(share - 0.1) < 0.01, String(share));
  assert.notDeepEqual(first.data.subarray(0, 30_000), first.data.subarray(30_000, 60_000));
});

test("hostile declarations are none, or small", () => {
  const base = declaration({ type: "2d", builtin: "checker", width: "8", height: "8" });
  for (const change of [{ width: 0 }, { height: -5 }, { width: NaN }, { builtin: 0 }]) assert.equal(builtinTexture({ ...base, ...change }), null);
  for (const change of [{ width: 2 ** 31 - 1, height: 2 ** 31 - 1 }, { type: 2, builtin: 1, width: 1e9 }, { rgb1: [], rgb2: [NaN, 1e9, -1] }]) {
    assert.ok(builtinTexture({ ...base, ...change }).data.length <= 3 * 6 * 1024 * 1024);
  }
});

test("many large textures share a budget; files are measured before they are decoded", () => {
  const large = declaration({ type: "2d", builtin: "checker", width: "1024", height: "1024" });
  const made = builtinTextures(Array.from({ length: 100 }, () => large));
  assert.equal(made.length, 100);
  assert.deepEqual([made[15].width, made[16].width, made[99].width], [1024, 1, 1]);
  const png = (width, height) => {
    const bytes = new Uint8Array(64);
    bytes.set([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
    new DataView(bytes.buffer).setUint32(16, width);
    new DataView(bytes.buffer).setUint32(20, height);
    return bytes;
  };
  assert.equal(countPixels(png(20, 10)), 200);
  for (const file of [undefined, "text", new Uint8Array(0), new Uint8Array(64), png(60_000, 60_000), png(0, 5), png(20, 10).subarray(0, 20)]) assert.equal(countPixels(file), Infinity);
});
