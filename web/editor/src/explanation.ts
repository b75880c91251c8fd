/** What is under the pointer, or at the cursor: the meaning of a name, and its value at the start of the lab. */
import { StateEffect, StateField, type Extension } from "@codemirror/state";
import { EditorView, hoverTooltip, keymap, showTooltip, type Tooltip } from "@codemirror/view";
import type { CheckerClient } from "./client.js";
import type { Hover } from "./protocol.js";
import { plainText, renderMarkdown } from "./text.js";

const shown = StateEffect.define<Tooltip | null>();

/** The explanation that the keyboard asked for, until the text or the selection changes. */
const explained = StateField.define<Tooltip | null>({
  create: () => null,
  update(tooltip, transaction) {
    for (const effect of transaction.effects) if (effect.is(shown)) return effect.value;
    return transaction.docChanged || transaction.selection !== undefined ? null : tooltip;
  },
  provide: (field) => showTooltip.from(field),
});

/** Explains a text with this path; `speak` reads an explanation to those who do not see it. */
export function explanationOf(checker: CheckerClient, path: string, speak: (text: string) => void): Extension {
  const ask = async (view: EditorView, position: number): Promise<Tooltip | null> => {
    const { doc } = view.state;
    const hover = await checker.ask("hover", path, doc.toString(), position).catch(() => null);
    return hover === null || !view.state.doc.eq(doc) ? null : tooltipOf(hover);
  };
  const explain = (view: EditorView): boolean => {
    const position = view.state.selection.main.head;
    void checker.ask("hover", path, view.state.doc.toString(), position).catch(() => null).then((hover) => {
      view.dispatch({ effects: shown.of(hover === null ? null : tooltipOf(hover)) });
      speak(hover === null ? "No explanation here." : plainText(hover.text));
    });
    return true;
  };
  const hide = (view: EditorView): boolean => {
    if (view.state.field(explained) === null) return false;
    view.dispatch({ effects: shown.of(null) });
    return true;
  };
  return [explained, hoverTooltip(ask, { hoverTime: 250 }), keymap.of([{ key: "Mod-k Mod-i", run: explain }, { key: "Escape", run: hide }])];
}

function tooltipOf(hover: Hover): Tooltip {
  return { pos: hover.start, end: hover.end, above: true, create: () => ({ dom: renderMarkdown(hover.text) }) };
}
