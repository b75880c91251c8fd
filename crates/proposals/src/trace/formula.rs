//! Formulas before a number: `t = \sqrt{2d/g} = 0.4401 s`, evaluated with the values that the text gives for d and g.

use super::units::si;
use labspec::verify::Stated;

/// A symbol with a value in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Binding {
    name: String,
    /// In SI units.
    value: f64,
    /// The position in the file.
    offset: usize,
}

/// A formula in the language of labs, with its value in SI units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EvaluatedFormula {
    pub(super) code: String,
    pub(super) value: f64,
}

/// The maximum number of bytes before a number that are searched for a formula.
const LONG: usize = 300;
/// The maximum number of tokens of a formula, and its maximum nesting.
const TOKENS: usize = 60;
const DEEP: usize = 12;

/// The symbols with values in a text.
pub(super) fn bindings(numbers: &[Stated]) -> Vec<Binding> {
    let one = |s: &Stated| {
        // The formula ends where words begin.
        let mut parts = chain(s)?.into_iter().map(|part| tokens(&part));
        let first = parts.find(|all| has_words(all) || all.len() == 1)?;
        let Some(FormulaToken::Symbol(name)) = first.last().cloned() else { return None };
        Some(Binding { name, value: si(s), offset: s.span.start })
    };
    numbers.iter().filter_map(one).collect()
}

/// The formula before a number, evaluated.
pub(super) fn before(s: &Stated, bindings: &[Binding]) -> Option<EvaluatedFormula> {
    for part in chain(s)? {
        let all = tokens(&part);
        // Words may precede the formula: the longest suffix that is a formula is used.
        let found = (0..all.len()).find_map(|from| {
            let mut parser =
                FormulaParser { tokens: all.get(from..)?, next: 0, deep: 0, operations: 0, s, bindings };
            let worked = parser.sum()?;
            let whole = parser.next == parser.tokens.len() && parser.operations > 0;
            whole.then_some(worked)
        });
        if found.is_some() {
            return found.filter(|w| w.value.is_finite());
        }
        if has_words(&all) {
            return None;
        }
    }
    None
}

/// Whether there are words in addition to a formula.
fn has_words(all: &[FormulaToken]) -> bool {
    all.iter()
        .any(|t| matches!(t, FormulaToken::Symbol(name) if name.len() > 3 && name.chars().all(char::is_alphabetic)))
}

/// The parts between the equality signs before a number, the nearest first, or `None` if there is no such sign.
fn chain(s: &Stated) -> Option<Vec<String>> {
    let text = s.paragraph.get(..s.offset)?;
    let mut from = text.len().saturating_sub(LONG);
    while !text.is_char_boundary(from) {
        from += 1;
    }
    let text = text.get(from..)?.replace("\\approx", "≈").replace("\\quad", "=");
    let mut parts: Vec<&str> = text.split(['=', '≈']).collect();
    let last = parts.pop()?;
    let nothing = last.chars().all(|c| c.is_whitespace() || matches!(c, '$' | '{' | '~' | '\\' | ',' | ';'));
    if parts.is_empty() || !nothing {
        return None;
    }
    parts.reverse();
    Some(parts.into_iter().map(|p| p.trim_matches(['$', ' ', '\n']).to_string()).collect())
}

#[derive(Clone, Debug, PartialEq)]
enum FormulaToken {
    Number(f64, String),
    Symbol(String),
    Command(String),
    Sign(char),
}

