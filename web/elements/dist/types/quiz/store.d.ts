/** An answer: chosen options, or a text; how often it was tried, and whether it was right at last. */
export interface Stored {
    readonly choice: readonly number[];
    readonly text: string;
    readonly tries: number;
    readonly isRight: boolean | null;
    readonly isDone: boolean;
}
export declare function loadAnswer(quiz: string, index: number): Stored | null;
export declare function storeAnswer(quiz: string, index: number, answer: Stored | null): void;
