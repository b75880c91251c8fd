import type { Messages } from "./en.js";
/** The texts of the elements in German. */
export declare const german: Messages;
