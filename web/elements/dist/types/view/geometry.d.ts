/** The meshes, height fields and textures of a model, and their names in the shared context. */
import type { SharedContext } from "./context.js";
import type { GeometryNames } from "./scene.js";
import type { SceneModel } from "./types.js";
/** Names of everything that a model needs uploaded; equal data has equal names, in every view. */
export interface Geometry extends GeometryNames {
    readonly textures: readonly string[];
    /** Id of the sky box, −1 without one. */
    readonly sky: number;
}
export declare function nameGeometry(m: SceneModel): Geometry;
export declare function uploadGeometry(context: SharedContext, m: SceneModel, g: Geometry): void;
export declare function releaseGeometry(context: SharedContext, g: Geometry): void;
