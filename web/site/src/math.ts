/** Draws the formulas of a page. Until then, and where that fails, they are TeX. */
import { besideScript } from "./files.js";

type Katex = typeof import("./katex.js");
let loaded: Promise<Katex> | undefined;

/** Draws every formula below an element that is not drawn yet. */
export async function drawFormulas(below: ParentNode): Promise<void> {
  const formulas = [...below.querySelectorAll<HTMLElement>(".math:not([data-tex])")];
  if (formulas.length === 0) return;
  loaded ??= import(besideScript("katex.js")) as Promise<Katex>;
  const { drawFormula } = await loaded;
  for (const formula of formulas) {
    const tex = formula.textContent;
    formula.dataset["tex"] = tex;
    drawFormula(tex, formula, formula.classList.contains("display"));
  }
}
