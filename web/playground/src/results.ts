/** The findings of the model and the lab, and what became of the claims. */
import type { CheckedFinding, Report } from "labspec-editor";
import { byId, h } from "./dom.js";

export interface FindingActions {
  /** Shows the place of a finding; `null` for a file that is not open. */
  show: ((finding: CheckedFinding) => void) | null;
  fix(finding: CheckedFinding, index: number): void;
}

const MOST = 100;

/** An item of the list, with what its buttons do now. */
interface Row {
  readonly item: HTMLLIElement;
  finding: CheckedFinding;
  actions: FindingActions;
}

let rows: ReadonlyMap<string, Row> = new Map();

/** Shows findings. An item that was shown before stays the same element: it keeps the focus and a click that has begun. */
export function showFindings(groups: readonly { readonly findings: readonly CheckedFinding[]; readonly actions: FindingActions }[]): void {
  const now = new Map<string, Row>();
  for (const { findings, actions } of groups) {
    for (const finding of findings) {
      let key = JSON.stringify([finding, actions.show === null]);
      // Two findings with the same content are two items.
      while (now.has(key)) key += "+";
      now.set(key, rowOf(rows.get(key), finding, actions));
    }
  }
  rows = now;
  const items = [...now.values()].map((row) => row.item);
  const more = items.length > MOST ? [h("li", {}, `${items.length - MOST} more`)] : [];
  replaceItems(byId("findings", HTMLUListElement), [...(items.length === 0 ? [h("li", { class: "none" }, "None.")] : items.slice(0, MOST)), ...more]);
}

/** Makes `items` the children of `list`; those that are in their place already are not touched. */
function replaceItems(list: HTMLUListElement, items: readonly HTMLLIElement[]): void {
  const wanted = new Set<Element>(items);
  for (const child of [...list.children]) if (!wanted.has(child)) child.remove();
  items.forEach((item, i) => {
    const there = list.children[i];
    if (there !== item) list.insertBefore(item, there ?? null);
  });
}

function rowOf(before: Row | undefined, finding: CheckedFinding, actions: FindingActions): Row {
  if (before !== undefined) return Object.assign(before, { finding, actions });
  const place = finding.line === null ? finding.file : `${finding.file}, ${finding.line}:${finding.column ?? 1}`;
  const button = actions.show === null ? h("code", {}, place) : h("button", { type: "button", class: "place" }, place);
  const help = [finding.why, finding.help].filter((part) => part !== null).map((part) => h("p", { class: "help" }, part));
  const fixes = finding.fixes.map((fix) => h("button", { type: "button" }, `Fix: ${fix.title}`));
  const row: Row = {
    finding,
    actions,
    item: h("li", { class: finding.severity }, h("p", {}, button, ` ${finding.severity}: ${finding.message} `, h("code", {}, finding.code)), ...help,
      fixes.length === 0 ? null : h("div", { class: "fixes" }, ...fixes)),
  };
  button.addEventListener("click", () => row.actions.show?.(row.finding));
  fixes.forEach((apply, index) => apply.addEventListener("click", () => row.actions.fix(row.finding, index)));
  return row;
}

/** How the states of claims look; others are plain. */
const STATES: ReadonlyMap<string, string> = new Map([["true", "good"], ["false", "bad"]]);

/** The claims of a lab: all of them, or those of one lab of a lesson. */
export function showClaims(entries: Report["entries"]): void {
  const items = entries.map(({ owner, subject, state, word, remark }) => h("li", { class: STATES.get(state) ?? "" },
    h("strong", {}, word), ` ${owner}: ${subject} `, remark === "" ? null : h("span", { class: "remark" }, remark)));
  byId("claims", HTMLUListElement).replaceChildren(...items);
  const count = (state: string): number => entries.filter((entry) => entry.state === state).length;
  const [held, failed] = [count("true"), count("false")];
  sayClaims(entries.length === 0 ? "There is nothing to check." : `${held} true, ${failed} false, ${entries.length - held - failed} not checked.`);
}

export function sayClaims(text: string): void {
  byId("claims-state", HTMLParagraphElement).textContent = text;
}
