/** The end of the channel in the page: it starts engines and calls them. */
import type { Calls, Channel, Opened, Problem, Reply } from "./messages.js";

/** The engine of a build. */
export interface EngineSource {
  /** The address of the script of the worker, where it is a file. */
  readonly workerUrl: string | null;
  /** The same program: its text is the script where there is no file, and it runs in the page itself where a policy forbids workers. */
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

/** A running engine, with the number of its labs. */
interface Engine {
  readonly ask: Promise<Ask>;
  labs: number;
}

const MOST_WORKERS = 3;
let source: EngineSource | undefined;
const engines = new Set<Engine>();
let compiled: Promise<WebAssembly.Module> | undefined;

/** Sets the engine of the build. Only the first call has an effect. */
export function setEngineSource(given: EngineSource): void {
  source ??= given;
}

/** Opens a lab in the engine that has the fewest. */
export async function openRemote(json: string, models: Calls["open"]["args"][1], state: Uint8Array | null): Promise<RemoteLab> {
  const engine = engineOfNextLab();
  engine.labs += 1;
  try {
    const ask = await engine.ask;
    const opened = await ask(0, "open", json, models, state);
    return {
      opened,
      ask(call, ...args) {
        if (call === "free") engine.labs -= 1;
        return ask(opened.id, call, ...args);
      },
    };
  } catch (e) {
    engine.labs -= 1;
    throw e;
  }
}

/** Starts the engine of the next lab while its content is still read. */
export function prepareEngine(): void {
  // The caller that opens a lab receives the error.
  engineOfNextLab().ask.catch(() => undefined);
}

function engineOfNextLab(): Engine {
  const most = Math.max(1, Math.min(MOST_WORKERS, (navigator.hardwareConcurrency || 2) - 1));
  const [emptiest] = [...engines].sort((a, b) => a.labs - b.labs);
  if (emptiest !== undefined && (emptiest.labs === 0 || engines.size >= most)) return emptiest;
  // The next lab starts another engine in place of a failed one: the module may be available then.
  const forget = (): void => void engines.delete(engine);
  const ask = startEngine(forget).catch((e: unknown) => {
    forget();
    compiled = undefined;
    throw e;
  });
  const engine: Engine = { ask, labs: 0 };
  engines.add(engine);
  return engine;
}

async function startEngine(failed: () => void): Promise<Ask> {
  if (source === undefined) throw new Error("no engine was given to this page");
  const engineSource = source;
  const module = (compiled ??= engineSource.module());
  for (const url of workerUrls(engineSource)) {
    const worker = await startWorker(url, module);
    if (worker !== undefined) return createCaller(worker, failed);
  }
  const { port1, port2 } = new MessageChannel();
  engineSource.serve(port1);
  await started(port2, await module);
  return createCaller(port2, failed);
}

/** Addresses of the script of the worker. The first one that the page allows is used; each exists until the next one is asked for. */
function* workerUrls({ workerUrl, serve }: EngineSource): Generator<string, void> {
  if (workerUrl !== null) yield workerUrl;
  // A script of another origin cannot be a worker, but its text can.
  const url = URL.createObjectURL(new Blob([`(${serve.toString()})(self)`], { type: "text/javascript" }));
  try {
    yield url;
  } finally {
    URL.revokeObjectURL(url);
  }
}

/** A worker; `undefined` where the page may have none. It loads while the module is compiled. */
async function startWorker(url: string, module: Promise<WebAssembly.Module>): Promise<Worker | undefined> {
  let worker: Worker;
  try {
    worker = new Worker(url);
  } catch {
    return undefined;
  }
  const failed = new Promise<false>((resolve) => {
    worker.onerror = (event) => {
      event.preventDefault();
      resolve(false);
    };
  });
  let isReady = false;
  try {
    isReady = await Promise.race([module.then((compiledModule) => started(worker, compiledModule)), failed]);
  } finally {
    if (!isReady) worker.terminate();
  }
  return isReady ? worker : undefined;
}

/** Sends the module, and waits until the engine is ready. */
function started(channel: Channel, module: WebAssembly.Module): Promise<true> {
  return new Promise((resolve, reject) => {
    channel.onmessage = ({ data }: MessageEvent) => {
      if (data === "ready") resolve(true);
      else reject(new EngineError((data as { failed: Problem }).failed));
    };
    channel.postMessage({ module }, []);
  });
}

/** Calls an engine. After an error of its worker, all calls are rejected, and `failed` is called. */
function createCaller(channel: Channel, failed: () => void): Ask {
  const waiting = new Map<number, { resolve: (value: unknown) => void; reject: (e: Error) => void }>();
  let next = 1;
  let failure: EngineError | undefined;
  channel.onmessage = ({ data }: MessageEvent) => {
    const { id, result, problem } = data as Reply;
    const entry = waiting.get(id);
    waiting.delete(id);
    if (problem === undefined) entry?.resolve(result);
    else entry?.reject(new EngineError(problem));
  };
  if (channel instanceof Worker) {
    channel.onerror = ({ message }) => {
      failure = new EngineError({ code: "worker", message: message || "the worker failed", findings: [] });
      for (const { reject } of waiting.values()) reject(failure);
      waiting.clear();
      channel.terminate();
      failed();
    };
  }
  return <Name extends keyof Calls>(lab: number, call: Name, ...args: Calls[Name]["args"]) =>
    new Promise<Calls[Name]["answer"]>((resolve, reject) => {
      if (failure !== undefined) return reject(failure);
      const id = next++;
      waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
      channel.postMessage({ id, lab, call, args }, []);
    });
}
