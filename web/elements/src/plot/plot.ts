/** A plot with its legend, hover values, table and export. */
import { fileName, h, saveFile, setText } from "../dom.js";
import type { PlotSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { formatBrief, formatTime } from "../text/numbers.js";
import { drawPlot, timeOf, type PlotArea, type PlotLook } from "./draw.js";
import { addRows, clearSeries, createSeries, nearestIndex, resolutionOf, toCsv, type Series } from "./series.js";
import { startSound, type Sound } from "./sound.js";
import { describeTrace, tableRows } from "./summary.js";

export interface Plot {
  readonly element: HTMLElement;
  readonly series: Series;
  /** Adds samples: rows of `width` numbers, time first. */
  add(rows: Float64Array, width: number): void;
  clear(): void;
  /** Draws, where something has changed. */
  draw(): void;
  /** Takes the colours of the page again. */
  restyle(): void;
  /** What the traces do, in sentences. */
  describe(): string[];
  dispose(): void;
}

/** A plot whose traces are the `columns` of a row, counted after the time. */
export function createPlot(spec: PlotSpec, columns: readonly number[], title: string, say: Say): Plot {
  const series = createSeries(columns.length, spec.window);
  const labels = columns.map((_, i) => spec.traces[i]?.label ?? "");
  const timeLabel = spec.xlabel ?? say("time");
  const canvas = h("canvas", { part: "plot-canvas" });
  const values = labels.map(() => h("span", { class: "trace-value" }));
  const swatches = labels.map((_, i) => colored(h("span", { class: spec.traces[i]?.dash === true ? "swatch dashed" : "swatch" }), `--_trace-${i % 8}`));
  const legend = h("ul", { class: "legend", part: "legend" },
    ...labels.map((label, i) => h("li", {}, swatches[i], h("span", { class: "trace-label" }, label), values[i])));
  const hoverTime = h("span", { class: "hover-time" });
  const spoken = h("p", { class: "hidden", role: "status" });
  const names = labels.join(", ");
  const stage = h("div", { class: "plot-stage", tabindex: 0, role: "group", "aria-label": `${say("plotOf", { traces: names })}. ${say("plotHelp")}` }, canvas);
  stage.style.height = `${spec.height}px`;
  const table = h("tbody");
  const details = h("details", { class: "plot-data", part: "plot-data" }, h("summary", {}, say("data")));
  const csv = h("button", { type: "button", class: "quiet" }, say("saveCsv"));
  const png = h("button", { type: "button", class: "quiet" }, say("savePng"));
  const listen = h("button", { type: "button", class: "quiet", "aria-pressed": "false" }, say("sound", { label: labels[0] ?? "" }));
  details.append(
    h("div", { class: "plot-actions" }, csv, png, labels.length > 0 && listen),
    h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": say("dataOf", { traces: names }) },
      h("table", {}, h("caption", { class: "hidden" }, say("dataOf", { traces: names })),
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, timeLabel), ...labels.map((label) => h("th", { scope: "col" }, label)))), table)));
  const element = h("figure", { class: "plot", part: "plot" },
    h("figcaption", { class: "plot-head" }, h("span", { class: "plot-title" }, spec.ylabel), hoverTime, legend),
    stage, h("div", { class: "plot-foot" }, details, h("span", { class: "plot-xlabel" }, timeLabel)), spoken);

  let [area, look]: [PlotArea | null, PlotLook | null] = [null, null];
  let [hovered, isStale, columnsWidth] = [-1, true, 1 + columns.length];
  let size: readonly [number, number] = [0, 0];
  let sound: Sound | null = null;

  const fillTable = (): void => {
    if (!details.open) return;
    const rows = tableRows(series).map((row) => h("tr", {}, ...row.map((cell, i) => (i === 0 ? h("th", { scope: "row" }, cell) : h("td", {}, cell)))));
    table.replaceChildren(...rows);
  };
  const printed = (trace: number, index: number): string => formatBrief(series.values[trace]?.[index] ?? NaN, resolutionOf(series, trace));
  const showValues = (): void => {
    const index = hovered >= 0 && hovered < series.length ? hovered : series.length - 1;
    values.forEach((value, i) => setText(value, index < 0 ? "" : printed(i, index).replace(/^-/, "−")));
    setText(hoverTime, hovered >= 0 && index >= 0 ? say("at", { time: formatTime(series.times[index] ?? NaN) }) : "");
  };
  const hover = (index: number): void => {
    if (index === hovered) return;
    [hovered, isStale] = [index, true];
    draw();
  };
  const draw = (): void => {
    if (!isStale || size[0] < 1) return;
    const context = canvas.getContext("2d");
    if (context === null) return;
    look ??= readLook(element, swatches);
    const ratio = Math.min(3, globalThis.devicePixelRatio || 1);
    const [width, height] = [Math.round(size[0] * ratio), Math.round(size[1] * ratio)];
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    area = drawPlot(context, series, spec, look, size, hovered);
    isStale = false;
    showValues();
  };
  const resize = new ResizeObserver(() => {
    size = [stage.clientWidth, stage.clientHeight];
    isStale = true;
    draw();
  });
  resize.observe(stage);

  stage.addEventListener("pointermove", (event) => {
    if (area !== null) hover(nearestIndex(series, timeOf(area, event.clientX - canvas.getBoundingClientRect().left)));
  });
  stage.addEventListener("pointerleave", () => hover(-1));
  stage.addEventListener("blur", () => hover(-1));
  stage.addEventListener("keydown", (event) => {
    const stride = event.shiftKey ? 50 : 5;
    const from = hovered < 0 ? series.length - 1 : hovered;
    const moves: Record<string, number> = { ArrowLeft: from - stride, ArrowRight: from + stride, Home: 0, End: series.length - 1, Escape: -1 };
    const to = moves[event.key];
    if (to === undefined || series.length === 0) return;
    event.preventDefault();
    hover(event.key === "Escape" ? -1 : Math.max(0, Math.min(series.length - 1, to)));
    if (hovered < 0) return;
    const readings = labels.map((label, i) => `${label} ${printed(i, hovered)}`);
    setText(spoken, `${say("at", { time: formatTime(series.times[hovered] ?? NaN) })}: ${readings.join(", ")}`);
  });
  const silence = (): void => {
    sound?.stop();
    sound = null;
    listen.setAttribute("aria-pressed", "false");
  };
  listen.addEventListener("click", () => {
    if (sound !== null) return silence();
    sound = startSound();
    listen.setAttribute("aria-pressed", "true");
  });
  details.addEventListener("toggle", fillTable);
  const name = fileName(`${title} ${spec.ylabel}`);
  csv.addEventListener("click", () => saveFile(`${name}.csv`, new Blob([toCsv(series, labels, timeLabel)], { type: "text/csv" })));
  png.addEventListener("click", () => exportPng(canvas, spec.ylabel, look, name));

  return {
    element, series,
    add(rows, width) {
      columnsWidth = width;
      addRows(series, rows, columnsWidth, columns);
      if (rows.length > 0) {
        isStale = true;
        sound?.play(series, 0);
      }
      if (hovered >= series.length) hovered = -1;
    },
    clear() {
      clearSeries(series);
      [hovered, isStale] = [-1, true];
    },
    draw() {
      draw();
      fillTableWhenOpen(details, fillTable);
    },
    restyle() {
      [look, isStale] = [null, true];
      draw();
    },
    dispose() {
      resize.disconnect();
      silence();
    },
    describe: () => labels.map((label, i) => describeTrace(series, i, label, say)).filter((text) => text !== null),
  };
}

