/** Where the parts of a lab stand. */
import type { Finding } from "labspec/slim";
import type { LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
export interface LabParts {
    readonly spec: LabSpec;
    readonly title: string;
    readonly say: Say;
    readonly view: HTMLElement;
    readonly viewBar: HTMLElement | null;
    readonly toolbar: HTMLElement;
    readonly controls: readonly HTMLElement[];
    readonly buttons: readonly HTMLElement[];
    readonly readouts: HTMLElement | null;
    readonly plots: readonly HTMLElement[];
    readonly note: HTMLElement | null;
    readonly spoken: readonly HTMLElement[];
    readonly findings: readonly Finding[];
}
export declare function layOut(parts: LabParts): HTMLElement;
export declare function findingText(finding: Finding): HTMLElement;
/** A lab that cannot run says why. */
export declare function errorPanel(title: string, messages: readonly (string | HTMLElement)[], help: string | null): HTMLElement;
