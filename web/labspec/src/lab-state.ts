import type { ControlValue, Models } from "./lab-types.js";
import { STATE, weight } from "./weight.js";
import type { State as RawState } from "#glue";

/** An action of a student, which can be repeated. */
export type Action = readonly ["play", number] | readonly ["set", string, ControlValue] | readonly ["press", string] | readonly ["reset"]
  | readonly ["force", number, readonly number[]];

/** The format of saved states. */
export const FORMAT = 1;

/** A saved state of a lab. */
export class LabState {
  readonly #raw: RawState;
  readonly #actions: readonly Action[];
  readonly #lab: string;
  readonly #weight = weight(STATE);

  /** @internal */
  constructor(raw: RawState, actions: readonly Action[], lab: string) {
    [this.#raw, this.#actions, this.#lab] = [raw, actions, lab];
  }

  /** @internal */
  static parts(state: LabState): { raw: RawState; actions: readonly Action[] } {
    return { raw: state.#raw, actions: state.#actions };
  }

  /** The state as bytes, for `Lab.resume`: all actions since the lab was opened. */
  toBytes(): Uint8Array {
    const content = { format: FORMAT, lab: this.#lab, actions: this.#actions };
    void this.#weight;
    return new TextEncoder().encode(JSON.stringify({ labspec: content }));
  }
}

/** A number for the texts of a lab. */
export function fingerprint(json: string, models: Models): string {
  let [a, b] = [0x811c9dc5, 0x1b873593];
  const take = (code: number): void => {
    a = Math.imul(a ^ code, 0x01000193);
    b = Math.imul(b + code, 0x85ebca6b) ^ (b >>> 13);
  };
  const feed = (part: string | Uint8Array): void => {
    if (typeof part === "string") for (let i = 0; i < part.length; i++) take(part.charCodeAt(i));
    else part.forEach(take);
    take(0x10000);
  };
  feed(json);
  Object.keys(models).sort().forEach((name) => {
    feed(name);
    feed(models[name] ?? "");
  });
  return (a >>> 0).toString(16).padStart(8, "0") + (b >>> 0).toString(16).padStart(8, "0");
}
