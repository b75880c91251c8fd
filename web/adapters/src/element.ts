/** The element of a fence, as data and as HTML. No text of a lesson ends its script or its attribute. */

/** A script of data inside an element. */
export interface DataScript {
  readonly type: "application/json" | "model/mjcf";
  /** The name of a model. */
  readonly name?: string;
  readonly text: string;
}

/** `<sim-lab>` or `<lesson-quiz>`. */
export interface FenceElement {
  readonly tag: "sim-lab" | "lesson-quiz";
  readonly attributes: Readonly<Record<string, string>>;
  readonly scripts: readonly DataScript[];
}

const ESCAPES: Readonly<Record<string, string>> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };

/** Escapes a text for the content of an element or a quoted attribute. */
export function escapeHtml(text: string): string {
  return text.replace(/[&<>"']/g, (c) => ESCAPES[c] ?? c);
}

/** JSON for a script element: nothing in it ends the element or opens another one. */
export function jsonInScript(json: string): string {
  return json.replace(/[<>\u2028\u2029]/g, (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`);
}

/**
 * The text of a model on one line and without comments, if a script element can contain it; otherwise `null`. In XML, a line break in an
 * attribute is a space, and MJCF has no other text.
 */
export function modelInScript(xml: string): string | null {
  const parts = xml.replace(/^\ufeff/, "").split("<!--");
  const kept = parts.map((part, i) => (i === 0 ? part : part.includes("-->") ? part.slice(part.indexOf("-->") + 3) : null));
  if (kept.includes(null)) return null;
  const text = kept.join("").trim().replace(/\s*[\r\n]\s*/g, " ");
  return /<!--|<\/?script|<!doctype|<!\[cdata\[/i.test(text) ? null : text;
}

/** The element as HTML on one line. */
export function elementHtml({ tag, attributes, scripts }: FenceElement): string {
  const inside = scripts.map(({ type, name, text }) => `<script type="${type}"${name === undefined ? "" : ` data-name="${escapeHtml(name)}"`}>${text}</script>`);
  return `<${tag}${attributesHtml(attributes)}>${inside.join("")}</${tag}>`;
}

function attributesHtml(attributes: Readonly<Record<string, string>>): string {
  return Object.entries(attributes).map(([name, value]) => ` ${name}="${escapeHtml(value)}"`).join("");
}
