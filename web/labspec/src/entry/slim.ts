import { call, LabspecError } from "../error.js";
import { limited, start } from "../glue.js";
import { isReady, type InitOptions } from "../state.js";

/** The argument of `init`: the bytes of `labspec.wasm`, its compiled form, or its address. */
export type Source = Uint8Array | ArrayBuffer | WebAssembly.Module | Response | URL | string;

/** Makes the module ready. */
export async function init(source: Source | Promise<Source>, options: InitOptions = {}): Promise<void> {
  if (isReady()) return;
  let given = await source;
  if (typeof given === "string" || given instanceof URL) given = await fetch(given);
  if (typeof Response !== "undefined" && given instanceof Response) {
    if (!given.ok) throw new LabspecError("not-ready", `the module cannot be fetched: ${given.status} ${given.statusText}`);
    given = await given.arrayBuffer();
  }
  if (given instanceof WebAssembly.Module) return initSync(given, options);
  const bytes = limit(given as Uint8Array | ArrayBuffer, options);
  let module: WebAssembly.Module;
  try {
    module = await WebAssembly.compile(bytes as BufferSource);
  } catch (e) {
    throw new LabspecError("not-ready", `the module cannot be compiled: ${e instanceof Error ? e.message : String(e)}`);
  }
  start(module);
}

/** Makes the module ready at once, where the host compiles large modules at once: not on the main thread of a page. */
export function initSync(source: Uint8Array | ArrayBuffer | WebAssembly.Module, options: InitOptions = {}): void {
  if (isReady()) return;
  const module = source instanceof WebAssembly.Module ? source : call(() => new WebAssembly.Module(limit(source, options) as BufferSource));
  start(module);
}

function limit(source: Uint8Array | ArrayBuffer, { maximumMemory }: InitOptions): Uint8Array {
  if (!(source instanceof Uint8Array) && !(source instanceof ArrayBuffer)) {
    throw new LabspecError("wrong-type", "`init` takes the bytes of labspec.wasm, its compiled form, a Response or a URL");
  }
  const bytes = source instanceof Uint8Array ? source : new Uint8Array(source);
  return maximumMemory === undefined ? bytes : limited(bytes, maximumMemory);
}

export * from "../api.js";
