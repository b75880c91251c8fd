/** Formulas, in a file of their own that only pages with formulas fetch. */
import katex from "katex";

/** The most that a formula may expand macros, and the largest size that it may ask for, in em. */
const LIMITS = { maxExpand: 1000, maxSize: 20 };

/**
 * Runs `work` so that a `style` that is set as an attribute is set as a style: the policy of the pages forbids the attribute and allows
 * the property. KaTeX sets the attribute for stretched arrows and boxes.
 */
function withStyles(work: () => void): void {
  const { setAttribute } = Element.prototype;
  Element.prototype.setAttribute = function (this: Element, name: string, value: string): void {
    const isStyled = this instanceof HTMLElement || this instanceof SVGElement || this instanceof MathMLElement;
    if (name === "style" && isStyled) this.style.cssText = value;
    else setAttribute.call(this, name, value);
  };
  try {
    work();
  } finally {
    Element.prototype.setAttribute = setAttribute;
  }
}

/** Elements of MathML whose number of children is fixed. */
const FIXED = ["msub", "msup", "msubsup", "munder", "mover", "munderover", "mfrac", "mroot"];

/** KaTeX writes `h_{\max}` with the sign of a function application as a third child of the index, which no browser can place. */
function removeApplications(formula: Element): void {
  for (const sign of formula.querySelectorAll(FIXED.map((name) => `${name} > mo`).join())) if (sign.textContent === "\u2061") sign.remove();
}

/** Draws a formula in an element. A formula with a mistake stays as text, with the reason. */
export function drawFormula(tex: string, into: HTMLElement, isDisplay: boolean): void {
  const drawn = document.createElement("span");
  try {
    withStyles(() => katex.render(tex, drawn, { displayMode: isDisplay, throwOnError: true, trust: false, strict: "ignore", ...LIMITS }));
    removeApplications(drawn);
    into.replaceChildren(...drawn.childNodes);
  } catch (e) {
    into.classList.add("math-wrong");
    into.title = e instanceof Error ? e.message : String(e);
  }
}
