/** The quizzes of a page as one activity of a learning system: they share one state and one score. */
import { isObject } from "../spec.js";
import type { QuizAnswer } from "./xapi.js";

/** A quiz of the page, as the activity sees it. */
export interface GradedQuiz {
  /** The state that is stored: plain data. */
  readonly state: unknown;
  /** Right answers and questions that are graded. */
  readonly right: number;
  readonly count: number;
  /** Whether every question is answered. */
  readonly isAnswered: boolean;
}

/** All quizzes of the page together. */
export interface ActivityTotals {
  readonly right: number;
  readonly count: number;
  readonly isAnswered: boolean;
  readonly states: Readonly<Record<string, unknown>>;
}

/** A learning system that keeps the answers of a page. */
export interface Activity {
  /** Adds a quiz; gives what was stored of it, or null. */
  join(name: string, quiz: () => GradedQuiz): Promise<unknown>;
  /** Reports what was answered. */
  answered(detail: QuizAnswer): void;
  /** Reports the score of the page and its state. */
  report(): Promise<void>;
}

/** Adds up the quizzes that are open. Quizzes that are not keep their old state. */
export function addUp(quizzes: ReadonlyMap<string, () => GradedQuiz>, old: unknown): ActivityTotals {
  const all = [...quizzes].map(([name, quiz]) => [name, quiz()] as const);
  return {
    right: all.reduce((sum, [, quiz]) => sum + quiz.right, 0),
    count: all.reduce((sum, [, quiz]) => sum + quiz.count, 0),
    isAnswered: all.every(([, quiz]) => quiz.isAnswered),
    states: { ...(isObject(old) ? old : {}), ...Object.fromEntries(all.map(([name, { state }]) => [name, state])) },
  };
}

/** What was stored of one quiz. */
export function storedOf(states: unknown, name: string): unknown {
  return isObject(states) && Object.hasOwn(states, name) ? states[name] : null;
}
