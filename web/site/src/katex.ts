/** Formulas, in a file of their own that only pages with formulas fetch. */
import katex from "katex";

/** The most that a formula may expand macros, and the largest size that it may ask for, in em. */
const LIMITS = { maxExpand: 1000, maxSize: 20 };

/** Draws a formula in an element. A formula with a mistake stays as text, with the reason. */
export function drawFormula(tex: string, into: HTMLElement, isDisplay: boolean): void {
  const drawn = document.createElement("span");
  try {
    katex.render(tex, drawn, { displayMode: isDisplay, throwOnError: true, trust: false, strict: "ignore", ...LIMITS });
    into.replaceChildren(...drawn.childNodes);
  } catch (e) {
    into.classList.add("math-wrong");
    into.title = e instanceof Error ? e.message : String(e);
  }
}
