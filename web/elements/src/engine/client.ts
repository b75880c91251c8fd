/** The end of the channel in the page: it starts engines and calls them. */
import type { Calls, Channel, Opened, Problem, Reply } from "./messages.js";

/** The engine of a build. */
export interface EngineSource {
  /** Addresses of the script of the worker. The first one that the page allows is used. */
  workerUrls(): readonly string[];
  /** The same program, for the page itself where a policy forbids workers. */
  serve(channel: Channel): void;
  /** The compiled module. */
  module(): Promise<WebAssembly.Module>;
}

/** An error of the engine. */
export class EngineError extends Error {
  readonly problem: Problem;

  constructor(problem: Problem) {
    super(problem.message);
    [this.name, this.problem] = ["EngineError", problem];
  }
}

/** Asks one engine. */
export type Ask = <Name extends keyof Calls>(lab: number, call: Name, ...args: Calls[Name]["args"]) => Promise<Calls[Name]["answer"]>;

/** A lab in an engine. */
export interface RemoteLab {
  readonly opened: Opened;
  ask<Name extends Exclude<keyof Calls, "open">>(call: Name, ...args: Calls[Name]["args"]): Promise<Calls[Name]["answer"]>;
}

const MOST_WORKERS = 3;
let source: EngineSource | undefined;
const engines: Promise<Ask>[] = [];
let compiled: Promise<WebAssembly.Module> | undefined;
let opened = 0;

/** Sets the engine of the build. Only the first call has an effect. */
export function setEngineSource(given: EngineSource): void {
  source ??= given;
}

/** Opens a lab in the engine that has the fewest. */
export async function openRemote(json: string, models: Calls["open"]["args"][1], state: Uint8Array | null): Promise<RemoteLab> {
  const ask = await engineOf(opened++);
  const answer = await ask(0, "open", json, models, state);
  return { opened: answer, ask: (call, ...args) => ask(answer.id, call, ...args) };
}

/** Starts the engine of the next lab while its content is still read. */
export function prepareEngine(): void {
  // The caller that opens a lab receives the error.
  engineOf(opened).catch(() => undefined);
}

function engineOf(lab: number): Promise<Ask> {
  const most = Math.max(1, Math.min(MOST_WORKERS, (navigator.hardwareConcurrency || 2) - 1));
  const slot = lab % most;
  return (engines[slot] ??= startEngine().catch((e: unknown) => {
    // The next lab tries again: the module may be available then.
    delete engines[slot];
    compiled = undefined;
    throw e;
  }));
}

async function startEngine(): Promise<Ask> {
  if (source === undefined) throw new Error("no engine was given to this page");
  const own = source;
  const module = (compiled ??= own.module());
  for (const url of own.workerUrls()) {
    const worker = await startWorker(url, module);
    if (worker !== undefined) return asking(worker);
  }
  const { port1, port2 } = new MessageChannel();
  own.serve(port1);
  await started(port2, await module);
  return asking(port2);
}

/** A worker; `undefined` where the page may have none. It loads while the module is compiled. */
async function startWorker(url: string, module: Promise<WebAssembly.Module>): Promise<Channel | undefined> {
  let worker: Worker;
  try {
    worker = new Worker(url);
  } catch {
    return undefined;
  }
  const failed = new Promise<undefined>((resolve) => {
    worker.onerror = (event) => {
      event.preventDefault();
      resolve(undefined);
    };
  });
  const ready = module.then((compiledModule) => started(worker, compiledModule)).then(() => worker);
  const first = await Promise.race([ready, failed]);
  if (first === undefined) ready.catch(() => undefined);
  return first;
}

/** Sends the module, and waits until the engine is ready. */
function started(channel: Channel, module: WebAssembly.Module): Promise<void> {
  return new Promise((resolve, reject) => {
    channel.onmessage = ({ data }: MessageEvent) => {
      if (data === "ready") resolve();
      else reject(new EngineError((data as { failed: Problem }).failed));
    };
    channel.postMessage({ module }, []);
  });
}

function asking(channel: Channel): Ask {
  const waiting = new Map<number, { resolve: (value: unknown) => void; reject: (e: Error) => void }>();
  let next = 1;
  channel.onmessage = ({ data }: MessageEvent) => {
    const { id, result, problem } = data as Reply;
    const entry = waiting.get(id);
    waiting.delete(id);
    if (problem === undefined) entry?.resolve(result);
    else entry?.reject(new EngineError(problem));
  };
  if (channel instanceof Worker) {
    channel.onerror = (event) => {
      const problem = { code: "worker", message: event.message, findings: [] };
      for (const { reject } of waiting.values()) reject(new EngineError(problem));
      waiting.clear();
    };
  }
  return <Name extends keyof Calls>(lab: number, call: Name, ...args: Calls[Name]["args"]) =>
    new Promise<Calls[Name]["answer"]>((resolve, reject) => {
      const id = next++;
      waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
      channel.postMessage({ id, lab, call, args }, []);
    });
}
