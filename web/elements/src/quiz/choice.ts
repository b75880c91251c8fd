/** Questions with options: one of several, several of several, true or false, and predictions, which a lab answers. */
import type { Models } from "labspec/slim";
import { h, icon, uniqueId } from "../dom.js";
import { SimLab } from "../lab/element.js";
import { numberOf, type Json } from "../spec.js";
import { safeHtml } from "../text/sanitize.js";
import { compareWithLab } from "./evidence.js";
import { createCard, keepFocus, showRemark, showVerdict, type Card, type CardContext } from "./card.js";
import { isRightChoice, isRightOption } from "./grade.js";
import type { ChoiceQuestion } from "./read.js";
import type { Stored } from "./store.js";

/** The time that a lab without an end plays before the verdict, s. */
const WATCH = 3;

export function createChoice(question: ChoiceQuestion, context: CardContext, models: Models | null): Card {
  const { say } = context;
  const parts = createCard(context, question.label, question.q);
  const { form, verdict } = parts;
  const isPredict = question.kind === "predict" && question.sim !== null;
  const name = uniqueId();
  const type = question.kind === "multiple" ? "checkbox" : "radio";
  const inputs = question.options.map((_, i) => h("input", { type, name, value: i }));
  const rows = question.options.map((option, i) => h("label", { class: "option", part: "option" }, inputs[i], h("span", { class: "prose" }, safeHtml(option, document))));
  const submit = h("button", { type: "submit", class: "primary" }, say(isPredict ? "commit" : "check"));
  const hint = say(isPredict ? "predictHelp" : type === "checkbox" ? "chooseAll" : "chooseOne");
  form.append(
    h("fieldset", { class: "options", "aria-labelledby": parts.promptId }, h("legend", { class: "hidden" }, hint), ...rows),
    h("div", { class: "form-foot" }, submit, (isPredict || type === "checkbox") && h("span", { class: "hint" }, hint)));
  let [tries, isRight, isDone]: [number, boolean | null, boolean] = [0, null, false];
  const chosen = (): number[] => inputs.flatMap((input, i) => (input.checked ? [i] : []));

  const lock = (): void => {
    for (const input of inputs) input.disabled = true;
    submit.hidden = true;
    form.querySelector(".hint")?.remove();
  };
  const unmark = (): void => {
    for (const row of rows) {
      row.classList.remove("right", "wrong");
      row.querySelector(".icon")?.remove();
    }
  };
  /** Marks the chosen options, and the right ones if the question is finished. */
  const mark = (choice: readonly number[]): void => {
    unmark();
    rows.forEach((row, i) => {
      const isChosen = choice.includes(i);
      const isGood = isRightOption(question, i, choice, isRight === true);
      const name = isGood === true && isDone ? "right" : isGood === false && isChosen ? "wrong" : null;
      if (name === null) return;
      row.classList.add(name);
      row.append(icon(name === "right" ? "check" : "cross"));
    });
  };
  const conclude = (choice: readonly number[], lab: SimLab | null = null): void => {
    mark(choice);
    const said = choice.map((i) => plainText(question.options[i] ?? "")).join("; ");
    const prediction = !isPredict ? null : lab === null ? h("p", { class: "said" }, say("committed", { answer: said })) : compareWithLab(said, lab, say);
    showVerdict(verdict, isRight, say(isRight === true ? "correct" : "wrong"), question.explain, [prediction]);
  };
  const stored = (choice: readonly number[]): Stored => ({ choice, text: "", tries, isRight, isDone });

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const choice = chosen();
    if (choice.length === 0 && type === "radio") return showRemark(verdict, say("chooseFirst"));
    tries++;
    if (isPredict && question.sim !== null) return predict(choice, question.sim);
    isRight = isRightChoice(question, choice);
    isDone = isRight || tries >= question.attempts;
    context.answered(stored(choice));
    if (!isDone) {
      mark(choice);
      return showVerdict(verdict, false, say("wrong"), null, [h("p", {}, say("attempts", { number: tries, count: question.attempts }))]);
    }
    keepFocus(parts, () => {
      lock();
      conclude(choice);
    });
  });
  /** Commits a prediction. It counts when the lab has run: until then, the score would give its verdict away. */
  const predict = (choice: readonly number[], sim: Json): void => {
    isDone = true;
    context.committed(stored(choice));
    keepFocus(parts, () => {
      lock();
      watchLab(sim, models, parts, context, (lab) => {
        isRight = isRightChoice(question, choice);
        context.answered(stored(choice));
        keepFocus(parts, () => conclude(choice, lab));
      });
    });
  };
  for (const input of inputs) {
    input.addEventListener("change", () => {
      if (!isDone) unmark();
    });
  }
  restore(context.stored);

  /** Restores an answer of an earlier visit. */
  function restore(before: Stored | null): void {
    if (before === null || before.tries === 0) return;
    for (const i of before.choice) {
      const input = inputs[i];
      if (input !== undefined) input.checked = true;
    }
    [tries, isDone] = [before.tries, before.isDone];
    // The page was left while the lab of the prediction ran.
    if (isDone && before.isRight === null && isPredict && question.sim !== null) return predict(before.choice, question.sim);
    isRight = isRightChoice(question, before.choice);
    if (!isDone) return;
    lock();
    if (isPredict && question.sim !== null) parts.verdict.before(createLab(question.sim, models, context));
    conclude(before.choice);
  }
  return { element: parts.element, isGraded: true, get isRight() { return isRight; } };
}

function createLab(sim: Json, models: Models | null, { name }: CardContext): SimLab {
  const lab = new SimLab();
  lab.id = name;
  // `watchLab` plays it.
  lab.lab = { ...sim, autoplay: false };
  if (models !== null) lab.models = models;
  return lab;
}

/** Shows the lab and plays it. Calls `conclude` at its end, or when the reader asks for the verdict. */
function watchLab(sim: Json, models: Models | null, parts: { verdict: HTMLElement }, context: CardContext, conclude: (lab: SimLab) => void): void {
  const { say } = context;
  const lab = createLab(sim, models, context);
  const show = h("button", { type: "button" }, say("showVerdict"));
  parts.verdict.before(lab);
  parts.verdict.replaceChildren(h("div", { class: "watch" }, h("p", {}, say("running")), show));
  let [isOver, timer]: [boolean, ReturnType<typeof setInterval> | undefined] = [false, undefined];
  const finish = (): void => {
    if (isOver) return;
    isOver = true;
    clearInterval(timer);
    lab.removeEventListener("lab-pause", look);
    lab.removeEventListener("lab-ready", begin);
    conclude(lab);
  };
  const until = numberOf(sim["stopAt"]) ?? WATCH;
  const look = (): void => {
    // A lab that is taken away is watched again when it is opened again.
    if (!lab.isConnected) return clearInterval(timer);
    if (lab.isOver || lab.time >= until) {
      lab.pause();
      finish();
    }
  };
  const wantsNoMotion = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const begin = (): void => {
    clearInterval(timer);
    timer = setInterval(look, 150);
    if (!wantsNoMotion) lab.play();
  };
  lab.addEventListener("lab-pause", look);
  lab.addEventListener("lab-ready", begin);
  show.addEventListener("click", finish);
  lab.ready.catch(finish);
}

function plainText(html: string): string {
  return safeHtml(html, document).textContent?.trim() ?? "";
}
