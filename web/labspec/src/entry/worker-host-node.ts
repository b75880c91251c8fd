import { parentPort } from "node:worker_threads";
import { load } from "./load-node.js";
import { serve } from "../worker-host.js";

load();
const port = {
  post: (message: unknown, transfer: readonly ArrayBuffer[]): void => parentPort?.postMessage(message, [...transfer]),
  listen: (listener: (message: unknown) => void): void => void parentPort?.on("message", listener),
};
serve(port, Promise.resolve());
