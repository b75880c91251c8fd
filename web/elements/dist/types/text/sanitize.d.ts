/** The safe part of some HTML; formulas between `$` signs become MathML. */
export declare function safeHtml(html: string, owner: Document): DocumentFragment;
