/** What a lab may draw over its scene: frames, joints, centres of mass, cameras, contacts, forces. */
import { BRIGHT, LAYER, type Color, type DrawList } from "./instances.js";
import { add, addScaled, at, IDENTITY, length, normalize, rotate, rotationAt, rotationToZ, row3, scale, type Mat3, type Vec3 } from "./matrix.js";
import { PATTERN } from "./programs.js";
import { GEOM } from "./scene.js";
import type { Palette } from "./theme.js";
import type { SceneFrame, SceneModel } from "./types.js";

/** Lengths of overlays: about the size of a geom, m. */
export function overlaySize(m: SceneModel): number {
  let sum = 0, count = 0;
  for (let id = 0; id < m.geom_type.length; id++) {
    const type = at(m.geom_type, id);
    if (type === GEOM.plane || type === GEOM.hfield || at(m.geom_bodyid, id) === 0) continue;
    sum += length(row3(m.geom_size, id));
    count++;
  }
  const mean = count > 0 ? sum / count : m.extent / 10;
  return Math.min(Math.max(mean, 0.03 * m.extent), 0.12 * m.extent);
}

function solid(list: DrawList, shape: string, position: Vec3, rotation: Mat3, size: Vec3, color: Color, pattern: number = PATTERN.plain): void {
  list.push({ shape, position, rotation, scale: size, color, material: BRIGHT, layer: LAYER.overlay, pattern });
}

/** An arrow of this radius; its head shrinks with a short arrow. */
export function pushArrow(list: DrawList, from: Vec3, along: Vec3, radius: number, color: Color): void {
  const total = length(along);
  if (!(total > 1e-9) || !Number.isFinite(total)) return;
  const rotation = rotationToZ(along), z = normalize(along);
  const head = Math.min(5 * radius, 0.6 * total), thickness = Math.min(radius, 0.25 * total), shaft = total - head;
  solid(list, "cylinder", addScaled(from, z, shaft / 2), rotation, [thickness, thickness, shaft / 2], color);
  solid(list, "cone", addScaled(from, z, shaft), rotation, [2.2 * thickness, 2.2 * thickness, head], color);
}

export function pushFrames(list: DrawList, f: SceneFrame, size: number, palette: Palette): void {
  for (let body = 1; 3 * body < f.xpos.length; body++) {
    const origin = row3(f.xpos, body), m = rotationAt(f.xmat, body);
    palette.axes.forEach((color, axis) => {
      pushArrow(list, origin, scale([at(m, axis), at(m, 3 + axis), at(m, 6 + axis)], 1.3 * size), 0.035 * size, color);
    });
  }
}

/** `mjtJoint`. */
const JOINT = { free: 0, ball: 1, slide: 2, hinge: 3 } as const;

/** A hinge is a drum with an arrow along its axis, a slide a block with an arrow, a ball joint a ball, a free joint a cube. */
export function pushJoints(list: DrawList, m: SceneModel, f: SceneFrame, size: number, palette: Palette): void {
  for (let id = 0; id < m.jnt_type.length; id++) {
    const anchor = row3(f.xanchor, id), axis = row3(f.xaxis, id), along = rotationToZ(axis), s = 0.16 * size;
    const type = at(m.jnt_type, id);
    if (type === JOINT.ball) solid(list, "sphere", anchor, IDENTITY, [1.3 * s, 1.3 * s, 1.3 * s], palette.joint);
    else if (type === JOINT.free) solid(list, "box", anchor, rotationAt(f.xmat, at(m.jnt_bodyid, id)), [s, s, s], palette.joint);
    else {
      solid(list, type === JOINT.hinge ? "cylinder" : "box", anchor, along, type === JOINT.hinge ? [s, s, 1.8 * s] : [0.8 * s, 0.8 * s, 1.8 * s], palette.joint);
      pushArrow(list, anchor, scale(axis, 1.6 * size), 0.06 * size, palette.joint);
    }
  }
}

/** A checkered ball at the centre of mass of every body, a larger one at that of a tree of several bodies. */
export function pushCentres(list: DrawList, m: SceneModel, f: SceneFrame, size: number, palette: Palette): void {
  for (let body = 1; body < m.body_mass.length; body++) {
    const mass = at(m.body_mass, body), tree = at(m.body_subtreemass, body);
    const ball = (center: Vec3, radius: number): void => {
      solid(list, "sphere", center, IDENTITY, [radius, radius, radius], palette.com, PATTERN.checker);
    };
    if (mass > 0) ball(row3(f.xipos, body), 0.18 * size);
    if (at(m.body_parentid, body) === 0 && tree > mass) ball(row3(f.subtree_com, body), 0.28 * size);
  }
}

export function pushCameras(list: DrawList, m: SceneModel, f: SceneFrame, size: number, palette: Palette): void {
  for (let id = 0; id < m.cam_fovy.length; id++) {
    const position = row3(f.cam_xpos, id), rotation = rotationAt(f.cam_xmat, id), fovy = at(m.cam_fovy, id);
    const isOrthographic = at(m.cam_projection, id) === 1;
    const depth = 1.5 * size, height = isOrthographic ? fovy / 2 : depth * Math.tan((fovy * Math.PI) / 360), width = (4 / 3) * height;
    const corner = (x: number, y: number, z: number): Vec3 => add(position, rotate(rotation, [x * width, y * height, -z]));
    const line = (a: Vec3, b: Vec3): void => { list.line(a, b, palette.camera, palette.lineWidth); };
    const loop = [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const;
    loop.forEach(([x, y], i) => {
      const [u, v] = loop[(i + 1) % 4] ?? [0, 0];
      line(corner(x, y, depth), corner(u, v, depth));
      line(isOrthographic ? corner(x, y, 0) : position, corner(x, y, depth));
    });
    line(corner(-0.3, 1.15, depth), corner(0, 1.5, depth));
    line(corner(0, 1.5, depth), corner(0.3, 1.15, depth));
    solid(list, "box", position, rotation, [0.12 * size, 0.12 * size, 0.18 * size], palette.camera);
  }
}

export function pushContacts(list: DrawList, f: SceneFrame, size: number, palette: Palette): void {
  for (const { pos, normal } of f.contacts) {
    solid(list, "cylinder", pos, rotationToZ(normal), [0.16 * size, 0.16 * size, 0.02 * size], palette.contact);
  }
}

/** `forceScale` in m per N. */
export function pushForces(list: DrawList, f: SceneFrame, forceScale: number, size: number, palette: Palette): void {
  for (const { pos, force } of f.contacts) pushArrow(list, pos, scale(force, forceScale), 0.055 * size, palette.force);
}

/** A coil from the grabbed point to the pointer. */
export function pushDrag(list: DrawList, from: Vec3, to: Vec3, size: number, palette: Palette): void {
  const color = palette.drag, along: Vec3 = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  const total = length(along), rotation = rotationToZ(along), turns = 8, steps = 12 * turns;
  const radius = Math.min(0.12 * size, 0.1 * total);
  let last = from;
  for (let i = 1; i <= steps; i++) {
    const t = i / steps, angle = 2 * Math.PI * turns * t, width = radius * Math.min(1, 8 * t, 8 * (1 - t));
    const point = add(from, rotate(rotation, [width * Math.cos(angle), width * Math.sin(angle), t * total]));
    list.line(last, point, color, palette.lineWidth);
    last = point;
  }
  for (const end of [from, to]) solid(list, "sphere", end, IDENTITY, [0.1 * size, 0.1 * size, 0.1 * size], color);
}
