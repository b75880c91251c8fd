/** What a lab may draw over its scene: frames, joints, centres of mass, cameras, contacts, forces. */
import { type Color, type DrawList } from "./instances.js";
import { type Vec3 } from "./matrix.js";
import type { Palette } from "./theme.js";
import type { SceneFrame, SceneModel } from "./types.js";
/** Lengths of overlays: about the size of a geom, m. */
export declare function overlaySize(m: SceneModel): number;
/** An arrow of this radius; its head shrinks with a short arrow. */
export declare function pushArrow(list: DrawList, from: Vec3, along: Vec3, radius: number, color: Color): void;
export declare function pushFrames(list: DrawList, f: SceneFrame, size: number, palette: Palette): void;
/** A hinge is a drum with an arrow along its axis, a slide a block with an arrow, a ball joint a ball, a free joint a cube. */
export declare function pushJoints(list: DrawList, m: SceneModel, f: SceneFrame, size: number, palette: Palette): void;
/** A checkered ball at the centre of mass of every body, a larger one at that of a tree of several bodies. */
export declare function pushCentres(list: DrawList, m: SceneModel, f: SceneFrame, size: number, palette: Palette): void;
export declare function pushCameras(list: DrawList, m: SceneModel, f: SceneFrame, size: number, palette: Palette): void;
export declare function pushContacts(list: DrawList, f: SceneFrame, size: number, palette: Palette): void;
/** `forceScale` in m per N. */
export declare function pushForces(list: DrawList, f: SceneFrame, forceScale: number, size: number, palette: Palette): void;
/** A coil from the grabbed point to the pointer. */
export declare function pushDrag(list: DrawList, from: Vec3, to: Vec3, size: number, palette: Palette): void;
