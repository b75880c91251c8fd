/** A first picture that nobody sees: drivers translate programs when they are first used, which takes longer than a picture. */
import type { Eye } from "./camera.js";
import { fitCanvas, type SharedContext } from "./context.js";
import { DrawList, LAYER, PLAIN, type Instance } from "./instances.js";
import type { Lights } from "./lights.js";
import { orthographic } from "./matrix.js";
import { MAX_LIGHTS, PATTERN } from "./programs.js";
import { drawPicture } from "./render.js";

/** Pixels. */
const SIZE = 16;

const EYE: Eye = { position: [0, 0, 3], right: [1, 0, 0], up: [0, 1, 0], forward: [0, 0, -1], halfHeight: 1, isOrthographic: false, near: 0.1, far: 10 };

/** A light from the eye, which casts shadows. */
function lightOfEye(): Lights {
  const four = (...values: number[]): Float32Array => {
    const all = new Float32Array(4 * MAX_LIGHTS);
    all.set(values);
    return all;
  };
  const three = (): Float32Array => new Float32Array(3 * MAX_LIGHTS).fill(1);
  return {
    count: 1, position: four(0, 0, 1, 0), direction: four(0, 0, -1, -1), diffuse: four(1, 1, 1, 0), specular: three(), attenuation: three(),
    sky: [1, 1, 1], ground: [1, 1, 1], shadowLight: 0, shadow: orthographic(1, 1, 0, 10), shadowPixel: 0.01,
  };
}

/** Draws a box, a plane and a line with the programs of a context. */
export function warmPrograms(context: SharedContext): void {
  const list = new DrawList();
  const box: Instance = {
    shape: "box", position: [0, 0, 0], rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], scale: [1, 1, 1], color: [1, 1, 1, 1], material: PLAIN,
    layer: LAYER.opaque, castsShadow: true,
  };
  list.push(box);
  list.push({ ...box, shape: "plane", layer: LAYER.plane, castsShadow: false, pattern: PATTERN.grid });
  list.push({ ...box, layer: LAYER.overlay, castsShadow: false });
  list.line([0, 0, 0], [1, 1, 0], [1, 1, 1, 1], 1);
  list.finish();
  fitCanvas(context, SIZE, SIZE);
  drawPicture(context, {
    width: SIZE, height: SIZE, eye: EYE, list, lights: lightOfEye(), geometry: { mesh: [], hfield: [], textures: [], sky: -1 }, grid: [1, 5, 10, 1],
    hiddenAlpha: 0.5, density: 1,
  });
  context.gpu.gl.flush();
}
