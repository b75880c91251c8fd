/** Where a ray meets a geom first. Textbook intersections, in the frame of the geom. */
import type { Ray } from "./camera.js";
import { type Vec3 } from "./matrix.js";
import type { SceneFrame, SceneModel } from "./types.js";
/** Möller and Trumbore, 1997: both sides of the triangle. */
export declare function rayTriangle({ from, direction }: Ray, a: Vec3, b: Vec3, c: Vec3): number;
/** Distance along a ray to geom `id`; infinite where the ray misses it. */
export declare function rayGeom(m: SceneModel, f: SceneFrame, id: number, ray: Ray): number;
/** The first visible geom along a ray. */
export declare function castRay(m: SceneModel, f: SceneFrame, ray: Ray): {
    geom: number;
    distance: number;
    point: Vec3;
} | null;
