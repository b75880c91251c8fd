import { type Options as PageOptions } from "../page.js";
/** How fences become nodes. */
export interface Options extends Omit<PageOptions, "form"> {
    /** The one file of the elements: an address, or a path from the file of the lesson; `/` begins at the folder of `myst.yml`. */
    readonly esm?: string;
}
/** A plugin, as mystmd loads it. */
export interface Plugin {
    readonly name: string;
    readonly transforms: readonly {
        readonly name: string;
        readonly stage: "document";
        readonly plugin: () => (tree: object, file: object) => void;
    }[];
}
/** Makes the plugin with options; the default export is the plugin without any. */
export declare function createPlugin(options?: Options): Plugin;
declare const _default: Plugin;
export default _default;
