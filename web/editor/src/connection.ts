/** One worker with a checker: questions wait until it is ready, and fail with a reason where it cannot be. */
import type { Answers, FileChanges, Models, Question, Reply, Request } from "./protocol.js";

interface Waiting {
  resolve(answer: Answers[Question]): void;
  reject(e: Error): void;
}

/** Why a question has no answer. */
export class CheckerError extends Error {}

export class Connection {
  readonly #worker: Worker;
  readonly #waiting = new Map<number, Waiting>();
  /** What is sent when the worker is ready; `null` afterwards. */
  #queue: Request[] | null = [];
  #sent: Models = {};
  #failure: CheckerError | null = null;
  #last = 0;

  constructor(worker: Worker) {
    this.#worker = worker;
    worker.onmessage = ({ data }: MessageEvent<Reply>) => this.#receive(data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.close(event.message || "its script cannot be loaded");
    };
  }

  get isClosed(): boolean { return this.#failure !== null; }

  ask<Q extends Question>(question: Q, models: Models, path: string, text: string, offset = 0): Promise<Answers[Q]> {
    if (this.#failure !== null) return Promise.reject(this.#failure);
    const id = ++this.#last;
    const request: Request = { id, question, path, text, offset, models: changesBetween(this.#sent, models) };
    this.#sent = models;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve: resolve as Waiting["resolve"], reject });
      if (this.#queue === null) this.#worker.postMessage(request);
      else this.#queue.push(request);
    });
  }

  /** Ends the worker; what was asked has no answer. */
  close(why = "it was closed"): void {
    if (this.#failure !== null) return;
    this.#failure = new CheckerError(`the checker does not answer: ${why}`);
    this.#worker.terminate();
    for (const { reject } of this.#waiting.values()) reject(this.#failure);
    this.#waiting.clear();
  }

  #receive(reply: Reply): void {
    if ("ready" in reply) {
      for (const request of this.#queue ?? []) this.#worker.postMessage(request);
      this.#queue = null;
      return;
    }
    const waiting = this.#waiting.get(reply.id);
    this.#waiting.delete(reply.id);
    if ("error" in reply) waiting?.reject(new CheckerError(reply.error));
    else waiting?.resolve(reply.answer);
  }
}

/** What turns some files into others. */
function changesBetween(before: Models, after: Models): FileChanges {
  const changes: Record<string, string | Uint8Array | null> = {};
  for (const name of Object.keys(before)) if (!Object.hasOwn(after, name)) changes[name] = null;
  for (const [name, content] of Object.entries(after)) if (before[name] !== content) changes[name] = content;
  return changes;
}
