/** Lights: the headlight, those of the model, or one from above where the model has none; and the view of the light that casts shadows. */
import type { Eye } from "./camera.js";
import {
  addScaled, at, length, multiply, normalize, orthographic, perspective, rotationToZ, row3, scale, sub, viewMatrix, type Mat4, type Vec3,
} from "./matrix.js";
import { MAX_LIGHTS } from "./programs.js";
import { GEOM, isVisible } from "./scene.js";
import type { Palette } from "./theme.js";
import type { SceneFrame, SceneModel } from "./types.js";

/** The uniforms of the lights. */
export interface Lights {
  readonly count: number;
  readonly position: Float32Array;
  readonly direction: Float32Array;
  readonly diffuse: Float32Array;
  readonly specular: Float32Array;
  readonly attenuation: Float32Array;
  readonly sky: readonly [number, number, number];
  readonly ground: readonly [number, number, number];
  /** The light that casts shadows, −1 without one, and the projection of its view. */
  readonly shadowLight: number;
  readonly shadow: Mat4;
  /** Width of a pixel of the shadow map in the scene, m. */
  readonly shadowPixel: number;
}

interface Light {
  /** Position, or the opposite of the direction of a directional light. */
  readonly position: Vec3;
  readonly isDirectional: boolean;
  readonly direction: Vec3;
  /** Cosine of the cutoff; −1 for a light in all directions. */
  readonly cutoff: number;
  readonly exponent: number;
  readonly diffuse: Vec3;
  readonly specular: Vec3;
  readonly attenuation: Vec3;
  readonly castsShadow: boolean;
}

/** `mjtLightType`. */
const LIGHT = { spot: 0, directional: 1, point: 2 } as const;
export const SHADOW_SIZE = 2048;

function directional(direction: Vec3, diffuse: Vec3, specular: number, castsShadow: boolean): Light {
  return {
    position: scale(direction, -1), isDirectional: true, direction, cutoff: -1, exponent: 0, diffuse, specular: [specular, specular, specular],
    attenuation: [1, 0, 0], castsShadow,
  };
}

/** MuJoCo's headlight, a little weaker than there where other light comes from above. */
const headlight = (eye: Eye): Light => directional(eye.forward, [0.3, 0.3, 0.3], 0.25, false);
/** The light of a model that has none. */
const SUN = directional(normalize([-0.35, 0.45, -1]), [0.72, 0.7, 0.66], 0.5, true);

function modelLights(m: SceneModel, f: SceneFrame): { lights: Light[]; ambient: Vec3 } {
  const lights: Light[] = [];
  let ambient: Vec3 = [0, 0, 0];
  for (let id = 0; id < m.light_type.length; id++) {
    const type = at(m.light_type, id);
    // A light from an image is drawn as no light.
    if (!at(m.light_active, id) || type > LIGHT.point) continue;
    const direction = normalize(row3(f.light_xdir, id)), isDirectional = type === LIGHT.directional;
    ambient = addScaled(ambient, row3(m.light_ambient, id), 1);
    lights.push({
      position: isDirectional ? scale(direction, -1) : row3(f.light_xpos, id), isDirectional, direction,
      cutoff: type === LIGHT.spot ? Math.cos((at(m.light_cutoff, id) * Math.PI) / 180) : -1, exponent: at(m.light_exponent, id),
      diffuse: row3(m.light_diffuse, id), specular: row3(m.light_specular, id), attenuation: row3(m.light_attenuation, id),
      castsShadow: at(m.light_castshadow, id) !== 0 && type !== LIGHT.point,
    });
  }
  return { lights, ambient };
}

