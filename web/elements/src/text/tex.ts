/** The part of TeX that short formulas use, as MathML, which browsers draw and read aloud. Other text is shown unchanged. */

const MATHML = "http://www.w3.org/1998/Math/MathML";

const GREEK =
  "alpha α beta β gamma γ delta δ epsilon ϵ varepsilon ε zeta ζ eta η theta θ iota ι kappa κ lambda λ mu μ nu ν xi ξ pi π rho ρ sigma σ " +
  "tau τ upsilon υ phi ϕ varphi φ chi χ psi ψ omega ω Gamma Γ Delta Δ Theta Θ Lambda Λ Xi Ξ Pi Π Sigma Σ Phi Φ Psi Ψ Omega Ω " +
  "ell ℓ hbar ℏ partial ∂ infty ∞ nabla ∇";
const OPERATORS =
  "times × cdot ⋅ div ÷ pm ± mp ∓ approx ≈ sim ∼ le ≤ leq ≤ ge ≥ geq ≥ ne ≠ neq ≠ equiv ≡ propto ∝ to → rightarrow → Rightarrow ⇒ in ∈ " +
  "ldots … dots … cdots ⋯ sum ∑ prod ∏ int ∫ lbrace { rbrace } { { } } | ‖ ll ≪ gg ≫ perp ⟂ parallel ∥ top ⊤ circ ∘ prime ′ degree °";
const FUNCTIONS = new Set(["sin", "cos", "tan", "log", "ln", "exp", "max", "min", "arctan", "arcsin", "arccos", "det", "sinh", "cosh", "tanh"]);
const ACCENTS: Readonly<Record<string, string>> = { dot: "˙", ddot: "¨", hat: "^", bar: "¯", vec: "→", tilde: "~", overline: "¯" };
const SPACES: Readonly<Record<string, string>> = { ",": "0.17em", ";": "0.28em", ":": "0.22em", "!": "0em", " ": "0.25em", quad: "1em", qquad: "2em" };

const table = (pairs: string): ReadonlyMap<string, string> => {
  const words = pairs.split(" ");
  return new Map(words.flatMap((word, i) => (i % 2 === 0 ? [[word, words[i + 1] ?? ""] as const] : [])));
};
const IDENTIFIERS = table(GREEK);
const SIGNS = table(OPERATORS);
const MOST_DEPTH = 20;

/** A formula as a `math` element. */
export function texToMath(tex: string, owner: Document): Element {
  const tokens = tex.match(/\\[a-zA-Z]+|\\.|\d+(?:\.\d+)?|[^\s]/g) ?? [];
  let at = 0;
  let depth = 0;
  const make = (name: string, ...children: (Node | string)[]): Element => {
    const element = owner.createElementNS(MATHML, name);
    element.append(...children);
    return element;
  };
  const row = (children: Element[]): Element => (children.length === 1 && children[0] !== undefined ? children[0] : make("mrow", ...children));

  const group = (): Element => {
    const token = tokens[at] ?? "";
    if (/^\d./.test(token)) {
      // Without braces, an argument is one digit.
      tokens[at] = token.slice(1);
      return make("mn", token.charAt(0));
    }
    if (token !== "{") return atom();
    at++;
    const inside = sequence("}");
    at++;
    return row(inside);
  };
  /** The text of a group as it is written, for `\text`. */
  const words = (): string => {
    let out = "";
    if (tokens[at] === "{") {
      const from = at++;
      while (at < tokens.length && tokens[at] !== "}") at++;
      out = tokens.slice(from + 1, at++).join(" ");
    }
    return out;
  };
  const command = (name: string): Element => {
    if (name === "frac" || name === "tfrac" || name === "dfrac") {
      const above = group();
      return make("mfrac", above, group());
    }
    if (name === "sqrt") return make("msqrt", group());
    if (name === "text" || name === "mathrm" || name === "operatorname" || name === "textrm") return make("mtext", words());
    if (name === "mathbf" || name === "boldsymbol" || name === "mathit") return group();
    if (name === "left" || name === "right" || name === "big" || name === "Big") return at < tokens.length ? atom() : make("mrow");
    if (FUNCTIONS.has(name)) return make("mi", name);
    const accent = ACCENTS[name];
    if (accent !== undefined) {
      const base = group();
      const over = make("mover", base, make("mo", accent));
      over.setAttribute("accent", "true");
      return over;
    }
    const space = SPACES[name];
    if (space !== undefined) {
      const element = make("mspace");
      element.setAttribute("width", space);
      return element;
    }
    const letter = IDENTIFIERS.get(name);
    if (letter !== undefined) return make("mi", letter);
    const sign = SIGNS.get(name);
    return sign === undefined ? make("mtext", name.length > 1 ? `\\${name}` : name) : make("mo", sign);
  };
  const atom = (): Element => {
    const token = tokens[at++];
    if (token === undefined || depth > MOST_DEPTH) return make("mrow");
    depth++;
    try {
      if (token.startsWith("\\")) return command(token.slice(1));
      if (token === "{") {
        at--;
        return group();
      }
      if (/^\d/.test(token)) return make("mn", token);
      if (/^\p{L}$/u.test(token)) return make("mi", token);
      return make("mo", token === "-" ? "−" : token === "*" ? "∗" : token === "'" ? "′" : token);
    } finally {
      depth--;
    }
  };
  /** Atoms with their scripts, up to a token. */
  const sequence = (end: string | null): Element[] => {
    const out: Element[] = [];
    while (at < tokens.length && tokens[at] !== end) {
      const before = at;
      const base = tokens[at] === "^" || tokens[at] === "_" ? make("mrow") : atom();
      let [below, above]: [Element | null, Element | null] = [null, null];
      while (tokens[at] === "^" || tokens[at] === "_") {
        const isAbove = tokens[at++] === "^";
        if (isAbove) above = group();
        else below = group();
      }
      if (below !== null && above !== null) out.push(make("msubsup", base, below, above));
      else if (below !== null) out.push(make("msub", base, below));
      else if (above !== null) out.push(make("msup", base, above));
      else out.push(base);
      if (at === before) at++;
    }
    return out;
  };
  const math = make("math", row(sequence(null)));
  const all = owner.createElementNS(MATHML, "annotation");
  all.setAttribute("encoding", "application/x-tex");
  all.textContent = tex;
  const inside = make("semantics", ...math.childNodes, all);
  math.replaceChildren(inside);
  return math;
}
