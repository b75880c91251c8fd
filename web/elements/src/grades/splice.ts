/**
 * Grades for a learning system that holds the page in a frame: the messages of SPLICE (https://cssplice.org). The page is one activity; its
 * quizzes share one state and one score.
 */
import { isObject, type Json } from "../spec.js";

/** A quiz of the page, as the activity sees it. */
export interface GradedQuiz {
  /** The state that is stored: plain data. */
  readonly state: unknown;
  /** Right answers and questions that are graded. */
  readonly right: number;
  readonly count: number;
}

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

/** Adds a quiz to the activity; gives what was stored of it, or null. */
export async function joinActivity(name: string, quiz: () => GradedQuiz): Promise<unknown> {
  quizzes.set(name, quiz);
  const state = (await storedState())["quizzes"];
  return isObject(state) && Object.hasOwn(state, name) ? state[name] : null;
}

/** Reports the score of the page, from 0 to 1, and its state. */
export async function reportActivity(): Promise<void> {
  // Quizzes that are not open keep their state.
  const old = (await storedState())["quizzes"];
  const all = [...quizzes].map(([name, quiz]) => [name, quiz()] as const);
  const right = all.reduce((sum, [, quiz]) => sum + quiz.right, 0);
  const count = all.reduce((sum, [, quiz]) => sum + quiz.count, 0);
  const states = { ...(isObject(old) ? old : {}), ...Object.fromEntries(all.map(([name, { state }]) => [name, state])) };
  send({ subject: "SPLICE.reportScoreAndState", score: count === 0 ? 0 : right / count, state: { quizzes: states } });
}

/** Reports an event of the page: what was answered. */
export function reportEvent(name: string, data: object): void {
  send({ subject: "SPLICE.sendEvent", name, data });
}
