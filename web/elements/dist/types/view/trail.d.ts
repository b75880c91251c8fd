/** The path of a site: its last points, until time goes back. */
import type { DrawList } from "./instances.js";
import { type Vec3 } from "./matrix.js";
import type { Palette } from "./theme.js";
export declare class Trail {
    #private;
    clear(): void;
    /** Adds a point, unless it is nearer than `spacing` to the last one. */
    add(time: number, point: Vec3, spacing: number): void;
    /** Draws the path; its oldest part is faint. */
    push(list: DrawList, palette: Palette): void;
}
