/** The elements as a widget: `render` as anywidget asks for it (JupyterLab, marimo, MyST). */
import type { SimLab } from "../lab/element.js";
import type { LessonQuiz } from "../quiz/element.js";
import type { Models } from "labspec/slim";

/** The model of a widget: its traits. */
export interface WidgetModel {
  get(name: string): unknown;
  on?(event: string, listener: () => void): void;
  off?(event: string, listener: () => void): void;
}

/** Keys of a lab or a quiz, where the widget's own content is one: MyST passes the JSON of a directive as traits. */
const LAB_KEYS = [
  "model", "xml", "key", "title", "kind", "note", "height", "dock", "autoplay", "camera", "overlays", "toggles", "forceScale", "trail",
  "speeds", "stopAt", "setup", "controller", "controls", "plots", "readouts",
];
const QUIZ_KEYS = ["id", "title", "questions"];

/** Shows a lab or a quiz in an element; returns a function that takes it away. */
export function render({ model, el }: { model: WidgetModel; el: HTMLElement }): () => void {
  const isQuiz = isGiven(model.get("quiz")) || isGiven(model.get("questions"));
  // A notebook loads this module once for each class of widgets, and only the first one defines the elements: another one's classes
  // construct nothing.
  const lab = isQuiz ? null : (document.createElement("sim-lab") as SimLab);
  const element = lab ?? (document.createElement("lesson-quiz") as LessonQuiz);
  const update = (): void => {
    const models = model.get("models");
    if (typeof models === "object" && models !== null) element.models = modelsOf(models);
    if (typeof models === "string") element.setAttribute("models", models);
    const lang = model.get("lang");
    if (typeof lang === "string") element.lang = lang;
    if (lab === null) (element as LessonQuiz).quiz = contentOf(model, "quiz", QUIZ_KEYS);
    else lab.lab = contentOf(model, "lab", LAB_KEYS);
  };
  update();
  el.replaceChildren(element);
  const events = ["change:lab", "change:quiz", "change:models"];
  for (const event of events) model.on?.(event, update);
  return () => {
    element.remove();
    try {
      for (const event of events) model.off?.(event, update);
    } catch {
      // The model of MyST's themes throws: it has no way to remove a listener. The page drops it with the model.
    }
  };
}

/** Models as the elements take them. anywidget passes bytes as a `DataView` of a message, of which only these bytes are kept. */
function modelsOf(given: object): Models {
  const content = (x: unknown): unknown => {
    if (x instanceof Uint8Array) return x;
    if (ArrayBuffer.isView(x)) return new Uint8Array(x.buffer, x.byteOffset, x.byteLength).slice();
    return x instanceof ArrayBuffer ? new Uint8Array(x) : x;
  };
  return Object.fromEntries(Object.entries(given).map(([name, x]) => [name, content(x)])) as Models;
}

/** Whether a trait has a content: an empty object is the default of a trait that nobody has set. */
function isGiven(x: unknown): boolean {
  return x !== undefined && x !== null && x !== "" && !(typeof x === "object" && Object.keys(x).length === 0);
}

function contentOf(model: WidgetModel, name: string, keys: readonly string[]): object | string {
  const content = model.get(name);
  if (typeof content === "string" || (typeof content === "object" && content !== null)) return content;
  const entries = keys.map((key) => [key, model.get(key)] as const).filter(([, value]) => value !== undefined && value !== null);
  return Object.fromEntries(entries);
}
