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

/** Calls `restyle` when the colours of the page may have changed; returns a function that ends this. */
export function watchTheme(restyle: () => void): () => void {
  const later = (): void => void requestAnimationFrame(restyle);
  const queries = QUERIES.map((query) => matchMedia(query));
  for (const query of queries) query.addEventListener("change", later);
  const roots = new MutationObserver(later);
  for (const element of [document.documentElement, document.body]) {
    roots.observe(element, { attributes: true, attributeFilter: ["class", "style", "data-theme", "data-color-mode", "theme"] });
  }
  return () => {
    for (const query of queries) query.removeEventListener("change", later);
    roots.disconnect();
  };
}
