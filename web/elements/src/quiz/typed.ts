/** Questions that are answered in writing: a number, a text, a program. */
import { h, uniqueId } from "../dom.js";
import { formatBrief, formatUnit, parseTyped } from "../text/numbers.js";
import { createCard, keepFocus, showRemark, showVerdict, type Card, type CardContext } from "./card.js";
import { isRightNumber } from "./grade.js";
import type { NumericQuestion, OpenQuestion } from "./read.js";

export function createNumeric(question: NumericQuestion, context: CardContext): Card {
  const { say } = context;
  const parts = createCard(context, question.label, question.q);
  const { element, form, verdict, promptId } = parts;
  const id = uniqueId();
  const input = h("input", { id, type: "text", inputmode: "decimal", autocomplete: "off", size: 10, "aria-describedby": promptId, part: "input" });
  const submit = h("button", { type: "submit", class: "primary" }, say("check"));
  const unit = formatUnit(question.unit);
  const label = unit === "" ? say("yourAnswer") : `${say("yourAnswer")}, ${say("inUnit", { unit })}`;
  form.append(h("div", { class: "typed" }, h("label", { for: id, class: "hidden" }, label), input,
    unit !== "" && h("span", { class: "unit", "aria-hidden": "true" }, unit), submit));
  let [tries, isRight, isDone]: [number, boolean | null, boolean] = [0, null, false];
  const conclude = (): void => {
    if (isDone) {
      input.disabled = true;
      submit.hidden = true;
    }
    const answer = `${formatBrief(question.answer, question.tol)}${unit === "" ? "" : ` ${unit}`}`;
    const remark = isRight === true ? null : h("p", {}, isDone ? say("correctAnswer", { answer }) : `${attemptText()} ${say("tryAgain")}.`);
    showVerdict(verdict, isRight, say(isRight === true ? "correct" : "wrong"), isDone ? question.explain : null, [remark]);
  };
  const attemptText = (): string =>
    `${Number.isFinite(question.attempts) ? say("attempts", { number: tries, count: question.attempts }) : say("attempt", { number: tries })}.`;
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const value = parseTyped(input.value, question.unit);
    input.toggleAttribute("aria-invalid", value === null);
    if (value === null) {
      input.setAttribute("aria-invalid", "true");
      return showRemark(verdict, say("notANumber"));
    }
    tries++;
    isRight = isRightNumber(question, value);
    isDone = isRight || tries >= question.attempts;
    context.answered({ choice: [], text: input.value, tries, isRight, isDone });
    keepFocus(parts, conclude);
  });
  const { stored } = context;
  const before = stored === null ? null : parseTyped(stored.text, question.unit);
  if (stored !== null && before !== null) {
    input.value = stored.text;
    [tries, isRight, isDone] = [stored.tries, isRightNumber(question, before), stored.isDone];
    conclude();
  }
  return { element, isGraded: true, get isRight() { return isRight; } };
}

export function createOpen(question: OpenQuestion, context: CardContext): Card {
  const { say } = context;
  const { element, form, verdict, promptId } = createCard(context, question.label, question.q);
  const id = uniqueId();
  const text = h("textarea", {
    id, rows: question.kind === "code" ? 8 : 4, class: question.kind, "aria-describedby": promptId, spellcheck: question.kind === "open", part: "input",
  });
  const submit = h("button", { type: "submit", class: "primary" }, say(question.reference === null ? "check" : "compare"));
  form.append(h("label", { for: id, class: "hidden" }, say("yourAnswer")), text, h("div", { class: "form-foot" }, submit));
  const compare = (): void => {
    const reference = question.reference ?? question.explain;
    const title = question.reference === null ? null : h("p", {}, h("strong", {}, say("reference")));
    showVerdict(verdict, null, "", reference, [title]);
  };
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (text.value.trim() === "") return showRemark(verdict, say("writeFirst"));
    context.answered({ choice: [], text: text.value, tries: 1, isRight: null, isDone: true });
    compare();
  });
  if (context.stored !== null && context.stored.text !== "") {
    text.value = context.stored.text;
    compare();
  }
  return { element, isGraded: false, isRight: null };
}
