/** The style sheet of the elements, and changes of the theme of the page. */
import base from "./base.css";
import lab from "./lab.css";
import plot from "./plot.css";
import quiz from "./quiz.css";

let sheet: CSSStyleSheet | undefined;

/** Gives a shadow root the styles of the elements. A content policy does not restrict a constructed sheet. */
export function applyStyles(root: ShadowRoot): void {
  if (sheet === undefined) {
    sheet = new CSSStyleSheet();
    sheet.replaceSync([base, lab, plot, quiz].join("\n"));
  }
  if (!root.adoptedStyleSheets.includes(sheet)) root.adoptedStyleSheets.push(sheet);
}

const QUERIES = ["(prefers-color-scheme: dark)", "(forced-colors: active)", "(prefers-contrast: more)"];

/** Calls `restyle` when the colours of the page or of an element may have changed; returns a function that ends this. */
export function watchTheme(element: Element, restyle: () => void): () => void {
  const later = (): void => void requestAnimationFrame(restyle);
  const queries = QUERIES.map((query) => matchMedia(query));
  for (const query of queries) query.addEventListener("change", later);
  const roots = new MutationObserver(later);
  const root = element.getRootNode();
  const hosts = root instanceof ShadowRoot ? [root.host] : [];
  for (const watched of [document.documentElement, document.body, element, ...hosts]) {
    roots.observe(watched, { attributes: true, attributeFilter: ["class", "style", "data-theme", "data-color-mode", "theme"] });
  }
  return () => {
    for (const query of queries) query.removeEventListener("change", later);
    roots.disconnect();
  };
}
