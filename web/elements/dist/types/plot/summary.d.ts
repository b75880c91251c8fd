/** A plot in words and in a table. */
import type { Say } from "../text/messages.js";
import { type Series } from "./series.js";
/** What a trace does: from where to where, and its turning values where they are not at the ends. */
export declare function describeTrace(series: Series, trace: number, label: string, say: Say): string | null;
/** The samples of a table: all of them, or as many as one reads, evenly spread. */
export declare function tableRows(series: Series): string[][];
