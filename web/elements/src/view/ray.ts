/** Where a ray meets a geom first. Textbook intersections, in the frame of the geom. */
import type { Ray } from "./camera.js";
import { addScaled, at, cross, dot, rotationAt, row3, sub, unrotate, type Vec3 } from "./matrix.js";
import { heightGrid } from "./mesh.js";
import { GEOM, isVisible } from "./scene.js";
import type { Numbers, SceneFrame, SceneModel } from "./types.js";

/** No intersection. */
const NONE = Infinity;

/** The smallest of two distances that is in front. */
const nearer = (a: number, b: number): number => (a >= 0 && a < b ? a : b >= 0 ? b : NONE);

/** Roots of a t² + 2 b t + c, in order; none where they are not real. */
function roots(a: number, b: number, c: number): readonly [number, number] {
  const d = b * b - a * c;
  if (!(d >= 0) || a === 0) return [NONE, NONE];
  const s = Math.sqrt(d);
  return [(-b - s) / a, (-b + s) / a];
}

function rayEllipsoid({ from: p, direction: d }: Ray, [a, b, c]: Vec3): number {
  const q: Vec3 = [p[0] / a, p[1] / b, p[2] / c], e: Vec3 = [d[0] / a, d[1] / b, d[2] / c];
  return nearer(...roots(dot(e, e), dot(q, e), dot(q, q) - 1));
}

/** Where a ray enters and leaves a box; it leaves before it enters where it misses. */
function boxSpan({ from: p, direction: d }: Ray, size: Vec3): readonly [enter: number, leave: number] {
  let enter = -Infinity, leave = Infinity;
  for (const i of [0, 1, 2] as const) {
    if (d[i] === 0) {
      if (Math.abs(p[i]) > size[i]) return [NONE, -NONE];
      continue;
    }
    enter = Math.max(enter, (-Math.sign(d[i]) * size[i] - p[i]) / d[i]);
    leave = Math.min(leave, (Math.sign(d[i]) * size[i] - p[i]) / d[i]);
  }
  return [enter, leave];
}

function rayBox(ray: Ray, size: Vec3): number {
  const [enter, leave] = boxSpan(ray, size);
  return enter <= leave ? nearer(enter, leave) : NONE;
}

/** The side of a cylinder of this radius, at heights up to ±half. */
function raySide({ from: p, direction: d }: Ray, radius: number, half: number): number {
  const side = roots(d[0] * d[0] + d[1] * d[1], p[0] * d[0] + p[1] * d[1], p[0] * p[0] + p[1] * p[1] - radius * radius);
  const reached = side.map(t => (Math.abs(p[2] + t * d[2]) <= half ? t : NONE));
  return nearer(at(reached, 0), at(reached, 1));
}

function rayCylinder(ray: Ray, radius: number, half: number): number {
  const { from: p, direction: d } = ray;
  let best = raySide(ray, radius, half);
  for (const z of [half, -half]) {
    const t = (z - p[2]) / d[2], x = p[0] + t * d[0], y = p[1] + t * d[1];
    if (x * x + y * y <= radius * radius) best = nearer(t, best);
  }
  return best;
}

function rayCapsule(ray: Ray, radius: number, half: number): number {
  const { from: p, direction: d } = ray;
  let best = raySide(ray, radius, half);
  for (const sign of [1, -1]) {
    const q: Vec3 = [p[0], p[1], p[2] - sign * half];
    for (const t of roots(dot(d, d), dot(q, d), dot(q, q) - radius * radius)) {
      if (sign * (q[2] + t * d[2]) >= 0) best = nearer(t, best);
    }
  }
  return best;
}

/** Möller and Trumbore, 1997: both sides of the triangle. */
export function rayTriangle({ from, direction }: Ray, a: Vec3, b: Vec3, c: Vec3): number {
  const ab = sub(b, a), ac = sub(c, a), p = cross(direction, ac), det = dot(ab, p);
  if (det === 0) return NONE;
  const s = sub(from, a), u = dot(s, p) / det;
  if (!(u >= 0 && u <= 1)) return NONE;
  const q = cross(s, ab), v = dot(direction, q) / det;
  if (!(v >= 0 && u + v <= 1)) return NONE;
  const t = dot(ac, q) / det;
  return t >= 0 ? t : NONE;
}

/** Half sizes of the boxes around meshes, by the list of their vertices. */
const meshBoxes = new WeakMap<Numbers, Vec3[]>();

/** Half sizes of a box around mesh `id`, whose middle is the origin. */
function meshBox(m: SceneModel, id: number): Vec3 {
  const boxes = meshBoxes.get(m.mesh_vert) ?? [];
  meshBoxes.set(m.mesh_vert, boxes);
  const found = boxes[id];
  if (found) return found;
  const first = at(m.mesh_vertadr, id);
  let [x, y, z] = [0, 0, 0];
  for (let i = first; i < first + at(m.mesh_vertnum, id); i++) {
    x = Math.max(x, Math.abs(at(m.mesh_vert, 3 * i)));
    y = Math.max(y, Math.abs(at(m.mesh_vert, 3 * i + 1)));
    z = Math.max(z, Math.abs(at(m.mesh_vert, 3 * i + 2)));
  }
  return (boxes[id] = [x, y, z]);
}

