/** The frame of a question: its number, text, form, verdict and explanation. */
import { h, icon } from "../dom.js";
import type { Say } from "../text/messages.js";
import { safeHtml } from "../text/sanitize.js";
import type { Stored } from "./store.js";

/** A question on the page. */
export interface Card {
  readonly element: HTMLElement;
  /** `null` if it is not graded or not answered. */
  readonly isRight: boolean | null;
  readonly isGraded: boolean;
}

export interface CardContext {
  readonly number: number;
  readonly count: number;
  /** A name of the question that no other one of the page has. */
  readonly name: string;
  readonly say: Say;
  readonly stored: Stored | null;
  /** Stores an answer whose verdict is not shown yet. It does not count. */
  committed(answer: Stored): void;
  /** Stores an answer and reports it to the page. */
  answered(answer: Stored): void;
}

export interface CardParts {
  readonly element: HTMLElement;
  readonly form: HTMLFormElement;
  /** The place of verdicts, which screen readers announce. */
  readonly verdict: HTMLElement;
  readonly promptId: string;
}

let prompts = 0;

export function createCard(context: CardContext, label: string | null, prompt: string): CardParts {
  const { number, count, say } = context;
  const promptId = `labspec-question-${++prompts}`;
  const place = say("question", { number, count });
  const form = h("form", { class: "answer", novalidate: true });
  const verdict = h("div", { class: "verdict-area", role: "status", tabindex: -1 });
  const element = h("section", { class: "question", part: "question", "aria-labelledby": promptId },
    h("p", { class: "kind" }, label === null ? place : `${place} · ${label}`),
    h("div", { class: "prose prompt", id: promptId, dir: "auto" }, safeHtml(prompt, document)), form, verdict);
  return { element, form, verdict, promptId };
}

/** Changes a question. If the change takes the focus from a control of it, the verdict has the focus then. */
export function keepFocus({ element, verdict }: Pick<CardParts, "element" | "verdict">, change: () => void): void {
  const root = element.getRootNode();
  const focused = root instanceof ShadowRoot ? root.activeElement : null;
  const isInside = focused !== null && element.contains(focused);
  change();
  if (isInside && (!focused.isConnected || focused.matches(":disabled, [hidden]"))) verdict.focus();
}

/** Shows the verdict on an answer, with its explanation. */
export function showVerdict(area: HTMLElement, isRight: boolean | null, text: string, explain: string | null, more: readonly (Node | null)[] = []): void {
  const badge = isRight === null ? null : h("p", { class: isRight ? "badge good" : "badge bad" }, icon(isRight ? "check" : "cross"), h("strong", {}, text));
  const why = explain === null ? null : h("div", { class: "prose explain", dir: "auto" }, safeHtml(explain, document));
  const children = [badge, ...more, why].filter((child) => child !== null);
  area.replaceChildren(h("div", { class: `verdict ${isRight === null ? "" : isRight ? "good" : "bad"}` }, ...children));
}

/** Shows a remark below the form. */
export function showRemark(area: HTMLElement, text: string): void {
  area.replaceChildren(h("p", { class: "remark" }, text));
}
