/** Plays a lab: asks the engine for as much simulated time as has passed, and never twice at once. */
import type { ControlValue } from "labspec/slim";
import type { RemoteLab } from "../engine/client.js";
import type { Drag, Frame } from "../engine/messages.js";
export interface Player {
    readonly isPlaying: boolean;
    /** Simulated seconds for each second. */
    speed: number;
    /** Whether the lab is seen: one that is not stands still. */
    isVisible: boolean;
    play(): void;
    pause(): void;
    /** Plays so many simulated seconds at once. */
    advance(seconds: number): Promise<void>;
    step(steps: number): Promise<void>;
    reset(): Promise<void>;
    set(label: string, value: ControlValue): Promise<void>;
    press(label: string): Promise<void>;
    drag(drag: Drag | null): Promise<void>;
    close(): void;
}
export interface PlayerEvents {
    frame(frame: Frame): void;
    playing(isPlaying: boolean): void;
    /** How fast the lab really plays, where that is slower than asked; `null` where it is not. */
    slow(speed: number | null): void;
    failed(e: unknown): void;
}
export declare function createPlayer(remote: RemoteLab, events: PlayerEvents): Player;
