/** The checker of a page: one worker answers while an author types, another one runs labs. */
import { CheckerError, Connection } from "./connection.js";
import type { Answers, Models, Question, Report } from "./protocol.js";

export { CheckerError } from "./connection.js";

/** Starts a worker whose script is `labspec-editor/worker`. */
export type StartWorker = () => Worker;

export class CheckerClient {
  readonly #start: StartWorker;
  #typing: Connection | null = null;
  #running: Connection | null = null;
  #models: Models = {};
  readonly #listeners = new Set<() => void>();

  constructor(start: StartWorker) {
    this.#start = start;
  }

  /** The models of the labs, and their files. */
  get models(): Models { return this.#models; }
  set models(models: Models) {
    this.#models = models;
    for (const listener of this.#listeners) listener();
  }

  /** Calls `listener` when the models change; returns a function that ends this. */
  watch(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  ask<Q extends Exclude<Question, "check">>(question: Q, path: string, text: string, offset = 0): Promise<Answers[Q]> {
    if (this.#typing === null || this.#typing.isClosed) this.#typing = this.#connect();
    return this.#typing.ask(question, this.#models, path, text, offset);
  }

  /** Runs the labs of a lesson and verifies its claims. A check that is still running is ended: its promise is refused. */
  async check(path: string, text: string): Promise<Report> {
    if (this.#running !== null && this.#isBusy) this.#running.close("a newer text is checked");
    if (this.#running === null || this.#running.isClosed) this.#running = this.#connect();
    const turn = ++this.#turn;
    this.#isBusy = true;
    try {
      return await this.#running.ask("check", this.#models, path, text);
    } finally {
      if (turn === this.#turn) this.#isBusy = false;
    }
  }

  #isBusy = false;
  #turn = 0;

  dispose(): void {
    this.#typing?.close();
    this.#running?.close();
    this.#listeners.clear();
  }

  #connect(): Connection {
    try {
      return new Connection(this.#start());
    } catch (e) {
      throw new CheckerError(`the checker does not start: ${e instanceof Error ? e.message : String(e)}`);
    }
  }
}
