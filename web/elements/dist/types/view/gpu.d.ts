import { type Shape } from "./shapes.js";
import type { SceneTexture } from "./types.js";
type Gl = WebGL2RenderingContext;
/** Texture units. */
export declare const UNIT: {
    readonly image: 0;
    readonly cube: 1;
    readonly shadow: 2;
};
export interface Program {
    readonly program: WebGLProgram;
    /** Place of a uniform; null where the program has no use for it. */
    readonly uniform: (name: string) => WebGLUniformLocation | null;
}
export interface UploadedShape {
    readonly vertexArray: WebGLVertexArrayObject;
    readonly buffers: readonly WebGLBuffer[];
    readonly count: number;
    readonly indexType: number;
}
export interface UploadedTexture {
    readonly texture: WebGLTexture;
    readonly isCube: boolean;
}
/** What a context holds for all scenes. */
export interface Gpu {
    readonly gl: Gl;
    readonly surface: Program;
    readonly shadow: Program;
    readonly line: Program;
    readonly sky: Program;
    readonly instances: WebGLBuffer;
    readonly lines: WebGLBuffer;
    readonly lineArray: WebGLVertexArrayObject;
    readonly emptyArray: WebGLVertexArrayObject;
    readonly shadowBuffer: WebGLFramebuffer;
    readonly shadowTexture: WebGLTexture;
    readonly noImage: WebGLTexture;
    readonly noCube: WebGLTexture;
}
export declare function createGpu(gl: Gl): Gpu;
export declare function uploadShape(gl: Gl, shape: Shape): UploadedShape;
export declare function deleteShape(gl: Gl, shape: UploadedShape): void;
/** A texture with mipmaps. Grey and grey with alpha become colours. */
export declare function uploadTexture(gl: Gl, t: SceneTexture): UploadedTexture;
export {};
