/** An editor of a lesson, a lab or a model, in any element of a page. */
import { closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { bracketMatching, foldGutter, foldKeymap, indentOnInput, indentUnit } from "@codemirror/language";
import { lintKeymap } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Compartment, EditorState, type Extension } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { CheckerClient, type StartWorker } from "./client.js";
import { completionOf } from "./completion.js";
import { explanationOf } from "./explanation.js";
import { applyFix, checkAgain, findingsOf } from "./findings.js";
import { languageOf, type EditorLanguage } from "./language.js";
import type { CheckedFinding, Models } from "./protocol.js";
import { element } from "./text.js";
import { theme } from "./theme.js";

export { CheckerClient, CheckerError, type StartWorker } from "./client.js";
export type { EditorLanguage } from "./language.js";
export type { CheckedFinding, Completion, Fix, Hover, LabOfLesson, Models, Report } from "./protocol.js";

export interface EditorOptions {
  readonly text: string;
  readonly language: EditorLanguage;
  /** The name of the text; its ending says what it is: `lesson.md`, `lab.json`, `drop.xml`. */
  readonly path: string;
  /** The models that its labs name. Editors that share a checker share its models. */
  readonly models?: Models;
  /** The checker, or what starts its worker. */
  readonly checker: CheckerClient | StartWorker;
  /** What a screen reader calls it. */
  readonly label?: string;
  readonly onChange?: (text: string) => void;
  /** Ctrl-S, or Command-S. */
  readonly onSave?: (text: string) => void;
  /** The findings of the text, after each change. */
  readonly onFindings?: (findings: readonly CheckedFinding[]) => void;
  /** The text cannot be checked. */
  readonly onFailure?: (why: string) => void;
}

export interface EditorHandle {
  text: string;
  readonly checker: CheckerClient;
  readonly findings: readonly CheckedFinding[];
  focus(): void;
  /** Selects a part of the text, and shows it. */
  select(start: number, end: number): void;
  /** Makes a fix of one of the current findings; whether the text was still the same. */
  fix(finding: CheckedFinding, index?: number): boolean;
  /** Formats the code of the labs in the text. */
  format(): Promise<void>;
  /** Takes the editor away, and ends a checker that belongs to it alone. */
  dispose(): void;
}

/** Shows an editor in an element. Its styles are in a shadow root, so that no policy of styles has to allow anything. */
export function mountEditor(host: HTMLElement, options: EditorOptions): EditorHandle {
  const { path, language } = options;
  const isOwn = !(options.checker instanceof CheckerClient);
  const checker = options.checker instanceof CheckerClient ? options.checker : new CheckerClient(options.checker);
  if (options.models !== undefined) checker.models = options.models;
  const box = element("div", "labspec-editor");
  box.style.height = "100%";
  const root = box.attachShadow({ mode: "open" });
  const spoken = element("div", "lab-spoken");
  spoken.setAttribute("role", "status");
  let [findings, checked] = [[] as readonly CheckedFinding[], EditorState.create({}).doc];
  const found = (now: readonly CheckedFinding[]): void => {
    [findings, checked] = [now, view.state.doc];
    options.onFindings?.(now);
  };
  const fix = (finding: CheckedFinding, index = 0): boolean => {
    const chosen = finding.fixes[index];
    return chosen !== undefined && applyFix(view, chosen, checked);
  };
  const format = async (): Promise<void> => {
    const { doc } = view.state;
    const text = await checker.ask("format", path, doc.toString()).catch(() => null);
    if (text !== null && view.state.doc.eq(doc)) replace(view, text);
  };
  const commands = keymap.of([
    { key: "Mod-s", preventDefault: true, run: () => (options.onSave?.(view.state.doc.toString()), true) },
    { key: "Mod-.", run: () => fixAtCursor(view, findings, fix) },
    { key: "Shift-Alt-f", run: () => (void format(), true) },
  ]);
  const dark = new Compartment();
  const state = EditorState.create({
    doc: options.text,
    extensions: [
      commands, ...basics(options.label ?? path), languageOf(language), theme(), dark.of(EditorView.darkTheme.of(isDark())),
      findingsOf(checker, path, { found, failed: (why) => options.onFailure?.(why) }), completionOf(checker, path, language),
      explanationOf(checker, path, (text) => spoken.replaceChildren(text)),
      EditorView.updateListener.of((update) => {
        if (update.docChanged) options.onChange?.(update.state.doc.toString());
      }),
    ],
  });
  const view: EditorView = new EditorView({ state, root });
  root.append(view.dom);
  view.dom.append(spoken);
  host.append(box);
  const ends = [checker.watch(() => checkAgain(view)), watchDark((now) => view.dispatch({ effects: dark.reconfigure(EditorView.darkTheme.of(now)) }))];
  return {
    checker, fix, format,
    get text() { return view.state.doc.toString(); },
    set text(text) { replace(view, text); },
    get findings() { return findings; },
    focus: () => view.focus(),
    select(start, end) {
      const [anchor, head] = [Math.min(start, view.state.doc.length), Math.min(end, view.state.doc.length)];
      view.dispatch({ selection: { anchor, head }, effects: EditorView.scrollIntoView(anchor, { y: "center" }) });
      view.focus();
    },
    dispose() {
      for (const end of ends) end();
      view.destroy();
      box.remove();
      if (isOwn) checker.dispose();
    },
  };
}

