/** Triangles of meshes and height fields, in m, in the frame of their geom. */
import { type Vec3 } from "./matrix.js";
import { type Shape } from "./shapes.js";
import type { Numbers, SceneModel } from "./types.js";
/** Mesh `id` of a model. A vertex with several normals or texture coordinates is several vertices. */
export declare function meshShape(m: SceneModel, id: number): Shape;
/** A height field as a grid of points: its size and the height of a point. */
export interface HeightGrid {
    readonly rows: number;
    readonly columns: number;
    /** Half sizes in x and y, height of elevation 1, thickness of the base, m. */
    readonly size: readonly [number, number, number, number];
    readonly point: (row: number, column: number) => Vec3;
}
export declare function heightGrid(m: SceneModel, id: number): HeightGrid;
/** Height field `id`: its surface with smooth normals, its four sides and its base. */
export declare function hfieldShape(m: SceneModel, id: number): Shape;
/** Two 32-bit FNV-1a hashes of numbers `from` to `to` of a list, to recognize geometry that has been uploaded. */
export declare function hashNumbers(list: Numbers, from?: number, to?: number, seed?: string): string;
