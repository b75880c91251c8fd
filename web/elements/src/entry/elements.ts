/** The elements with the module and the worker in files of their own, beside this one. */
import { serve } from "#engine";
import { setEngineSource } from "../engine/client.js";
import { defineElements } from "./define.js";
import { render } from "./widget.js";

export * from "./define.js";
export default { render };

setEngineSource({
  serve,
  get workerUrl() { return new URL("./engine.js", import.meta.url).href; },
  async module() {
    const response = await fetch(new URL("./labspec.wasm", import.meta.url));
    if (!response.ok) throw new Error(`labspec.wasm is not beside the script: ${response.status}`);
    const isTyped = response.headers.get("content-type")?.startsWith("application/wasm") === true;
    return isTyped ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
  },
});
defineElements();
