/** The path of a site: its last points, until time goes back. */
import type { DrawList } from "./instances.js";
import { length, sub, type Vec3 } from "./matrix.js";
import type { Palette } from "./theme.js";

const MOST_POINTS = 1200;

export class Trail {
  #points: Vec3[] = [];
  #time = -Infinity;

  clear(): void {
    this.#points = [];
    this.#time = -Infinity;
  }

  /** Adds a point, unless it is nearer than `spacing` to the last one. */
  add(time: number, point: Vec3, spacing: number): void {
    if (time < this.#time) this.clear();
    this.#time = time;
    const last = this.#points.at(-1);
    if (!point.every(Number.isFinite) || (last && length(sub(point, last)) < spacing)) return;
    this.#points.push(point);
    if (this.#points.length > MOST_POINTS) this.#points.splice(0, MOST_POINTS / 4);
  }

  /** Draws the path; its oldest part is faint. */
  push(list: DrawList, palette: Palette): void {
    const [r, g, b] = palette.trail, count = this.#points.length;
    for (let i = 0; i + 1 < count; i++) {
      const [from, to] = [this.#points[i], this.#points[i + 1]];
      if (from && to) list.line(from, to, [r, g, b, 0.15 + (0.85 * (i + 1)) / count], palette.lineWidth);
    }
  }
}
