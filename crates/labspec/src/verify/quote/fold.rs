//! Normalizes spaces, dashes, superscripts and the TeX of numbers, so that a quote matches whether it is written as in the
//! source or as on the page.

use super::html::TEXT_SEPARATOR;
use super::{equations, siunitx};
use crate::markdown::tex;
use crate::source::SourceMap;
use nom::combinator::verify;
use nom::sequence::preceded;
use nom::{IResult, Parser};
use std::ops::Range;

/// The normalized text and its source map. Pieces that a page displays separately become lines. With `flat`, a dash becomes
/// a minus; texts are compared in this form. Without it, `0.4–0.5` and `0.4-0.5` remain different; numbers are read in this
/// form. The function tries one form after the other at each index. They are in one function because their order matters.
pub(super) fn fold(text: &str, flat: bool) -> (String, SourceMap) {
    let mut out = Out {
        text: String::with_capacity(text.len()),
        map: SourceMap::default(),
        space: None,
        glue: true,
        row: None,
    };
    let (mut offset, mut aligned) = (0, 0_usize);
    while let Some(rest) = text.get(offset..).filter(|rest| !rest.is_empty()) {
        let plain = rest.bytes().take_while(|&b| is_plain(b) && (b != b'&' || aligned == 0)).count();
        if plain > 0 {
            out.run(rest.get(..plain).unwrap_or(""), offset);
            offset += plain;
            continue;
        }
        let c = rest.chars().next().unwrap_or(' ');
        let unit = |tex: &str| fold(tex, true).0;
        let whole = siunitx::quantity(rest).ok().or_else(|| equations::fraction_of_units(rest, &unit));
        if let Some((tail, rendered)) = whole {
            let end = text.len() - tail.len();
            out.whole(&rendered, offset..end);
            offset = end;
            continue;
        }
        if let Some(tail) = equations::layout(rest, &mut aligned) {
            out.wait(offset..text.len() - tail.len());
            offset = text.len() - tail.len();
            continue;
        }
        if let Ok((tail, _)) = unseen(rest) {
            offset = text.len() - tail.len();
            continue;
        }
        // The arguments of a command are separate: `\frac{0.5}{2}` is not 0.52.
        if rest.starts_with("}{") {
            out.push('⁄', offset..offset + 2, text);
            offset += 2;
            continue;
        }
        let (what, length) = match c {
            '\\' => command(rest),
            '&' if aligned > 0 => (Meaning::Space, 1),
            _ => (meaning(c, flat), c.len_utf8()),
        };
        let range = offset..offset + length;
        out.write(what, range, text);
        offset += length;
    }
    (out.text, out.map)
}

/// The meaning of a character or a command.
enum Meaning {
    Space,
    Nothing,
    /// Displayed separately from the text before it.
    Separator,
    /// A space after a digit, else "about".
    Tilde,
    Letter(char),
    /// A superscript or subscript, with the mark that begins a sequence of them.
    Script(char, char),
    /// Spaces around it are removed.
    Operator(char),
    /// Copied unchanged.
    Verbatim,
}

/// Whether a byte means itself in any context.
fn is_plain(b: u8) -> bool {
    b.is_ascii_graphic() && !matches!(b, b'$' | b'{' | b'}' | b'\\' | b'~')
}

fn meaning(c: char, flat: bool) -> Meaning {
    match c {
        TEXT_SEPARATOR => Meaning::Separator,
        '$' | '{' | '}' | '\u{200b}'..='\u{200d}' | '\u{2060}' | '\u{feff}' | '\u{ad}' => Meaning::Nothing,
        '~' | '∼' => Meaning::Tilde,
        '−' | '‐' | '‑' => Meaning::Letter('-'),
        '‒' | '–' => Meaning::Letter(if flat { '-' } else { '–' }),
        '—' => Meaning::Letter(if flat { '-' } else { '—' }),
        '×' | '✕' => Meaning::Operator('×'),
        '·' | '⋅' | '∙' => Meaning::Operator('·'),
        '±' => Meaning::Operator('±'),
        '≈' | '≃' | '≅' => Meaning::Letter('≈'),
        'µ' => Meaning::Letter('μ'),
        // Full-width characters, used for figures in Chinese and Japanese.
        '\u{ff01}'..='\u{ff5e}' => {
            let plain = char::from_u32(u32::from(c) - 0xfee0).unwrap_or(c);
            if plain == '~' { Meaning::Tilde } else { Meaning::Letter(plain) }
        }
        '〜' => Meaning::Tilde,
        '\u{2126}' => Meaning::Letter('Ω'),
        '’' => Meaning::Letter('\''),
        '⁺' => Meaning::Script('^', '+'),
        '⁻' => Meaning::Script('^', '-'),
        '²' => Meaning::Script('^', '2'),
        '³' => Meaning::Script('^', '3'),
        '¹' => Meaning::Script('^', '1'),
        '⁰' | '⁴'..='⁹' => Meaning::Script('^', digit(c, '⁰')),
        '₀'..='₉' => Meaning::Script('_', digit(c, '₀')),
        c if c.is_whitespace() || c.is_control() => Meaning::Space,
        c => Meaning::Letter(c),
    }
}

