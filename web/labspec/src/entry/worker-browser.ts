import { LabWorker } from "../worker.js";

/** Starts a worker. */
export function startWorker(): LabWorker {
  const worker = new Worker(new URL("./worker-host.js", import.meta.url), { type: "module" });
  const port = {
    post: (message: unknown, transfer: readonly ArrayBuffer[]): void => worker.postMessage(message, [...transfer]),
    listen: (listener: (message: unknown) => void): void => {
      worker.onmessage = (e: MessageEvent<unknown>) => listener(e.data);
    },
  };
  const labs = new LabWorker(port, () => worker.terminate());
  worker.onerror = (e) => labs.fail(`the worker failed: ${e.message || "its script cannot be loaded"}`);
  return labs;
}

export { LabspecError, type Finding } from "../error.js";
export * from "../worker.js";
