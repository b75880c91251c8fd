/** What a lab shows at its end, as evidence beside a prediction: its readouts, its curves, and what happened. */
import { h } from "../dom.js";
import type { SimLab } from "../lab/element.js";
import { curveOf } from "../plot/curve.js";
import { describeTrace } from "../plot/summary.js";
import type { Say } from "../text/messages.js";
import { formatTime } from "../text/numbers.js";

/** Events that are listed. */
const MOST_EVENTS = 12;
const MOST_CURVES = 4;

/** The prediction and the evidence, side by side. */
export function compareWithLab(prediction: string, lab: SimLab, say: Say): HTMLElement {
  const happened = h("div", { class: "evidence" }, h("p", {}, say("happened", { time: formatTime(lab.time) })), readoutsOf(lab), ...curvesOf(lab, say), eventsOf(lab, say));
  return h("div", { class: "beside" }, h("p", { class: "said" }, say("committed", { answer: prediction })), happened);
}

function readoutsOf(lab: SimLab): HTMLElement | null {
  const labels = lab.shown.filter((one) => one.plot === undefined).map((one) => one.label);
  return labels.length === 0 ? null : h("dl", {}, ...labels.flatMap((label, i) => [h("dt", {}, label), h("dd", {}, lab.texts[i] ?? "")]));
}

function curvesOf(lab: SimLab, say: Say): (HTMLElement | null)[] {
  return lab.traces.slice(0, MOST_CURVES).map(({ label, series, trace }) => {
    const text = describeTrace(series, trace, label, say);
    const curve = text === null ? null : curveOf(series, trace, text);
    return curve === null ? null : h("figure", { class: "evidence-curve" }, curve, h("figcaption", {}, text));
  });
}

function eventsOf(lab: SimLab, say: Say): HTMLElement | null {
  const events = lab.events.slice(0, MOST_EVENTS);
  return events.length === 0 ? null : h("div", {}, h("p", {}, say("events")), h("ol", { class: "evidence-events" }, ...events.map((event) => h("li", {}, event))));
}