fn digit(c: char, zero: char) -> char {
    char::from_digit(u32::from(c).wrapping_sub(u32::from(zero)), 10).unwrap_or(c)
}

/// Maximum length of an invisible argument, in bytes.
const MAX_HIDDEN_LENGTH: usize = 1000;

/// A command without visible output, with its argument: `\phantom{0.5}`.
fn unseen(text: &str) -> IResult<&str, &str> {
    const NAMES: [&str; 10] =
        ["phantom", "hphantom", "vphantom", "label", "tag", "hspace", "vspace", "kern", "ref", "cite"];
    let name = verify(tex::command, |name: &str| NAMES.contains(&name));
    preceded(name, |text| tex::group(text, MAX_HIDDEN_LENGTH)).parse(text)
}

/// The TeX command at the beginning of `text`, and its length including the spaces after its name.
fn command(text: &str) -> (Meaning, usize) {
    let (rest, name) = tex::command(text).unwrap_or((text, ""));
    let length = text.len() - rest.len();
    let spaces = rest.len() - rest.trim_start_matches(' ').len();
    let meaning = match name {
        "," | ";" | ":" | " " | "\\" | "\n" => return (Meaning::Space, length),
        "!" | "(" | ")" | "[" | "]" => return (Meaning::Nothing, length),
        "%" | "$" | "{" | "}" | "#" | "&" | "_" => {
            return (name.chars().next().map_or(Meaning::Nothing, Meaning::Letter), length);
        }
        "times" => Meaning::Operator('×'),
        "cdot" => Meaning::Operator('·'),
        "pm" => Meaning::Operator('±'),
        "approx" | "simeq" | "cong" => Meaning::Letter('≈'),
        "sim" => Meaning::Letter('~'),
        "to" | "rightarrow" | "longrightarrow" | "Rightarrow" | "implies" | "longmapsto" | "mapsto" => {
            Meaning::Letter('→')
        }
        "le" | "leq" => Meaning::Letter('≤'),
        "ge" | "geq" => Meaning::Letter('≥'),
        "lt" => Meaning::Letter('<'),
        "gt" => Meaning::Letter('>'),
        "mu" => Meaning::Letter('μ'),
        "Omega" => Meaning::Letter('Ω'),
        "pi" => Meaning::Letter('π'),
        "circ" | "degree" => Meaning::Letter('°'),
        "ldots" | "dots" => Meaning::Letter('…'),
        "quad" | "qquad" => Meaning::Space,
        "mathrm" | "mathit" | "mathbf" | "mathsf" | "text" | "textrm" | "textbf" | "operatorname" | "rm"
        | "bf" | "left" | "right" | "displaystyle" | "big" | "Big" | "bigl" | "bigr" | "Bigl" | "Bigr"
        | "boxed" | "mbox" | "hbox" | "textit" | "emph" | "mathbin" | "mathord" | "ensuremath" => {
            Meaning::Nothing
        }
        name if name.starts_with(|c: char| c.is_ascii_alphabetic()) => return (Meaning::Verbatim, length),
        _ => return (Meaning::Letter('\\'), 1),
    };
    (meaning, length + spaces)
}

struct Out {
    text: String,
    map: SourceMap,
    /// Spaces that were read and not yet written.
    space: Option<Range<usize>>,
    /// Whether the text is empty or ends with an operator: then a space is not written.
    glue: bool,
    /// The mark of the preceding sequence of raised or lowered digits.
    row: Option<char>,
}

impl Out {
    /// Writes a character or a command of this meaning.
    fn write(&mut self, what: Meaning, range: Range<usize>, text: &str) {
        match what {
            Meaning::Space => self.wait(range),
            Meaning::Nothing => {}
            Meaning::Separator => self.separate(range.start),
            Meaning::Tilde if self.text.ends_with(|c: char| c.is_ascii_digit()) && self.space.is_none() => {
                self.wait(range)
            }
            Meaning::Tilde => self.push('~', range, text),
            Meaning::Letter(c) => self.push(c, range, text),
            Meaning::Script(mark, digit) => self.script(mark, digit, range, text),
            Meaning::Operator(c) => {
                self.space = None;
                self.push(c, range, text);
                self.glue = true;
            }
            Meaning::Verbatim => {
                let word = text.get(range.clone()).unwrap_or("");
                self.run(word, range.start);
            }
        }
    }

    fn wait(&mut self, range: Range<usize>) {
        let start = self.space.as_ref().map_or(range.start, |s| s.start);
        self.space = Some(start..range.end);
    }

