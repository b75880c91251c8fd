/** The bar with overlays and cameras below the picture, and the choice of a body to drag by keys. */
import { h, uniqueId } from "../dom.js";
import type { Opened } from "../engine/messages.js";
import type { LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { bodyName, type Viewport } from "./viewport.js";

export interface ViewBar {
  readonly element: HTMLElement | null;
  /** The choice of a body to drag. */
  readonly bodies: HTMLElement | null;
  /** Shows that no body is held. */
  showReleased(): void;
}

export function createViewBar(opened: Opened, spec: LabSpec, viewport: Viewport, say: Say): ViewBar {
  if (!viewport.isDrawn) return { element: null, bodies: null, showReleased: () => undefined };
  const group = createToggles(spec, viewport, say);
  const camera = createCameras(opened, viewport, say);
  const bodies = createBodies(opened, viewport, say);
  return {
    element: viewBarOf(group, camera),
    bodies: bodies?.element ?? null,
    showReleased: () => bodies?.clear(),
  };
}

/** The bar below the picture, if it contains anything. */
export function viewBarOf(toggles: HTMLElement | null, camera: HTMLElement | null): HTMLElement | null {
  return toggles !== null || camera !== null ? h("div", { class: "view-bar", part: "view-bar" }, toggles, camera) : null;
}

/** A checkbox for each overlay that a lab lets its reader switch. */
export function createToggles(spec: LabSpec, { overlay: isShown, setOverlay }: Pick<Viewport, "overlay" | "setOverlay">, say: Say): HTMLElement | null {
  const toggles = spec.toggles.map((overlay) => {
    const box = h("input", { type: "checkbox" });
    box.checked = isShown(overlay);
    box.addEventListener("change", () => setOverlay(overlay, box.checked));
    return h("label", { class: "toggle", part: "toggle" }, box, h("span", {}, say(overlay)));
  });
  return toggles.length > 0 ? h("fieldset", { class: "toggles" }, h("legend", { class: "hidden" }, say("overlays")), ...toggles) : null;
}

function createCameras({ model }: Opened, viewport: Viewport, say: Say): HTMLElement | null {
  if (model.cameras.length === 0) return null;
  const id = uniqueId();
  const select = h("select", { id },
    h("option", { value: "" }, say("freeCamera")),
    ...model.cameras.map((name, i) => h("option", { value: i }, name === "" ? say("cameraNumber", { number: i + 1 }) : name)));
  select.addEventListener("change", () => viewport.setCamera(select.value === "" ? null : Number(select.value)));
  return h("span", { class: "choice" }, h("label", { for: id }, say("camera")), select);
}

function createBodies(opened: Opened, viewport: Viewport, say: Say): { element: HTMLElement; clear(): void } | null {
  const bodies = opened.bodies.map((_, id) => ({ name: bodyName(opened, id, say), id }));
  const movable = bodies.filter(({ id }) => opened.movable[id] === true);
  if (movable.length === 0) return null;
  const id = uniqueId();
  const select = h("select", { id, class: "drag", title: say("dragEnter") }, h("option", { value: "" }, say("noBody")), ...movable.map((body) => h("option", { value: body.id }, body.name)));
  let [held, key]: [string, string | null] = ["", null];
  const grab = (): void => {
    const { value } = select;
    viewport.grab(value === "" ? null : Number(value));
    [held, select.value] = [value, value];
  };
  // Arrow keys choose a body of a closed list one after the other. Only Enter takes it: the focus goes to the picture then.
  select.addEventListener("keydown", (event) => {
    key = event.key;
    if (key !== "Enter" || select.value === held) return;
    event.preventDefault();
    grab();
  });
  select.addEventListener("pointerdown", () => {
    key = null;
  });
  select.addEventListener("change", () => {
    if (key === null || key === "Enter" || select.value === "") grab();
  });
  select.addEventListener("blur", () => {
    select.value = held;
  });
  return {
    element: h("span", { class: "choice" }, h("label", { for: id }, say("dragBody")), select),
    clear() {
      [held, select.value] = ["", ""];
    },
  };
}
