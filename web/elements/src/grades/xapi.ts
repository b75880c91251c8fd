/** Statements of the Experience API (xAPI 1.0.3) about answers. The page sends them: the elements have no network of their own. */

/** Characters of a quiz's id in the id of a question; learning systems take 4000 with all escapes. */
const MOST_ID = 250;

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

/** The id of a question within its page, as a part of an address. */
export function questionId({ quiz, index }: Pick<QuizAnswer, "quiz" | "index">): string {
  // An address has no half characters.
  return `${encodeURIComponent(quiz.slice(0, MOST_ID).replace(/\p{Surrogate}/gu, "\ufffd"))}.${index + 1}`;
}

/** Interaction types of SCORM and of the Experience API. */
export const INTERACTIONS: Readonly<Record<string, string>> = {
  mcq: "choice", debug: "choice", predict: "choice", multiple: "choice", truefalse: "true-false", numeric: "numeric", open: "long-fill-in", code: "long-fill-in",
};

/** An answer as xAPI writes it: options joined by `[,]`, `true` or `false`, or the text. */
export function responseOf({ kind, answer }: QuizAnswer): string {
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
      id: `${activity}#${questionId(detail)}`,
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
