import type { PlotSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { type Series } from "./series.js";
export interface Plot {
    readonly element: HTMLElement;
    readonly series: Series;
    /** Adds samples: rows of `width` numbers, time first. */
    add(rows: Float64Array, width: number): void;
    clear(): void;
    /** Draws, where something has changed. */
    draw(): void;
    /** Takes the colours of the page again. */
    restyle(): void;
    /** What the traces do, in sentences. */
    describe(): string[];
}
/** A plot whose traces are the `columns` of a row, counted after the time. */
export declare function createPlot(spec: PlotSpec, columns: readonly number[], title: string, say: Say): Plot;
