/** Cameras, as MuJoCo's: the free camera, cameras of the model, a camera whose target follows a body. */
import {
  addScaled, at, dot, multiply, normalize, orthographic, perspective, rotationAt, row3, sub, viewMatrix, type Mat4, type Vec3,
} from "./matrix.js";
import type { CameraPose, SceneFrame, SceneModel } from "./types.js";

/** A camera in the world. */
export interface Eye {
  readonly position: Vec3;
  readonly right: Vec3;
  readonly up: Vec3;
  readonly forward: Vec3;
  /** Half the height of the picture: at distance 1, or in m where the camera is orthographic. */
  readonly halfHeight: number;
  readonly isOrthographic: boolean;
  readonly near: number;
  readonly far: number;
}

export interface Ray {
  readonly from: Vec3;
  /** Unit vector. */
  readonly direction: Vec3;
}

/** `vis.global.fovy` of a model that does not set it, degrees. */
const FREE_FOVY = 45;
/** `vis.map.znear` and `zfar` of a model that does not set them, in extents. */
const NEAR = 0.01, FAR = 50;
const DEGREE = Math.PI / 180;

/** The camera of a lab that sets none: from the front left, above. */
export function defaultCamera(model: SceneModel): CameraPose {
  return { azimuth: 125, elevation: -25, distance: 1.9 * model.extent, target: [at(model.center, 0), at(model.center, 1), at(model.center, 2)] };
}

/**
 * The camera of a lab as a free camera. A lab's `azimuth` and `elevation` say where the camera is, seen from its target; those of a free
 * camera say where it looks.
 */
export function labCamera(camera: { azimuth?: number; elevation?: number; distance?: number; target?: readonly number[] }): Partial<CameraPose> {
  const pose: Partial<CameraPose> = {};
  if (camera.azimuth !== undefined) pose.azimuth = camera.azimuth + 180;
  if (camera.elevation !== undefined) pose.elevation = -camera.elevation;
  if (camera.distance !== undefined) pose.distance = camera.distance;
  if (camera.target !== undefined) pose.target = [at(camera.target, 0), at(camera.target, 1), at(camera.target, 2)];
  return pose;
}

/** The camera `pose` in a frame of the scene. */
export function placeEye(pose: CameraPose, model: SceneModel, frame: SceneFrame): Eye {
  const extent = Math.max(model.extent, 1e-6), near = NEAR * extent, far = FAR * extent;
  const fixed = pose.fixed;
  if (fixed !== undefined && fixed >= 0 && 3 * fixed < frame.cam_xpos.length) {
    const m = rotationAt(frame.cam_xmat, fixed);
    const isOrthographic = at(model.cam_projection, fixed) === 1;
    const fovy = at(model.cam_fovy, fixed);
    return {
      position: row3(frame.cam_xpos, fixed), right: [m[0], m[3], m[6]], up: [m[1], m[4], m[7]], forward: [-m[2], -m[5], -m[8]],
      halfHeight: isOrthographic ? fovy / 2 : Math.tan((fovy * DEGREE) / 2), isOrthographic, near, far,
    };
  }
  const [a, e] = [pose.azimuth * DEGREE, pose.elevation * DEGREE];
  const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
  const forward: Vec3 = [ce * ca, ce * sa, se];
  const target = pose.track === undefined ? pose.target : row3(frame.subtree_com, pose.track);
  return {
    position: addScaled(target, forward, -pose.distance), right: [sa, -ca, 0], up: [-se * ca, -se * sa, ce], forward,
    halfHeight: Math.tan(((model.fovy ?? FREE_FOVY) * DEGREE) / 2), isOrthographic: false, near: Math.max(Math.min(near, pose.distance / 20), 1e-6 * extent), far: Math.max(far, 4 * pose.distance),
  };
}

/** From the world to the picture; `aspect` is its width over its height. */
export function projectionOf(eye: Eye, aspect: number): Mat4 {
  const make = eye.isOrthographic ? orthographic : perspective;
  return multiply(make(eye.halfHeight * aspect, eye.halfHeight, eye.near, eye.far), viewMatrix(eye.position, eye.right, eye.up, eye.forward));
}

/** The ray through a point of the picture: `u` from −1 (left) to 1, `v` from −1 (below) to 1. */
export function rayThrough(eye: Eye, aspect: number, u: number, v: number): Ray {
  const side = u * eye.halfHeight * aspect, height = v * eye.halfHeight;
  if (eye.isOrthographic) return { from: addScaled(addScaled(eye.position, eye.right, side), eye.up, height), direction: eye.forward };
  return { from: eye.position, direction: normalize(addScaled(addScaled(eye.forward, eye.right, side), eye.up, height)) };
}

/** The point of a ray in the plane through `through` that faces the camera. */
export function pointFacing(eye: Eye, ray: Ray, through: Vec3): [number, number, number] {
  const t = dot(sub(through, ray.from), eye.forward) / dot(ray.direction, eye.forward);
  const p = addScaled(ray.from, ray.direction, t);
  return [p[0], p[1], p[2]];
}

/** Distance from the eye to a point along the view, for sorting. */
export const depthOf = (eye: Eye, point: Vec3): number => dot(sub(point, eye.position), eye.forward);
