/** Everything in one file: the elements, their styles, the engine and its module. */
import { serve } from "#engine";
import text from "#module";
import { fromBase64 } from "../bytes.js";
import { setEngineSource } from "../engine/client.js";
import { defineElements } from "./define.js";
import { render } from "./widget.js";

export * from "./define.js";
export default { render };

setEngineSource({
  serve,
  workerUrls: () => [URL.createObjectURL(new Blob([`(${serve.toString()})(self)`], { type: "text/javascript" }))],
  module() {
    const bytes = new Blob([fromBase64(text) as BlobPart]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compileStreaming(new Response(bytes, { headers: { "content-type": "application/wasm" } }));
  },
});
defineElements();
