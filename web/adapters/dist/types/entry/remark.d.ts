import { type Options } from "../page.js";
export type { Options } from "../page.js";
/** The plugin. */
export default function remarkLabspec(options?: Options): (tree: object, file: object) => void;