function basics(label: string): Extension[] {
  return [
    lineNumbers(), foldGutter(), history(), drawSelection(), indentOnInput(), bracketMatching(), closeBrackets(), highlightActiveLine(),
    highlightSelectionMatches(), indentUnit.of("  "), EditorView.lineWrapping,
    // Tab leaves the editor, as everywhere on a page; Ctrl-] and Ctrl-[ indent.
    keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...foldKeymap, ...completionKeymap, ...lintKeymap]),
    EditorView.domEventHandlers({ beforeinput: replaceLines }),
    EditorView.contentAttributes.of({ "aria-label": label, tabindex: "0", spellcheck: "false", autocapitalize: "off", autocorrect: "off" }),
  ];
}

/**
 * Text in place of several lines, or of several lines itself. Left to a browser, it would join the elements of the lines by styles in attributes,
 * which a policy of styles refuses and reports.
 */
function replaceLines(event: InputEvent, view: EditorView): boolean {
  const { data, inputType, isComposing } = event;
  const { from, to } = view.state.selection.main;
  const isText = inputType === "insertText" && data !== null && !isComposing;
  if (!isText || view.state.readOnly || view.state.selection.ranges.length > 1) return false;
  if (!data.includes("\n") && view.state.doc.lineAt(from).number === view.state.doc.lineAt(to).number) return false;
  event.preventDefault();
  view.dispatch(view.state.replaceSelection(data), { userEvent: "input.type", scrollIntoView: true });
  return true;
}

/** Replaces what differs, so that the cursor stays where it is. */
function replace(view: EditorView, text: string): void {
  const old = view.state.doc.toString();
  if (old === text) return;
  let [start, end] = [0, 0];
  const most = Math.min(old.length, text.length);
  while (start < most && old[start] === text[start]) start++;
  while (end < most - start && old[old.length - 1 - end] === text[text.length - 1 - end]) end++;
  view.dispatch({ changes: { from: start, to: old.length - end, insert: text.slice(start, text.length - end) }, userEvent: "input" });
}

/** Makes the best fix of the finding at the cursor. */
function fixAtCursor(view: EditorView, findings: readonly CheckedFinding[], fix: (finding: CheckedFinding) => boolean): boolean {
  const { head } = view.state.selection.main;
  const line = view.state.doc.lineAt(head);
  const at = (f: CheckedFinding): boolean => (f.start ?? -1) <= head && head <= (f.end ?? -1);
  const here = (f: CheckedFinding): boolean => (f.start ?? -1) <= line.to && line.from <= (f.end ?? -1);
  const finding = findings.find((f) => at(f) && f.fixes.length > 0) ?? findings.find((f) => here(f) && f.fixes.length > 0);
  return finding !== undefined && fix(finding);
}

const DARK = "(prefers-color-scheme: dark)";

function isDark(): boolean {
  const scheme = getComputedStyle(document.documentElement).colorScheme;
  return scheme === "dark" || (scheme !== "light" && scheme !== "normal" && matchMedia(DARK).matches);
}

function watchDark(changed: (isDark: boolean) => void): () => void {
  const query = matchMedia(DARK);
  const listener = (): void => changed(isDark());
  query.addEventListener("change", listener);
  return () => query.removeEventListener("change", listener);
}
