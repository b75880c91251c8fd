/** Where models come from. */
export interface ModelOptions {
    /**
     * The folder of the MJCF files, relative to `root`; or their texts by name. Without it, the nearest folder `models` beside the lesson or
     * above it, up to `root`. `false`: the page has the models by other means, and nothing is looked up.
     */
    readonly models?: string | Readonly<Record<string, string>> | false | undefined;
    /** The folder outside of which no file is opened; by default the working directory. */
    readonly root?: string | undefined;
    /** The address from which pages fetch models by name. With it, no model is written into a page. */
    readonly modelsUrl?: string | undefined;
}
/** The text of a model. Throws a `FenceError`. */
export declare function readModel(name: string, options: ModelOptions, lesson: string | null): string;
