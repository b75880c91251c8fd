/** Readouts as `output` elements with their labels. */
import type { Shown } from "labspec/slim";
export interface Readouts {
    readonly element: HTMLElement | null;
    show(texts: readonly string[]): void;
    /** The readouts as one sentence. */
    describe(): string;
}
export declare function createReadouts(shown: readonly Shown[], title: string): Readouts;
