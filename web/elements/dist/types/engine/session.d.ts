/** A lab that is played: what a page asks of it, frame by frame. */
import { Lab, type ControlValue, type Models } from "labspec/slim";
import type { Drag, EngineEvent, Frame, Opened } from "./messages.js";
import { readSceneModel, writtenSceneFields } from "./scene.js";
export interface Session {
    readonly lab: Lab;
    readonly names: readonly string[];
    readonly controls: Lab["controls"];
    readonly written: ReturnType<typeof writtenSceneFields>;
    /** Findings that the page knows. */
    reported: number;
    sent: ReturnType<typeof readSceneModel>;
    rows: number[][];
    events: EngineEvent[];
    drag: Drag | null;
    /** Time that was asked for and is less than a step, s. */
    carry: number;
}
/** Opens a lab, or one in a saved state. */
export declare function openSession(json: string, models: Models, state: Uint8Array | null): Session;
/** What a page is told of a lab that was opened. */
export declare function describeOpened(id: number, session: Session): Opened;
/** Plays for so many simulated seconds, but works for at most `budget` milliseconds. */
export declare function advance(session: Session, seconds: number, budget: number): Frame;
/** Makes so many steps. */
export declare function stepSession(session: Session, steps: number): Frame;
/** Does something else to the lab, and looks at it. */
export declare function actOn(session: Session, what: (lab: Lab) => void): Frame;
/** Sets a control. */
export declare function setControl(session: Session, label: string, value: ControlValue): Frame;
/** Drags a body with a spring, or lets it go. */
export declare function setDrag(session: Session, drag: Drag | null): Frame;
