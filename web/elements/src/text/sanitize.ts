/** HTML of authors. Elements that show text are kept; all others are removed, with scripts, styles and addresses that run or load something. */
import { texToMath } from "./tex.js";

const TAGS = new Set([
  "a", "abbr", "b", "blockquote", "br", "code", "dd", "del", "details", "dfn", "div", "dl", "dt", "em", "figcaption", "figure", "h3", "h4",
  "h5", "h6", "hr", "i", "img", "ins", "kbd", "li", "mark", "ol", "p", "pre", "q", "s", "samp", "small", "span", "strong", "sub",
  "summary", "sup", "table", "tbody", "td", "tfoot", "th", "thead", "tr", "u", "ul", "var",
]);
/** Elements that are removed with their text. */
const DROPPED = new Set(["script", "style", "template", "iframe", "object", "embed", "noscript", "svg", "math", "textarea", "select", "title"]);
const ATTRIBUTES: Readonly<Record<string, readonly string[]>> = {
  a: ["href", "title"], img: ["src", "alt", "width", "height"], td: ["colspan", "rowspan"], th: ["colspan", "rowspan", "scope"],
  ol: ["start"], abbr: ["title"],
};
const EVERYWHERE = ["lang", "dir"];
const MOST_NODES = 5000;

/** The safe part of some HTML; formulas between `$` signs become MathML. */
export function safeHtml(html: string, owner: Document): DocumentFragment {
  const parsed = new DOMParser().parseFromString(html, "text/html");
  const out = owner.createDocumentFragment();
  let left = MOST_NODES;
  const copy = (from: Node, to: Node, inCode: boolean): void => {
    for (const node of from.childNodes) {
      if (left-- <= 0) return;
      if (node instanceof Text) to.appendChild(inCode ? owner.createTextNode(node.data) : withFormulas(node.data, owner));
      else if (node instanceof Element) copyElement(node, to, inCode);
    }
  };
  const copyElement = (element: Element, to: Node, inCode: boolean): void => {
    const tag = element.localName;
    if (DROPPED.has(tag)) return;
    if (!TAGS.has(tag)) return copy(element, to, inCode);
    const safe = owner.createElement(tag);
    for (const name of [...EVERYWHERE, ...(ATTRIBUTES[tag] ?? [])]) {
      const value = element.getAttribute(name);
      if (value !== null && isSafe(name, value)) safe.setAttribute(name, value);
    }
    if (tag === "img" && !safe.hasAttribute("src")) return;
    if (tag === "a") safe.setAttribute("rel", "noopener noreferrer");
    to.appendChild(safe);
    copy(element, safe, inCode || tag === "code" || tag === "pre" || tag === "kbd" || tag === "samp");
  };
  copy(parsed.body, out, false);
  return out;
}

/** Links lead to pages, and pictures are part of the text. */
function isSafe(name: string, value: string): boolean {
  if (name === "src") return /^data:image\/(png|jpeg|gif|webp);base64,[a-z0-9+/=\s]*$/i.test(value);
  if (name !== "href") return true;
  const bare = value.replace(/[\u0000-\u0020]/g, "");
  return /^(https?:|mailto:|#|\/|\.)/i.test(bare) || /^[^:]*$/.test(bare);
}

function withFormulas(text: string, owner: Document): DocumentFragment {
  const out = owner.createDocumentFragment();
  // Every second part stands between dollar signs.
  const parts = text.split(/\$([^$\n]+)\$/);
  parts.forEach((part, i) => {
    if (part === "") return;
    out.appendChild(i % 2 === 1 ? texToMath(part, owner) : owner.createTextNode(part));
  });
  return out;
}
