import { start } from "../glue.js";
import { serve } from "../worker-host.js";
import type { GivenModule } from "../worker-protocol.js";

const scope = globalThis as unknown as {
  postMessage(message: unknown, transfer: ArrayBuffer[]): void;
  onmessage: ((e: MessageEvent<unknown>) => void) | null;
};
let take: (given: GivenModule) => void = () => undefined;
const given = new Promise<GivenModule>((resolve) => {
  take = resolve;
});
const port = {
  post: (message: unknown, transfer: readonly ArrayBuffer[]): void => scope.postMessage(message, [...transfer]),
  listen: (listener: (message: unknown) => void): void => {
    // The page gives the module once, and asks before and after.
    scope.onmessage = ({ data }) => (typeof data === "object" && data !== null && "module" in data ? take(data as GivenModule) : listener(data));
  },
};
serve(port, given.then(({ module, why }) => {
  if (module === undefined) throw new Error(why ?? "labspec.wasm is not beside the script of the worker: copy it there");
  start(module);
}));
