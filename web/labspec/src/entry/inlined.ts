import { fromBase64 } from "../glue.js";

/** The module as it is inlined: compressed, in base64. */
export async function inlined(): Promise<WebAssembly.Module> {
  const { default: text } = await import("./inline-module.js");
  const stream = new Blob([fromBase64(text) as BlobPart]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}
