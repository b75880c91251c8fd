/** Where the answers of a quiz are kept, and who is told the score. */
import type { Activity } from "../grades/activity.js";
import type { QuizAnswer } from "../grades/xapi.js";
import { listOf } from "../spec.js";
import type { Card } from "./card.js";
import type { QuizSpec } from "./read.js";
import { readAnswer, type Stored } from "./store.js";

/** Right answers and questions that are graded. */
export interface Count {
  readonly right: number;
  readonly count: number;
}

export interface Grading {
  load(index: number): Stored | null;
  store(index: number, answer: Stored | null): void;
  /** The score of the stored answers. */
  begin(score: Count): void;
  /** Reports the score, and what was answered. */
  report(score: Count, answer: QuizAnswer | null): void;
}

export function countRight(cards: readonly (Card | null)[]): Count {
  const graded = cards.filter((card) => card?.isGraded === true);
  return { right: graded.filter((card) => card?.isRight === true).length, count: graded.length };
}

/** A quiz whose answers a learning system keeps. */
export async function joinActivity(spec: QuizSpec, activity: Activity): Promise<Grading> {
  const answers: (Stored | null)[] = spec.questions.map(() => null);
  let score: Count = { right: 0, count: 0 };
  // A question that cannot be read has no answer to wait for.
  const isAnswered = (): boolean => spec.questions.every(({ kind }, i) => kind === "broken" || (answers[i] ?? null) !== null);
  const stored = await activity.join(spec.id, () => ({ state: answers, ...score, isAnswered: isAnswered() }));
  listOf(stored).slice(0, answers.length).forEach((answer, i) => {
    answers[i] = readAnswer(answer);
  });
  return {
    load: (index) => answers[index] ?? null,
    store(index, answer) {
      answers[index] = answer;
    },
    begin(now) {
      score = now;
    },
    report(now, answer) {
      score = now;
      if (answer !== null) activity.answered(answer);
      void activity.report();
    },
  };
}
