import { readFileSync } from "node:fs";
import { notReady, start } from "../glue.js";
import { isReady } from "../state.js";

/** Reads and compiles the module that lies beside this file. */
export function load(): void {
  if (isReady()) return;
  try {
    start(new WebAssembly.Module(readFileSync(new URL("./labspec.wasm", import.meta.url))));
  } catch (e) {
    notReady(`labspec.wasm cannot be read beside the script (${e instanceof Error ? e.message : String(e)}); copy it there, or use \`labspec/slim\``);
  }
}