    fn settle(&mut self) {
        if let Some(space) = self.space.take()
            && !self.glue
        {
            self.text.push(' ');
            self.map.push_whole(1, space);
        }
        self.glue = false;
        self.row = None;
    }

    fn run(&mut self, word: &str, offset: usize) {
        self.settle();
        self.text.push_str(word);
        self.map.push_verbatim(offset..offset + word.len());
    }

    fn push(&mut self, c: char, range: Range<usize>, source: &str) {
        self.settle();
        self.text.push(c);
        let mut bytes = [0; 4];
        if source.get(range.clone()) == Some(&*c.encode_utf8(&mut bytes)) {
            self.map.push_verbatim(range);
        } else {
            self.map.push_whole(c.len_utf8(), range);
        }
    }

    /// Appends the text for a whole command.
    fn whole(&mut self, rendered: &str, range: Range<usize>) {
        self.settle();
        self.text.push_str(rendered);
        self.map.push_whole(rendered.len(), range);
    }

    /// Appends a raised or lowered digit: the first of a sequence gets the mark.
    fn script(&mut self, mark: char, digit: char, range: Range<usize>, source: &str) {
        if self.row != Some(mark) || self.space.is_some() {
            self.push(mark, range.clone(), source);
        }
        self.push(digit, range, source);
        self.row = Some(mark);
    }

    fn separate(&mut self, offset: usize) {
        self.space = None;
        self.glue = true;
        if !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push('\n');
            self.map.push_whole(1, offset..offset);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_notations_are_equal() {
        let f = |text: &str| fold(text, true).0;
        for text in ["2.4 × 10⁻⁴", "$2.4 \\times 10^{-4}$", "2.4\\times10^{-4}", "2.4×10^\u{2212}4"] {
            assert_eq!(f(text), "2.4×10^-4", "{text}");
        }
        for text in ["0.442\u{202f}s", "0.442\n s", "$0.442\\,\\mathrm{s}$", "0.442~s", "$0.442$ s"] {
            assert_eq!(f(text), "0.442 s", "{text}");
        }
        assert_eq!(f("0.44 ± 0.01 and ~5"), "0.44±0.01 and ~5");
        assert_eq!(f("0.4–0.5, \u{2212}2, m², x₁₂, 1{,}500"), "0.4-0.5, -2, m^2, x_12, 1,500");
        assert_eq!(fold("0.4–0.5", false).0, "0.4–0.5");
        assert_eq!(f("a\u{1} \u{1}b"), "a\nb");
        assert_eq!(f("\\frac{1}{2} \\"), "\\frac1⁄2 \\");
        let aligned =
            "$$\\begin{aligned} v &= \\sqrt{2gh} \\\\[4pt] &= 3.96\\,\\mathrm{m/s}\\end{aligned}$$ a & b";
        assert_eq!(f(aligned), "v = \\sqrt2gh = 3.96 m/s a & b");
        for text in [
            "\\frac{\\mathrm{m}}{\\mathrm{s}}",
            "\\tfrac{\\text{m}}{\\text{s}}",
            "\\dfrac{m}{s}",
            "\\frac{\\rm m}{\\rm s}",
        ] {
            assert_eq!(f(&format!("$3.96\\,{text}$")), "3.96 m/s", "{text}");
        }
        assert_eq!(f("3.96 \\frac{\\mathrm{kg\\,m}}{\\mathrm{s}^2}"), "3.96 (kg m)/(s^2)");
        assert_eq!(f("\\frac{m}{s}^2, \\frac{m}{k}, \\frac{0.5}{s}"), "\\fracm⁄s^2, \\fracm⁄k, \\frac0.5⁄s");
        assert_eq!(f("$\\SI{0.5}{s}$, \\phantom{3 m}０．５秒"), "0.5 s, 0.5秒");
    }

    #[test]
    fn byte_ranges_are_kept() {
        let text = "takes $2.4 \\times 10^{-4}$ s";
        let (folded, map) = fold(text, true);
        assert_eq!(folded, "takes 2.4×10^-4 s");
        let offset = folded.find("2.4").unwrap();
        assert_eq!(&text[map.span(offset..folded.len())], "2.4 \\times 10^{-4}$ s");
    }
    /// Text of 100 kB of any opening character is read in linear time.
    #[test]
    fn hostile_texts_are_folded_in_linear_time() {
        for piece in [
            "\\",
            "{",
            "}{",
            "\\SI[",
            "\\SI{",
            "\\phantom{",
            "\\phantom{}",
            "\\a",
            "$",
            "~",
            "²",
            "\\SI{1}{\\m",
            "1",
        ] {
            let text = piece.repeat(100_000 / piece.len());
            assert!(fold(&text, true).0.len() <= 2 * text.len(), "{piece}");
        }
    }
}
