/** Geoms and sites of a model, as instances of shapes. */
import { depthOf, type Eye } from "./camera.js";
import { LAYER, PLAIN, type Color, type DrawList, type Instance, type Material } from "./instances.js";
import { add, at, rotate, rotationAt, row3, sub, unrotate, type Vec3 } from "./matrix.js";
import { mirrorOf } from "./mirror.js";
import { PATTERN, TEXTURE_MODE } from "./programs.js";
import type { ShapeName } from "./shapes.js";
import type { Palette } from "./theme.js";
import type { SceneFrame, SceneModel } from "./types.js";

/** `mjtGeom`. */
export const GEOM = { plane: 0, hfield: 1, sphere: 2, capsule: 3, ellipsoid: 4, cylinder: 5, box: 6, mesh: 7, sdf: 8 } as const;
/** Columns of `mat_texid` (`mjtTextureRole`): the column of colours. */
const TEXTURE_ROLES = 10, ROLE_RGB = 1;
/** Groups that are visible: 0 to 2, as in MuJoCo. */
const LAST_GROUP = 2;

export const isVisible = (groups: ArrayLike<number>, id: number): boolean => at(groups, id) <= LAST_GROUP;

/** The name of the shape of a mesh or height field, as `geometry.ts` keeps it. */
export type GeometryNames = { readonly mesh: readonly string[]; readonly hfield: readonly string[] };

interface Form {
  readonly shape: string;
  readonly scale: Vec3;
  readonly shift?: number;
}

const form = (shape: ShapeName, scale: Vec3, shift = 0): Form => ({ shape, scale, shift });

/** The shape of a geom or a site that is neither a plane nor made of triangles. */
export function primitive(type: number, [a, b, c]: Vec3): Form {
  switch (type) {
    case GEOM.sphere: return form("sphere", [a, a, a]);
    case GEOM.capsule: return form("capsule", [a, a, a], b);
    case GEOM.ellipsoid: return form("sphere", [a, b, c]);
    case GEOM.cylinder: return form("cylinder", [a, a, b]);
    default: return form("box", [a, b, c]);
  }
}

/** The colour of an element with its own colour and perhaps a material; its own wins where it is not MuJoCo's default. */
function colorOf(m: SceneModel, rgba: ArrayLike<number>, id: number, material: number): { color: Color; isDefault: boolean } {
  const read = (a: ArrayLike<number>, i: number): Color => [at(a, 4 * i), at(a, 4 * i + 1), at(a, 4 * i + 2), at(a, 4 * i + 3)];
  const color = read(rgba, id);
  const isDefault = color[0] === 0.5 && color[1] === 0.5 && color[2] === 0.5 && color[3] === 1;
  return isDefault && material >= 0 ? { color: read(m.mat_rgba, material), isDefault: false } : { color, isDefault };
}

/** Material `id` of an element of this type and size; a plane without end has no size that a texture could cover. */
function materialOf(m: SceneModel, id: number, type: number, size: Vec3, isEndless = false): Material {
  if (id < 0) return PLAIN;
  const texture = m.mat_texid[TEXTURE_ROLES * id + ROLE_RGB] ?? -1;
  const image = texture < 0 ? undefined : m.textures?.[texture];
  const plain = {
    emission: at(m.mat_emission, id), specular: at(m.mat_specular, id), shininess: at(m.mat_shininess, id), reflectance: at(m.mat_reflectance, id),
  };
  if (!image) return { ...PLAIN, ...plain };
  const isUniform = at(m.mat_texuniform, id) !== 0;
  const hasCoordinates = type === GEOM.mesh || type === GEOM.sdf || type === GEOM.hfield;
  const flatMode = hasCoordinates ? TEXTURE_MODE.mesh : isEndless ? TEXTURE_MODE.endless : TEXTURE_MODE.box;
  const cubeMode = isUniform ? TEXTURE_MODE.cubeOfMetres : TEXTURE_MODE.cube;
  // MuJoCo multiplies by half sizes: `texrepeat` is for two metres.
  const repeat = (axis: 0 | 1): number => at(m.mat_texrepeat, 2 * id + axis) * (isUniform && !isEndless ? size[axis] : 1);
  return { ...plain, texture, textureMode: image.type === 0 ? flatMode : cubeMode, repeat: [repeat(0), repeat(1)] };
}

/** How far an infinite plane is drawn, m. */
export const planeReach = (m: SceneModel, eye: Eye): number => Math.max(12 * m.extent, 25 * Math.abs(eye.position[2]));

