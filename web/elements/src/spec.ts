/** The keys of a lab that the elements read: those of its presentation. The engine reads and checks the others. */
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
  /** The position of the camera as seen from its target, as in the lab format. */
  readonly camera: Partial<CameraPose>;
  readonly overlays: Partial<Record<Overlay, boolean>>;
  readonly toggles: readonly Overlay[];
  readonly forceScale: number | null;
  readonly trail: string | null;
  readonly speeds: readonly number[];
  readonly stopAt: number | null;
  readonly plots: readonly PlotSpec[];
  /** The labs of the integrators that it compares; empty for another lab. */
  readonly compared: readonly { readonly name: string; readonly json: string }[];
}

export const OVERLAYS: readonly Overlay[] = ["frames", "joints", "contacts", "forces", "com", "sites", "cameras", "shadows"];
const SPEEDS = [0.1, 0.25, 1, 4];

/** An object of JSON. */
export type Json = Readonly<Record<string, unknown>>;

/** Whether a value of JSON is an object. */
export function isObject(x: unknown): x is Json {
  return typeof x === "object" && x !== null && !Array.isArray(x);
}

export const textOf = (x: unknown): string | null => (typeof x === "string" ? x : null);
export const numberOf = (x: unknown): number | null => (typeof x === "number" && Number.isFinite(x) ? x : null);
export const listOf = (x: unknown): readonly unknown[] => (Array.isArray(x) ? (x as unknown[]) : []);

/** Reads how a lab is shown. A key of a wrong type is ignored; the engine reports it. */
export function readLab(lab: Json, json: string): LabSpec {
  const overlay = (x: unknown): x is Overlay => OVERLAYS.includes(x as Overlay);
  const switched = Object.entries(isObject(lab["overlays"]) ? lab["overlays"] : {});
  const speeds = listOf(lab["speeds"]).filter((s): s is number => typeof s === "number" && s > 0);
  return {
    json, model: textOf(lab["model"]), title: textOf(lab["title"]) ?? "", kind: textOf(lab["kind"]), note: textOf(lab["note"]),
    height: clamp(numberOf(lab["height"]) ?? 300, 80, 2000), dock: lab["dock"] === true, autoplay: lab["autoplay"] === true,
    camera: readCamera(lab["camera"]),
    overlays: Object.fromEntries(switched.filter(([name, on]) => overlay(name) && typeof on === "boolean")),
    toggles: listOf(lab["toggles"]).filter(overlay),
    forceScale: numberOf(lab["forceScale"]), trail: textOf(lab["trail"]), speeds: speeds.length > 0 ? speeds : SPEEDS,
    stopAt: numberOf(lab["stopAt"]), plots: listOf(lab["plots"]).filter(isObject).map(readPlot), compared: [],
  };
}

function readCamera(camera: unknown): Partial<CameraPose> {
  const given = isObject(camera) ? camera : {};
  const target = listOf(given["target"]);
  const [distance, azimuth, elevation] = [numberOf(given["distance"]), numberOf(given["azimuth"]), numberOf(given["elevation"])];
  const [x, y, z] = [numberOf(target[0]), numberOf(target[1]), numberOf(target[2])];
  return {
    azimuth: azimuth ?? -55, elevation: elevation ?? 25,
    ...(distance !== null && distance > 0 ? { distance } : {}),
    ...(x !== null && y !== null && z !== null ? { target: [x, y, z] } : {}),
  };
}

function readPlot(plot: Json): PlotSpec {
  const refLines = listOf(plot["refLines"]).filter(isObject).map((line) => ({ y: numberOf(line["y"]) ?? NaN, label: textOf(line["label"]) ?? "" }));
  const traces = listOf(plot["traces"]).filter(isObject).map((trace) => ({ label: textOf(trace["label"]) ?? "", dash: trace["dash"] === true }));
  const window = numberOf(plot["window"]);
  return {
    ylabel: textOf(plot["ylabel"]) ?? "", xlabel: textOf(plot["xlabel"]), window: window !== null && window > 0 ? window : 5,
    ymin: numberOf(plot["ymin"]), ymax: numberOf(plot["ymax"]), height: clamp(numberOf(plot["height"]) ?? 140, 60, 1000),
    refLines: refLines.filter((line) => Number.isFinite(line.y)), traces,
  };
}

export function clamp(x: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, x));
}
