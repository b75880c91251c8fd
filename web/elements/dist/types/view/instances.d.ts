/** What a picture consists of: shapes with a pose, a size, a colour and a material; lines. Filled anew for every picture. */
import type { Mat3, Vec3 } from "./matrix.js";
/** Numbers of an instance: pose (12), scale (4), colour (4), material (4), texture and pattern (4). */
export declare const INSTANCE_SIZE = 28;
/** Numbers of a line: its ends (6), colour (4), width in pixels. */
export declare const LINE_SIZE = 11;
/** Drawn in this order: opaque, planes (blended, both sides), transparent from back to front, overlays. */
export declare const LAYER: {
    readonly opaque: 0;
    readonly plane: 1;
    readonly transparent: 2;
    readonly overlay: 3;
};
export type Layer = (typeof LAYER)[keyof typeof LAYER];
export type Color = readonly [r: number, g: number, b: number, a: number];
export interface Material {
    readonly emission: number;
    readonly specular: number;
    readonly shininess: number;
    readonly reflectance: number;
    /** Id of a texture, −1 without one. */
    readonly texture: number;
    readonly textureMode: number;
    readonly repeat: readonly [number, number];
}
/** MuJoCo's material of a geom that names none. */
export declare const PLAIN: Material;
/** Overlays: bright in every light. */
export declare const BRIGHT: Material;
export interface Instance {
    readonly shape: string;
    readonly position: Vec3;
    readonly rotation: Mat3;
    readonly scale: Vec3;
    /** Half length of a capsule. */
    readonly shift?: number;
    readonly color: Color;
    readonly material: Material;
    readonly pattern?: number;
    readonly layer: Layer;
    /** Distance in front of the camera, for the order of transparent ones. */
    readonly depth?: number;
    readonly castsShadow?: boolean;
}
/** Instances `first` to `first + count` are of one shape and one texture. */
export interface Run {
    readonly shape: string;
    readonly texture: number;
    readonly layer: Layer;
    readonly first: number;
    count: number;
}
export declare class DrawList {
    #private;
    /** Runs of the last `finish`, and those that cast shadows. */
    runs: Run[];
    shadowRuns: Run[];
    lineCount: number;
    clear(): void;
    push(i: Instance): void;
    line(from: Vec3, to: Vec3, color: Color, width: number): void;
    /** Sorts the instances into runs. */
    finish(): void;
    get instances(): Float32Array<ArrayBuffer>;
    get lines(): Float32Array<ArrayBuffer>;
}
