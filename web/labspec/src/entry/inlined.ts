import { compilePacked } from "../packed.js";

/** The module that is part of the package's scripts, for pages and programs that cannot fetch it. */
export async function inlined(): Promise<WebAssembly.Module> {
  return compilePacked(await import("./inline-module.js"));
}
