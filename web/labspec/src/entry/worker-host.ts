import { start } from "../glue.js";
import { serve } from "../worker-host.js";
import { fetched } from "./load-browser.js";

const scope = globalThis as unknown as {
  postMessage(message: unknown, transfer: ArrayBuffer[]): void;
  onmessage: ((e: MessageEvent<unknown>) => void) | null;
};
const port = {
  post: (message: unknown, transfer: readonly ArrayBuffer[]): void => scope.postMessage(message, [...transfer]),
  listen: (listener: (message: unknown) => void): void => {
    scope.onmessage = (e) => listener(e.data);
  },
};
serve(port, fetched().then((module) => {
  if (module === undefined) throw new Error("labspec.wasm is not beside the script of the worker: copy it there");
  start(module);
}));
