/** Geoms and sites of a model, as instances of shapes. */
import { type Eye } from "./camera.js";
import { type DrawList } from "./instances.js";
import { type Vec3 } from "./matrix.js";
import type { Palette } from "./theme.js";
import type { SceneFrame, SceneModel } from "./types.js";
/** `mjtGeom`. */
export declare const GEOM: {
    readonly plane: 0;
    readonly hfield: 1;
    readonly sphere: 2;
    readonly capsule: 3;
    readonly ellipsoid: 4;
    readonly cylinder: 5;
    readonly box: 6;
    readonly mesh: 7;
    readonly sdf: 8;
};
export declare const isVisible: (groups: ArrayLike<number>, id: number) => boolean;
/** The name of the shape of a mesh or height field, as `geometry.ts` keeps it. */
export type GeometryNames = {
    readonly mesh: readonly string[];
    readonly hfield: readonly string[];
};
interface Form {
    readonly shape: string;
    readonly scale: Vec3;
    readonly shift?: number;
}
/** The shape of a geom or a site that is neither a plane nor made of triangles. */
export declare function primitive(type: number, [a, b, c]: Vec3): Form;
/** How far an infinite plane is drawn, m. */
export declare const planeReach: (m: SceneModel, eye: Eye) => number;
/** Distance of the lines of a floor: 1, 2 or 5 times a power of ten, m. */
export declare function gridCell(m: SceneModel): number;
export declare function pushGeoms(list: DrawList, m: SceneModel, f: SceneFrame, names: GeometryNames, eye: Eye, palette: Palette): void;
export declare function pushSites(list: DrawList, m: SceneModel, f: SceneFrame, eye: Eye): void;
export {};
