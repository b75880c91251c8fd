/** Made by build.mjs: the engine as one function without references to other code. Its text is also the script of a worker. */
declare module "#engine" {
  import type { Channel } from "../engine/messages.js";
  export function serve(channel: Channel): void;
}

/** Made by build.mjs: the module, which is part of the script. */
declare module "#module" {
  export function compile(): Promise<WebAssembly.Module>;
}
