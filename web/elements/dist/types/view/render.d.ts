/** Draws a list of instances and lines into the lower left part of the shared canvas. */
import { type Eye } from "./camera.js";
import type { SharedContext } from "./context.js";
import type { Geometry } from "./geometry.js";
import { type DrawList } from "./instances.js";
import { type Lights } from "./lights.js";
export interface Picture {
    readonly width: number;
    readonly height: number;
    readonly eye: Eye;
    readonly list: DrawList;
    readonly lights: Lights;
    readonly geometry: Geometry;
    /** Distance of grid lines; where infinite planes begin to fade, and end, m; opacity of the lines. */
    readonly grid: readonly [cell: number, near: number, far: number, opacity: number];
    readonly hiddenAlpha: number;
    /** Device pixels of a CSS pixel. */
    readonly density: number;
}
export declare function drawPicture(context: SharedContext, p: Picture): void;
