/** The state of a lab as text: in the fragment of an address, or in a file. What comes from outside is checked before it is played. */

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
  const packed = await collect(streamOf(bytes).pipeThrough(new CompressionStream("deflate-raw")), MOST_BYTES);
  let binary = "";
  for (const byte of packed) binary += String.fromCharCode(byte);
  const text = btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return text.length > MOST_CHARACTERS ? null : text;
}

/** The state of a link. */
export async function decodeState(text: string): Promise<Uint8Array> {
  if (text.length > MOST_CHARACTERS || !/^[\w-]+$/.test(text)) throw new StateError("damaged");
  let bytes: Uint8Array;
  try {
    const binary = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    const packed = Uint8Array.from(binary, (c) => c.charCodeAt(0));
    bytes = await collect(streamOf(packed).pipeThrough(new DecompressionStream("deflate-raw")), MOST_BYTES);
  } catch (e) {
    throw e instanceof StateError ? e : new StateError("damaged");
  }
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

function streamOf(bytes: Uint8Array): ReadableStream<BufferSource> {
  return new Blob([bytes as BlobPart]).stream();
}

/** All bytes of a stream, up to a limit. */
async function collect(stream: ReadableStream<Uint8Array>, limit: number): Promise<Uint8Array> {
  const reader = stream.getReader();
  const parts: Uint8Array[] = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > limit) {
      await reader.cancel();
      throw new StateError("too-long");
    }
    parts.push(value);
  }
  const out = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
