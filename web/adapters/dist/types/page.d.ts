/** The fences of one page as elements. */
import { type FenceElement } from "./element.js";
import { type FenceKind, type Json } from "./fence.js";
import { type ModelOptions } from "./models.js";
/** How fences become elements. */
export interface Options extends ModelOptions {
    /**
     * Where the content of an element is. `script`, the default: in scripts of data inside it. `attribute`: in its attribute `src`, for tools
     * that compile pages into components, in which no script can be; its policy must allow `connect-src data:`.
     */
    readonly form?: "script" | "attribute" | undefined;
}
/** A page while its fences are converted: their numbers and ids. */
export interface Page {
    readonly options: Options;
    /** The file of the lesson, if there is one. */
    readonly lesson: string | null;
    readonly ids: Set<string>;
    labs: number;
}
/** The element of a fence, or why it stays a code block: a sentence without a full stop. */
export type Converted = {
    readonly kind: FenceKind;
    readonly element: FenceElement;
    readonly content: Json;
    readonly models: Readonly<Record<string, string>>;
} | {
    readonly kind: FenceKind;
    readonly element: null;
    readonly message: string;
};
/** A page of which no fence has been converted yet. */
export declare function createPage(options?: Options, lesson?: string | null): Page;
/** Converts a fence. `null` for a fence that is neither a lab nor a quiz. */
export declare function convertFence(info: string, text: string, page: Page): Converted | null;