/// The last tokens of a text.
fn tokens(text: &str) -> Vec<FormulaToken> {
    let chars: Vec<char> = text.chars().collect();
    let char_at = |i: usize| chars.get(i).copied();
    let mut all = Vec::new();
    let mut i = 0;
    while let Some(c) = char_at(i) {
        let run = |from: usize, test: &dyn Fn(char) -> bool| {
            (from..).take_while(|k| char_at(*k).is_some_and(test)).count()
        };
        match c {
            '0'..='9' => {
                let length = match is_digit_of_fraction(&all) {
                    true => 1,
                    false => run(i, &|c| c.is_ascii_digit() || c == '.'),
                };
                let word: String = chars.iter().skip(i).take(length).collect();
                let word = word.trim_end_matches('.').to_string();
                all.push(word.parse().map_or(FormulaToken::Sign('?'), |x| FormulaToken::Number(x, word)));
                i += length;
                continue;
            }
            '\\' => {
                let length = run(i + 1, &|c| c.is_ascii_alphabetic());
                let word: String = chars.iter().skip(i + 1).take(length).collect();
                command(&chars, &mut i, word, length, &mut all);
                i += length + 1;
                continue;
            }
            '×' | '·' | '*' => all.push(FormulaToken::Sign('*')),
            '−' | '-' | '–' => all.push(FormulaToken::Sign('-')),
            '²' | '³' => {
                all.push(FormulaToken::Sign('^'));
                let (x, word) = if c == '²' { (2.0, "2") } else { (3.0, "3") };
                all.push(FormulaToken::Number(x, word.into()));
            }
            '√' => all.push(FormulaToken::Command("sqrt".into())),
            '+' | '/' | '(' | ')' | '{' | '}' | '^' => all.push(FormulaToken::Sign(c)),
            c if c.is_alphabetic() => {
                let length = run(i, &|c| c.is_alphabetic());
                if length == 1 {
                    symbol(&chars, &mut i, c.to_string(), 1, &mut all);
                } else {
                    // Adjacent letters are a product in a formula, and a word in a sentence.
                    let word: String = chars.iter().skip(i).take(length).collect();
                    all.push(FormulaToken::Symbol(word));
                    i += length - 1;
                }
            }
            c if c.is_whitespace() || matches!(c, '$' | '~') => {}
            c => all.push(FormulaToken::Sign(c)),
        }
        i += 1;
    }
    let from = all.len().saturating_sub(TOKENS);
    all.split_off(from)
}

/// Whether the next digit is a separate number: in `\tfrac12`, each digit is one.
fn is_digit_of_fraction(before: &[FormulaToken]) -> bool {
    match before {
        [.., FormulaToken::Command(c)] | [.., FormulaToken::Command(c), FormulaToken::Number(..)] => {
            c.ends_with("frac")
        }
        _ => false,
    }
}

/// Adds the token of a TeX command with a name of this length.
fn command(chars: &[char], i: &mut usize, name: String, length: usize, all: &mut Vec<FormulaToken>) {
    match name.as_str() {
        // Spaces and size commands are ignored.
        "" => *i += 1,
        "left" | "right" | "displaystyle" | "mathrm" | "text" | "ast" | "dot" => {}
        "times" | "cdot" => all.push(FormulaToken::Sign('*')),
        "frac" | "tfrac" | "dfrac" | "sqrt" | "sin" | "cos" | "tan" | "exp" | "ln" | "arcsin" | "arccos"
        | "arctan" => {
            all.push(FormulaToken::Command(name));
        }
        _ => symbol(chars, i, name, length + 1, all),
    }
}

/// Adds a symbol with its subscript and star: `t^\ast`, `z_{k+1}`.
fn symbol(chars: &[char], i: &mut usize, mut name: String, length: usize, all: &mut Vec<FormulaToken>) {
    let mut end = *i + length;
    if chars.get(end) == Some(&'_') {
        let braces = chars.get(end + 1) == Some(&'{');
        let from = end + if braces { 2 } else { 1 };
        let count = if braces {
            (from..).take_while(|k| chars.get(*k).is_some_and(|c| *c != '}')).count()
        } else {
            1
        };
        name.push('_');
        name.extend(chars.iter().skip(from).take(count));
        end = from + count + usize::from(braces);
    }
    let rest: String = chars.iter().skip(end).take(5).collect();
    for star in ["^\\ast", "^*", "^{*}"] {
        if rest.starts_with(star) {
            name.push('*');
            end += star.chars().count();
            break;
        }
    }
    all.push(FormulaToken::Symbol(name));
    *i = end - length;
}

struct FormulaParser<'a> {
    tokens: &'a [FormulaToken],
    next: usize,
    deep: usize,
    operations: usize,
    s: &'a Stated,
    bindings: &'a [Binding],
}

