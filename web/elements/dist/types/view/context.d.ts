/** The one WebGL context of a page: browsers allow about 16, and a page may have more views. */
import { type Gpu, type UploadedShape, type UploadedTexture } from "./gpu.js";
import { type Shape } from "./shapes.js";
import type { SceneTexture } from "./types.js";
/** A view, as the context knows it. */
export interface Client {
    /** Size of its picture, pixels. */
    readonly width: number;
    readonly height: number;
    /** The context has been lost: what was uploaded is gone. */
    contextLost(): void;
}
/** A canvas with its context, and everything that is uploaded to it. */
export declare class SharedContext {
    #private;
    readonly canvas: HTMLCanvasElement | OffscreenCanvas;
    readonly gpu: Gpu;
    private constructor();
    static create(onLost: () => void): SharedContext | null;
    /** Makes the canvas as large as the largest picture. */
    fit(width: number, height: number): void;
    shape(name: string): UploadedShape | null;
    texture(name: string): UploadedTexture | null;
    /** Uploads a shape, unless another view has. */
    addShape(name: string, make: () => Shape): void;
    addTexture(name: string, image: SceneTexture): void;
    removeShape(name: string): void;
    removeTexture(name: string): void;
    /** Uploaded shapes and textures, for tests. */
    get uploads(): {
        shapes: number;
        textures: number;
    };
    free(): void;
}
/** The context of the page; null where the browser has none now. */
export declare function sharedContext(): SharedContext | null;
export declare function addClient(client: Client): void;
/** Forgets a view; the context is freed with the last one. */
export declare function removeClient(client: Client): void;
/** Makes the shared canvas large enough for every view and for a picture of this size. */
export declare function fitCanvas(context: SharedContext, width: number, height: number): void;
