/** Findings in the text: where they are, what they say, and the edits that resolve them. */
import { forceLinting, linter, lintGutter, type Action, type Diagnostic } from "@codemirror/lint";
import { StateEffect, type Extension, type Text } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import type { CheckerClient } from "./client.js";
import type { CheckedFinding, Fix } from "./protocol.js";
import { element } from "./text.js";

/** After so many milliseconds without a change, a text is checked. */
const PAUSE = 120;
const MOST_DIAGNOSTICS = 200;
const SEVERITIES = { error: "error", warning: "warning", note: "info" } as const;

/** The models changed: the same text may have other findings. */
const outdated = StateEffect.define<null>();

export interface FindingListener {
  /** All findings of the text, in its order. */
  found(findings: readonly CheckedFinding[]): void;
  /** The text could not be checked. */
  failed(why: string): void;
}

/** Shows the findings of a text with this path. */
export function findingsOf(checker: CheckerClient, path: string, listener: FindingListener): Extension {
  const check = async (view: EditorView): Promise<Diagnostic[]> => {
    const { doc } = view.state;
    try {
      const findings = await checker.ask("findings", path, doc.toString());
      if (!view.dom.isConnected) return [];
      // An answer about an older text is not shown: the next one is on its way.
      if (view.state.doc.eq(doc)) listener.found(findings);
      const here = findings.filter((finding) => finding.file === path).slice(0, MOST_DIAGNOSTICS);
      return here.map((finding) => diagnosticOf(finding, doc));
    } catch (e) {
      listener.failed(e instanceof Error ? e.message : String(e));
      return [];
    }
  };
  return [
    lintGutter(),
    linter(check, { delay: PAUSE, needsRefresh: (update) => update.transactions.some((tr) => tr.effects.some((effect) => effect.is(outdated))) }),
  ];
}

/** Checks the text again, because models changed. */
export function checkAgain(view: EditorView): void {
  view.dispatch({ effects: outdated.of(null) });
  forceLinting(view);
}

function diagnosticOf(finding: CheckedFinding, doc: Text): Diagnostic {
  const [from, to] = [Math.min(finding.start ?? 0, doc.length), Math.min(finding.end ?? 0, doc.length)];
  const actions = finding.fixes.map((fix): Action => ({ name: fix.title, apply: (view) => void applyFix(view, fix, doc) }));
  return {
    from, to: Math.max(from, to), severity: SEVERITIES[finding.severity], source: finding.code, actions,
    message: [finding.message, finding.why, finding.help].filter((part) => part !== null).join("\n"),
    renderMessage: () => element("div", "lab-finding",
      element("p", "", element("strong", "", finding.message), element("span", "lab-code", ` ${finding.code}`)),
      ...[finding.why, finding.help].filter((part) => part !== null).map((part) => element("p", "", part))),
  };
}

/** Makes a fix for a text, unless the text has changed. */
export function applyFix(view: EditorView, fix: Fix, doc: Text): boolean {
  if (!view.state.doc.eq(doc)) return false;
  const changes = fix.edits.map(({ start, end, text }) => ({ from: start, to: end, insert: text }));
  const [first] = changes;
  // A suppression waits for its reason.
  const reason = first === undefined || fix.kind !== "suppression" ? null : /"why": "()"|:  -->/.exec(first.insert);
  const anchor = first === undefined || reason === null ? null : first.from + reason.index + (reason[0] === ":  -->" ? 2 : reason[0].length - 1);
  view.dispatch({ changes, userEvent: "input.fix", scrollIntoView: true, ...(anchor === null ? {} : { selection: { anchor } }) });
  view.focus();
  return true;
}
