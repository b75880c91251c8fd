//! Formulas in texts of lessons: rendered with Unicode characters where possible, else printed as source.
//!
//! `$v_0 = 4.3\,\mathrm{m/s}$` becomes v₀ = 4.3 m/s. Fractions, roots, sums and matrices need a program to draw them, which
//! this page must not run: their source is printed as code.

use super::text::{cut, escape, rest};
use crate::printable::printable;
use crate::verify::{folded, plain};

/// Maximum nesting depth of scripts.
const MAX_SCRIPT_DEPTH: usize = 3;
/// Separates the blocks of a text.
const BLOCK_SEPARATOR: char = '\u{1}';
/// Private-use characters that mark the positions of scripts while the rest is read.
const SCRIPT_MARKS: std::ops::RangeInclusive<char> = '\u{e000}'..='\u{e0ff}';

/// Commands for single characters that the reader of quoted numbers does not need.
const LETTERS: [(&str, char); 40] = [
    ("alpha", 'α'),
    ("beta", 'β'),
    ("gamma", 'γ'),
    ("delta", 'δ'),
    ("epsilon", 'ε'),
    ("varepsilon", 'ε'),
    ("zeta", 'ζ'),
    ("eta", 'η'),
    ("theta", 'θ'),
    ("vartheta", 'ϑ'),
    ("iota", 'ι'),
    ("kappa", 'κ'),
    ("lambda", 'λ'),
    ("nu", 'ν'),
    ("xi", 'ξ'),
    ("rho", 'ρ'),
    ("sigma", 'σ'),
    ("tau", 'τ'),
    ("upsilon", 'υ'),
    ("phi", 'φ'),
    ("varphi", 'φ'),
    ("chi", 'χ'),
    ("psi", 'ψ'),
    ("omega", 'ω'),
    ("Gamma", 'Γ'),
    ("Delta", 'Δ'),
    ("Theta", 'Θ'),
    ("Lambda", 'Λ'),
    ("Xi", 'Ξ'),
    ("Pi", 'Π'),
    ("Sigma", 'Σ'),
    ("Phi", 'Φ'),
    ("Psi", 'Ψ'),
    ("infty", '∞'),
    ("propto", '∝'),
    ("neq", '≠'),
    ("ll", '≪'),
    ("gg", '≫'),
    ("ast", '*'),
    ("star", '*'),
];

/// Commands for functions that are written by their name.
const FUNCTIONS: [&str; 9] = ["sin", "cos", "tan", "exp", "ln", "log", "min", "max", "arctan"];

/// Commands for a sign between two sides.
const RELATIONS: [&str; 12] =
    ["approx", "simeq", "cong", "sim", "to", "rightarrow", "le", "leq", "ge", "geq", "lt", "gt"];

/// The visible text of a piece of HTML with its formulas, as content of an element.
pub(super) fn of_html(html: &str) -> String {
    // Paragraphs are joined on one line.
    text(&plain(html).replace(BLOCK_SEPARATOR, " "))
}

/// A text with its formulas.
fn text(text: &str) -> String {
    let visible: Vec<&str> = cut(text).split_whitespace().collect();
    let visible = visible.join(" ");
    if visible.is_empty() {
        return rest(text);
    }
    let mut out = String::from("<bdi>");
    let mut left = visible.as_str();
    while let Some((before, tex, after)) = formula(left) {
        out.push_str(&escape(before));
        out.push_str(&read(tex, 0).unwrap_or_else(|| format!("<code>{}</code>", escape(tex.trim()))));
        left = after;
    }
    out.push_str(&escape(left));
    out.push_str(&rest(text));
    out.push_str("</bdi>");
    out
}

