import type { GivenModule } from "../worker-protocol.js";
import { LabWorker } from "../worker.js";
import { fetched } from "./load-browser.js";

/** Starts a worker. */
export function startWorker(): LabWorker {
  const module = fetched();
  const worker = new Worker(new URL("./worker-host.js", import.meta.url), { type: "module" });
  const port = {
    post: (message: unknown, transfer: readonly ArrayBuffer[]): void => worker.postMessage(message, [...transfer]),
    listen: (listener: (message: unknown) => void): void => {
      worker.onmessage = (e: MessageEvent<unknown>) => listener(e.data);
    },
  };
  const labs = new LabWorker(port, () => worker.terminate());
  module.then(
    (found) => worker.postMessage({ module: found } satisfies GivenModule),
    (e: unknown) => worker.postMessage({ module: undefined, why: e instanceof Error ? e.message : String(e) } satisfies GivenModule),
  );
  worker.onerror = (e) => labs.fail(`the worker failed: ${e.message || "its script cannot be loaded"}`);
  return labs;
}

export { LabspecError, type Finding } from "../error.js";
export * from "../worker.js";