/** A plane; one without a size reaches to the horizon, and its middle follows the eye. */
function planeInstance(m: SceneModel, f: SceneFrame, id: number, eye: Eye, palette: Palette): Instance {
  const rotation = rotationAt(f.geom_xmat, id), size = row3(m.geom_size, id), origin = row3(f.geom_xpos, id);
  const matid = m.geom_matid[id] ?? -1;
  const { color, isDefault } = colorOf(m, m.geom_rgba, id, matid);
  const seen = unrotate(rotation, sub(eye.position, origin));
  const reach = planeReach(m, eye);
  const isInfinite = size[0] <= 0 || size[1] <= 0;
  const material = materialOf(m, matid, GEOM.plane, size, isInfinite);
  // The shader draws grid and texture in the frame of the quad, which therefore moves by whole cells.
  const snap = (x: number, axis: 0 | 1): number => {
    const step = material.texture < 0 ? 10 * gridCell(m) : 2 / Math.max(material.repeat[axis], 1e-3);
    return Math.round(x / step) * step;
  };
  const middle: Vec3 = [size[0] > 0 ? 0 : snap(seen[0], 0), size[1] > 0 ? 0 : snap(seen[1], 1), 0];
  const pattern = (material.texture < 0 ? PATTERN.grid : PATTERN.plain) | (isInfinite ? PATTERN.fading : 0);
  return {
    shape: "plane", position: add(origin, rotate(rotation, middle)), rotation, scale: [size[0] > 0 ? size[0] : reach, size[1] > 0 ? size[1] : reach, 1],
    color: isDefault ? palette.floor : color, material, pattern, layer: LAYER.plane,
  };
}

/** Distance of the lines of a floor: 1, 2 or 5 times a power of ten, m. */
export function gridCell(m: SceneModel): number {
  const about = Math.max(m.extent, 1e-6) / 12;
  const power = 10 ** Math.floor(Math.log10(about));
  const digit = about / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

function geomForm(m: SceneModel, names: GeometryNames, id: number): Form | null {
  const type = at(m.geom_type, id), data = m.geom_dataid[id] ?? -1;
  if (type === GEOM.mesh || type === GEOM.sdf || type === GEOM.hfield) {
    const shape = (type === GEOM.hfield ? names.hfield : names.mesh)[data];
    return shape === undefined ? null : { shape, scale: [1, 1, 1] };
  }
  return primitive(type, row3(m.geom_size, id));
}

/** Pushes a geom, which is the mirror of the scene if it reflects and none before it does. */
function pushMirror(list: DrawList, instance: Instance, eye: Eye): void {
  const mirror = list.mirror === null ? mirrorOf(instance, eye) : null;
  if (mirror !== null) list.mirror = mirror;
  list.push(mirror === null ? instance : { ...instance, pattern: (instance.pattern ?? PATTERN.plain) | PATTERN.mirror });
}

export function pushGeoms(list: DrawList, m: SceneModel, f: SceneFrame, names: GeometryNames, eye: Eye, palette: Palette): void {
  for (let id = 0; id < m.geom_type.length; id++) {
    if (!isVisible(m.geom_group, id)) continue;
    if (at(m.geom_type, id) === GEOM.plane) {
      pushMirror(list, planeInstance(m, f, id, eye, palette), eye);
      continue;
    }
    const shape = geomForm(m, names, id), matid = m.geom_matid[id] ?? -1;
    const given = colorOf(m, m.geom_rgba, id, matid), color = given.isDefault ? palette.geom : given.color;
    if (!shape || color[3] <= 0) continue;
    const position = row3(f.geom_xpos, id), isOpaque = color[3] >= 1;
    pushMirror(list, {
      ...shape, position, rotation: rotationAt(f.geom_xmat, id), color, material: materialOf(m, matid, at(m.geom_type, id), row3(m.geom_size, id)),
      layer: isOpaque ? LAYER.opaque : LAYER.transparent, depth: depthOf(eye, position), castsShadow: isOpaque,
    }, eye);
  }
}

export function pushSites(list: DrawList, m: SceneModel, f: SceneFrame, eye: Eye): void {
  for (let id = 0; id < m.site_type.length; id++) {
    if (!isVisible(m.site_group, id)) continue;
    const type = at(m.site_type, id), size = row3(m.site_size, id), matid = m.site_matid[id] ?? -1;
    const { color } = colorOf(m, m.site_rgba, id, matid);
    if (color[3] <= 0) continue;
    const position = row3(f.site_xpos, id);
    list.push({
      ...primitive(type, size), position, rotation: rotationAt(f.site_xmat, id), color, material: materialOf(m, matid, type, size),
      layer: color[3] >= 1 ? LAYER.overlay : LAYER.transparent, depth: depthOf(eye, position),
    });
  }
}
