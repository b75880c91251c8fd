/** A small curve as SVG, for texts: a trace with its first and last time and its smallest and largest value. */
import { formatBrief, formatTime } from "../text/numbers.js";
import { extremes, resolutionOf, type Series } from "./series.js";

const WIDTH = 240, HEIGHT = 64;
const MOST_POINTS = 240;
const SPACE = "http://www.w3.org/2000/svg";

function draw(name: string, attributes: Readonly<Record<string, string | number>>, text = ""): SVGElement {
  const element = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.textContent = text;
  return element;
}

/** The curve of a trace; null where it has no numbers. `label` describes it to those who do not see it. */
export function curveOf(series: Series, trace: number, label: string): SVGElement | null {
  const found = extremes(series, trace, 0, series.length);
  const list = series.values[trace];
  if (found === null || list === undefined || series.length < 2) return null;
  const [start, end] = [series.times[0] ?? 0, series.times[series.length - 1] ?? 0];
  const x = (time: number): number => (end > start ? ((time - start) / (end - start)) * WIDTH : 0);
  const y = (value: number): number => (found.max > found.min ? ((found.max - value) / (found.max - found.min)) * HEIGHT : HEIGHT / 2);
  let [path, isOpen] = ["", false];
  for (const i of pointsOf(list, series.length)) {
    const value = list[i] ?? NaN;
    if (Number.isFinite(value)) path += `${isOpen ? "L" : "M"}${x(series.times[i] ?? 0).toFixed(1)} ${y(value).toFixed(1)}`;
    isOpen = Number.isFinite(value);
  }
  const svg = draw("svg", { viewBox: `-4 -14 ${WIDTH + 8} ${HEIGHT + 30}`, width: WIDTH + 8, height: HEIGHT + 30, role: "img", "aria-label": label, class: "curve" });
  const resolution = resolutionOf(series, trace);
  const note = (at: number, row: number, anchor: string, text: string): SVGElement => draw("text", { x: at, y: row, "text-anchor": anchor }, text);
  svg.append(
    draw("line", { x1: 0, x2: WIDTH, y1: HEIGHT + 1, y2: HEIGHT + 1 }), draw("path", { d: path }),
    note(0, -4, "start", formatBrief(found.max, resolution)), note(0, HEIGHT - 4, "start", found.max > found.min ? formatBrief(found.min, resolution) : ""),
    note(0, HEIGHT + 13, "start", `${formatTime(start)} s`), note(WIDTH, HEIGHT + 13, "end", `${formatTime(end)} s`));
  return svg;
}

/** The samples of a curve: of many, the lowest and the highest of each part. */
function pointsOf(list: Float64Array, length: number): number[] {
  const stride = Math.max(1, Math.ceil((2 * length) / MOST_POINTS));
  const points: number[] = [];
  for (let from = 0; from < length; from += stride) {
    let [low, high] = [from, from];
    for (let i = from; i < Math.min(from + stride, length); i++) {
      if ((list[i] ?? NaN) < (list[low] ?? NaN)) low = i;
      if ((list[i] ?? NaN) > (list[high] ?? NaN)) high = i;
    }
    points.push(Math.min(low, high));
    if (low !== high) points.push(Math.max(low, high));
  }
  if (points[points.length - 1] !== length - 1) points.push(length - 1);
  return points;
}
