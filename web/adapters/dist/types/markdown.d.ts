/** The fences of a Markdown text, line by line as CommonMark defines them, for tools that give texts and no trees. */
/** A fence of a text. */
export interface TextFence {
    /** The first line, and the line after the last one. */
    readonly start: number;
    readonly end: number;
    readonly info: string;
    /** The text inside, without the prefixes of quotes and lists. */
    readonly body: string;
    /** The prefix of lines in its place: the marks of quotes and the indentation of lists. */
    readonly prefix: string;
    /** What precedes the marks on the first line: as `prefix`, with the marker of a list that begins there. */
    readonly head: string;
}
/** Finds all fences, in order. */
export declare function findFences(lines: readonly string[]): TextFence[];
