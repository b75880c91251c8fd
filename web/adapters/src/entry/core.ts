/** What the adapters share: a fence becomes an element. */
import { elementHtml, escapeHtml } from "../element.js";
import { convertFence, type Page } from "../page.js";

export { elementHtml, escapeHtml, type DataScript, type FenceElement } from "../element.js";
export { fenceKind, type FenceKind } from "../fence.js";
export { convertFence, createPage, type Converted, type Options, type Page } from "../page.js";

/**
 * The HTML of a fence of a lesson, on one line but for the source of a fence that cannot be read: that is a message and a code block.
 * `null` for a fence that is neither a lab nor a quiz.
 */
export function fenceHtml(info: string, text: string, page: Page): string | null {
  const converted = convertFence(info, text, page);
  if (converted === null) return null;
  if (converted.element !== null) return elementHtml(converted.element);
  return `${messageHtml(converted.message)}<pre><code class="language-json">${escapeHtml(text)}</code></pre>`;
}

/** The message about a fence that stays a code block. It may quote the fence, whose braces mean nothing to a template of Vue either. */
export function messageHtml(message: string): string {
  const text = escapeHtml(message).replace(/[{}]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<p class="labspec-message" role="note"><strong>${text}.</strong></p>`;
}
