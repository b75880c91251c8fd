/** What the page asks its checker, and what it answers. */
import type { CheckedFinding, Completion, Fix, Hover, LabOfLesson, Report } from "labspec/checker";
import type { Models } from "labspec/slim";

/** Files that changed since the last question: a text or bytes, or `null` for one that is gone. */
export type FileChanges = Readonly<Record<string, string | Uint8Array | null>>;

/** The questions, with what each of them gives. */
export interface Answers {
  findings: CheckedFinding[];
  complete: readonly Completion[];
  hover: Hover | null;
  fixAll: Fix | null;
  labs: readonly LabOfLesson[];
  format: string;
  check: Report;
}

export type Question = keyof Answers;

/** Sent to the worker. */
export interface Request {
  readonly id: number;
  readonly question: Question;
  readonly path: string;
  readonly text: string;
  readonly offset: number;
  /** Changes of the models, which are made first. */
  readonly models: FileChanges;
}

/** Sent by the worker: that it is ready, or an answer. */
export type Reply =
  | { readonly ready: true }
  | { readonly id: number; readonly answer: Answers[Question] }
  | { readonly id: number; readonly error: string };

export type { CheckedFinding, Completion, Fix, Hover, LabOfLesson, Models, Report };