function rayMesh(ray: Ray, m: SceneModel, id: number): number {
  // Thousands of triangles are looked at only where the ray meets their box.
  if (rayBox(ray, meshBox(m, id)) === NONE) return NONE;
  const first = at(m.mesh_vertadr, id), face = at(m.mesh_faceadr, id), count = at(m.mesh_facenum, id);
  const corner = (i: number): Vec3 => row3(m.mesh_vert, first + at(m.mesh_face, i));
  let best = NONE;
  for (let i = 3 * face; i < 3 * (face + count); i += 3) best = Math.min(best, rayTriangle(ray, corner(i), corner(i + 1), corner(i + 2)));
  return best;
}

/** The first and last of `count` cells of an axis of half size `size` that lie between two coordinates. */
function cellRange(a: number, b: number, size: number, count: number): [first: number, last: number] {
  const cell = (x: number): number => Math.min(Math.max(Math.floor(((x / size + 1) / 2) * count), 0), count - 1);
  const [low, high] = [Math.min(a, b), Math.max(a, b)], margin = 1e-9 * size;
  return [cell(low - margin), cell(high + margin)];
}

function rayHfield(ray: Ray, m: SceneModel, id: number): number {
  const { rows, columns, size, point } = heightGrid(m, id);
  const [x, y, top, base] = size, { from: p, direction: d } = ray;
  let best = rayBox({ from: [p[0], p[1], p[2] + base / 2], direction: d }, [x, y, base / 2]);
  const [enter, leave] = boxSpan({ from: [p[0], p[1], p[2] - (top - base) / 2], direction: d }, [x, y, (top + base) / 2 + 1e-9]);
  if (!(enter <= leave && leave >= 0)) return best;
  const meet = (a: Vec3, b: Vec3, c: Vec3): void => { best = Math.min(best, rayTriangle(ray, a, b, c)); };
  const wall = (a: Vec3, b: Vec3): void => {
    meet(a, b, [b[0], b[1], 0]);
    meet(a, [b[0], b[1], 0], [a[0], a[1], 0]);
  };
  // Only cells below the ray.
  const start = Math.max(enter, 0), [firstColumn, lastColumn] = cellRange(p[0] + start * d[0], p[0] + leave * d[0], x, columns - 1);
  const [firstRow, lastRow] = cellRange(p[1] + start * d[1], p[1] + leave * d[1], y, rows - 1);
  for (let r = firstRow; r <= lastRow; r++) {
    for (let c = firstColumn; c <= lastColumn; c++) {
      const a = point(r, c), b = point(r, c + 1), e = point(r + 1, c), f = point(r + 1, c + 1);
      meet(a, b, f);
      meet(a, f, e);
      if (r === 0) wall(a, b);
      if (r === rows - 2) wall(e, f);
      if (c === 0) wall(a, e);
      if (c === columns - 2) wall(b, f);
    }
  }
  return best;
}

/** A plane within its drawn size, from both sides. */
function rayPlane({ from: p, direction: d }: Ray, [sx, sy]: Vec3): number {
  const t = -p[2] / d[2];
  const inside = (i: 0 | 1, size: number): boolean => size <= 0 || Math.abs(p[i] + t * d[i]) <= size;
  return t >= 0 && Number.isFinite(t) && inside(0, sx) && inside(1, sy) ? t : NONE;
}

/** Distance along a ray to geom `id`; infinite where the ray misses it. */
export function rayGeom(m: SceneModel, f: SceneFrame, id: number, ray: Ray): number {
  const rotation = rotationAt(f.geom_xmat, id), size = row3(m.geom_size, id), data = m.geom_dataid[id] ?? -1;
  const local: Ray = { from: unrotate(rotation, sub(ray.from, row3(f.geom_xpos, id))), direction: unrotate(rotation, ray.direction) };
  switch (at(m.geom_type, id)) {
    case GEOM.plane: return rayPlane(local, size);
    case GEOM.hfield: return rayHfield(local, m, data);
    case GEOM.sphere: return rayEllipsoid(local, [size[0], size[0], size[0]]);
    case GEOM.capsule: return rayCapsule(local, size[0], size[1]);
    case GEOM.ellipsoid: return rayEllipsoid(local, size);
    case GEOM.cylinder: return rayCylinder(local, size[0], size[1]);
    case GEOM.mesh: case GEOM.sdf: return rayMesh(local, m, data);
    default: return rayBox(local, size);
  }
}

/** The first visible geom along a ray. */
export function castRay(m: SceneModel, f: SceneFrame, ray: Ray): { geom: number; distance: number; point: Vec3 } | null {
  let geom = -1, distance = NONE;
  for (let id = 0; id < m.geom_type.length; id++) {
    const hasMaterial = (m.geom_matid[id] ?? -1) >= 0;
    if (!isVisible(m.geom_group, id) || (at(m.geom_rgba, 4 * id + 3) === 0 && !hasMaterial)) continue;
    const t = rayGeom(m, f, id, ray);
    if (t < distance) [geom, distance] = [id, t];
  }
  return geom < 0 ? null : { geom, distance, point: addScaled(ray.from, ray.direction, distance) };
}
