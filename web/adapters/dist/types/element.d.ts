/** The element of a fence, as data and as HTML. No text of a lesson ends its script or its attribute. */
/** A script of data inside an element. */
export interface DataScript {
    readonly type: "application/json" | "model/mjcf";
    /** The name of a model. */
    readonly name?: string;
    readonly text: string;
}
/** `<sim-lab>` or `<lesson-quiz>`. */
export interface FenceElement {
    readonly tag: "sim-lab" | "lesson-quiz";
    readonly attributes: Readonly<Record<string, string>>;
    readonly scripts: readonly DataScript[];
}
/** Escapes a text for the content of an element or a quoted attribute. */
export declare function escapeHtml(text: string): string;
/** JSON for a script element: nothing in it ends the element or opens another one. */
export declare function jsonInScript(json: string): string;
/**
 * The text of a model on one line and without comments, if a script element can contain it; otherwise `null`. In XML, a line break in an
 * attribute is a space, and MJCF has no other text.
 */
export declare function modelInScript(xml: string): string | null;
/** The element as HTML on one line. */
export declare function elementHtml({ tag, attributes, scripts }: FenceElement): string;
