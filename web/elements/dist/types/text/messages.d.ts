import { type MessageName, type Messages } from "./en.js";
/** Adds a language, or replaces one: a page calls it before its elements are shown. */
export declare function addLanguage(code: string, messages: Partial<Messages>): void;
/** A text of an element's language, with values for its names. */
export type Say = (name: MessageName, values?: Readonly<Record<string, string | number>>) => string;
/** The language of an element: its own `lang`, or that of an ancestor; English where there is none. */
export declare function messagesFor(element: Element): Say;
