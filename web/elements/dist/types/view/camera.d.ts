/** Cameras, as MuJoCo's: the free camera, cameras of the model, a camera whose target follows a body. */
import { type Mat4, type Vec3 } from "./matrix.js";
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
/** The camera of a lab that sets none: from the front left, above. */
export declare function defaultCamera(model: SceneModel): CameraPose;
/**
 * The camera of a lab as a free camera. A lab's `azimuth` and `elevation` say where the camera is, seen from its target; those of a free
 * camera say where it looks.
 */
export declare function labCamera(camera: {
    azimuth?: number;
    elevation?: number;
    distance?: number;
    target?: readonly number[];
}): Partial<CameraPose>;
/** The camera `pose` in a frame of the scene. */
export declare function placeEye(pose: CameraPose, model: SceneModel, frame: SceneFrame): Eye;
/** From the world to the picture; `aspect` is its width over its height. */
export declare function projectionOf(eye: Eye, aspect: number): Mat4;
/** The ray through a point of the picture: `u` from −1 (left) to 1, `v` from −1 (below) to 1. */
export declare function rayThrough(eye: Eye, aspect: number, u: number, v: number): Ray;
/** The point of a ray in the plane through `through` that faces the camera. */
export declare function pointFacing(eye: Eye, ray: Ray, through: Vec3): [number, number, number];
/** Distance from the eye to a point along the view, for sorting. */
export declare const depthOf: (eye: Eye, point: Vec3) => number;
