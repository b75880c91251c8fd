import * as glue from "#glue";
import { LabspecError } from "./error.js";
import { markReady } from "./state.js";

let memory: WebAssembly.Memory | undefined;

/** The reason that the module is missing, if an entry knows it. */
let missing = "import it from an entry that loads it, or call `init` and wait for it";

export function notReady(why: string): void {
  missing = why;
}

/** The module, when it is ready. */
export function ready(): typeof glue {
  if (memory === undefined) throw new LabspecError("not-ready", `labspec is not ready: ${missing}`);
  return glue;
}

/** The memory of the module. It has a new buffer after it has grown. */
export function buffer(): ArrayBuffer {
  ready();
  return (memory as WebAssembly.Memory).buffer;
}

/** Makes the module ready from its compiled form. */
export function start(module: WebAssembly.Module): void {
  if (memory !== undefined) return;
  memory = glue.initSync({ module }).memory;
  markReady();
}

/** A number of the module's format, and where the next byte is. */
function unsigned(bytes: Uint8Array, at: number): [number, number] {
  let [value, shift] = [0, 0];
  for (;;) {
    const byte = bytes[at++] ?? 0;
    value += (byte & 0x7f) * 2 ** shift;
    if (byte < 0x80 || shift > 28) return [value, at];
    shift += 7;
  }
}

function encoded(value: number): number[] {
  const out: number[] = [];
  do {
    const low = value & 0x7f;
    value >>>= 7;
    out.push(value > 0 ? low | 0x80 : low);
  } while (value > 0);
  return out;
}

/** The module with a limit of its memory: the fifth section says how many pages it has. */
export function limited(bytes: Uint8Array, maximum: number): Uint8Array {
  let at = 8;
  while (at < bytes.length) {
    const id = bytes[at];
    const [size, body] = unsigned(bytes, at + 1);
    if (id === 5) {
      const [, flags] = unsigned(bytes, body);
      const [initial] = unsigned(bytes, flags + 1);
      const pages = Math.max(initial, Math.min(65536, Math.floor(maximum / 65536)));
      const inside = [1, 1, ...encoded(initial), ...encoded(pages)];
      const section = [5, ...encoded(inside.length), ...inside];
      const out = new Uint8Array(at + section.length + (bytes.length - body - size));
      out.set(bytes.subarray(0, at));
      out.set(section, at);
      out.set(bytes.subarray(body + size), at + section.length);
      return out;
    }
    at = body + size;
  }
  return bytes;
}
