/** Fetches and compiles the module beside this file; `undefined` if it is missing. */
export async function fetched(signal?: AbortSignal): Promise<WebAssembly.Module | undefined> {
  try {
    const response = await fetch(new URL("./labspec.wasm", import.meta.url), signal === undefined ? {} : { signal });
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
