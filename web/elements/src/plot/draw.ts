/** One frame of a plot on a canvas: grid, reference lines, traces, the sample under the pointer. */
import type { PlotSpec } from "../spec.js";
import { formatTick } from "../text/numbers.js";
import { tickSpacing, ticks, timeRange, valueRange, type Range } from "./scale.js";
import { indexAt, type Series } from "./series.js";

export interface PlotColors {
  readonly text: string;
  readonly grid: string;
  readonly axis: string;
  readonly reference: string;
  readonly background: string;
  readonly traces: readonly string[];
}

export interface PlotLook {
  readonly colors: PlotColors;
  readonly font: string;
  readonly lineWidth: number;
}

/** Where values are on the canvas, in CSS pixels. */
export interface PlotArea {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
  readonly times: Range;
  readonly values: Range;
}

const FONT_SIZE = 11;
export const DASH = [5, 4];

/** Draws a plot of `width` x `height` CSS pixels; `hovered` is the sample that is marked, or -1. */
export function drawPlot(
  context: CanvasRenderingContext2D, series: Series, spec: PlotSpec, look: PlotLook, size: readonly [number, number], hovered: number,
): PlotArea {
  const [width, height] = size;
  const { colors } = look;
  context.clearRect(0, 0, width, height);
  context.font = `${FONT_SIZE}px ${look.font}`;
  const times = timeRange(series, spec.window);
  const values = valueRange(series, spec, times);
  const spacing = tickSpacing(values, Math.max(2, Math.floor((height - 26) / 26)));
  const marks = ticks(values, spacing).map((y) => [y, formatTick(y, spacing)] as const);
  const left = Math.ceil(Math.max(20, ...marks.map(([, text]) => context.measureText(text).width))) + 8;
  const area: PlotArea = { left, top: 6, width: Math.max(10, width - left - 8), height: Math.max(10, height - 26), times, values };
  drawAxes(context, area, marks, colors);
  drawReferences(context, area, spec, colors);
  context.save();
  context.beginPath();
  context.rect(area.left, area.top - 2, area.width + 2, area.height + 4);
  context.clip();
  for (let trace = 0; trace < series.traces; trace++) {
    context.strokeStyle = colors.traces[trace % colors.traces.length] ?? colors.text;
    context.lineWidth = look.lineWidth;
    context.setLineDash(spec.traces[trace]?.dash === true ? DASH : []);
    strokeTrace(context, area, series, trace);
  }
  context.setLineDash([]);
  if (hovered >= 0 && hovered < series.length) drawHovered(context, area, series, hovered, look);
  context.restore();
  return area;
}

export function xOf(area: PlotArea, time: number): number {
  return area.left + ((time - area.times.min) / (area.times.max - area.times.min)) * area.width;
}

export function timeOf(area: PlotArea, x: number): number {
  return area.times.min + ((x - area.left) / area.width) * (area.times.max - area.times.min);
}

function yOf(area: PlotArea, value: number): number {
  return area.top + ((area.values.max - value) / (area.values.max - area.values.min)) * area.height;
}

function drawAxes(context: CanvasRenderingContext2D, area: PlotArea, marks: readonly (readonly [number, string])[], colors: PlotColors): void {
  const bottom = area.top + area.height;
  context.lineWidth = 1;
  context.textBaseline = "middle";
  context.textAlign = "right";
  for (const [y, text] of marks) {
    const at = Math.round(yOf(area, y)) + 0.5;
    strokeLine(context, area.left, at, area.left + area.width, at, colors.grid);
    context.fillStyle = colors.text;
    context.fillText(text, area.left - 6, at);
  }
  context.textBaseline = "top";
  context.textAlign = "center";
  const spacing = tickSpacing(area.times, Math.max(2, Math.floor(area.width / 70)));
  for (const t of ticks(area.times, spacing)) {
    const at = Math.round(xOf(area, t)) + 0.5;
    if (at > area.left + 1) strokeLine(context, at, area.top, at, bottom, colors.grid);
    const text = formatTick(t, spacing);
    const half = context.measureText(text).width / 2;
    context.fillStyle = colors.text;
    context.fillText(text, Math.min(at, area.left + area.width + 7 - half), bottom + 6);
  }
  strokeLine(context, area.left, bottom + 0.5, area.left + area.width, bottom + 0.5, colors.axis);
}

function drawReferences(context: CanvasRenderingContext2D, area: PlotArea, spec: PlotSpec, colors: PlotColors): void {
  for (const { y, label } of spec.refLines) {
    if (y < area.values.min || y > area.values.max) continue;
    const at = Math.round(yOf(area, y)) + 0.5;
    context.setLineDash([2, 3]);
    strokeLine(context, area.left, at, area.left + area.width, at, colors.reference);
    context.setLineDash([]);
    if (label === "") continue;
    context.textAlign = "right";
    context.textBaseline = at - area.top > 14 ? "bottom" : "top";
    const [x, baseline] = [area.left + area.width - 4, at + (at - area.top > 14 ? -2 : 3)];
    context.lineWidth = 3;
    context.strokeStyle = colors.background;
    context.strokeText(label, x, baseline);
    context.fillStyle = colors.reference;
    context.fillText(label, x, baseline);
    context.lineWidth = 1;
  }
}

function strokeLine(context: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number, color: string): void {
  context.strokeStyle = color;
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

/** A trace. Where many samples fall on one column of pixels, its first, least, greatest and last value are drawn. */
function strokeTrace(context: CanvasRenderingContext2D, area: PlotArea, series: Series, trace: number): void {
  const list = series.values[trace];
  if (list === undefined) return;
  const from = Math.max(0, indexAt(series, area.times.min) - 1);
  const scale = area.height / (area.values.max - area.values.min);
  const top = area.values.max;
  let isOpen = false;
  context.beginPath();
  let i = from;
  while (i < series.length) {
    const first = list[i] ?? NaN;
    if (!Number.isFinite(first)) {
      isOpen = false;
      i++;
      continue;
    }
    const column = Math.round(2 * xOf(area, series.times[i] ?? 0)) / 2;
    let [low, high, last, next] = [first, first, first, i + 1];
    while (next < series.length && Math.round(2 * xOf(area, series.times[next] ?? 0)) / 2 === column) {
      const y = list[next] ?? NaN;
      if (!Number.isFinite(y)) break;
      if (y < low) low = y;
      if (y > high) high = y;
      last = y;
      next++;
    }
    const y = (value: number): number => area.top + (top - value) * scale;
    if (isOpen) context.lineTo(column, y(first));
    else context.moveTo(column, y(first));
    isOpen = true;
    if (next - i > 2) {
      context.lineTo(column, y(low));
      context.lineTo(column, y(high));
    }
    if (next - i > 1) context.lineTo(column, y(last));
    i = next;
  }
  context.lineJoin = "round";
  context.stroke();
}

function drawHovered(context: CanvasRenderingContext2D, area: PlotArea, series: Series, index: number, look: PlotLook): void {
  const x = Math.round(xOf(area, series.times[index] ?? 0)) + 0.5;
  strokeLine(context, x, area.top, x, area.top + area.height, look.colors.axis);
  series.values.forEach((list, trace) => {
    const value = list[index] ?? NaN;
    if (!Number.isFinite(value)) return;
    context.beginPath();
    context.arc(x, yOf(area, value), 3.5, 0, 2 * Math.PI);
    context.fillStyle = look.colors.traces[trace % look.colors.traces.length] ?? look.colors.text;
    context.fill();
    context.strokeStyle = look.colors.background;
    context.lineWidth = 1.5;
    context.stroke();
  });
}
