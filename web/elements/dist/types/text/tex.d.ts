/** The part of TeX that short formulas use, as MathML, which browsers draw and read aloud. Anything else is shown as it is written. */
/** A formula as a `math` element. */
export declare function texToMath(tex: string, owner: Document): Element;
