/** The one WebGL context of a page: browsers allow about 16, and a page may have more views. */
import { createGpu, deleteShape, uploadShape, uploadTexture, type Gpu, type UploadedShape, type UploadedTexture } from "./gpu.js";
import { SHAPES, type Shape, type ShapeName } from "./shapes.js";
import type { SceneTexture } from "./types.js";

/** A view, as the context knows it. */
export interface Client {
  /** Size of its picture, pixels. */
  readonly width: number;
  readonly height: number;
  /** The context was lost, with everything that was uploaded. */
  contextLost(): void;
}

interface Counted<T> {
  readonly value: T;
  users: number;
}

/** Time until a lost context is replaced, and the longest time between two attempts, ms. */
const RETRY = 100, LONGEST_RETRY = 8000;

function newCanvas(): HTMLCanvasElement | OffscreenCanvas {
  return typeof OffscreenCanvas === "undefined" ? document.createElement("canvas") : new OffscreenCanvas(1, 1);
}

/** A canvas with its context, and everything that is uploaded to it. */
export class SharedContext {
  readonly #shapes = new Map<string, Counted<UploadedShape>>();
  readonly #textures = new Map<string, Counted<UploadedTexture>>();
  private constructor(readonly canvas: HTMLCanvasElement | OffscreenCanvas, readonly gpu: Gpu) {}

  static create(onLost: () => void): SharedContext | null {
    let canvas = newCanvas();
    const wanted: WebGLContextAttributes = { alpha: true, antialias: true, premultipliedAlpha: true };
    let gl = canvas.getContext("webgl2", wanted) as WebGL2RenderingContext | null;
    if (!gl && !(canvas instanceof HTMLCanvasElement)) {
      // Some browsers have WebGL 2 for canvases of the document only.
      canvas = document.createElement("canvas");
      gl = canvas.getContext("webgl2", wanted);
    }
    if (!gl || gl.isContextLost()) return null;
    canvas.addEventListener("webglcontextlost", onLost, { once: true });
    return new SharedContext(canvas, createGpu(gl));
  }

  /** Makes the canvas as large as the largest picture. */
  fit(width: number, height: number): void {
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
  }

  shape(name: string): UploadedShape | null {
    const found = this.#shapes.get(name);
    if (found) return found.value;
    if (!(name in SHAPES)) return null;
    // The shapes of geom types are never removed.
    const value = uploadShape(this.gpu.gl, SHAPES[name as ShapeName]());
    this.#shapes.set(name, { value, users: 1 });
    return value;
  }

  texture(name: string): UploadedTexture | null {
    return this.#textures.get(name)?.value ?? null;
  }

  /** Uploads a shape, unless another view has. */
  addShape(name: string, make: () => Shape): void {
    const found = this.#shapes.get(name);
    if (found) found.users++;
    else this.#shapes.set(name, { value: uploadShape(this.gpu.gl, make()), users: 1 });
  }

  addTexture(name: string, image: SceneTexture): void {
    const found = this.#textures.get(name);
    if (found) found.users++;
    else this.#textures.set(name, { value: uploadTexture(this.gpu.gl, image), users: 1 });
  }

  removeShape(name: string): void {
    const found = this.#shapes.get(name);
    if (!found || --found.users > 0) return;
    deleteShape(this.gpu.gl, found.value);
    this.#shapes.delete(name);
  }

  removeTexture(name: string): void {
    const found = this.#textures.get(name);
    if (!found || --found.users > 0) return;
    this.gpu.gl.deleteTexture(found.value.texture);
    this.#textures.delete(name);
  }

  /** Uploaded shapes and textures, for tests. */
  get uploads(): { shapes: number; textures: number } {
    return { shapes: this.#shapes.size, textures: this.#textures.size };
  }

  free(): void {
    this.gpu.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

let shared: SharedContext | null = null;
let hasHadContext = false;
/** Before this time no context is asked for, after one was refused. */
let refusedUntil = 0;
const clients = new Set<Client>();

/** Draws every view again as soon as there is a context; a browser may refuse one for a while. */
function revive(delay: number): void {
  setTimeout(() => {
    if (clients.size === 0) return;
    if (sharedContext()) for (const client of clients) client.contextLost();
    else revive(Math.min(2 * delay, LONGEST_RETRY));
  }, delay);
}

function contextLost(of: SharedContext | null): void {
  // A context that was freed on purpose has been replaced already.
  if (of !== shared) return;
  shared = null;
  revive(RETRY);
}

/** The context of the page; null if the browser has none at present. */
export function sharedContext(): SharedContext | null {
  if (shared?.gpu.gl.isContextLost()) contextLost(shared);
  if (!shared && performance.now() >= refusedUntil) {
    const made: { context: SharedContext | null } = { context: null };
    made.context = SharedContext.create(() => { contextLost(made.context); });
    shared = made.context;
    if (shared) hasHadContext = true;
    else refusedUntil = performance.now() + RETRY / 2;
  }
  return shared;
}

/** Whether the browser has WebGL 2, even if it has lost its context at the moment. */
export const hasWebGl = (): boolean => hasHadContext || sharedContext() !== null;

export function addClient(client: Client): void { clients.add(client); }

/** Forgets a view; the context is freed with the last one. */
export function removeClient(client: Client): void {
  clients.delete(client);
  if (clients.size > 0 || !shared) return;
  const last = shared;
  shared = null;
  last.free();
}

/** Makes the shared canvas large enough for every view and for a picture of this size. */
export function fitCanvas(context: SharedContext, width: number, height: number): void {
  let [w, h] = [width, height];
  for (const client of clients) [w, h] = [Math.max(w, client.width), Math.max(h, client.height)];
  context.fit(w, h);
}
