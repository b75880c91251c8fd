/** Triangles of meshes and height fields, in m, in the frame of their geom. */
import { at, cross, normalize, sub, type Vec3 } from "./matrix.js";
import { STRIDE, type Shape } from "./shapes.js";
import type { Numbers, SceneModel } from "./types.js";

function indexArray(indices: readonly number[], vertices: number): Uint16Array | Uint32Array {
  return vertices > 0xffff ? Uint32Array.from(indices) : Uint16Array.from(indices);
}

/** Mesh `id` of a model. A vertex with several normals or texture coordinates is several vertices. */
export function meshShape(m: SceneModel, id: number): Shape {
  const vertex = at(m.mesh_vertadr, id), normal = at(m.mesh_normaladr, id), face = at(m.mesh_faceadr, id);
  const texture = m.mesh_texcoordadr[id] ?? -1;
  const count = at(m.mesh_facenum, id);
  const vertices: number[] = [], indices: number[] = [];
  const copies = new Map<string, number>();
  for (let corner = 3 * face; corner < 3 * (face + count); corner++) {
    const v = at(m.mesh_face, corner), n = at(m.mesh_facenormal, corner), t = at(m.mesh_facetexcoord, corner);
    const key = `${v} ${n} ${t}`;
    let index = copies.get(key);
    if (index === undefined) {
      index = vertices.length / STRIDE;
      copies.set(key, index);
      const [p, q, r] = [3 * (vertex + v), 3 * (normal + n), 2 * (texture + t)];
      vertices.push(at(m.mesh_vert, p), at(m.mesh_vert, p + 1), at(m.mesh_vert, p + 2), 0);
      vertices.push(at(m.mesh_normal, q), at(m.mesh_normal, q + 1), at(m.mesh_normal, q + 2));
      vertices.push(texture < 0 ? 0 : at(m.mesh_texcoord, r), texture < 0 ? 0 : at(m.mesh_texcoord, r + 1));
    }
    indices.push(index);
  }
  return { vertices: Float32Array.from(vertices), indices: indexArray(indices, vertices.length / STRIDE) };
}

/** A height field as a grid of points: its size and the height of a point. */
export interface HeightGrid {
  readonly rows: number;
  readonly columns: number;
  /** Half sizes in x and y, height of elevation 1, thickness of the base, m. */
  readonly size: readonly [number, number, number, number];
  readonly point: (row: number, column: number) => Vec3;
}

export function heightGrid(m: SceneModel, id: number): HeightGrid {
  const rows = at(m.hfield_nrow, id), columns = at(m.hfield_ncol, id), first = at(m.hfield_adr, id);
  const [x, y, z, base] = [0, 1, 2, 3].map(i => at(m.hfield_size, 4 * id + i)) as [number, number, number, number];
  const point = (row: number, column: number): Vec3 => [
    x * ((2 * column) / (columns - 1) - 1), y * ((2 * row) / (rows - 1) - 1), z * at(m.hfield_data, first + row * columns + column),
  ];
  return { rows, columns, size: [x, y, z, base], point };
}

/** Height field `id`: its surface with smooth normals, its four sides and its base. */
export function hfieldShape(m: SceneModel, id: number): Shape {
  const grid = heightGrid(m, id), { rows, columns, size, point } = grid;
  const vertices: number[] = [], indices: number[] = [];
  const clamp = (i: number, n: number): number => Math.min(Math.max(i, 0), n - 1);
  for (let r = 0; r < rows; r++) {
    for (let c = 0; c < columns; c++) {
      const across = sub(point(r, clamp(c + 1, columns)), point(r, clamp(c - 1, columns)));
      const along = sub(point(clamp(r + 1, rows), c), point(clamp(r - 1, rows), c));
      vertices.push(...point(r, c), 0, ...normalize(cross(across, along)), c / (columns - 1), r / (rows - 1));
    }
  }
  for (let r = 0; r + 1 < rows; r++) {
    for (let c = 0; c + 1 < columns; c++) {
      const a = r * columns + c, b = a + columns;
      indices.push(a, a + 1, b + 1, a, b + 1, b);
    }
  }
  const wall = (n: Vec3, points: Vec3[]): void => {
    for (let i = 0; i + 1 < points.length; i++) {
      const first = vertices.length / STRIDE;
      for (const p of [points[i], points[i + 1]]) {
        if (p) vertices.push(p[0], p[1], p[2], 0, ...n, 0, 0, p[0], p[1], -size[3], 0, ...n, 0, 0);
      }
      indices.push(first, first + 1, first + 3, first, first + 3, first + 2);
    }
  };
  const list = (n: number, f: (i: number) => Vec3): Vec3[] => Array.from({ length: n }, (_, i) => f(i));
  wall([0, -1, 0], list(columns, c => point(0, c)));
  wall([1, 0, 0], list(rows, r => point(r, columns - 1)));
  wall([0, 1, 0], list(columns, c => point(rows - 1, columns - 1 - c)));
  wall([-1, 0, 0], list(rows, r => point(rows - 1 - r, 0)));
  const first = vertices.length / STRIDE;
  for (const [x, y] of [[-1, -1], [-1, 1], [1, 1], [1, -1]] as const) vertices.push(x * size[0], y * size[1], -size[3], 0, 0, 0, -1, 0, 0);
  indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
  return { vertices: Float32Array.from(vertices), indices: indexArray(indices, vertices.length / STRIDE) };
}

/** Two 32-bit FNV-1a hashes of numbers `from` to `to` of a list, to recognize geometry that has been uploaded. */
export function hashNumbers(list: Numbers, from = 0, to = list.length): string {
  let a = 0x811c9dc5, b = 0x01234567;
  const word = new Float32Array(1), bits = new Uint32Array(word.buffer);
  for (let i = from; i < to; i++) {
    word[0] = at(list, i);
    a = Math.imul(a ^ at(bits, 0), 0x01000193);
    b = Math.imul(b ^ (at(bits, 0) >>> 7) ^ (i - from), 0x85ebca6b);
    a ^= a >>> 15;
    b ^= b >>> 13;
  }
  return `${to - from}:${(a >>> 0).toString(36)}${(b >>> 0).toString(36)}`;
}
