import type { CreateView } from "./types.js";
export { labCamera } from "./camera.js";
export type * from "./types.js";
export declare const createView: CreateView;
