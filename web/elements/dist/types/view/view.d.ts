import { type Client } from "./context.js";
import type { CameraPose, Overlay, Pick, SceneFrame, SceneModel, View, ViewOptions } from "./types.js";
export declare class SceneView implements View, Client {
    #private;
    readonly camera: CameraPose;
    readonly overlays: Record<Overlay, boolean>;
    width: number;
    height: number;
    constructor(canvas: HTMLCanvasElement, model: SceneModel, options?: ViewOptions);
    setModel(model: SceneModel): void;
    setFrame(frame: SceneFrame): void;
    clearTrail(): void;
    setDrag(drag: {
        from: readonly number[];
        to: readonly number[];
    } | null): void;
    setTheme(theme: {
        background: string | null;
        highContrast: boolean;
    }): void;
    draw(): void;
    pick(x: number, y: number): Pick | null;
    unproject(x: number, y: number, through: readonly number[]): [number, number, number];
    toPng(width: number, height: number): Promise<Blob>;
    dispose(): void;
    contextLost(): void;
}
