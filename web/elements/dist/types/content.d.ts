/** Where the content of an element comes from: a property, an attribute, or a script inside it. */
import type { Models } from "labspec/slim";
import { type Json } from "./spec.js";
import type { Say } from "./text/messages.js";
/** What a reader can be told: what is wrong with the content of an element. */
export declare class ContentError extends Error {
}
/** The JSON of an element, as an object and as it is written. */
export interface Content {
    readonly json: Json;
    readonly text: string;
}
/** Reads the content of an element: its property, then `src`, then a `<script type="application/json">` inside. */
export declare function readContent(element: Element, property: unknown, missing: string, say: Say): Promise<Content>;
/**
 * The models of an element: its property, `<script type="model/mjcf" data-name="…">` inside it or anywhere on the page, and, for a model
 * that is named and not there, the file of that name in the folder that `models` or `data-models` names.
 */
export declare function readModels(element: Element, property: Models | null, name: string | null, say: Say): Promise<Models>;
/** Waits until the children of an element have been read. */
export declare function childrenRead(): Promise<void>;
