/** Tendons as tubes, which follow the sphere or cylinder that they wrap around. */
import { type Eye } from "./camera.js";
import { type DrawList } from "./instances.js";
import { type Vec3 } from "./matrix.js";
import type { SceneFrame, SceneModel } from "./types.js";
/** Points of the shortest arc from `a` to `b` around geom `id`: a great circle of a sphere, a helix of a cylinder. */
export declare function wrapArc(m: SceneModel, f: SceneFrame, id: number, a: Vec3, b: Vec3): Vec3[];
export declare function pushTendons(list: DrawList, m: SceneModel, f: SceneFrame, eye: Eye): void;
