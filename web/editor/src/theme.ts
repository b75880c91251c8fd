/** How an editor looks. Every colour is a custom property of the page, with a value of its own for light and dark. */
import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { tags } from "@lezer/highlight";

const color = (name: string, light: string, dark: string): string => `var(--editor-${name}, light-dark(${light}, ${dark}))`;
const surface = color("surface", "#ffffff", "#14171c");
const text = color("text", "#1a1d21", "#e6e8eb");
const muted = color("muted", "#59616b", "#a3abb5");
const line = color("line", "#c9ced4", "#3a414b");
const raised = color("raised", "#f5f6f8", "#1d2127");
const accent = color("accent", "#1f5fbf", "#7db2ff");
const error = color("error", "#b3261e", "#ff8a80");

const look = EditorView.theme({
  "&": { color: text, backgroundColor: surface, fontSize: "0.875rem", height: "100%", border: `1px solid ${line}`, borderRadius: "6px" },
  "&.cm-focused": { outline: `2px solid ${accent}`, outlineOffset: "-1px" },
  ".cm-scroller": { fontFamily: "ui-monospace, SFMono-Regular, Menlo, Consolas, monospace", lineHeight: "1.5" },
  ".cm-content": { caretColor: text },
  ".cm-cursor": { borderLeftColor: text },
  ".cm-gutters": { backgroundColor: raised, color: muted, borderRight: `1px solid ${line}` },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "light-dark(#1f5fbf12, #7db2ff1a)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "light-dark(#cfe0fb, #2c4468)" },
  ".cm-panels, .cm-tooltip": { color: text, backgroundColor: raised, borderColor: line },
  ".cm-tooltip": { border: `1px solid ${line}`, borderRadius: "6px", maxWidth: "min(36rem, 90vw)" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: color("selected", "#1f5fbf", "#274b80"), color: "#ffffff" },
  ".cm-completionDetail": { color: "inherit", fontStyle: "normal", opacity: "0.85", marginLeft: "1em" },
  ".cm-completionMatchedText": { textDecoration: "none", fontWeight: "700" },
  ".cm-completionInfo": { maxWidth: "24rem", padding: "0 0.6em" },
  ".cm-diagnostic": { padding: "0.4em 0.7em" },
  ".cm-diagnosticAction": { backgroundColor: accent, color: color("on-accent", "#ffffff", "#10131a"), borderRadius: "4px", padding: "0.2em 0.6em", margin: "0.4em 0.6em 0 0", display: "inline-block" },
  ".cm-panel button, .cm-textfield": { color: text, backgroundColor: surface, backgroundImage: "none", borderColor: line },
  ".cm-panel.cm-panel-lint ul [aria-selected]": { backgroundColor: "light-dark(#cfe0fb, #2c4468)" },
  ".lab-doc": { padding: "0.4em 0.7em", lineHeight: "1.4" },
  ".lab-doc p, .lab-doc pre": { margin: "0.3em 0", whiteSpace: "pre-wrap" },
  ".lab-doc pre, .lab-doc code": { fontFamily: "ui-monospace, SFMono-Regular, Menlo, Consolas, monospace" },
  ".lab-finding p": { margin: "0" },
  ".lab-finding .lab-code": { color: muted },
  ".lab-spoken": { position: "absolute", width: "1px", height: "1px", overflow: "hidden", clipPath: "inset(50%)" },
});

const colors = HighlightStyle.define([
  { tag: [tags.propertyName, tags.attributeName], color: color("key", "#1f5fbf", "#8ab8ff") },
  { tag: [tags.string, tags.attributeValue], color: color("string", "#236b3a", "#8fd3a3") },
  { tag: [tags.number, tags.bool, tags.null], color: color("number", "#8a4a00", "#e6b070") },
  { tag: [tags.tagName, tags.heading, tags.keyword], color: color("tag", "#7a2a8a", "#d7a3e6"), fontWeight: "600" },
  { tag: [tags.comment, tags.meta, tags.processingInstruction], color: muted },
  { tag: [tags.angleBracket, tags.punctuation, tags.separator, tags.brace], color: muted },
  { tag: tags.strong, fontWeight: "700" },
  { tag: tags.emphasis, fontStyle: "italic" },
  { tag: [tags.link, tags.url], color: accent },
  { tag: tags.invalid, color: error },
]);

export function theme(): Extension {
  return [look, syntaxHighlighting(colors)];
}
