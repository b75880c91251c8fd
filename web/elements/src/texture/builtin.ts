/** The pixels of MuJoCo's builtin textures (XML reference, `asset/texture`). */
import type { TextureDeclaration } from "labspec/slim";
import type { SceneTexture } from "../view/types.js";

/** `mjtTexture`, `mjtBuiltin` and `mjtMark`. */
export const KIND = { flat: 0, cube: 1, sky: 2 } as const;
export const BUILTIN = { none: 0, gradient: 1, checker: 2, flat: 3 } as const;
const MARK = { none: 0, edge: 1, cross: 2, random: 3 } as const;
/** The largest side of a texture, pixels. A smooth one needs fewer. */
const MOST_SIDE = 1024;
const MOST_SMOOTH = 256;
/** Faces of a cube: right, left, up, down, front, back. */
export const FACES = 6;
const UP = 2, DOWN = 3, FRONT = 4;

type Color = readonly [number, number, number];

const toByte = (x: number): number => Math.floor(255 * Math.min(1, Math.max(0, x)));
const colorOf = (rgb: readonly number[]): Color => [toByte(rgb[0] ?? 0), toByte(rgb[1] ?? 0), toByte(rgb[2] ?? 0)];

/** An S-shaped curve from 0 to 1, for the gradients. */
function sigmoid(t: number): number {
  const u = 2 * t - 1;
  return 0.5 + (Math.SQRT1_2 * u) / Math.sqrt(1 + u * u);
}

/** The width and the height of one image. Sides that are too large for a page become smaller. */
function sizeOf(t: TextureDeclaration): readonly [number, number] {
  const most = t.builtin === BUILTIN.gradient && t.mark === MARK.none ? MOST_SMOOTH : MOST_SIDE;
  const side = (x: number): number => Math.min(most, Math.max(1, Math.floor(x)));
  return t.type === KIND.flat ? [side(t.width), side(t.height)] : [side(t.width), side(t.width)];
}

/** A texture that needs no file; `null` for one that does, or that has no size. */
export function builtinTexture(t: TextureDeclaration): SceneTexture | null {
  const isSized = t.width > 0 && (t.type !== KIND.flat || t.height > 0);
  if (t.builtin === BUILTIN.none || !isSized) return null;
  const [width, height] = sizeOf(t);
  const faces = t.type === KIND.flat ? 1 : FACES;
  const data = new Uint8Array(3 * width * height * faces);
  for (let face = 0; face < faces; face++) {
    const pixels = data.subarray(3 * width * height * face, 3 * width * height * (face + 1));
    // The sides of a gradient are alike.
    const isAlike = t.builtin === BUILTIN.gradient && faces > 1 && face > 0 && face !== UP && face !== DOWN;
    if (isAlike) pixels.set(data.subarray(0, pixels.length));
    else paint(pixels, t, width, height, face);
  }
  for (let face = 0; face < faces; face++) mark(data.subarray(3 * width * height * face, 3 * width * height * (face + 1)), t, width, height, face);
  return { type: t.type, width, height: height * faces, channels: 3, data };
}

function put(pixels: Uint8Array, at: number, color: Color): void {
  pixels[3 * at] = color[0];
  pixels[3 * at + 1] = color[1];
  pixels[3 * at + 2] = color[2];
}

function paint(pixels: Uint8Array, t: TextureDeclaration, width: number, height: number, face: number): void {
  const [first, second] = [colorOf(t.rgb1), colorOf(t.rgb2)];
  if (t.builtin === BUILTIN.gradient) return paintGradient(pixels, t, width, height, face);
  for (let y = 0, at = 0; y < height; y++) {
    for (let x = 0; x < width; x++, at++) {
      if (t.builtin === BUILTIN.flat) put(pixels, at, face === DOWN ? second : first);
      else {
        const isFirst = (x < width >> 1) === (y < height >> 1);
        // On the front and the back, the colours are exchanged.
        put(pixels, at, isFirst === face < FRONT ? first : second);
      }
    }
  }
}

/** The first colour in the middle of an image or at the top of a cube, the second one at the border or at the bottom. */
function paintGradient(pixels: Uint8Array, t: TextureDeclaration, width: number, height: number, face: number): void {
  const [a, b] = [t.rgb1, t.rgb2];
  const coordinate = (i: number, n: number): number => (n > 1 ? (2 * i) / (n - 1) - 1 : 0);
  for (let row = 0, at = 0; row < height; row++) {
    const y = coordinate(row, height);
    for (let column = 0; column < width; column++, at++) {
      const x = coordinate(column, width);
      const share = sigmoid(t.type === KIND.flat ? Math.max(0, 1 - Math.hypot(x, y)) : elevation(x, y, face));
      put(pixels, at, [0, 1, 2].map((i) => toByte((a[i] ?? 0) * share + (b[i] ?? 0) * (1 - share))) as unknown as Color);
    }
  }
}

/** How high a direction points, from 0 (down) to 1 (up). */
function elevation(x: number, y: number, face: number): number {
  const rise = face === UP ? Math.atan2(1, Math.hypot(x, y)) : face === DOWN ? -Math.atan2(1, Math.hypot(x, y)) : Math.atan2(-y, Math.hypot(x, 1));
  return 0.5 + rise / Math.PI;
}

/** Marks of one pixel's width: the border, a cross in the middle, or random dots. */
function mark(pixels: Uint8Array, t: TextureDeclaration, width: number, height: number, face: number): void {
  if (t.mark === MARK.none) return;
  const color = colorOf(t.markrgb);
  const random = randomNumbers(face);
  for (let y = 0, at = 0; y < height; y++) {
    for (let x = 0; x < width; x++, at++) {
      const isEdge = x === 0 || y === 0 || x === width - 1 || y === height - 1;
      const isCross = x === width >> 1 || y === height >> 1;
      if (t.mark === MARK.edge ? isEdge : t.mark === MARK.cross ? isCross : random() < t.random) put(pixels, at, color);
    }
  }
}

/** Random numbers from 0 to 1, the same in every run (Mulberry32). */
function randomNumbers(seed: number): () => number {
  let state = (seed + 1) * 0x9e3779b9;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}
