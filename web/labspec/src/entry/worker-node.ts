import { Worker } from "node:worker_threads";
import { LabWorker } from "../worker.js";

/** Starts a worker. */
export function startWorker(): LabWorker {
  // Options of the program itself, such as `--eval`, are not for the worker.
  const worker = new Worker(new URL("./worker-host-node.js", import.meta.url), { execArgv: [] });
  // A program ends when nothing else is left to do.
  worker.unref();
  let open = 0;
  const port = {
    post: (message: unknown, transfer: readonly ArrayBuffer[]): void => {
      worker.postMessage(message, [...transfer]);
      if (open++ === 0) worker.ref();
    },
    listen: (listener: (message: unknown) => void): void => {
      worker.on("message", (message: unknown) => {
        if (--open === 0) worker.unref();
        listener(message);
      });
    },
  };
  const labs = new LabWorker(port, () => void worker.terminate());
  worker.on("error", (e: Error) => labs.fail(`the worker failed: ${e.message}`));
  return labs;
}

export { LabspecError, type Finding } from "../error.js";
export * from "../worker.js";
