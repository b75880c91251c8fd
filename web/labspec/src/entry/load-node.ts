import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { notReady, start } from "../glue.js";
import { isReady } from "../state.js";

/** The file of the module as a bundler has put it beside its bundle, or else as it lies in the package. */
const FILES = [
  (): URL => new URL("./labspec.wasm", import.meta.url),
  (): string => join(dirname(fileURLToPath(import.meta.url)), "labspec.wasm"),
];

/** Reads and compiles the module that lies beside this file. */
export function load(): void {
  let why: unknown;
  for (const file of FILES) {
    if (isReady()) return;
    try {
      start(new WebAssembly.Module(readFileSync(file())));
    } catch (e) {
      why ??= e;
    }
  }
  if (isReady()) return;
  notReady(`labspec.wasm cannot be read beside the script (${why instanceof Error ? why.message : String(why)}); copy it there, or use \`labspec/slim\``);
}
