/** The state of a lab as text: in the fragment of an address, or in a file. What comes from outside is checked before it is played. */
/** Why a state is refused. */
export declare class StateError extends Error {
    readonly reason: "damaged" | "too-long";
    constructor(reason: "damaged" | "too-long");
}
/** A state as text of a link; `null` where it is too long for one. */
export declare function encodeState(bytes: Uint8Array): Promise<string | null>;
/** The state of a link. */
export declare function decodeState(text: string): Promise<Uint8Array>;
/** Refuses what is no state of a lab, or would take too long to play. Whose state it is, the engine says. */
export declare function checkState(bytes: Uint8Array): void;
/** The state of one lab in a fragment such as `#lab.drop=…&lab.2=…`. */
export declare function stateInFragment(fragment: string, key: string): string | null;
/** A fragment with the state of one lab; the other parts stay. */
export declare function fragmentWith(fragment: string, key: string, state: string): string;
