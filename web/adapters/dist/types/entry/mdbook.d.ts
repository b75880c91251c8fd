import { type Page } from "../page.js";
export type { Options } from "../page.js";
/** A book with its fences converted, and what is to be reported. */
export interface Preprocessed {
    readonly book: unknown;
    readonly messages: readonly string[];
}
/** Whether the preprocessor changes what a renderer gets: only pages can have elements. */
export declare function supports(renderer: string): boolean;
/** Converts `[context, book]`, the input of a preprocessor. Throws an `Error` if it is something else. */
export declare function preprocess(input: unknown): Preprocessed;
/** A Markdown text with the HTML of its fences, each on one line, so that it is one block of HTML in quotes and lists too. */
export declare function convertText(text: string, page: Page, report: (message: string) => void): string;
