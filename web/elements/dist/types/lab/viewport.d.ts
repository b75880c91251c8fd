import type { Overlay, SceneFrame, SceneModel } from "../view/types.js";
import type { Drag, Opened } from "../engine/messages.js";
import { type LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
export interface Viewport {
    readonly element: HTMLElement;
    /** Whether there is a picture. */
    readonly isDrawn: boolean;
    setModel(model: SceneModel): void;
    setFrame(frame: SceneFrame): void;
    clearTrail(): void;
    draw(): void;
    restyle(): void;
    setOverlay(overlay: Overlay, on: boolean): void;
    overlay(overlay: Overlay): boolean;
    /** Through a camera of the model, or the free one (`null`). */
    setCamera(fixed: number | null): void;
    /** Drags a body with the keyboard, or lets it go (`null`). */
    grab(body: number | null): void;
    savePicture(title: string): void;
    dispose(): void;
}
export interface ViewportActions {
    drag(drag: Drag | null): void;
    say(text: string): void;
    /** The body that is dragged by keys was let go there. */
    released(): void;
}
export declare function createViewport(opened: Opened, spec: LabSpec, say: Say, actions: ViewportActions): Viewport;
