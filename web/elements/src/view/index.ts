/** The 3D view of a lab: `createView` draws a scene into a canvas. */
import { sharedContext } from "./context.js";
import { SceneView } from "./view.js";
import type { CreateView } from "./types.js";
import { warmPrograms } from "./warm.js";

export { labCamera } from "./camera.js";
export type * from "./types.js";

let isPrepared = false;

/** Starts the WebGL context of the page and its programs, so that the first view finds them. */
export function prepareViews(): void {
  if (isPrepared) return;
  isPrepared = true;
  const context = sharedContext();
  // On two cores, the driver would take the time of the engine.
  if (context !== null && navigator.hardwareConcurrency > 2) warmPrograms(context);
}

/**
 * A view of `model` in `canvas`, whose size on the page comes from its style, not from its pixels. The canvas must have no context of
 * another kind. Throws an `Error` where the browser has no WebGL 2.
 */
export const createView: CreateView = (canvas, model, options) => new SceneView(canvas, model, options);