/** A table that is open follows the run a few times in a second. */
const filled = new WeakMap<Element, number>();
function fillTableWhenOpen(details: HTMLDetailsElement, fill: () => void): void {
  if (!details.open) return;
  const now = performance.now();
  if (now - (filled.get(details) ?? 0) < 300) return;
  filled.set(details, now);
  fill();
}

/** Gives an element a colour of the style sheet. A policy that forbids `style` attributes allows this. */
function colored<E extends HTMLElement>(element: E, name: string): E {
  element.style.color = `var(${name})`;
  return element;
}

/** The colours that the style sheet gives the plot. */
function readLook(element: HTMLElement, swatches: readonly HTMLElement[]): PlotLook {
  const style = getComputedStyle(element);
  const colorOf = (name: string): string => {
    const probe = colored(h("span"), name);
    element.append(probe);
    const { color } = getComputedStyle(probe);
    probe.remove();
    return color;
  };
  const traces = swatches.map((swatch) => getComputedStyle(swatch).color);
  return {
    font: style.fontFamily, lineWidth: matchMedia("(forced-colors: active)").matches ? 2.5 : 1.8,
    colors: {
      text: colorOf("--_muted"), grid: colorOf("--_grid"), axis: colorOf("--_axis"), reference: colorOf("--_reference"),
      background: colorOf("--_surface"), traces,
    },
  };
}

/** The plot as a picture on a plain ground, with its title. */
function exportPng(canvas: HTMLCanvasElement, title: string, look: PlotLook | null, name: string): void {
  const ratio = canvas.width / Math.max(1, canvas.clientWidth);
  const head = Math.round(22 * ratio);
  const picture = h("canvas", { width: canvas.width, height: canvas.height + head });
  const context = picture.getContext("2d");
  if (context === null || look === null) return;
  context.fillStyle = look.colors.background;
  context.fillRect(0, 0, picture.width, picture.height);
  context.fillStyle = look.colors.text;
  context.font = `${12 * ratio}px ${look.font}`;
  context.textBaseline = "middle";
  context.fillText(title, 8 * ratio, head / 2);
  context.drawImage(canvas, 0, head);
  picture.toBlob((blob) => {
    if (blob !== null) saveFile(`${name}.png`, blob);
  });
}