impl FormulaParser<'_> {
    fn sign(&mut self, c: char) -> bool {
        let there = self.tokens.get(self.next) == Some(&FormulaToken::Sign(c));
        self.next += usize::from(there);
        there
    }

    fn sum(&mut self) -> Option<EvaluatedFormula> {
        self.deep += 1;
        if self.deep > DEEP {
            return None;
        }
        let mut all = self.product()?;
        loop {
            let (sign, add) = if self.sign('+') {
                ("+", 1.0)
            } else if self.sign('-') {
                ("-", -1.0)
            } else {
                break;
            };
            let next = self.product()?;
            self.operations += 1;
            all = EvaluatedFormula {
                code: format!("({} {sign} {})", all.code, next.code),
                value: all.value + add * next.value,
            };
        }
        self.deep -= 1;
        Some(all)
    }

    fn product(&mut self) -> Option<EvaluatedFormula> {
        let mut all = self.power()?;
        loop {
            if self.sign('/') {
                let next = self.power()?;
                all = EvaluatedFormula {
                    code: format!("{} / {}", all.code, next.code),
                    value: all.value / next.value,
                };
            } else {
                let written = self.sign('*');
                let begins = match self.tokens.get(self.next) {
                    Some(FormulaToken::Number(..)) => written,
                    Some(
                        FormulaToken::Symbol(_) | FormulaToken::Command(_) | FormulaToken::Sign('(' | '{'),
                    ) => true,
                    _ => written,
                };
                if !begins {
                    break;
                }
                let next = self.power()?;
                all = EvaluatedFormula {
                    code: format!("{} * {}", all.code, next.code),
                    value: all.value * next.value,
                };
            }
            self.operations += 1;
        }
        Some(all)
    }

    fn power(&mut self) -> Option<EvaluatedFormula> {
        let base = self.atom()?;
        if !self.sign('^') {
            return Some(base);
        }
        let exponent = self.atom()?;
        self.operations += 1;
        Some(EvaluatedFormula {
            code: format!("({}) ** ({})", base.code, exponent.code),
            value: base.value.powf(exponent.value),
        })
    }

    fn group(&mut self, close: char) -> Option<EvaluatedFormula> {
        let inner = self.sum()?;
        let inner = EvaluatedFormula { code: format!("({})", inner.code), ..inner };
        self.sign(close).then_some(inner)
    }

    fn atom(&mut self) -> Option<EvaluatedFormula> {
        let token = self.tokens.get(self.next)?;
        self.next += 1;
        match token {
            FormulaToken::Number(value, code) => Some(EvaluatedFormula { code: code.clone(), value: *value }),
            FormulaToken::Symbol(name) => self.bound(name),
            FormulaToken::Sign('(') => self.group(')'),
            FormulaToken::Sign('{') => self.group('}'),
            FormulaToken::Sign('-') => {
                let inner = self.product()?;
                Some(EvaluatedFormula { code: format!("(-{})", inner.code), value: -inner.value })
            }
            FormulaToken::Sign(_) => None,
            FormulaToken::Command(name) if name.ends_with("frac") => {
                let (above, below) = (self.atom()?, self.atom()?);
                self.operations += 1;
                Some(EvaluatedFormula {
                    code: format!("({} / {})", above.code, below.code),
                    value: above.value / below.value,
                })
            }
            FormulaToken::Command(name) => {
                let name = if self.inverse() { format!("arc{name}") } else { name.clone() };
                let operand = self.atom()?;
                self.operations += 1;
                let (function, value) = match name.as_str() {
                    "arcsin" => ("asin", operand.value.asin()),
                    "arccos" => ("acos", operand.value.acos()),
                    "arctan" => ("atan", operand.value.atan()),
                    "sqrt" => ("sqrt", operand.value.sqrt()),
                    "sin" => ("sin", operand.value.sin()),
                    "cos" => ("cos", operand.value.cos()),
                    "tan" => ("tan", operand.value.tan()),
                    "exp" => ("exp", operand.value.exp()),
                    _ => ("log", operand.value.ln()),
                };
                Some(EvaluatedFormula { code: format!("Math.{function}({})", operand.code), value })
            }
        }
    }

    /// Whether the exponent −1 of an inverse function follows: `\tan^{-1} 0.6`.
    fn inverse(&mut self) -> bool {
        use FormulaToken::{Number, Sign};
        let rest = self.tokens.get(self.next..).unwrap_or_default();
        let length = match rest {
            [Sign('^'), Sign('{'), Sign('-'), Number(one, _), Sign('}'), ..] if *one == 1.0 => 5,
            [Sign('^'), Sign('-'), Number(one, _), ..] if *one == 1.0 => 3,
            _ => 0,
        };
        self.next += length;
        length > 0
    }

    /// The value of a symbol: the last one in the text before the number, otherwise the first one after it.
    fn bound(&self, name: &str) -> Option<EvaluatedFormula> {
        let here = self.s.span.start;
        let bound = || self.bindings.iter().filter(|b| b.name == name && b.offset != here);
        let found = bound()
            .filter(|b| b.offset < here)
            .max_by_key(|b| b.offset)
            .or_else(|| bound().min_by_key(|b| b.offset));
        let constant = match name {
            "pi" | "π" => Some(("Math.PI".to_string(), std::f64::consts::PI)),
            "e" => Some(("Math.E".to_string(), std::f64::consts::E)),
            _ => None,
        };
        if let Some(b) = found {
            return Some(EvaluatedFormula { code: b.value.to_string(), value: b.value });
        }
        if let Some((code, value)) = constant {
            return Some(EvaluatedFormula { code, value });
        }
        // Adjacent letters: `gd`.
        let letters: Vec<char> = name.chars().collect();
        if !(2..=3).contains(&letters.len()) || !letters.iter().all(|c| c.is_ascii_lowercase()) {
            return None;
        }
        let parts: Vec<EvaluatedFormula> =
            letters.iter().map(|c| self.bound(&c.to_string())).collect::<Option<_>>()?;
        let code: Vec<&str> = parts.iter().map(|p| p.code.as_str()).collect();
        Some(EvaluatedFormula { code: code.join(" * "), value: parts.iter().map(|p| p.value).product() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec_expr::dimension::Dimension;
    use std::sync::Arc;

    fn stated(text: &str, number: &str, offset: usize) -> Option<Stated> {
        let read = labspec::verify::quoted(number).ok()?;
        Some(Stated {
            quote: number.into(),
            span: offset..offset + 1,
            read,
            unit: String::new(),
            dimension: Dimension::NUMBER,
            context: String::new(),
            column: String::new(),
            paragraph: Arc::from(text),
            offset: text.rfind(number)?,
            bound: false,
            answer: false,
        })
    }

    fn value(text: &str, number: &str) -> Option<f64> {
        let bindings =
            [("d", 0.95), ("g", 9.81), ("h", 0.005), ("t", 0.5), ("v_0", 4.3), ("z_0", 1.0), ("r", 0.05)];
        let bindings: Vec<Binding> = bindings
            .iter()
            .map(|(name, value)| Binding { name: (*name).into(), value: *value, offset: 0 })
            .collect();
        before(&stated(text, number, 9)?, &bindings).map(|w| w.value)
    }

    #[test]
    fn formulas_are_worked_out() {
        for (text, number, truth) in [
            ("which takes $t^\\ast = \\sqrt{2d/g} = 0.4401$ s", "0.4401", (2.0 * 0.95 / 9.81f64).sqrt()),
            ("at speed \\sqrt{2gd} = 4.317", "4.317", (2.0 * 9.81 * 0.95f64).sqrt()),
            ("it falls d = z_0 - r = 0.95", "0.95", 0.95),
            ("is \\tfrac12 g h t = 0.01226 m = 12.26", "12.26", 0.5 * 9.81 * 0.005 * 0.5),
            ("about $v_0 / (\\omega e) = 4.3 / (50 \\times 2.72)$ = 32", "32", 4.3 / (50.0 * 2.72)),
            ("\\frac{1}{2} g t^2 = 1.2", "1.2", 0.5 * 9.81 * 0.25),
            ("\\tan^{-1} 0.6$ = 0.540", "0.540", 0.6f64.atan()),
            ("\\arctan 0.6 = 0.540", "0.540", 0.6f64.atan()),
        ] {
            let found = value(text, number).unwrap_or(f64::NAN);
            assert!((found - truth).abs() < 1e-12 * truth, "{text}: {found}");
        }
        for (text, number) in
            [("the ball falls 0.95", "0.95"), ("h = 5", "5"), ("a word = 3", "3"), ("= 3", "3")]
        {
            assert_eq!(value(text, number), None, "{text}");
        }
    }

    #[test]
    fn symbols_are_bound_where_they_are_given() {
        let names = |text: &str, number: &str| -> Vec<String> {
            stated(text, number, 3)
                .map_or(Vec::new(), |s| bindings(&[s]).into_iter().map(|b| b.name).collect())
        };
        assert_eq!(names("with $h$ = 5", "5"), ["h"]);
        assert_eq!(names("t^\\ast = \\sqrt{2d/g} = 0.44", "0.44"), ["t*"]);
        assert_eq!(names("height $z_0$ = 1.0", "1.0"), ["z_0"]);
        assert!(names("a height of 1.0", "1.0").is_empty());
    }
}
