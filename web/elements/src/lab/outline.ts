/**
 * A lab before its engine is there: its title, its picture, its controls, its readouts and its plots, at the places and in the sizes that they will have.
 * Nothing of it can be used or read aloud yet; the live region of the element says that the lab is loading.
 */
import { h } from "../dom.js";
import { createPlot } from "../plot/plot.js";
import { isObject, listOf, numberOf, textOf, type Json, type LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { buttonElement, selectElement, sliderElement } from "./controls.js";
import { createReadouts } from "./readouts.js";
import { layOut } from "./layout.js";
import { createPoster } from "./poster.js";
import { createToolbar } from "./toolbar.js";
import { createToggles, viewBarOf } from "./view-bar.js";

export interface Outline {
  readonly element: HTMLElement;
  dispose(): void;
}

/** The outline of a lab. `poster` is the address of its first picture. */
export function createOutline(lab: Json, spec: LabSpec, poster: string | null, say: Say): Outline {
  const title = spec.title === "" ? say("lab") : spec.title;
  const view = h("div", { class: "view" }, poster === null ? h("p", { class: "waiting" }, say("loading")) : createPoster(poster));
  view.style.height = `${spec.height}px`;
  const plots = spec.plots.map((plot) => createPlot(plot, plot.traces.map((_, i) => i), title, say));
  const controls = listOf(lab["controls"]).filter(isObject).map(outlineOf);
  const isButton = (element: HTMLElement): boolean => element.localName === "button";
  const readouts = spec.compared.length > 0 ? [] : listOf(lab["readouts"]).filter(isObject);
  const toggles = createToggles(spec, { overlay: (name) => spec.overlays[name] ?? name === "shadows", setOverlay: () => undefined }, say);
  const nothing = (): void => undefined;
  const toolbar = createToolbar(
    { speeds: spec.speeds, timestep: null, hasLargeSteps: matchMedia("(prefers-reduced-motion: reduce)").matches, hasPicture: true, first: null }, say, {
      toggle: nothing, step: nothing, stepMore: nothing, reset: nothing, speed: nothing, copyLink: nothing, saveState: nothing, openState: nothing,
      savePicture: nothing,
    });
  const element = layOut({
    spec, title, say, view, viewBar: viewBarOf(toggles, null), toolbar: toolbar.element, controls: controls.filter((control) => !isButton(control)),
    buttons: controls.filter(isButton), readouts: createReadouts(readouts.map((one) => ({ label: textOf(one["label"]) ?? "", unit: "" })), say("readouts")).element,
    plots: plots.map((plot) => plot.element), spoken: [], findings: [],
  });
  for (const child of element.children) (child as HTMLElement).inert = true;
  element.classList.add("outline");
  return {
    element,
    dispose() {
      for (const plot of plots) plot.dispose();
    },
  };
}

/** A control with its label, without its value. */
function outlineOf(control: Json): HTMLElement {
  const label = textOf(control["label"]) ?? "";
  switch (control["type"]) {
    case "button": return buttonElement(label);
    case "select": return selectElement(label, ["\u00a0"]).element;
    default: {
      const [min, max] = [numberOf(control["min"]) ?? 0, numberOf(control["max"]) ?? 1];
      const slider = sliderElement(label, min, max, "any");
      slider.move(numberOf(control["value"]) ?? min);
      slider.output.textContent = "\u00a0";
      return slider.element;
    }
  }
}
