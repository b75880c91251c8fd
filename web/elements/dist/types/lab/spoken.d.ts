import type { EngineEvent } from "../engine/messages.js";
import type { Say } from "../text/messages.js";
export interface Spoken {
    /** Read aloud, politely. */
    readonly region: HTMLElement;
    /** The last events, as a list. */
    readonly log: HTMLElement;
    /** Says something as soon as it is polite. */
    say(text: string): void;
    /** Says what happened; returns the sentences. */
    report(events: readonly EngineEvent[]): readonly string[];
    /** Forgets the list: the lab is back at its start. */
    clear(): void;
}
export declare function createSpoken(say: Say): Spoken;
/** Events as sentences; many contacts at once as one. */
export declare function describeEvents(events: readonly EngineEvent[], say: Say): string[];
