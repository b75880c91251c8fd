/**
 * The mirror of a scene. As in MuJoCo, the first plane or box with `reflectance` is one (of a box, the upper face): the scene that it shows is
 * added with this weight. Measured with MuJoCo 3.14.0: the sky is not mirrored, and what is transparent is no mirror.
 */
import type { Eye } from "./camera.js";
import type { Instance } from "./instances.js";
import { addScaled, dot, rotate, sub, type Mat4, type Vec3 } from "./matrix.js";

/** A plane in the world: its unit normal, on the side that reflects, and the distance of the origin to it along the normal, m. */
export interface Mirror {
  readonly normal: Vec3;
  readonly offset: number;
}

/** The mirror that an instance of a plane or a box is; null where the eye does not see its reflecting side. */
export function mirrorOf({ shape, position, rotation, scale: size, color, material }: Instance, eye: Eye): Mirror | null {
  const isFlat = shape === "plane";
  if (!(material.reflectance > 0) || color[3] < 1 || !(isFlat || shape === "box")) return null;
  const normal = rotate(rotation, [0, 0, 1]), point = isFlat ? position : addScaled(position, normal, size[2]);
  const height = eye.isOrthographic ? -dot(eye.forward, normal) : dot(sub(eye.position, point), normal);
  return height > 0 ? { normal, offset: dot(point, normal) } : null;
}

/** x − 2 (n·x − offset) n for points; as a matrix, column-major. */
export function reflection({ normal: [x, y, z], offset }: Mirror): Mat4 {
  return Float32Array.of(
    1 - 2 * x * x, -2 * x * y, -2 * x * z, 0, -2 * x * y, 1 - 2 * y * y, -2 * y * z, 0, -2 * x * z, -2 * y * z, 1 - 2 * z * z, 0,
    2 * offset * x, 2 * offset * y, 2 * offset * z, 1,
  );
}

/** The eye behind the mirror. */
export function mirrorEye(eye: Eye, { normal, offset }: Mirror): Eye {
  const turn = (v: Vec3): Vec3 => addScaled(v, normal, -2 * dot(v, normal));
  return { ...eye, position: addScaled(turn(eye.position), normal, 2 * offset), forward: turn(eye.forward) };
}

/** The plane that is the side of the mirror where things are mirrored, as the program reads it: positive in front. */
export const frontOf = ({ normal, offset }: Mirror, gap: number): readonly [number, number, number, number] => [...normal, -offset - gap];