/** Middle and radius of what casts shadows. */
function casters(m: SceneModel, f: SceneFrame): { center: Vec3; radius: number } {
  let low: Vec3 = [Infinity, Infinity, Infinity], high: Vec3 = [-Infinity, -Infinity, -Infinity];
  for (let id = 0; id < m.geom_type.length; id++) {
    const type = at(m.geom_type, id);
    if (type === GEOM.plane || !isVisible(m.geom_group, id)) continue;
    const p = row3(f.geom_xpos, id), size = row3(m.geom_size, id), r = type === GEOM.capsule ? size[0] + size[1] : length(size);
    if (!p.every(Number.isFinite)) continue;
    low = [Math.min(low[0], p[0] - r), Math.min(low[1], p[1] - r), Math.min(low[2], p[2] - r)];
    high = [Math.max(high[0], p[0] + r), Math.max(high[1], p[1] + r), Math.max(high[2], p[2] + r)];
  }
  if (!(low[0] <= high[0])) return { center: [at(m.center, 0), at(m.center, 1), at(m.center, 2)], radius: m.extent };
  const center = scale(addScaled(low, high, 1), 0.5);
  return { center, radius: Math.min(length(sub(high, center)), 4 * m.extent) };
}

/** The view of a light on everything that casts shadows. */
function shadowView(light: Light, m: SceneModel, f: SceneFrame): { shadow: Mat4; pixel: number } {
  const { center, radius } = casters(m, f);
  const [rx, ux, zx, ry, uy, zy, rz, uz, zz] = rotationToZ(light.direction);
  const right: Vec3 = [rx, ry, rz], up: Vec3 = [-ux, -uy, -uz], forward: Vec3 = [zx, zy, zz];
  if (light.isDirectional) {
    // The far side is where a floor below the scene may be.
    const view = viewMatrix(addScaled(center, forward, -2 * radius), right, up, forward);
    return { shadow: multiply(orthographic(radius, radius, 0, 6 * radius), view), pixel: (2 * radius) / SHADOW_SIZE };
  }
  const distance = length(sub(center, light.position));
  const wide = Math.tan(Math.min(Math.acos(light.cutoff), 1.3)), toScene = distance > radius ? radius / Math.sqrt(distance * distance - radius * radius) : wide;
  const aim = distance > radius ? normalize(sub(center, light.position)) : forward;
  const [ax, bx, cx, ay, by, cy, az, bz, cz] = rotationToZ(aim);
  const half = Math.min(wide, toScene * 1.1);
  const view = viewMatrix(light.position, [ax, ay, az], [-bx, -by, -bz], [cx, cy, cz]);
  const near = Math.max(0.02 * distance, distance - 1.5 * radius), far = distance + 4 * radius;
  return { shadow: multiply(perspective(half, half, near, far), view), pixel: (2 * half * distance) / SHADOW_SIZE };
}

export function collectLights(m: SceneModel, f: SceneFrame, eye: Eye, palette: Palette, hasShadows: boolean): Lights {
  const { lights: given, ambient } = modelLights(m, f);
  const lights = [headlight(eye), ...(given.length > 0 ? given : [SUN])].slice(0, MAX_LIGHTS);
  const shadowLight = hasShadows ? lights.findIndex(l => l.castsShadow) : -1;
  const caster = lights[shadowLight];
  const view = caster ? shadowView(caster, m, f) : { shadow: new Float32Array(16), pixel: 0 };
  const table = (size: number, values: (l: Light) => readonly number[]): Float32Array => {
    const out = new Float32Array(size * MAX_LIGHTS);
    lights.forEach((l, i) => out.set(values(l), size * i));
    return out;
  };
  return {
    count: lights.length,
    position: table(4, l => [...l.position, l.isDirectional ? 0 : 1]),
    direction: table(4, l => [...l.direction, l.cutoff]),
    diffuse: table(4, l => [...l.diffuse, l.exponent]),
    specular: table(3, l => l.specular),
    attenuation: table(3, l => l.attenuation),
    sky: [palette.sky[0] + ambient[0], palette.sky[1] + ambient[1], palette.sky[2] + ambient[2]],
    ground: [palette.ground[0] + ambient[0], palette.ground[1] + ambient[1], palette.ground[2] + ambient[2]],
    shadowLight, shadow: view.shadow, shadowPixel: view.pixel,
  };
}
