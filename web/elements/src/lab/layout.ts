/** The layout of a lab. */
import type { Finding } from "labspec/slim";
import { h, icon } from "../dom.js";
import type { LabSpec } from "../spec.js";
import type { Say } from "../text/messages.js";
import { safeHtml } from "../text/sanitize.js";

export interface LabParts {
  readonly spec: LabSpec;
  readonly title: string;
  readonly say: Say;
  readonly view: HTMLElement;
  readonly viewBar: HTMLElement | null;
  readonly toolbar: HTMLElement;
  readonly controls: readonly HTMLElement[];
  readonly buttons: readonly HTMLElement[];
  readonly readouts: HTMLElement | null;
  readonly plots: readonly HTMLElement[];
  readonly spoken: readonly HTMLElement[];
  readonly findings: readonly Finding[];
}

export function layOut(parts: LabParts): HTMLElement {
  const { spec, say } = parts;
  const head = spec.title === "" && spec.kind === null ? null : h("header", { class: "head", part: "header" },
    h("span", { class: "kind", dir: "auto" }, spec.kind ?? say("lab")),
    spec.title !== "" && h("h3", { class: "title", part: "title", dir: "auto" }, spec.title));
  const buttons = parts.buttons.length > 0 ? h("div", { class: "actions" }, ...parts.buttons) : null;
  const hasControls = parts.controls.length > 0 || buttons !== null;
  const controls = hasControls ? h("div", { class: "controls", part: "controls", role: "group", "aria-label": say("controls") }, ...parts.controls, buttons) : null;
  const side = controls !== null || parts.readouts !== null ? h("div", { class: "side" }, controls, parts.readouts) : null;
  const plots = parts.plots.length > 0 ? h("div", { class: "plots", part: "plots" }, ...parts.plots) : null;
  const note = spec.note === null ? null : h("div", { class: "note", part: "note", dir: "auto" }, safeHtml(spec.note, document));
  const stage = h("div", { class: "stage" }, parts.view, parts.toolbar, parts.viewBar);
  const wrong = parts.findings.filter((finding) => finding.severity === "error");
  return h("article", { class: spec.dock ? "lab dock" : "lab", part: "lab", "aria-label": parts.title },
    head, h("div", { class: "body" }, stage, side), plots, note, ...parts.spoken, wrong.length > 0 && findingsList(wrong, say));
}

/** The findings of a lab that runs in spite of them. */
function findingsList(findings: readonly Finding[], say: Say): HTMLElement {
  return h("details", { class: "findings", part: "findings", open: true }, h("summary", {}, say("findings")), ...findings.map(findingText));
}

export function findingText(finding: Finding): HTMLElement {
  const place = finding.line === null ? finding.file : `${finding.file}, ${finding.line}:${finding.column ?? 1}`;
  return h("p", { class: "finding" }, h("code", {}, place), ` ${sentence(finding.message)}`, finding.help !== null && h("span", { class: "help" }, ` ${sentence(finding.help)}`));
}

/** The panel of a lab that cannot run, with the reason. */
export function errorPanel(title: string, messages: readonly (string | HTMLElement)[], help: string | null): HTMLElement {
  return h("article", { class: "lab broken", part: "error", role: "alert" },
    h("p", { class: "error-title" }, icon("warning"), h("strong", {}, title)),
    ...messages.map((message) => (typeof message === "string" ? h("p", {}, message) : message)), help !== null && h("p", { class: "help" }, help));
}

/** Adds a capital letter and a full stop. */
function sentence(text: string): string {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}${/[.?!]$/.test(text) ? "" : "."}`;
}
