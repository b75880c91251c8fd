import { start } from "../glue.js";
import { isReady } from "../state.js";

/** Fetches and compiles the module that lies beside this file; `undefined` where it is not there. */
async function fetched(): Promise<WebAssembly.Module | undefined> {
  try {
    const response = await fetch(new URL("./labspec.wasm", import.meta.url));
    if (!response.ok) return undefined;
    // A server that does not know the type of the file sends it as another one.
    if (response.headers.get("content-type")?.startsWith("application/wasm") === true) return await WebAssembly.compileStreaming(response);
    const bytes = await response.arrayBuffer();
    return WebAssembly.validate(bytes) ? await WebAssembly.compile(bytes) : undefined;
  } catch (e) {
    // A policy that forbids WebAssembly would forbid it in another form as well.
    if (e instanceof WebAssembly.CompileError) throw e;
    return undefined;
  }
}

/** Makes the module ready; `inlined` gives it where a bundler has left the file behind. */
export async function load(inlined?: () => Promise<WebAssembly.Module>): Promise<void> {
  if (isReady()) return;
  const module = (await fetched()) ?? (await inlined?.());
  if (module === undefined) throw new Error("labspec.wasm is not beside the script: copy it there, or use `labspec/slim`");
  start(module);
}
