/** The content of a picture: shapes with a pose, a size, a colour and a material, and lines. Each picture fills it again. */
import type { Eye } from "./camera.js";
import { detailed } from "./detail.js";
import type { Mat3, Vec3 } from "./matrix.js";
import type { Mirror } from "./mirror.js";
import { PATTERN, TEXTURE_MODE } from "./programs.js";

/** Numbers of an instance: pose (12), scale (4), colour (4), material (4), texture and pattern (4). */
export const INSTANCE_SIZE = 28;
/** Numbers of a line: its ends (6), colour (4), width in pixels. */
export const LINE_SIZE = 11;

/** Drawn in this order: opaque, planes (blended, both sides), transparent from back to front, overlays. */
export const LAYER = { opaque: 0, plane: 1, transparent: 2, overlay: 3 } as const;
export type Layer = (typeof LAYER)[keyof typeof LAYER];

export type Color = readonly [r: number, g: number, b: number, a: number];

export interface Material {
  readonly emission: number;
  readonly specular: number;
  readonly shininess: number;
  readonly reflectance: number;
  /** Id of a texture, −1 without one. */
  readonly texture: number;
  readonly textureMode: number;
  readonly repeat: readonly [number, number];
}

/** MuJoCo's material of a geom that names none. */
export const PLAIN: Material = {
  emission: 0, specular: 0.5, shininess: 0.5, reflectance: 0, texture: -1, textureMode: TEXTURE_MODE.none, repeat: [1, 1],
};
/** Overlays: bright in every light. */
export const BRIGHT: Material = { ...PLAIN, emission: 0.35, specular: 0.2 };

export interface Instance {
  readonly shape: string;
  readonly position: Vec3;
  readonly rotation: Mat3;
  readonly scale: Vec3;
  /** Half length of a capsule. */
  readonly shift?: number;
  readonly color: Color;
  readonly material: Material;
  readonly pattern?: number;
  readonly layer: Layer;
  /** Distance in front of the camera, for the order of transparent ones. */
  readonly depth?: number;
  readonly castsShadow?: boolean;
}

/** Instances `first` to `first + count` are of one shape and one texture. */
export interface Run {
  readonly shape: string;
  readonly texture: number;
  readonly layer: Layer;
  readonly first: number;
  count: number;
}

interface Placed {
  readonly at: number;
  readonly key: Instance;
}

/** An array of numbers that grows. */
class GrowingArray {
  data: Float32Array<ArrayBuffer>;
  constructor(size: number) { this.data = new Float32Array(size); }
  reserve(size: number): void {
    if (size <= this.data.length) return;
    const grown = new Float32Array(2 * size);
    grown.set(this.data);
    this.data = grown;
  }
}

const isSameRun = (a: Instance, b: Instance): boolean => a.shape === b.shape && a.layer === b.layer && a.material.texture === b.material.texture
  && (a.castsShadow ?? false) === (b.castsShadow ?? false);

function order(a: Placed, b: Placed): number {
  const [x, y] = [a.key, b.key];
  if (x.layer !== y.layer) return x.layer - y.layer;
  if (x.layer === LAYER.transparent) return (y.depth ?? 0) - (x.depth ?? 0) || a.at - b.at;
  if (x.shape !== y.shape) return x.shape < y.shape ? -1 : 1;
  return x.material.texture - y.material.texture || Number(x.castsShadow ?? false) - Number(y.castsShadow ?? false) || a.at - b.at;
}

export class DrawList {
  readonly #written = new GrowingArray(64 * INSTANCE_SIZE);
  readonly #sorted = new GrowingArray(64 * INSTANCE_SIZE);
  readonly #lines = new GrowingArray(64 * LINE_SIZE);
  #items: Placed[] = [];
  #seen: { readonly eye: Eye; readonly height: number } | null = null;
  /** Runs of the last `finish`, and those that cast shadows. */
  runs: Run[] = [];
  shadowRuns: Run[] = [];
  lineCount = 0;
  /** The mirror of the scene, if it has one. */
  mirror: Mirror | null = null;

  /** Begins a picture of `height` pixels. */
  begin(eye: Eye, height: number): void {
    this.#seen = { eye, height };
    this.mirror = null;
    this.#items = [];
    this.lineCount = 0;
  }

  push(i: Instance): void {
    const at = this.#items.length * INSTANCE_SIZE;
    this.#written.reserve(at + INSTANCE_SIZE);
    const { position: p, rotation: r, scale: s, color: c, material: m } = i;
    const values = [
      r[0], r[1], r[2], p[0], r[3], r[4], r[5], p[1], r[6], r[7], r[8], p[2], s[0], s[1], s[2], i.shift ?? 0, c[0], c[1], c[2], c[3],
      m.emission, m.specular, m.shininess, m.reflectance, m.repeat[0], m.repeat[1], m.textureMode, i.pattern ?? PATTERN.plain,
    ];
    this.#written.data.set(values, at);
    const shape = this.#seen === null ? i.shape : detailed(i, this.#seen.eye, this.#seen.height);
    this.#items.push({ at, key: shape === i.shape ? i : { ...i, shape } });
  }

  line(from: Vec3, to: Vec3, color: Color, width: number): void {
    const at = this.lineCount * LINE_SIZE;
    this.#lines.reserve(at + LINE_SIZE);
    this.#lines.data.set([from[0], from[1], from[2], to[0], to[1], to[2], color[0], color[1], color[2], color[3], width], at);
    this.lineCount++;
  }

  /** Sorts the instances into runs. */
  finish(): void {
    this.#items.sort(order);
    this.#sorted.reserve(this.#items.length * INSTANCE_SIZE);
    this.runs = [];
    this.shadowRuns = [];
    let last: Instance | undefined, run: Run | undefined;
    this.#items.forEach(({ at, key }, first) => {
      this.#sorted.data.set(this.#written.data.subarray(at, at + INSTANCE_SIZE), first * INSTANCE_SIZE);
      if (run && last && isSameRun(last, key)) run.count++;
      else {
        run = { shape: key.shape, texture: key.material.texture, layer: key.layer, first, count: 1 };
        this.runs.push(run);
        if (key.castsShadow) this.shadowRuns.push(run);
      }
      last = key;
    });
  }

  get instances(): Float32Array<ArrayBuffer> { return this.#sorted.data.subarray(0, this.#items.length * INSTANCE_SIZE); }
  get lines(): Float32Array<ArrayBuffer> { return this.#lines.data.subarray(0, this.lineCount * LINE_SIZE); }
}
