/** Made by build.mjs: the engine as one function without references to other code. Its text is also the script of a worker. */
declare module "#engine" {
  import type { Channel } from "../engine/messages.js";
  export function serve(channel: Channel): void;
}

/** Made by build.mjs: the compressed module in base64. */
declare module "#module" {
  const text: string;
  export default text;
}
