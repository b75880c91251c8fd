import { load } from "./load-browser.js";
import { serve } from "../worker-host.js";

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
serve(port, load());
