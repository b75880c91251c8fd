/** How fine round shapes are drawn. A ball of a few pixels looks the same with a ninth of the triangles of a large one. */
import { depthOf, type Eye } from "./camera.js";
import type { Instance } from "./instances.js";

/** Slices around a ball or a capsule, from fine to coarse, and what the name of the shape ends with. */
export const LEVELS = [[48, ""], [24, "/24"], [16, "/16"]] as const;

/** The outline of a coarse ball may be this far inside the true one, pixels. */
const MOST_ERROR = 0.25;

/** The outline of a ball of radius 1 that is drawn with this number of slices is inside the true one by this. */
const errorOf = (slices: number): number => 1 - Math.cos(Math.PI / slices);

/** The name of the shape with which an instance is drawn in a picture of `height` pixels. */
export function detailed({ shape, position, scale, shift = 0 }: Instance, eye: Eye, height: number): string {
  if (shape !== "sphere" && shape !== "capsule") return shape;
  const radius = Math.max(...scale);
  // The nearest point of the instance.
  const depth = eye.isOrthographic ? 1 : depthOf(eye, position) - radius - shift;
  if (!(depth > 0)) return shape;
  const pixels = (radius * height) / (2 * eye.halfHeight * depth);
  const [, ending] = LEVELS.findLast(([slices]) => errorOf(slices) * pixels <= MOST_ERROR) ?? LEVELS[0];
  return `${shape}${ending}`;
}
