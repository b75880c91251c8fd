/** What the elements themselves read of a lab: how it is shown. The engine reads and checks the rest. */
import type { CameraPose, Overlay } from "./view/types.js";
export interface TraceSpec {
    readonly label: string;
    readonly dash: boolean;
}
export interface RefLine {
    readonly y: number;
    readonly label: string;
}
export interface PlotSpec {
    readonly ylabel: string;
    readonly xlabel: string | null;
    readonly window: number;
    readonly ymin: number | null;
    readonly ymax: number | null;
    readonly height: number;
    readonly refLines: readonly RefLine[];
    readonly traces: readonly TraceSpec[];
}
export interface LabSpec {
    /** The text that the engine opens. */
    readonly json: string;
    readonly model: string | null;
    readonly title: string;
    readonly kind: string | null;
    readonly note: string | null;
    readonly height: number;
    readonly dock: boolean;
    readonly autoplay: boolean;
    /** As a lab writes it: where the camera is, seen from its target. */
    readonly camera: Partial<CameraPose>;
    readonly overlays: Partial<Record<Overlay, boolean>>;
    readonly toggles: readonly Overlay[];
    readonly forceScale: number | null;
    readonly trail: string | null;
    readonly speeds: readonly number[];
    readonly stopAt: number | null;
    readonly plots: readonly PlotSpec[];
}
export declare const OVERLAYS: readonly Overlay[];
/** An object of JSON. */
export type Json = Readonly<Record<string, unknown>>;
/** Whether a value of JSON is an object. */
export declare function isObject(x: unknown): x is Json;
export declare const textOf: (x: unknown) => string | null;
export declare const numberOf: (x: unknown) => number | null;
export declare const listOf: (x: unknown) => readonly unknown[];
/** How a lab is shown. Keys of a wrong type count as left out: the engine reports them. */
export declare function readLab(lab: Json, json: string): LabSpec;
export declare function clamp(x: number, low: number, high: number): number;
