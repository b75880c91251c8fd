import type { Opened } from "../engine/messages.js";
import type { LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import type { Viewport } from "./viewport.js";
export interface ViewBar {
    readonly element: HTMLElement | null;
    /** The choice of a body to drag. */
    readonly bodies: HTMLElement | null;
    /** No body is held by keys any more. */
    showReleased(): void;
}
export declare function createViewBar(opened: Opened, spec: LabSpec, viewport: Viewport, say: Say): ViewBar;
