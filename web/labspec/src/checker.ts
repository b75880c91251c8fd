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
  /** The same for this subject: `verified`, `refuted`, `made` … */
  readonly word: string;
  readonly remark: string;
}

/** A replacement of a part of a text. Offsets are those of JavaScript strings (UTF-16). */
export interface TextEdit {
  readonly start: number;
  readonly end: number;
  readonly text: string;
}

/** An edit that resolves a finding. */
export interface Fix {
  /** What it does. */
  readonly title: string;
  /** `safe`: it keeps the meaning, or is the only correction; `guess`: the author must confirm it; `suppression`: the author adds the reason. */
  readonly kind: "safe" | "guess" | "suppression";
  readonly edits: readonly TextEdit[];
}

/** A finding of the checker, with the edits that resolve it. */
export interface CheckedFinding extends Finding {
  readonly fixes: readonly Fix[];
}

/** The result of a check. */
export interface Report {
  readonly outcome: string;
  readonly findings: readonly CheckedFinding[];
  readonly entries: readonly Entry[];
}

/** What can be written at a place. */
export interface Completion {
  readonly label: string;
  readonly kind: "key" | "value" | "object" | "field" | "function" | "name" | "variable" | "constant" | "element" | "attribute";
  /** The signature, or the type of a value. */
  readonly detail: string;
  /** Markdown. */
  readonly documentation: string;
  /** What is compared with the text that is there, if it is not the label. */
  readonly filter: string | null;
  readonly edit: TextEdit;
}

/** The explanation of a part of a text. */
export interface Hover {
  readonly start: number;
  readonly end: number;
  /** Markdown. */
  readonly text: string;
}

/** A lab of a lesson. */
export interface LabOfLesson {
  /** `#2`: the second lab; `#quiz-id.1`: that of a question. */
  readonly address: string;
  readonly title: string;
  /** The name of its model; `null` if the model is part of the lab. */
  readonly model: string | null;
  readonly start: number;
  readonly end: number;
  /** Its JSON. */
  readonly json: string;
}

interface RawAssistant {
  labs(path: string, text: string): readonly LabOfLesson[];
  findings(path: string, text: string): readonly { fixes: readonly Fix[] }[];
  complete(path: string, text: string, offset: number): readonly Completion[];
  hover(path: string, text: string, offset: number): Hover | null;
  fixAll(path: string, text: string): Fix | null;
  format(path: string, text: string): string;
  free(): void;
}

interface CheckerGlue {
  readonly Assistant: new (models: object, neighbours: object) => RawAssistant;
  check(path: string, text: string, models: object, neighbours: object): { outcome: string; findings: readonly { fixes: readonly Fix[] }[]; entries: readonly Entry[] };
}

/** Checks lessons, labs and models: findings, verification of every claim, and what an editor shows. */
export class Checker {
  readonly #models: Record<string, string | Uint8Array>;
  #neighbours: Record<string, string> = {};
  #assistant: RawAssistant | undefined;

  constructor(models: Models = {}) {
    ready();
    this.#models = check.models(models);
  }

  /** With the lessons and snapshots that a lesson names, by path. */
  neighbours(texts: Readonly<Record<string, string>>): this {
    const own = check.models(texts);
    this.#neighbours = Object.fromEntries(Object.entries(own).map(([path, t]) => [path, check.text(t, `the text of ${path}`)]));
    this.free();
    return this;
  }

  /** Checks a lesson (Markdown or JSON, by the ending of `path`): its labs run, and every claim is verified. */
  check(path: string, lesson: string): Report {
    const [where, content] = [check.text(path, "a path"), check.text(lesson, "a lesson")];
    const texts = this.#texts(where, content);
    return call(() => {
      const report = glue().check(where, content, this.#models, this.#neighbours);
      return { outcome: report.outcome, entries: report.entries, findings: located(report.findings, texts) };
    }, texts);
  }

  /** The findings of a lesson, a lab as JSON, or a model (`.xml`) while it is written. Nothing is run; what did not change is not checked again. */
  findings(path: string, text: string): CheckedFinding[] {
    return this.#ask(path, text, (assistant, where, content, texts) => located(assistant.findings(where, content), texts));
  }

  /** What can be written at an offset, in the order of the reference. */
  complete(path: string, text: string, offset: number): readonly Completion[] {
    const at = check.count(offset, "an offset");
    return this.#ask(path, text, (assistant, where, content) => assistant.complete(where, content, at));
  }

  /** What is at an offset; values are those at the start of the lab. */
  hover(path: string, text: string, offset: number): Hover | null {
    const at = check.count(offset, "an offset");
    return this.#ask(path, text, (assistant, where, content) => assistant.hover(where, content, at));
  }

  /** All safe fixes of a text as one; each is verified. `null` if there is none. */
  fixAll(path: string, text: string): Fix | null {
    return this.#ask(path, text, (assistant, where, content) => assistant.fixAll(where, content));
  }

  /** The labs of a lesson, in order; those of questions after the others. */
  labs(path: string, text: string): readonly LabOfLesson[] {
    return this.#ask(path, text, (assistant, where, content) => assistant.labs(where, content));
  }

  /** The text with the code of its labs formatted. JSON and Markdown around it stay as they are. */
  format(path: string, text: string): string {
    return this.#ask(path, text, (assistant, where, content) => assistant.format(where, content));
  }

  /** Gives back the memory that findings and compiled models take. The checker can be used again. */
  free(): void {
    this.#assistant?.free();
    this.#assistant = undefined;
  }

  [Symbol.dispose](): void {
    this.free();
  }

  #ask<T>(path: string, text: string, what: (assistant: RawAssistant, path: string, text: string, texts: ReadonlyMap<string, string>) => T): T {
    const [where, content] = [check.text(path, "a path"), check.text(text, "a text")];
    const texts = this.#texts(where, content);
    return call(() => {
      this.#assistant ??= new (glue().Assistant)(this.#models, this.#neighbours);
      return what(this.#assistant, where, content, texts);
    }, texts);
  }

  /** All texts by the names that findings give them; the one that is checked comes first. */
  #texts(path: string, text: string): Map<string, string> {
    const texts = new Map<string, string>(Object.entries(this.#neighbours));
    for (const [name, model] of Object.entries(this.#models)) if (typeof model === "string") texts.set(name, model);
    return texts.set(path, text);
  }
}

function glue(): CheckerGlue {
  return ready() as unknown as CheckerGlue;
}

function located(raw: readonly { fixes: readonly Fix[] }[], texts: ReadonlyMap<string, string>): CheckedFinding[] {
  return locate(raw, texts).map((finding, i) => ({ ...finding, fixes: raw[i]?.fixes ?? [] }));
}
