/** One frame of a plot on a canvas: grid, reference lines, traces, the sample under the pointer. */
import type { PlotSpec } from "../spec.js";
import { type Range } from "./scale.js";
import { type Series } from "./series.js";
export interface PlotColors {
    readonly text: string;
    readonly grid: string;
    readonly axis: string;
    readonly reference: string;
    readonly background: string;
    readonly traces: readonly string[];
}
export interface PlotLook {
    readonly colors: PlotColors;
    readonly font: string;
    readonly lineWidth: number;
}
/** Where values are on the canvas, in CSS pixels. */
export interface PlotArea {
    readonly left: number;
    readonly top: number;
    readonly width: number;
    readonly height: number;
    readonly times: Range;
    readonly values: Range;
}
export declare const DASH: number[];
/** Draws a plot of `width` x `height` CSS pixels; `hovered` is the sample that is marked, or -1. */
export declare function drawPlot(context: CanvasRenderingContext2D, series: Series, spec: PlotSpec, look: PlotLook, size: readonly [number, number], hovered: number): PlotArea;
export declare function xOf(area: PlotArea, time: number): number;
export declare function timeOf(area: PlotArea, x: number): number;
