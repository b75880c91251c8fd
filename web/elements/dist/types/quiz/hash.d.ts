/** SHA-256 (FIPS 180-4), also in pages that are not served securely, where the browser offers none. */
/** The SHA-256 of a text in UTF-8, in hexadecimal digits. */
export declare function sha256(text: string): string;
/**
 * The hash of a choice for a question that does not show its answer: the index of an option, a list of indexes, or true or false. It
 * keeps the answer out of the page's source; whoever tries all choices finds it.
 */
export declare function hashAnswer(salt: string, choice: number | readonly number[] | boolean): string;
