/** Textures from pictures: one for an image, one or six for a cube. The browser decodes them. */
import type { Models, TextureDeclaration } from "labspec/slim";
import type { SceneTexture } from "../view/types.js";
import { FACES, KIND } from "./builtin.js";

/** The largest side of a picture, pixels. */
const MOST_SIDE = 4096;
const SIGNATURE = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
/** Letters of the faces in a layout, in their order. */
const LETTERS = "RLUDFB";

/** Pixels with four channels. */
interface Pixels {
  readonly width: number;
  readonly height: number;
  readonly data: Uint8Array | Uint8ClampedArray;
}

/** The texture; `null` where a file is missing or is no picture. */
export async function textureOfFiles(t: TextureDeclaration, models: Models): Promise<SceneTexture | null> {
  const pictures = await Promise.all(t.files.map((path) => (path === "" ? null : decode(models[path]))));
  const channels = t.channels === 4 ? 4 : 3;
  const [only] = pictures;
  if (t.files.length === 1) {
    if (only === undefined || only === null) return null;
    const turned = flip(only, t.hflip, t.vflip);
    if (t.type === KIND.flat) return { type: t.type, width: turned.width, height: turned.height, channels, data: pack([turned], channels) };
    const faces = cutFaces(turned, t);
    return faces === null ? null : cube(t, faces, channels);
  }
  const size = pictures.find((picture) => picture !== null)?.width ?? 0;
  if (size === 0 || t.type === KIND.flat) return null;
  return cube(t, pictures.map((picture) => (picture === null ? plain(t, size) : flip(picture, t.hflip, t.vflip))), channels);
}

/** The number of pixels of a PNG file, from its header. Infinity for another file, or one that is too large. */
export function countPixels(file: string | Uint8Array | undefined): number {
  if (!(file instanceof Uint8Array) || file.length < 33 || SIGNATURE.some((byte, i) => file[i] !== byte)) return Infinity;
  const header = new DataView(file.buffer, file.byteOffset + 16, 8);
  const [width, height] = [header.getUint32(0), header.getUint32(4)];
  return width >= 1 && height >= 1 && width <= MOST_SIDE && height <= MOST_SIDE ? width * height : Infinity;
}

async function decode(file: string | Uint8Array | undefined): Promise<Pixels | null> {
  if (!(file instanceof Uint8Array) || countPixels(file) === Infinity) return null;
  try {
    const image = await createImageBitmap(new Blob([file as BlobPart], { type: "image/png" }), { premultiplyAlpha: "none", colorSpaceConversion: "none" });
    const { width, height } = image;
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context?.drawImage(image, 0, 0);
    image.close();
    return context?.getImageData(0, 0, width, height) ?? null;
  } catch {
    // A file that is no picture leaves the material plain.
    return null;
  }
}

/** A part of a picture, perhaps mirrored. */
function copy(from: Pixels, left: number, top: number, width: number, height: number, mirrorX = false, mirrorY = false): Pixels {
  const data = new Uint8Array(4 * width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const source = 4 * ((top + (mirrorY ? height - 1 - y : y)) * from.width + left + (mirrorX ? width - 1 - x : x));
      data.set(from.data.subarray(source, source + 4), 4 * (y * width + x));
    }
  }
  return { width, height, data };
}

const flip = (from: Pixels, hflip: boolean, vflip: boolean): Pixels => (hflip || vflip ? copy(from, 0, 0, from.width, from.height, hflip, vflip) : from);

/** A face of the first colour. */
function plain(t: TextureDeclaration, size: number): Pixels {
  const color = [...t.rgb1.slice(0, 3).map((x) => Math.floor(255 * Math.min(1, Math.max(0, x)))), 255];
  return { width: size, height: size, data: Uint8Array.from({ length: 4 * size * size }, (_, i) => color[i % 4] ?? 0) };
}

/** The faces in one picture: a grid, or one picture for all faces. */
function cutFaces(from: Pixels, t: TextureDeclaration): Pixels[] | null {
  const [rows = 1, columns = 1] = t.gridsize;
  if (rows === 1 && columns === 1) return from.width === from.height ? Array.from({ length: FACES }, () => from) : null;
  const [width, height] = [Math.floor(from.width / columns), Math.floor(from.height / rows)];
  if (!(rows > 0 && columns > 0 && rows * columns <= 12) || width !== height || width < 1) return null;
  const faces = Array.from({ length: FACES }, () => plain(t, width));
  [...t.gridlayout].forEach((letter, cell) => {
    const face = LETTERS.indexOf(letter);
    if (face >= 0 && cell < rows * columns) faces[face] = copy(from, (cell % columns) * width, Math.floor(cell / columns) * height, width, height);
  });
  return faces;
}

function cube(t: TextureDeclaration, faces: readonly Pixels[], channels: number): SceneTexture | null {
  const width = faces[0]?.width ?? 0;
  if (width === 0 || faces.some((face) => face.width !== width || face.height !== width)) return null;
  return { type: t.type, width, height: FACES * width, channels, data: pack(faces, channels) };
}

/** The pixels of pictures, one after the other. */
function pack(pictures: readonly Pixels[], channels: number): Uint8Array {
  const count = pictures.reduce((sum, { width, height }) => sum + width * height, 0);
  const data = new Uint8Array(channels * count);
  let at = 0;
  for (const picture of pictures) {
    for (let i = 0; i < picture.width * picture.height; i++, at++) {
      for (let channel = 0; channel < channels; channel++) data[channels * at + channel] = picture.data[4 * i + channel] ?? 0;
    }
  }
  return data;
}
