/** Tendons as tubes, which follow the sphere or cylinder that they wrap around. */
import { depthOf, type Eye } from "./camera.js";
import { LAYER, PLAIN, type Color, type DrawList } from "./instances.js";
import { add, at, length, mix, rotate, rotationAt, rotationToZ, row3, scale, sub, unrotate, type Vec3 } from "./matrix.js";
import { GEOM } from "./scene.js";
import type { SceneFrame, SceneModel } from "./types.js";

/** `wrap_obj` of a point that is a pulley. */
const PULLEY = -2;
const ARC_PIECES = 12;

function pushTube(list: DrawList, a: Vec3, b: Vec3, radius: number, color: Color, eye: Eye): void {
  const along = sub(b, a), total = length(along), position = mix(a, b, 0.5);
  if (!(total > 0)) return;
  list.push({
    shape: "capsule", position, rotation: rotationToZ(along), scale: [radius, radius, radius], shift: total / 2, color, material: PLAIN,
    layer: color[3] >= 1 ? LAYER.opaque : LAYER.transparent, depth: depthOf(eye, position), castsShadow: color[3] >= 1,
  });
}

/** Points of the shortest arc from `a` to `b` around geom `id`: a great circle of a sphere, a helix of a cylinder. */
export function wrapArc(m: SceneModel, f: SceneFrame, id: number, a: Vec3, b: Vec3): Vec3[] {
  const center = row3(f.geom_xpos, id), rotation = rotationAt(f.geom_xmat, id);
  const flatten = at(m.geom_type, id) === GEOM.sphere ? 1 : 0;
  const split = (p: Vec3): [radial: Vec3, height: number] => {
    const local = unrotate(rotation, sub(p, center));
    return flatten ? [local, 0] : [[local[0], local[1], 0], local[2]];
  };
  const [[p, h], [q, k]] = [split(a), split(b)];
  const [r, s] = [length(p), length(q)];
  const cosine = (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]) / (r * s);
  const angle = Math.acos(Math.min(1, Math.max(-1, cosine))), sine = Math.sin(angle);
  if (!(sine > 1e-6)) return [a, b];
  const points: Vec3[] = [];
  for (let i = 0; i <= ARC_PIECES; i++) {
    const t = i / ARC_PIECES, u = Math.sin((1 - t) * angle) / sine / r, v = Math.sin(t * angle) / sine / s;
    const radius = r + t * (s - r);
    const radial = scale(add(scale(p, u), scale(q, v)), radius);
    points.push(add(center, rotate(rotation, [radial[0], radial[1], radial[2] + h + t * (k - h)])));
  }
  return points;
}

export function pushTendons(list: DrawList, m: SceneModel, f: SceneFrame, eye: Eye): void {
  for (let id = 0; id < f.ten_wrapnum.length; id++) {
    const first = at(f.ten_wrapadr, id), count = at(f.ten_wrapnum, id), radius = at(m.tendon_width, id);
    const color: Color = [at(m.tendon_rgba, 4 * id), at(m.tendon_rgba, 4 * id + 1), at(m.tendon_rgba, 4 * id + 2), at(m.tendon_rgba, 4 * id + 3)];
    if (color[3] <= 0 || radius <= 0) continue;
    for (let i = first; i + 1 < first + count; i++) {
      const [from, to] = [f.wrap_obj[i] ?? PULLEY, f.wrap_obj[i + 1] ?? PULLEY];
      if (from === PULLEY || to === PULLEY) continue;
      const [a, b] = [row3(f.wrap_xpos, i), row3(f.wrap_xpos, i + 1)];
      const path = from >= 0 && from === to ? wrapArc(m, f, from, a, b) : [a, b];
      for (let k = 0; k + 1 < path.length; k++) pushTube(list, path[k] ?? a, path[k + 1] ?? b, radius, color, eye);
    }
  }
}
