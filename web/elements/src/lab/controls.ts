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
    const button = h("button", { type: "button", class: "action", part: "button" }, control.label);
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

function createSlider(control: Control, actions: ControlActions): Part {
  const id = uniqueId();
  const [min, max] = [control.min ?? 0, control.max ?? 1];
  const step = control.step !== undefined && control.step > 0 ? control.step : "any";
  const start = typeof control.start === "number" ? control.start : min;
  const input = h("input", { type: "range", id, min, max, step, value: start, part: "slider" });
  const output = h("output", { for: id, class: "slider-value", "aria-live": "off" });
  const describe = (value: number): void => {
    const text = formatControl(control, value);
    setText(output, text);
    input.setAttribute("aria-valuetext", text.replace("\u202f", " "));
    input.style.setProperty("--_fill", `${max > min ? ((value - min) / (max - min)) * 100 : 0}%`);
  };
  input.addEventListener("input", () => {
    describe(input.valueAsNumber);
    actions.set(control.label, input.valueAsNumber);
  });
  describe(start);
  const element = h("div", { class: "control slider", part: "control" },
    h("div", { class: "control-head" }, h("label", { for: id }, control.label), output), input);
  return {
    element,
    show(value) {
      if (typeof value !== "number" || input.matches(":active")) return;
      if (input.valueAsNumber !== value) input.value = String(value);
      describe(value);
    },
  };
}

function createSelect(control: Control, actions: ControlActions): Part {
  const id = uniqueId();
  const options = control.options ?? [];
  const select = h("select", { id, part: "select" }, ...options.map(([text], i) => h("option", { value: i }, text)));
  const show = (value: ControlValue | null): void => {
    const index = options.findIndex(([, own]) => Object.is(own, value));
    if (index >= 0 && select.selectedIndex !== index) select.selectedIndex = index;
  };
  show(control.start);
  select.addEventListener("change", () => {
    const chosen = options[select.selectedIndex]?.[1];
    if (chosen !== undefined && chosen !== null) actions.set(control.label, chosen);
  });
  return { element: h("div", { class: "control select", part: "control" }, h("label", { for: id }, control.label), select), show };
}
