/** Lights: the headlight, those of the model, or one from above where the model has none; and the view of the light that casts shadows. */
import type { Eye } from "./camera.js";
import { type Mat4 } from "./matrix.js";
import type { Palette } from "./theme.js";
import type { SceneFrame, SceneModel } from "./types.js";
/** The uniforms of the lights. */
export interface Lights {
    readonly count: number;
    readonly position: Float32Array;
    readonly direction: Float32Array;
    readonly diffuse: Float32Array;
    readonly specular: Float32Array;
    readonly attenuation: Float32Array;
    readonly sky: readonly [number, number, number];
    readonly ground: readonly [number, number, number];
    /** The light that casts shadows, −1 without one, and the projection of its view. */
    readonly shadowLight: number;
    readonly shadow: Mat4;
    /** Width of a pixel of the shadow map in the scene, m. */
    readonly shadowPixel: number;
}
export declare const SHADOW_SIZE = 2048;
export declare function collectLights(m: SceneModel, f: SceneFrame, eye: Eye, palette: Palette, hasShadows: boolean): Lights;
