/** The state of a lab as text: in the fragment of an address, or in a file. What comes from outside is checked before it is played. */
import { collect, fromAddressBase64, streamOf, toAddressBase64 } from "../bytes.js";

/** The engine plays a state again: so many steps at most, and so many things that a student did. */
const MOST_STEPS = 2_000_000;
const MOST_ACTIONS = 50_000;
/** Bytes of a state, and characters of it in a link. */
const MOST_BYTES = 4 << 20;
const MOST_CHARACTERS = 6000;

/** Why a state is refused. */
export class StateError extends Error {
  readonly reason: "damaged" | "too-long";

  constructor(reason: "damaged" | "too-long") {
    super(reason);
    this.reason = reason;
  }
}

/** A state as text of a link; `null` where it is too long for one. */
export async function encodeState(bytes: Uint8Array): Promise<string | null> {
  const packed = await collect(streamOf(bytes).pipeThrough(new CompressionStream("deflate-raw")), MOST_CHARACTERS);
  if (packed === null) return null;
  const text = toAddressBase64(packed);
  return text.length > MOST_CHARACTERS ? null : text;
}

/** The state of a link. */
export async function decodeState(text: string): Promise<Uint8Array> {
  const packed = text.length > MOST_CHARACTERS || text === "" ? null : fromAddressBase64(text);
  if (packed === null) throw new StateError("damaged");
  let bytes: Uint8Array | null;
  try {
    bytes = await collect(streamOf(packed).pipeThrough(new DecompressionStream("deflate-raw")), MOST_BYTES);
  } catch {
    throw new StateError("damaged");
  }
  if (bytes === null) throw new StateError("too-long");
  checkState(bytes);
  return bytes;
}

/** Refuses what is no state of a lab, or would take too long to play. Whose state it is, the engine says. */
export function checkState(bytes: Uint8Array): void {
  if (bytes.length > MOST_BYTES) throw new StateError("too-long");
  let content: unknown;
  try {
    content = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
  } catch {
    throw new StateError("damaged");
  }
  const state = (content as { labspec?: { actions?: unknown } } | null)?.labspec;
  const actions = state?.actions;
  if (!Array.isArray(actions)) throw new StateError("damaged");
  if (actions.length > MOST_ACTIONS) throw new StateError("too-long");
  let steps = 0;
  for (const action of actions as unknown[]) {
    if (!Array.isArray(action)) throw new StateError("damaged");
    const [what, count] = action as unknown[];
    if (what !== "play") continue;
    if (typeof count !== "number" || !Number.isSafeInteger(count) || count < 0) throw new StateError("damaged");
    steps += count;
  }
  if (steps > MOST_STEPS) throw new StateError("too-long");
}

/** The state of one lab in a fragment such as `#lab.drop=…&lab.2=…`. */
export function stateInFragment(fragment: string, key: string): string | null {
  for (const part of fragment.replace(/^#/, "").split("&")) {
    const at = part.indexOf("=");
    if (at > 0 && part.slice(0, at) === `lab.${encodeURIComponent(key)}`) return part.slice(at + 1);
  }
  return null;
}

/** A fragment with the state of one lab; the other parts stay, but for the name of a section. */
export function fragmentWith(fragment: string, key: string, state: string): string {
  const name = `lab.${encodeURIComponent(key)}`;
  const others = fragment.replace(/^#/, "").split("&").filter((part) => /^[\w.%-]+=/.test(part) && !part.startsWith(`${name}=`));
  return `#${[...others, `${name}=${state}`].join("&")}`;
}