/// The first formula of a text: the text before it, the formula, the text after it.
fn formula(text: &str) -> Option<(&str, &str, &str)> {
    let mut from = 0;
    while let Some(start) = text.get(from..)?.find(['$', '\\']).map(|i| from + i) {
        let rest = text.get(start..)?;
        let marks = [("$$", "$$"), ("\\(", "\\)"), ("\\[", "\\]"), ("$", "$")];
        let found = marks.into_iter().find(|(open, _)| rest.starts_with(open)).and_then(|(open, close)| {
            let (inside, after) = split(rest.get(open.len()..)?, close)?;
            Some((text.get(..start)?, inside, after))
        });
        if found.is_some() {
            return found;
        }
        // `\$` is a dollar sign.
        from = start + if rest.starts_with("\\$") { 2 } else { 1 };
    }
    None
}

/// Splits a text at the end of a formula. Prices are not formulas: `$5 and $6`.
fn split<'t>(text: &'t str, close: &str) -> Option<(&'t str, &'t str)> {
    let ends = |offset: &usize| !text.get(..*offset).is_some_and(|inside| inside.ends_with('\\'));
    let end = text.match_indices(close).map(|(offset, _)| offset).find(ends)?;
    let (inside, after) = (text.get(..end)?, text.get(end + close.len()..)?);
    let price = close == "$"
        && (inside.starts_with(' ')
            || inside.ends_with(' ')
            || after.starts_with(|c: char| c.is_ascii_digit()));
    (!inside.trim().is_empty() && !price).then_some((inside, after))
}

/// A formula in Unicode characters; `None` where that is impossible.
fn read(tex: &str, deep: usize) -> Option<String> {
    let unseen = printable(tex) != tex || tex.contains(|c| SCRIPT_MARKS.contains(&c));
    if deep > MAX_SCRIPT_DEPTH || unseen {
        return None;
    }
    let mut letters = String::new();
    let mut scripts = Vec::new();
    let mut left = tex;
    while let Some(c) = left.chars().next() {
        match c {
            '^' | '_' => {
                let (inner, after) = argument(left.get(1..)?)?;
                let tag = if c == '^' { "sup" } else { "sub" };
                let place = SCRIPT_MARKS.clone().nth(scripts.len())?;
                scripts.push(format!("<{tag}>{}</{tag}>", read(inner, deep + 1)?));
                letters.push(place);
                left = after;
            }
            '\\' => left = read_command(left, &mut letters)?,
            // Columns of a matrix, and comments.
            '&' | '%' => return None,
            c => {
                letters.push(c);
                left = left.get(c.len_utf8()..)?;
            }
        }
    }
    let letters = folded(&letters);
    if letters.contains('\\') || letters.trim().is_empty() {
        return None;
    }
    let mut out = String::new();
    for part in letters.trim().split_inclusive(|c| SCRIPT_MARKS.contains(&c)) {
        let place = part.chars().next_back().filter(|c| SCRIPT_MARKS.contains(c));
        let words = part.trim_end_matches(|c| SCRIPT_MARKS.contains(&c));
        out.push_str(&escape(words));
        let script =
            place.and_then(|c| scripts.get((c as usize).checked_sub(*SCRIPT_MARKS.start() as usize)?));
        out.extend(script.map(String::as_str));
    }
    Some(out)
}

/// Reads a command at the beginning of a text into letters, and returns the rest.
fn read_command<'t>(tex: &'t str, letters: &mut String) -> Option<&'t str> {
    let length = tex.bytes().skip(1).take_while(u8::is_ascii_alphabetic).count();
    let name = tex.get(1..1 + length)?;
    let after = tex.get(1 + length..)?;
    if let Some((_, letter)) = LETTERS.iter().find(|(command, _)| *command == name) {
        letters.push(*letter);
        let next = after.trim_start_matches(' ');
        let joins = next.starts_with(char::is_alphanumeric) && letter.is_alphabetic();
        return Some(if joins { next } else { after });
    }
    if FUNCTIONS.contains(&name) {
        let next = after.trim_start_matches(' ');
        let needs_separator = next.starts_with(|c: char| c.is_alphanumeric() || c == '\\');
        letters.push_str(name);
        letters.push_str(if needs_separator { " " } else { "" });
        return Some(next);
    }
    // The character after the backslash belongs to a one-character command: `\,`, `\%`.
    let sign = after.chars().next().filter(|_| length == 0).map_or(0, char::len_utf8);
    letters.push_str(tex.get(..1 + length + sign)?);
    // A space after a relation is displayed; after other names it ends the name.
    let needs_separator = RELATIONS.contains(&name) && after.starts_with(' ');
    letters.push_str(if needs_separator { "{}" } else { "" });
    after.get(sign..)
}

