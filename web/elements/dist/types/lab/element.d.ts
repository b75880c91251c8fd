/** `<sim-lab>`: a physics lab in a page. */
import type { ControlValue, Models } from "labspec/slim";
import { type Panel } from "./panel.js";
export declare class SimLab extends HTMLElement {
    #private;
    static readonly observedAttributes: string[];
    /** The lab as an object or as JSON. */
    get lab(): object | string | null;
    set lab(lab: object | string | null);
    /** Models by name (MJCF), and files that they name, by path. */
    get models(): Models | null;
    set models(models: Models | null);
    /** Fulfilled when the lab is open; refused with the reason where it cannot be. */
    get ready(): Promise<void>;
    get time(): number;
    get playing(): boolean;
    /** Whether the lab has reached its end, and stands still until it is reset. */
    get isOver(): boolean;
    /** Labels and units of the traces and readouts. */
    get shown(): Panel["remote"]["opened"]["shown"];
    /** What they show, in the same order. */
    get numbers(): readonly number[];
    /** The readouts as they are printed. */
    get texts(): readonly string[];
    play(): void;
    pause(): void;
    reset(): Promise<void>;
    step(steps?: number): Promise<void>;
    set(label: string, value: ControlValue): Promise<void>;
    press(label: string): Promise<void>;
    /** The state as bytes, for `openState`. */
    saveState(): Promise<Uint8Array>;
    /** Opens a state that was saved: the lab goes on from there with the same bits. */
    openState(state: Uint8Array): Promise<void>;
    connectedCallback(): void;
    disconnectedCallback(): void;
    attributeChangedCallback(_name: string, before: string | null, after: string | null): void;
}
/** Defines the element, unless the page has it. */
export declare function defineSimLab(): void;
