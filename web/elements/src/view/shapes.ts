/** Shapes of size 1, which every geom type, site and arrow is drawn from. */
import { LEVELS } from "./detail.js";

/** Numbers of a vertex: position (3), side of the capsule (−1, 0, 1), normal (3), texture coordinates (2). */
export const STRIDE = 9;

/** Triangles, counter-clockwise seen from outside. */
export interface Shape {
  readonly vertices: Float32Array;
  readonly indices: Uint16Array | Uint32Array;
}

/** A point of the outline of a solid of revolution: radius, height, the normal, and the side of the capsule. */
type OutlinePoint = readonly [r: number, z: number, nr: number, nz: number, side?: number];

/** Turns an outline, given from +z to −z, around the z axis. */
function revolve(outline: readonly OutlinePoint[], slices: number): Shape {
  const vertices: number[] = [], indices: number[] = [];
  outline.forEach(([r, z, nr, nz, side = 0], ring) => {
    for (let i = 0; i <= slices; i++) {
      // The last column has the bits of the first, so that the surface is closed.
      const angle = (2 * Math.PI * (i % slices)) / slices;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      vertices.push(r * c, r * s, z, side, nr * c, nr * s, nz, i / slices, ring / (outline.length - 1));
    }
  });
  for (let ring = 0; ring + 1 < outline.length; ring++) {
    const [upper, lower] = [outline[ring], outline[ring + 1]];
    if (!upper || !lower) continue;
    if (upper[0] === lower[0] && upper[1] === lower[1] && upper[4] === lower[4]) continue;
    for (let i = 0; i < slices; i++) {
      const a = ring * (slices + 1) + i, b = a + slices + 1;
      if (lower[0] > 0) indices.push(a, b, b + 1);
      if (upper[0] > 0) indices.push(a, b + 1, a + 1);
    }
  }
  return { vertices: Float32Array.from(vertices), indices: Uint16Array.from(indices) };
}

/** The outline of a quarter of a ball, with exact zeros at its pole and equator. */
function quarter(rings: number, isUpper: boolean, side: number): OutlinePoint[] {
  const points: OutlinePoint[] = [];
  for (let i = 0; i <= rings; i++) {
    const k = isUpper ? i : rings - i;
    const r = k === 0 ? 0 : k === rings ? 1 : Math.sin((k * Math.PI) / (2 * rings));
    const z = (k === rings ? 0 : Math.cos((k * Math.PI) / (2 * rings))) * (isUpper ? 1 : -1);
    points.push([r, z, r, z, side]);
  }
  return points;
}

const ball = (slices: number): Shape => revolve([...quarter(slices / 4, true, 0), ...quarter(slices / 4, false, 0).slice(1)], slices);
const capsule = (slices: number): Shape => revolve([...quarter(slices / 4, true, 1), ...quarter(slices / 4, false, -1)], slices);

/** Slices around cylinders and cones. */
const SLICES = 48;

function box(): Shape {
  const vertices: number[] = [], indices: number[] = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const sign of [1, -1]) {
      const first = vertices.length / STRIDE;
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const) {
        const point = [0, 0, 0], normal = [0, 0, 0];
        point[axis] = sign;
        normal[axis] = sign;
        point[(axis + 1) % 3] = u * sign;
        point[(axis + 2) % 3] = v;
        vertices.push(...point, 0, ...normal, (u + 1) / 2, (v + 1) / 2);
      }
      indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  }
  return { vertices: Float32Array.from(vertices), indices: Uint16Array.from(indices) };
}

function plane(): Shape {
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const;
  const vertices = corners.flatMap(([x, y]) => [x, y, 0, 0, 0, 0, 1, (x + 1) / 2, (y + 1) / 2]);
  return { vertices: Float32Array.from(vertices), indices: Uint16Array.of(0, 1, 2, 0, 2, 3) };
}

type Level = (typeof LEVELS)[number][1];

export type ShapeName = "plane" | "box" | `sphere${Level}` | `capsule${Level}` | "cylinder" | "cone";

/** Radius 1; a capsule's half length moves its two sides apart. A cone has its base at z = 0 and its tip at z = 1. */
export const SHAPES = {
  plane,
  box,
  ...Object.fromEntries(LEVELS.flatMap(([slices, level]) => [[`sphere${level}`, () => ball(slices)], [`capsule${level}`, () => capsule(slices)]])),
  cylinder: () => revolve([[0, 1, 0, 1], [1, 1, 0, 1], [1, 1, 1, 0], [1, -1, 1, 0], [1, -1, 0, -1], [0, -1, 0, -1]], SLICES),
  cone: () => revolve([[0, 1, Math.SQRT1_2, Math.SQRT1_2], [1, 0, Math.SQRT1_2, Math.SQRT1_2], [1, 0, 0, -1], [0, 0, 0, -1]], SLICES),
} as Record<ShapeName, () => Shape>;
