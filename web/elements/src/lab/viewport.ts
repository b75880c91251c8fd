/** The picture of a lab: the camera and the bodies follow the pointer and the keys. */
import { createView, labCamera } from "../view/index.js";
import type { CameraPose, Overlay, SceneFrame, SceneModel, SceneTexture, View } from "../view/types.js";
import { h, saveFile, fileName } from "../dom.js";
import type { Drag, Opened } from "../engine/messages.js";
import { clamp, type LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { builtinTextures } from "../texture/textures.js";
import { cameraAxes, copyPose, moveCameraByKey, panCamera, pinchCamera, scaled, turnCamera, zoomCamera, type Point } from "./camera-moves.js";
import { drawPaced, forgetPaced } from "./pace.js";
import { createPoster } from "./poster.js";

export interface Viewport {
  readonly element: HTMLElement;
  /** Whether there is a picture. */
  readonly isDrawn: boolean;
  /** Draws the first picture, and draws it again with the textures of files (`null`: there are none). */
  begin(fileTextures: Promise<readonly SceneTexture[] | null>): void;
  /** The textures of the model, by id. */
  readonly textures: readonly SceneTexture[];
  /** New constants of the model; the textures stay. */
  setModel(model: SceneModel): void;
  setFrame(frame: SceneFrame): void;
  clearTrail(): void;
  draw(): void;
  restyle(): void;
  setOverlay(overlay: Overlay, on: boolean): void;
  overlay(overlay: Overlay): boolean;
  /** Through a camera of the model, or the free one (`null`). */
  setCamera(fixed: number | null): void;
  /** Drags a body with the keyboard, or lets it go (`null`). */
  grab(body: number | null): void;
  savePicture(title: string): Promise<void>;
  dispose(): void;
}

export interface ViewportActions {
  drag(drag: Drag | null): void;
  say(text: string): void;
  /** The viewport has released the body that was dragged by keys. */
  released(): void;
}

/** The name of a body for readers. */
export function bodyName({ bodies }: Opened, body: number, say: Say): string {
  const name = bodies[body] ?? "";
  return name === "" ? say("bodyNumber", { number: body }) : name.replaceAll("_", " ");
}

/** Pixels that a pointer may move in a tap. */
const TAP = 8;
const TURN = 0.4;

export function createViewport(opened: Opened, spec: LabSpec, poster: string | null, say: Say, actions: ViewportActions): Viewport {
  const canvas = h("canvas", { part: "view" });
  const title = spec.title === "" ? say("lab") : spec.title;
  const hint = h("span", { class: "tap-hint", "aria-hidden": "true" }, say("viewTap"));
  const element = h("div", {
    class: "view", tabindex: 0, role: "application", "aria-label": say("view", { title }), "aria-description": say("viewHelp"),
  }, canvas, hint);
  const firstPicture = poster === null ? null : createPoster(poster);
  if (firstPicture !== null) element.prepend(firstPicture);
  element.style.height = `${spec.height}px`;
  const trail = spec.trail === null ? -1 : opened.sites.indexOf(spec.trail);
  let [model, textures]: [SceneModel, readonly SceneTexture[]] = [opened.model, builtinTextures(opened.textures)];
  let view: View | null = null;
  try {
    view = createView(canvas, { ...model, textures }, {
      camera: labCamera(spec.camera), overlays: spec.overlays, ...(spec.forceScale === null ? {} : { forceScale: spec.forceScale }),
      ...(trail >= 0 ? { trail } : {}),
    });
  } catch {
    for (const name of ["role", "tabindex", "aria-label", "aria-description", "style"]) element.removeAttribute(name);
    element.replaceChildren(h("p", { class: "view-failed" }, say("viewFailed")));
  }
  const state: PointerState = { frame: opened.frame.scene, home: view === null ? null : copyPose(view.camera), held: null, target: [0, 0, 0], isActive: false };
  // The view draws nothing before it has a frame: the first picture waits until the rest of the lab is on the page.
  let isBegun = false;
  if (view !== null) {
    listen(element, canvas, view, opened, say, actions, state);
  }
  const draw = (): void => view?.draw();
  const resize = new ResizeObserver(draw);
  resize.observe(canvas);
  return {
    element,
    isDrawn: view !== null,
    get textures() { return textures; },
    setModel(next) {
      model = next;
      view?.setModel({ ...model, textures });
    },
    begin(fileTextures) {
      isBegun = true;
      view?.setFrame(state.frame);
      view?.draw();
      // The picture of a site builder has the textures of files.
      void fileTextures.then((next) => {
        if (next !== null) {
          textures = next;
          view?.setModel({ ...model, textures });
          view?.draw();
        }
        firstPicture?.remove();
      });
    },
    setFrame(frame) {
      state.frame = frame;
      if (!isBegun) return;
      view?.setFrame(frame);
      if (view !== null && state.held !== null) view.setDrag({ from: grabbedPoint(frame, state.held), to: state.target });
    },
    clearTrail: () => view?.clearTrail(),
    draw: () => drawPaced(draw),
    restyle() {
      const style = getComputedStyle(element);
      view?.setTheme({ background: style.backgroundColor, highContrast: matchMedia("(forced-colors: active), (prefers-contrast: more)").matches });
      view?.draw();
    },
    setOverlay(overlay, on) {
      if (view === null) return;
      view.overlays[overlay] = on;
      view.draw();
    },
    overlay: (overlay) => view?.overlays[overlay] === true,
    setCamera(fixed) {
      if (view === null) return;
      if (fixed === null) delete view.camera.fixed;
      else view.camera.fixed = fixed;
      view.draw();
    },
    grab(body) {
      if (view === null || body === null) return release(view, state, actions);
      const held: Drag = { body, local: [0, 0, 0], target: [0, 0, 0] };
      state.target = grabbedPoint(state.frame, held);
      state.held = { ...held, target: state.target };
      actions.drag(state.held);
      view.setDrag({ from: state.target, to: state.target });
      const name = bodyName(opened, body, say);
      actions.say(`${say("grabbed", { body: name })} ${say("dragHelp", { body: name })}`);
      element.focus();
    },
    async savePicture(name) {
      const ratio = 2;
      const png = await view?.toPng(canvas.clientWidth * ratio, canvas.clientHeight * ratio);
      if (png !== undefined) saveFile(`${fileName(name)}.png`, png);
    },
    dispose() {
      forgetPaced(draw);
      resize.disconnect();
      view?.dispose();
    },
  };
}

interface PointerState {
  frame: SceneFrame;
  home: CameraPose | null;
  held: Drag | null;
  target: Point;
  /** Whether touches move the picture, not the page. A tap switches it on. */
  isActive: boolean;
}

function release(view: View | null, state: PointerState, actions: ViewportActions): void {
  if (state.held === null) return;
  state.held = null;
  view?.setDrag(null);
  view?.draw();
  actions.drag(null);
  actions.released();
}

/** The grabbed point of a body in the world frame. */
function grabbedPoint({ xpos, xmat }: SceneFrame, { body, local }: Drag): Point {
  const row = (i: number): number => {
    const axis = 9 * body + 3 * i;
    return (xpos[3 * body + i] ?? 0) + (xmat[axis] ?? 0) * local[0] + (xmat[axis + 1] ?? 0) * local[1] + (xmat[axis + 2] ?? 0) * local[2];
  };
  return [row(0), row(1), row(2)];
}

/** A point of the world in the frame of a body. */
function localPoint({ xpos, xmat }: SceneFrame, body: number, point: readonly number[]): Point {
  const away = [0, 1, 2].map((i) => (point[i] ?? 0) - (xpos[3 * body + i] ?? 0));
  const column = (i: number): number => [0, 1, 2].reduce((sum, j) => sum + (xmat[9 * body + 3 * j + i] ?? 0) * (away[j] ?? 0), 0);
  return [column(0), column(1), column(2)];
}

function listen(element: HTMLElement, canvas: HTMLCanvasElement, view: View, opened: Opened, say: Say, actions: ViewportActions, state: PointerState): void {
  const pointers = new Map<number, { x: number; y: number }>();
  let [moved, mode]: [number, "turn" | "move" | "drag" | "none"] = [0, "none"];
  const place = (event: PointerEvent): { x: number; y: number } => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const activate = (on: boolean): void => {
    state.isActive = on;
    element.classList.toggle("active", on);
  };
  element.addEventListener("blur", () => activate(false));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    const at = place(event);
    moved = 0;
    // A second pointer pinches the picture: the first one drags no body then.
    if (mode === "drag") release(view, state, actions);
    // The ends of earlier pointers may have been lost, for example when the lab was moved in its page.
    if (event.isPrimary) pointers.clear();
    if (event.pointerType === "touch" && !state.isActive) {
      mode = "none";
      return void pointers.set(event.pointerId, at);
    }
    pointers.set(event.pointerId, at);
    canvas.setPointerCapture(event.pointerId);
    element.focus({ preventScroll: true });
    const found = event.button === 0 && pointers.size === 1 && !event.shiftKey && !event.ctrlKey ? view.pick(at.x, at.y) : null;
    if (found !== null && opened.movable[found.body] === true) {
      mode = "drag";
      state.target = [...found.point];
      state.held = { body: found.body, local: localPoint(state.frame, found.body, found.point), target: state.target };
      actions.drag(state.held);
      view.setDrag({ from: state.target, to: state.target });
    } else mode = event.button === 0 && !event.shiftKey && !event.ctrlKey ? "turn" : "move";
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (before === undefined) return;
    const at = place(event);
    const [dx, dy] = [at.x - before.x, at.y - before.y];
    moved += Math.abs(dx) + Math.abs(dy);
    pointers.set(event.pointerId, at);
    if (mode === "none") return;
    if (pointers.size === 2) {
      pinchCamera(view, [...pointers.values()], before, at);
      return view.draw();
    }
    if (mode === "drag") {
      // The body may have been released by a reset.
      if (state.held === null) return;
      state.target = view.unproject(at.x, at.y, state.target);
      state.held = { ...state.held, target: state.target };
      actions.drag(state.held);
      view.setDrag({ from: grabbedPoint(state.frame, state.held), to: state.target });
    } else if (mode === "turn") turnCamera(view.camera, -dx * TURN, dy * TURN);
    else panCamera(view, dx, dy);
    view.draw();
  });
  const end = (event: PointerEvent): void => {
    if (event.pointerType === "touch" && !state.isActive && moved < TAP && event.type === "pointerup") {
      element.focus({ preventScroll: true });
      activate(true);
    }
    if (!pointers.delete(event.pointerId)) return;
    if (mode === "drag") release(view, state, actions);
    if (pointers.size === 0) mode = "none";
  };
  for (const type of ["pointerup", "pointercancel", "lostpointercapture"] as const) canvas.addEventListener(type, end);
  element.addEventListener("wheel", (event) => {
    // A page that is scrolled is not held up: the picture zooms when it has the focus, or with Ctrl.
    if (element.getRootNode() instanceof ShadowRoot && (element.getRootNode() as ShadowRoot).activeElement !== element && !event.ctrlKey) return;
    event.preventDefault();
    zoomCamera(view.camera, Math.exp(clamp(event.deltaY, -200, 200) * 0.002));
    view.draw();
  }, { passive: false });
  element.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { held } = state;
    const used = held === null ? moveCameraByKey(view, event, state.home) : dragByKey(view, event, state, opened.model.extent, actions);
    if (!used) return;
    event.preventDefault();
    event.stopPropagation();
    if (held !== null && state.held === null) actions.say(say("released", { body: bodyName(opened, held.body, say) }));
    view.draw();
  });
}

/** Pulls the held body: arrows in the plane that faces the camera, Page Up and Page Down along the vertical. */
function dragByKey(view: View, event: KeyboardEvent, state: PointerState, extent: number, actions: ViewportActions): boolean {
  if (event.key === "Escape") {
    release(view, state, actions);
    return true;
  }
  if (state.held === null) return false;
  const stride = 0.05 * extent;
  const [right, up] = cameraAxes(view.camera);
  const moves: Record<string, Point> = {
    ArrowLeft: scaled(right, -stride), ArrowRight: scaled(right, stride), ArrowUp: scaled(up, stride), ArrowDown: scaled(up, -stride),
    PageUp: [0, 0, stride], PageDown: [0, 0, -stride],
  };
  const move = moves[event.key];
  if (move === undefined) return false;
  state.target = [state.target[0] + move[0], state.target[1] + move[1], state.target[2] + move[2]];
  state.held = { ...state.held, target: state.target };
  actions.drag(state.held);
  view.setDrag({ from: grabbedPoint(state.frame, state.held), to: state.target });
  return true;
}
