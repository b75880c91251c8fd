/** The 3D view of a lab: `createView` draws a scene into a canvas. */
import { SceneView } from "./view.js";
import type { CreateView } from "./types.js";

export { labCamera } from "./camera.js";
export type * from "./types.js";

export const createView: CreateView = (canvas, model, options) => new SceneView(canvas, model, options);
