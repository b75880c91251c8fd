/** The findings of the model and the lab, and what became of the claims. */
import type { CheckedFinding, Report } from "labspec-editor";
import { byId, h } from "./dom.js";

export interface FindingActions {
  /** Shows the place of a finding; `null` for a file that is not open. */
  show: ((finding: CheckedFinding) => void) | null;
  fix(finding: CheckedFinding, index: number): void;
}

const MOST = 100;

export function showFindings(groups: readonly { readonly findings: readonly CheckedFinding[]; readonly actions: FindingActions }[]): void {
  const items = groups.flatMap(({ findings, actions }) => findings.map((finding) => itemOf(finding, actions)));
  const list = byId("findings", HTMLUListElement);
  const more = items.length > MOST ? [h("li", {}, `${items.length - MOST} more`)] : [];
  list.replaceChildren(...(items.length === 0 ? [h("li", { class: "none" }, "None.")] : items.slice(0, MOST)), ...more);
}

function itemOf(finding: CheckedFinding, actions: FindingActions): HTMLLIElement {
  const place = finding.line === null ? finding.file : `${finding.file}, ${finding.line}:${finding.column ?? 1}`;
  const { show } = actions;
  const button = show === null ? h("code", {}, place) : h("button", { type: "button", class: "place" }, place);
  if (show !== null) button.addEventListener("click", () => show(finding));
  const fixes = finding.fixes.map((fix, index) => {
    const apply = h("button", { type: "button" }, `Fix: ${fix.title}`);
    apply.addEventListener("click", () => actions.fix(finding, index));
    return apply;
  });
  const help = [finding.why, finding.help].filter((part) => part !== null).map((part) => h("p", { class: "help" }, part));
  return h("li", { class: finding.severity }, h("p", {}, button, ` ${finding.severity}: ${finding.message} `, h("code", {}, finding.code)), ...help,
    fixes.length === 0 ? null : h("div", { class: "fixes" }, ...fixes));
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
