/** Statements of the Experience API (xAPI 1.0.3) about answers. The page sends them: the elements have no network of their own. */

/** The detail of an event `quiz-answer`. */
export interface QuizAnswer {
  readonly quiz: string;
  readonly index: number;
  readonly kind: string;
  readonly answer: string | readonly number[];
  /** null for questions that are not graded. */
  readonly correct: boolean | null;
  readonly attempt: number;
  readonly done: boolean;
}

export interface StatementOptions {
  /** Who answered, as xAPI describes an agent. */
  readonly actor: object;
  /** The address of the lesson; the id of a question is this with `#quiz.number`. The address of the page when not given. */
  readonly activity?: string;
  /** When, as ISO 8601; now when not given. */
  readonly timestamp?: string;
  /** The text of the question. */
  readonly name?: string;
}

const INTERACTIONS: Readonly<Record<string, string>> = {
  mcq: "choice", debug: "choice", predict: "choice", multiple: "choice", truefalse: "true-false", numeric: "numeric", open: "long-fill-in", code: "long-fill-in",
};

/** An answer as xAPI writes it: options joined by `[,]`, `true` or `false`, or the text. */
function responseOf({ kind, answer }: QuizAnswer): string {
  if (typeof answer === "string") return kind === "numeric" ? answer.trim().replace(",", ".") : answer;
  return kind === "truefalse" ? String(answer[0] === 0) : answer.join("[,]");
}

/** The statement about an answer. It does not say which answer is right. */
export function toXapi(detail: QuizAnswer, options: StatementOptions): object {
  const { correct } = detail;
  const activity = (options.activity ?? location.href).split("#")[0] ?? "";
  return {
    actor: options.actor,
    verb: { id: "http://adlnet.gov/expapi/verbs/answered", display: { "en-US": "answered" } },
    object: {
      objectType: "Activity",
      id: `${activity}#${encodeURIComponent(detail.quiz)}.${detail.index + 1}`,
      definition: {
        type: "http://adlnet.gov/expapi/activities/cmi.interaction", interactionType: INTERACTIONS[detail.kind] ?? "other",
        ...(options.name === undefined ? {} : { description: { und: options.name } }),
      },
    },
    result: {
      response: responseOf(detail), completion: detail.done,
      ...(correct === null ? {} : { success: correct, score: { scaled: correct ? 1 : 0 } }),
    },
    context: { contextActivities: { parent: [{ objectType: "Activity", id: activity }] }, extensions: { "https://labspec.dev/xapi/attempt": detail.attempt } },
    timestamp: options.timestamp ?? new Date().toISOString(),
  };
}
