/**
 * Grades for a learning system that holds the page in a frame: the messages of SPLICE (https://cssplice.org). The page is one activity; its
 * quizzes share one state and one score.
 */
import { isObject, type Json } from "../spec.js";
import { addUp, storedOf, type Activity, type GradedQuiz } from "./activity.js";

/** Milliseconds that a learning system has to answer. */
const PATIENCE = 2000;
const RESPONSE = "SPLICE.getState.response";

const quizzes = new Map<string, () => GradedQuiz>();
let before: Promise<Json> | undefined;
let messages = 0;

/** A message to the page around this one; without a frame there is none. */
function send(message: Readonly<Record<string, unknown>>): string {
  const id = `labspec-${Date.now().toString(36)}-${++messages}`;
  if (window.parent !== window) window.parent.postMessage({ ...message, message_id: id }, parentOrigin());
  return id;
}

/** The origin of the page around this one. Not all browsers tell it; then the message, which has only the answers of this reader, has no target. */
function parentOrigin(): string {
  const ancestor = (location as { ancestorOrigins?: ArrayLike<string> }).ancestorOrigins?.[0];
  return ancestor === undefined || ancestor === "null" ? "*" : ancestor;
}

/** The state that the learning system has of this page; empty where it has none, or does not answer. It is asked once. */
function storedState(): Promise<Json> {
  return (before ??= new Promise((resolve) => {
    if (window.parent === window) return resolve({});
    const finish = (state: unknown): void => {
      clearTimeout(timer);
      removeEventListener("message", listen);
      resolve(isObject(state) ? state : {});
    };
    const listen = ({ source, data }: MessageEvent<unknown>): void => {
      const isAnswer = source === window.parent && isObject(data) && data["subject"] === RESPONSE;
      // Some systems leave the id out.
      if (isAnswer && (data["message_id"] === undefined || data["message_id"] === id)) finish(data["state"]);
    };
    const timer = setTimeout(() => finish(null), PATIENCE);
    addEventListener("message", listen);
    const id = send({ subject: "SPLICE.getState" });
  }));
}

/** The learning system in the page around this one. */
export const splice: Activity = {
  async join(name, quiz) {
    quizzes.set(name, quiz);
    return storedOf((await storedState())["quizzes"], name);
  },
  answered(detail) {
    send({ subject: "SPLICE.sendEvent", name: "quiz-answer", data: detail });
  },
  async report() {
    const { right, count, states } = addUp(quizzes, (await storedState())["quizzes"]);
    // From 0 to 1.
    send({ subject: "SPLICE.reportScoreAndState", score: count === 0 ? 0 : right / count, state: { quizzes: states } });
  },
};
