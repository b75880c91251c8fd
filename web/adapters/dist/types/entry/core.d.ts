import { type Page } from "../page.js";
export { elementHtml, escapeHtml, type DataScript, type FenceElement } from "../element.js";
export { fenceKind, type FenceKind } from "../fence.js";
export { convertFence, createPage, type Converted, type Options, type Page } from "../page.js";
/**
 * The HTML of a fence of a lesson, on one line but for the source of a fence that cannot be read: that is a message and a code block.
 * `null` for a fence that is neither a lab nor a quiz.
 */
export declare function fenceHtml(info: string, text: string, page: Page): string | null;
/** The message about a fence that stays a code block. It may quote the fence, whose braces mean nothing to a template of Vue either. */
export declare function messageHtml(message: string): string;
