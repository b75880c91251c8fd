/** Made by build.mjs: the engine as one function, which uses nothing outside it, so that its text is also a worker's script. */
declare module "#engine" {
  import type { Channel } from "../engine/messages.js";
  export function serve(channel: Channel): void;
}

/** Made by build.mjs: the compressed module in base64. */
declare module "#module" {
  const text: string;
  export default text;
}
