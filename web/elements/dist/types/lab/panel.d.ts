/** A lab that is open: its parts, and how frames of the engine reach them. */
import type { ControlValue, Models } from "labspec/slim";
import { type RemoteLab } from "../engine/client.js";
import type { EngineEvent, Frame } from "../engine/messages.js";
import type { LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { type Player } from "./player.js";
/** What the element tells the page. */
export interface PanelEvents {
    change(label: string, value: ControlValue | null, time: number): void;
    event(event: EngineEvent, text: string): void;
    playing(isPlaying: boolean): void;
    failed(e: unknown): void;
    /** A saved state is to be opened in place of this one. */
    reopen(state: Uint8Array): void;
}
export interface Panel {
    readonly element: HTMLElement;
    readonly remote: RemoteLab;
    readonly player: Player;
    readonly frame: Frame;
    /** Says something politely. */
    say(text: string): void;
    restyle(): void;
    describe(): string;
    save(): Promise<Uint8Array>;
    dispose(): void;
}
/** Opens a lab, and builds its parts. `key` is its name in addresses. */
export declare function openPanel(spec: LabSpec, models: Models, state: Uint8Array | null, key: string, say: Say, events: PanelEvents): Promise<Panel>;
