import type { Say } from "../text/messages.js";
export interface Toolbar {
    readonly element: HTMLElement;
    readonly play: HTMLButtonElement;
    showPlaying(isPlaying: boolean): void;
    showTime(time: number): void;
    /** The speed that is reached, where it is less than the chosen one. */
    showSlow(speed: number | null): void;
}
export interface ToolbarActions {
    toggle(): void;
    step(): void;
    stepMore(): void;
    reset(): void;
    speed(speed: number): void;
    copyLink(): void;
    saveState(): void;
    openState(file: File): void;
    savePicture(): void;
}
export interface ToolbarOptions {
    readonly speeds: readonly number[];
    readonly timestep: number;
    /** Whether larger steps get a button: for readers who want no motion. */
    readonly hasLargeSteps: boolean;
    readonly hasPicture: boolean;
    /** What stands first in the menu. */
    readonly first: HTMLElement | null;
}
export declare function createToolbar(options: ToolbarOptions, say: Say, actions: ToolbarActions): Toolbar;
