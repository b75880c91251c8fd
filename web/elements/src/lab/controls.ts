/** Sliders, selects and buttons of a lab, as native controls. */
import type { Control, ControlValue } from "labspec/slim";
import { h, setText, uniqueId } from "../dom.js";
import { formatNumber, formatUnit } from "../text/numbers.js";

export interface ControlPanel {
  readonly elements: readonly HTMLElement[];
  readonly buttons: readonly HTMLElement[];
  /** Shows the values of the controls, except those that are being moved. */
  show(values: readonly (ControlValue | null)[], isMoving: (label: string) => boolean): void;
}

export interface ControlActions {
  set(label: string, value: ControlValue): void;
  press(label: string): void;
}

interface Part {
  readonly element: HTMLElement;
  show(value: ControlValue | null): void;
}

/** The controls of a lab, in their order. */
export function createControls(controls: readonly Control[], actions: ControlActions): ControlPanel {
  const parts = controls.map((control) => createControl(control, actions));
  const isButton = (i: number): boolean => controls[i]?.kind === "button";
  return {
    elements: parts.filter((_, i) => !isButton(i)).map((part) => part.element),
    buttons: parts.filter((_, i) => isButton(i)).map((part) => part.element),
    show: (values, isMoving) => parts.forEach((part, i) => {
      if (!isMoving(controls[i]?.label ?? "")) part.show(values[i] ?? null);
    }),
  };
}

function createControl(control: Control, actions: ControlActions): Part {
  if (control.kind === "button") {
    const button = buttonElement(control.label);
    button.addEventListener("click", () => actions.press(control.label));
    return { element: button, show: () => undefined };
  }
  return control.kind === "select" ? createSelect(control, actions) : createSlider(control, actions);
}

/** A value with its unit. */
export function formatControl(control: Control, value: number): string {
  const unit = formatUnit(control.unit ?? "");
  return `${formatNumber(value, control.digits ?? 3).replace("-", "−")}${unit === "" ? "" : `\u202f${unit}`}`;
}

export function buttonElement(label: string): HTMLButtonElement {
  return h("button", { type: "button", class: "action", part: "button" }, label);
}

interface SliderElement {
  readonly element: HTMLElement;
  readonly input: HTMLInputElement;
  /** The place of the printed value. */
  readonly output: HTMLOutputElement;
  /** Sets the value of the input, and fills its track up to there. */
  move(value: number): void;
}

/** A slider with its label. */
export function sliderElement(label: string, min: number, max: number, step: number | "any"): SliderElement {
  const id = uniqueId();
  const input = h("input", { type: "range", id, min, max, step, part: "slider" });
  const output = h("output", { for: id, class: "slider-value", "aria-live": "off" });
  const element = h("div", { class: "control slider", part: "control" }, h("div", { class: "control-head" }, h("label", { for: id }, label), output), input);
  return {
    element, input, output,
    move(value) {
      if (input.valueAsNumber !== value) input.value = String(value);
      input.style.setProperty("--_fill", `${max > min ? ((value - min) / (max - min)) * 100 : 0}%`);
    },
  };
}

/** A select with its label; the value of an option is its place. */
export function selectElement(label: string, options: readonly string[]): { readonly element: HTMLElement; readonly select: HTMLSelectElement } {
  const id = uniqueId();
  const select = h("select", { id, part: "select" }, ...options.map((text, i) => h("option", { value: i }, text)));
  return { element: h("div", { class: "control select", part: "control" }, h("label", { for: id }, label), select), select };
}

function createSlider(control: Control, actions: ControlActions): Part {
  const min = control.min ?? 0;
  const step = control.step !== undefined && control.step > 0 ? control.step : "any";
  const { element, input, output, move } = sliderElement(control.label, min, control.max ?? 1, step);
  const display = (value: number): void => {
    const text = formatControl(control, value);
    setText(output, text);
    input.setAttribute("aria-valuetext", text.replace("\u202f", " "));
    move(value);
  };
  input.addEventListener("input", () => {
    display(input.valueAsNumber);
    actions.set(control.label, input.valueAsNumber);
  });
  display(typeof control.start === "number" ? control.start : min);
  return {
    element,
    show(value) {
      if (typeof value === "number" && !input.matches(":active")) display(value);
    },
  };
}

function createSelect(control: Control, actions: ControlActions): Part {
  const options = control.options ?? [];
  const { element, select } = selectElement(control.label, options.map(([text]) => text));
  const show = (value: ControlValue | null): void => {
    const index = options.findIndex(([, option]) => Object.is(option, value));
    if (index >= 0 && select.selectedIndex !== index) select.selectedIndex = index;
  };
  show(control.start);
  select.addEventListener("change", () => {
    const chosen = options[select.selectedIndex]?.[1];
    if (chosen !== undefined && chosen !== null) actions.set(control.label, chosen);
  });
  return { element, show };
}
