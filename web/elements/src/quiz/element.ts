/** `<lesson-quiz>`: questions about a lesson. */
import type { Models } from "labspec/slim";
import { childrenRead, ContentError, readContent, readModels } from "../content.js";
import { h, setText, takeOwnProperty } from "../dom.js";
import { openScorm } from "../grades/scorm.js";
import { splice } from "../grades/splice.js";
import { errorPanel } from "../lab/layout.js";
import { createBadge } from "../proof/badge.js";
import { textOf, type Json } from "../spec.js";
import { applyStyles } from "../style/apply.js";
import { messagesFor, type Say } from "../text/messages.js";
import type { Card, CardContext } from "./card.js";
import { createChoice } from "./choice.js";
import { countRight, joinActivity, type Grading } from "./grading.js";
import { readQuiz, type Question, type QuizSpec } from "./read.js";
import { loadAnswer, storeAnswer } from "./store.js";
import { createNumeric, createOpen } from "./typed.js";

const TAG = "lesson-quiz";

export class LessonQuiz extends HTMLElement {
  static readonly observedAttributes = ["src", "lang", "grades"];
  #quiz: object | string | null = null;
  #models: Models | null = null;
  #turn = 0;
  /** Whether the reader has cleared the answers: the first question has the focus then. */
  #isCleared = false;

  /** The quiz as an object or as JSON. */
  get quiz(): object | string | null { return this.#quiz; }
  set quiz(quiz: object | string | null) {
    this.#quiz = quiz;
    this.#reopen();
  }

  /** The models of the labs of predictions. */
  get models(): Models | null { return this.#models; }
  set models(models: Models | null) {
    this.#models = models;
    this.#reopen();
  }

  connectedCallback(): void {
    applyStyles(this.shadowRoot ?? this.attachShadow({ mode: "open" }));
    takeOwnProperty(this, "models");
    takeOwnProperty(this, "quiz");
    if (this.shadowRoot?.childElementCount === 0) this.#reopen();
  }

  attributeChangedCallback(_name: string, before: string | null, after: string | null): void {
    if (before !== after) this.#reopen();
  }

  #reopen(): void {
    if (this.isConnected && this.shadowRoot !== null) void this.#open(++this.#turn, this.shadowRoot);
  }

  async #open(turn: number, root: ShadowRoot): Promise<void> {
    const say = messagesFor(this);
    let shown: HTMLElement;
    try {
      await childrenRead();
      const { json } = await readContent(this, this.#quiz, say("noQuiz"), say);
      const spec = readQuiz(json, say);
      if (spec === null) throw new ContentError(say("noQuestions"));
      shown = await this.#build(spec, json, say, () => turn !== this.#turn);
    } catch (e) {
      shown = errorPanel(say("quizBroken"), [e instanceof Error ? e.message : String(e)], null);
    }
    if (turn !== this.#turn) return;
    root.replaceChildren(shown);
    if (this.#isCleared) root.querySelector<HTMLElement>(".question :is(input, textarea)")?.focus();
    this.#isCleared = false;
  }

  /** Builds the questions. Once the quiz `isOld`, for example cleared, its questions report nothing more. */
  async #build(spec: QuizSpec, json: Json, say: Say, isOld: () => boolean): Promise<HTMLElement> {
    const grading = await this.#grading(spec);
    const score = h("span", { class: "score", role: "status" });
    const clear = h("button", { type: "button", class: "quiet" }, say("clear"));
    const cards: (Card | null)[] = [];
    const showScore = (): void => {
      const { right, count } = countRight(cards);
      const isBegun = cards.some((card) => card?.isGraded === true && card.isRight !== null);
      setText(score, isBegun ? say("score", { right, count }) : "");
      clear.hidden = !isBegun;
    };
    for (const [index, question] of spec.questions.entries()) {
      if (question.kind === "broken") {
        cards.push(null);
        continue;
      }
      const context: CardContext = {
        number: index + 1, count: spec.questions.length, name: `${spec.id}.${index + 1}`, say, stored: grading.load(index),
        committed: (answer) => {
          if (!isOld()) grading.store(index, answer);
        },
        answered: (answer) => {
          if (isOld()) return;
          grading.store(index, answer);
          const given = question.kind === "numeric" || question.kind === "open" || question.kind === "code" ? answer.text : answer.choice;
          const detail = { quiz: spec.id, index, kind: question.kind, answer: given, correct: answer.isRight, attempt: answer.tries, done: answer.isDone };
          queueMicrotask(() => {
            showScore();
            grading.report(countRight(cards), detail);
          });
          this.dispatchEvent(new CustomEvent("quiz-answer", { detail, bubbles: true, composed: true }));
        },
      };
      cards.push(createQuestion(question, context, await this.#modelsOf(question, say)));
    }
    clear.addEventListener("click", () => {
      spec.questions.forEach((_, index) => grading.store(index, null));
      grading.report({ right: 0, count: countRight(cards).count }, null);
      this.#isCleared = true;
      this.#reopen();
    });
    const broken = (why: string, i: number): HTMLElement => errorPanel(say("quizBroken"), [say("badQuestion", { number: i + 1, why })], null);
    const elements = spec.questions.map((question, i) => (question.kind === "broken" ? broken(question.why, i) : cards[i]?.element));
    grading.begin(countRight(cards));
    showScore();
    return h("article", { class: "quiz", part: "quiz", "aria-label": spec.title ?? say("quiz") },
      h("header", { class: "head", part: "header" }, h("h3", { class: "title", part: "title" }, spec.title ?? say("quiz"))), ...elements,
      h("footer", { class: "quiz-foot" }, score, clear), createBadge(this, json, await this.#allModels(say), say));
  }

  /** Where answers are kept: in the browser, or by the learning system that `grades` names. */
  async #grading(spec: QuizSpec): Promise<Grading> {
    const grades = this.getAttribute("grades");
    const activity = grades === "splice" ? splice : grades === "scorm" ? openScorm(this.getAttribute("passing")) : null;
    if (activity !== null) return joinActivity(spec, activity);
    const keep = this.getAttribute("store") === "off" ? "" : spec.id;
    return { load: (index) => loadAnswer(keep, index), store: (index, answer) => storeAnswer(keep, index, answer), begin: () => undefined, report: () => undefined };
  }

  /** The models that the page has. */
  async #allModels(say: Say): Promise<Models> {
    return readModels(this, this.#models, null, say);
  }

  /** The models of the lab of a prediction. The lab reports a missing model. */
  async #modelsOf(question: Question, say: Say): Promise<Models | null> {
    if (question.kind !== "predict" || question.sim === null) return null;
    try {
      return await readModels(this, this.#models, textOf(question.sim["model"]), say);
    } catch {
      return this.#models;
    }
  }
}

function createQuestion(question: Question, context: CardContext, models: Models | null): Card {
  switch (question.kind) {
    case "numeric": return createNumeric(question, context);
    case "open": case "code": return createOpen(question, context);
    default: return createChoice(question, context, models);
  }
}

/** Defines the element, if the page has not defined it. */
export function defineLessonQuiz(): void {
  if (customElements.get(TAG) === undefined) customElements.define(TAG, LessonQuiz);
}
