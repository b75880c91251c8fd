/** Ranges and ticks of axes. */
import type { PlotSpec } from "../spec.js";
import { type Series } from "./series.js";
export interface Range {
    readonly min: number;
    readonly max: number;
}
/** The seconds that a plot shows: its window, which begins to move when it is full. */
export declare function timeRange(series: Series, window: number): Range;
/** The values that a plot shows: as its author says, else all that is in its window and its reference lines. */
export declare function valueRange(series: Series, spec: PlotSpec, times: Range): Range;
/** The distance of round ticks, of which about `count` fit into a range. */
export declare function tickSpacing(range: Range, count: number): number;
/** Round ticks inside a range. */
export declare function ticks(range: Range, spacing: number): number[];
