/** Completions from the checker. */
import { autocompletion, startCompletion, type Completion as Option, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import type { Extension } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import type { CheckerClient } from "./client.js";
import type { EditorLanguage } from "./language.js";
import type { Completion } from "./protocol.js";
import { renderMarkdown } from "./text.js";

/** Behind these characters, a list opens by itself. */
const TRIGGERS: Readonly<Record<EditorLanguage, RegExp>> = { json: /[\w$."'(]$/, markdown: /[\w$."'(]$/, mjcf: /[\w</"' ]$/ };
/** How CodeMirror names kinds. */
const TYPES: Readonly<Record<Completion["kind"], string>> = {
  key: "property", attribute: "property", value: "enum", object: "namespace", field: "property", function: "function", name: "constant",
  variable: "variable", constant: "constant", element: "type",
};

/** Completes a text with this path. */
export function completionOf(checker: CheckerClient, path: string, language: EditorLanguage): Extension {
  const source = async (context: CompletionContext): Promise<CompletionResult | null> => {
    const before = context.state.sliceDoc(Math.max(0, context.pos - 1), context.pos);
    if (!context.explicit && !TRIGGERS[language].test(before)) return null;
    const all = await checker.ask("complete", path, context.state.doc.toString(), context.pos).catch(() => []);
    const [first] = all;
    if (first === undefined || context.aborted) return null;
    const { start, end } = first.edit;
    const same = all.filter((c) => c.edit.start === start && c.edit.end === end);
    const rest = Math.max(0, end - context.pos);
    return { from: Math.min(start, context.pos), options: same.map((c, i) => optionOf(c, i, rest)), validFor: /^["</]?[\w$-]*$/ };
  };
  return autocompletion({ override: [source], icons: false, maxRenderedOptions: 100, activateOnTypingDelay: 60 });
}

/** `rest` is what the text has behind the cursor that is replaced as well. */
function optionOf(c: Completion, index: number, rest: number): Option {
  return {
    label: c.filter ?? c.label, displayLabel: c.label, detail: c.detail, type: TYPES[c.kind],
    // The order of the reference, among equally good matches.
    boost: -index / 1000,
    ...(c.documentation === "" ? {} : { info: () => renderMarkdown(c.documentation) }),
    apply: (view, _option, from, to) => insert(view, c.edit.text, from, Math.min(to + rest, view.state.doc.length)),
  };
}

function insert(view: EditorView, text: string, from: number, to: number): void {
  const isOpen = text.endsWith('=""');
  view.dispatch({ changes: { from, to, insert: text }, selection: { anchor: from + text.length - (isOpen ? 1 : 0) }, userEvent: "input.complete", scrollIntoView: true });
  if (isOpen) startCompletion(view);
}
