/** A view: keeps the scene, decides whether there is anything to draw, and brings the picture into its canvas. */
import { defaultCamera, placeEye, pointFacing, rayThrough, type Eye, type Ray } from "./camera.js";
import { addClient, fitCanvas, hasWebGl, removeClient, sharedContext, type Client, type SharedContext } from "./context.js";
import { nameGeometry, releaseGeometry, uploadGeometry, type Geometry } from "./geometry.js";
import { DrawList } from "./instances.js";
import { collectLights } from "./lights.js";
import { at, row3, type Vec3 } from "./matrix.js";
import {
  overlaySize, pushCameras, pushCentres, pushContacts, pushDrag, pushForces, pushFrames, pushJoints,
} from "./overlays.js";
import { castRay } from "./ray.js";
import { drawPicture } from "./render.js";
import { gridCell, planeReach, pushGeoms, pushSites } from "./scene.js";
import { pushTendons } from "./tendons.js";
import { makePalette, type Palette } from "./theme.js";
import { Trail } from "./trail.js";
import type { CameraPose, Overlay, Pick, SceneFrame, SceneModel, View, ViewOptions } from "./types.js";

/** m per N. */
const FORCE_SCALE = 0.02;
/** The maximum number of device pixels per CSS pixel. */
const MOST_DENSE = 2;

const triple = (a: ArrayLike<number>): Vec3 => [at(a, 0), at(a, 1), at(a, 2)];

export class SceneView implements View, Client {
  readonly camera: CameraPose;
  readonly overlays: Record<Overlay, boolean>;
  width = 0;
  height = 0;
  readonly #canvas: HTMLCanvasElement;
  readonly #options: ViewOptions;
  readonly #list = new DrawList();
  readonly #trail = new Trail();
  readonly #disposal = new AbortController();
  readonly #resize: ResizeObserver;
  readonly #visibility: IntersectionObserver;
  #model: SceneModel;
  #geometry: Geometry;
  #uploaded: { context: SharedContext; geometry: Geometry } | null = null;
  #frame: SceneFrame | null = null;
  #drag: { from: Vec3; to: Vec3 } | null = null;
  #palette: Palette;
  #isChanged = true;
  #isOnScreen = true;
  #isDisposed = false;
  /** Size in CSS pixels. */
  #size: readonly [number, number] = [0, 0];
  /** Camera and overlays of the last picture. */
  #drawn = "";

