/** The page's end of the channel: starts engines, and asks them. */
import type { Calls, Channel, Opened, Problem } from "./messages.js";
/** How a build brings the engine along. */
export interface EngineSource {
    /** Addresses of the worker's script, the first one that a page allows is taken. */
    workerUrls(): readonly string[];
    /** The same program, for the page itself where a policy forbids workers. */
    serve(channel: Channel): void;
    /** The compiled module. */
    module(): Promise<WebAssembly.Module>;
}
/** What went wrong in the engine. */
export declare class EngineError extends Error {
    readonly problem: Problem;
    constructor(problem: Problem);
}
/** Asks one engine. */
export type Ask = <Name extends keyof Calls>(lab: number, call: Name, ...args: Calls[Name]["args"]) => Promise<Calls[Name]["answer"]>;
/** A lab in an engine. */
export interface RemoteLab {
    readonly opened: Opened;
    ask<Name extends Exclude<keyof Calls, "open">>(call: Name, ...args: Calls[Name]["args"]): Promise<Calls[Name]["answer"]>;
}
/** Says where the engine comes from: once for each build. */
export declare function setEngineSource(given: EngineSource): void;
/** Opens a lab in the engine that has the fewest. */
export declare function openRemote(json: string, models: Calls["open"]["args"][1], state: Uint8Array | null): Promise<RemoteLab>;