/// The argument of a superscript or subscript (a group, a command or a character), and the text after it.
fn argument(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start_matches(' ');
    let first = text.chars().next()?;
    let end = match first {
        '{' => {
            let mut deep = 0;
            let close = text.char_indices().find(|(_, c)| {
                deep += i32::from(*c == '{') - i32::from(*c == '}');
                deep == 0
            })?;
            return Some((text.get(1..close.0)?, text.get(close.0 + 1..)?));
        }
        // A command with an argument is more than a character.
        '\\' => 1 + text.bytes().skip(1).take_while(u8::is_ascii_alphabetic).count(),
        c => c.len_utf8(),
    };
    let rest = text.get(end..)?;
    (first != '\\' || !rest.starts_with('{')).then_some((text.get(..end)?, rest))
}

#[cfg(test)]
mod tests {
    use super::text;

    fn rendered(t: &str) -> String {
        let all = text(t);
        all.trim_start_matches("<bdi>").trim_end_matches("</bdi>").to_string()
    }

    #[test]
    fn formulas_of_plain_letters_are_read() {
        for (tex, read) in [
            (r"after $0.442\,\mathrm{s}$ it", "after 0.442 s it"),
            (r"\(h = 2\) ms, $$v \le 4.3$$", "h = 2 ms, v ≤ 4.3"),
            (r"$9.81\ \mathrm{m/s^2}$", "9.81 m/s<sup>2</sup>"),
            (r"$2.4 \times 10^{-4}$", "2.4×10<sup>-4</sup>"),
            (r"$z_{k+1} = v_0 e^{-t/\tau}$", "z<sub>k+1</sub> = v<sub>0</sub> e<sup>-t/τ</sup>"),
            (r"$\omega \approx 1/\tau$", "ω ≈ 1/τ"),
            (r"$\sin\theta \neq \sin(x) \cdot 50\%$", "sin θ ≠ sin(x)·50%"),
            (r"$m^\star = 2\mu N / g$", "m<sup>*</sup> = 2μN / g"),
            (r"$a < b$", "a &lt; b"),
            (r"$v_{\mathrm{max}}$ and $x_{i_1}$", "v<sub>max</sub> and x<sub>i<sub>1</sub></sub>"),
        ] {
            assert_eq!(rendered(tex), read, "{tex}");
        }
    }

    #[test]
    fn unsupported_formulas_stay_as_written() {
        for tex in [
            r"\tfrac12 g t^2",
            r"\frac{a}{b}",
            r"\sqrt{2d/g}",
            r"\sum_{i=1}^{n} i",
            r"\begin{matrix} a & b \\ c & d \end{matrix}",
            r"\dot x",
            r"x^\mathrm{a}",
            r"x^{\frac{1}{2}}",
            r"a & b",
            r"x^",
            r"x_{a",
        ] {
            let escaped = tex.replace('&', "&amp;");
            assert_eq!(rendered(&format!("is ${tex}$ m")), format!("is <code>{escaped}</code> m"));
        }
    }

    #[test]
    fn a_dollar_is_no_formula() {
        for t in ["$5 and $6", "a $ b", "$", "$$", r"\$5$", r"a \ b", "$ x $", "costs $5"] {
            assert_eq!(rendered(t), t);
        }
        assert_eq!(text(""), "");
        assert_eq!(rendered("$<script>$"), "&lt;script&gt;");
        // Invisible characters are written as escapes, in formulas too.
        assert_eq!(rendered("$a\u{202e}b$"), "<code>a\\u{202e}b</code>");
        assert_eq!(rendered("$a_0\u{e000}$"), "<code>a_0\u{e000}</code>");
    }
}