  constructor(canvas: HTMLCanvasElement, model: SceneModel, options: ViewOptions = {}) {
    if (!hasWebGl()) throw new Error("the 3D view needs WebGL 2");
    this.#canvas = canvas;
    this.#model = model;
    this.#options = options;
    this.#geometry = nameGeometry(model);
    this.camera = { ...defaultCamera(model), ...options.camera };
    this.overlays = {
      frames: false, joints: false, contacts: false, forces: false, com: false, sites: false, cameras: false, shadows: true, ...options.overlays,
    };
    this.#palette = makePalette(null, false, getComputedStyle(canvas).color);
    this.#fit(canvas.clientWidth, canvas.clientHeight);
    this.#resize = new ResizeObserver(() => {
      this.#fit(canvas.clientWidth, canvas.clientHeight);
      this.draw();
    });
    this.#visibility = new IntersectionObserver(entries => {
      this.#isOnScreen = entries.at(-1)?.isIntersecting ?? true;
      this.draw();
    });
    this.#resize.observe(canvas);
    this.#watchDensity();
    // A reset of the graphics processor empties the canvas too.
    canvas.addEventListener("contextrestored", () => { this.contextLost(); }, { signal: this.#disposal.signal });
    this.#visibility.observe(canvas);
    addClient(this);
  }

  setModel(model: SceneModel): void {
    this.#geometry = nameGeometry(model, { model: this.#model, geometry: this.#geometry });
    this.#model = model;
    this.#isChanged = true;
  }

  setFrame(frame: SceneFrame): void {
    this.#frame = frame;
    this.#isChanged = true;
    const { trail } = this.#options;
    if (trail !== undefined && trail >= 0) this.#trail.add(frame.time, row3(frame.site_xpos, trail), 0.002 * this.#model.extent);
  }

  clearTrail(): void {
    this.#trail.clear();
    this.#isChanged = true;
  }

  setDrag(drag: { from: readonly number[]; to: readonly number[] } | null): void {
    if (!drag && !this.#drag) return;
    this.#drag = drag && { from: triple(drag.from), to: triple(drag.to) };
    this.#isChanged = true;
  }

  setTheme(theme: { background: string | null; highContrast: boolean }): void {
    this.#palette = makePalette(theme.background, theme.highContrast, getComputedStyle(this.#canvas).color);
    this.#isChanged = true;
  }

  draw(): void {
    const [width, height] = this.#size;
    this.#fit(width, height);
    const state = this.#state();
    if (this.#isDisposed || !this.#isOnScreen || !this.#frame || this.width === 0 || this.height === 0) return;
    if (!this.#isChanged && state === this.#drawn) return;
    const isDone = this.#paint(this.#canvas, this.width, this.height, this.width / width);
    if (!isDone) return;
    this.#isChanged = false;
    this.#drawn = state;
  }

  pick(x: number, y: number): Pick | null {
    if (!this.#frame) return null;
    const hit = castRay(this.#model, this.#frame, this.#rayAt(x, y, this.#frame).ray);
    if (!hit) return null;
    const [px, py, pz] = hit.point;
    return { geom: hit.geom, body: at(this.#model.geom_bodyid, hit.geom), point: [px, py, pz], distance: hit.distance };
  }

  unproject(x: number, y: number, through: readonly number[]): [number, number, number] {
    const point = triple(through);
    if (!this.#frame) return [point[0], point[1], point[2]];
    const { eye, ray } = this.#rayAt(x, y, this.#frame);
    return pointFacing(eye, ray, point);
  }

  async toPng(width: number, height: number): Promise<Blob> {
    const canvas = document.createElement("canvas");
    canvas.width = width;
    canvas.height = height;
    this.#paint(canvas, width, height, Math.max(1, width / Math.max(1, this.#size[0])));
    return new Promise((resolve, reject) => {
      canvas.toBlob(blob => { if (blob) resolve(blob); else reject(new Error("the picture is too large")); }, "image/png");
    });
  }

  dispose(): void {
    if (this.#isDisposed) return;
    this.#isDisposed = true;
    this.#disposal.abort();
    this.#resize.disconnect();
    this.#visibility.disconnect();
    if (this.#uploaded) releaseGeometry(this.#uploaded.context, this.#uploaded.geometry);
    this.#uploaded = null;
    removeClient(this);
  }

  contextLost(): void {
    this.#isChanged = true;
    this.draw();
  }

  /** Gives the canvas the pixels of its size on the page. */
  #fit(width: number, height: number): void {
    this.#size = [width, height];
    const density = Math.min(devicePixelRatio, MOST_DENSE), [w, h] = [Math.round(width * density), Math.round(height * density)];
    if (w === this.width && h === this.height) return;
    [this.width, this.height] = [w, h];
    this.#canvas.width = w;
    this.#canvas.height = h;
    this.#isChanged = true;
  }

  /** Draws again when the page moves to a screen with other pixels. */
  #watchDensity(): void {
    const change = (): void => {
      this.#watchDensity();
      this.draw();
    };
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", change, { once: true, signal: this.#disposal.signal });
  }

  /** The camera and the overlays as a text, to detect changes. */
  #state(): string {
    const { azimuth, elevation, distance, target, fixed, track } = this.camera, o = this.overlays;
    return [azimuth, elevation, distance, ...target, fixed, track, o.frames, o.joints, o.contacts, o.forces, o.com, o.sites, o.cameras, o.shadows].join();
  }

  #rayAt(x: number, y: number, frame: SceneFrame): { eye: Eye; ray: Ray } {
    const [width, height] = this.#size, eye = placeEye(this.camera, this.#model, frame);
    return { eye, ray: rayThrough(eye, width / height, (2 * x) / width - 1, 1 - (2 * y) / height) };
  }

  #fill(frame: SceneFrame, eye: Eye, height: number): void {
    const list = this.#list, m = this.#model, palette = this.#palette, show = this.overlays, size = overlaySize(m);
    list.begin(eye, height);
    pushGeoms(list, m, frame, this.#geometry, eye, palette);
    pushTendons(list, m, frame, eye);
    if (show.sites) pushSites(list, m, frame, eye);
    if (show.frames) pushFrames(list, frame, size, palette);
    if (show.joints) pushJoints(list, m, frame, size, palette);
    if (show.com) pushCentres(list, m, frame, size, palette);
    if (show.cameras) pushCameras(list, m, frame, size, palette);
    if (show.contacts) pushContacts(list, frame, size, palette);
    if (show.forces) pushForces(list, frame, this.#options.forceScale ?? FORCE_SCALE, size, palette);
    this.#trail.push(list, palette);
    if (this.#drag) pushDrag(list, this.#drag.from, this.#drag.to, size, palette);
    list.finish();
  }

  #upload(context: SharedContext): void {
    const last = this.#uploaded;
    if (last?.context === context && last.geometry === this.#geometry) return;
    uploadGeometry(context, this.#model, this.#geometry);
    if (last?.context === context) releaseGeometry(context, last.geometry);
    this.#uploaded = { context, geometry: this.#geometry };
  }

  /** Draws the scene into a canvas. Returns false if the browser has no WebGL context at present. */
  #paint(canvas: HTMLCanvasElement, width: number, height: number, density: number): boolean {
    const frame = this.#frame, context = sharedContext(), target = canvas.getContext("2d");
    if (!frame || !context || !target) return false;
    const eye = placeEye(this.camera, this.#model, frame), m = this.#model, reach = planeReach(m, eye);
    this.#fill(frame, eye, height);
    this.#upload(context);
    fitCanvas(context, width, height);
    drawPicture(context, {
      width, height, eye, list: this.#list, lights: collectLights(m, frame, eye, this.#palette, this.overlays.shadows), geometry: this.#geometry,
      grid: [gridCell(m), 0.15 * reach, 0.8 * reach, this.#palette.grid], hiddenAlpha: this.#palette.hiddenAlpha, density,
    });
    target.clearRect(0, 0, width, height);
    if (this.#palette.background !== null) {
      target.fillStyle = this.#palette.background;
      target.fillRect(0, 0, width, height);
    }
    target.drawImage(context.canvas, 0, context.canvas.height - height, width, height, 0, 0, width, height);
    return true;
  }
}
