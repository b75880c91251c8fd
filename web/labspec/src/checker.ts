import * as check from "./arguments.js";
import { call, locate, type Finding } from "./error.js";
import { ready } from "./glue.js";
import type { Models } from "./lab-types.js";

/** A claim of a lesson, and its result. */
export interface Entry {
  readonly owner: string;
  readonly subject: string;
  /** `true`, `false`, `unchecked`, `left out`, `known` or `not claimed`. */
  readonly state: string;
  readonly word: string;
  readonly remark: string;
}

/** The result of a check. */
export interface Report {
  readonly outcome: string;
  readonly findings: readonly Finding[];
  readonly entries: readonly Entry[];
}

/** Checks lessons: lint, and verification of every claim. */
export class Checker {
  readonly #models: Record<string, string | Uint8Array>;
  #neighbours: Record<string, string> = {};

  constructor(models: Models = {}) {
    ready();
    this.#models = check.models(models);
  }

  /** With the lessons and snapshots that a lesson names, by path. */
  neighbours(texts: Readonly<Record<string, string>>): this {
    const own = check.models(texts);
    this.#neighbours = Object.fromEntries(Object.entries(own).map(([path, t]) => [path, check.text(t, `the text of ${path}`)]));
    return this;
  }

  /** Checks a lesson (Markdown or JSON, by the ending of `path`). */
  check(path: string, lesson: string): Report {
    const [where, content] = [check.text(path, "a path"), check.text(lesson, "a lesson")];
    const texts = new Map<string, string>([[where, content], ...Object.entries(this.#neighbours)]);
    for (const [name, model] of Object.entries(this.#models)) if (typeof model === "string") texts.set(name, model);
    const glue = ready() as unknown as { check(...args: unknown[]): Report };
    return call(() => {
      const report = glue.check(where, content, this.#models, this.#neighbours);
      return { outcome: report.outcome, entries: report.entries, findings: locate(report.findings, texts) };
    }, texts);
  }
}
