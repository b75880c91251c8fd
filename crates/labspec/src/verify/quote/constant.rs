//! Computes constant arithmetic before an equality sign, in TeX or plain text: `\sqrt{2 \cdot 9.81 \cdot 0.8} = 3.96`.

use std::iter::Peekable;
use std::str::Chars;

/// Maximum length of the arithmetic, in bytes, and depth of its brackets.
const MAX_LENGTH: usize = 200;
const MAX_DEPTH: usize = 8;

/// The value of the arithmetic before the equality sign that precedes the number at an index of the file; `None` where
/// there is no such sign, or where the text before it is not constant arithmetic with an operation.
pub(super) fn value_before(file: &str, start: usize) -> Option<f64> {
    let mut from = start.saturating_sub(MAX_LENGTH);
    while !file.is_char_boundary(from) {
        from += 1;
    }
    // In JSON, a backslash is doubled.
    let text = file.get(from..start)?.replace("\\\\", "\\");
    let text = text.trim_end_matches([' ', '$', '&']).strip_suffix('=')?;
    let begin = text.rfind(['=', '≈', '$', '"', '\n', '>'])?;
    let text = text.get(begin..)?.trim_start_matches(['=', '≈', '$', '"', '\n', '>']);
    let mut arithmetic = Arithmetic { chars: text.chars().peekable(), operations: 0, depth: 0 };
    let value = arithmetic.sum()?;
    arithmetic.blanks();
    (arithmetic.chars.peek().is_none() && arithmetic.operations > 0 && value.is_finite()).then_some(value)
}

/// A reader of constant arithmetic.
struct Arithmetic<'t> {
    chars: Peekable<Chars<'t>>,
    operations: usize,
    depth: usize,
}

/// A TeX command or a character.
#[derive(PartialEq)]
enum Sign {
    Times,
    Over,
    Root,
    Fraction,
    Pi,
    Open,
    Other,
}

impl Arithmetic<'_> {
    /// Skips spaces, alignment marks and commands for spaces.
    fn blanks(&mut self) {
        loop {
            let mut ahead = self.chars.clone();
            match (ahead.next(), ahead.next()) {
                (Some(' ' | '~' | '&' | '\u{a0}' | '\u{202f}'), _) => {}
                (Some('\\'), Some(',' | ';' | ':' | ' ' | '!')) => {
                    self.chars.next();
                }
                (Some('\\'), None) => {}
                _ => return,
            }
            self.chars.next();
        }
    }

    fn take(&mut self, c: char) -> bool {
        self.blanks();
        self.chars.next_if_eq(&c).is_some()
    }

    fn sum(&mut self) -> Option<f64> {
        let mut all = self.product()?;
        loop {
            if self.take('+') {
                all += self.product()?;
            } else if self.take('-') || self.take('−') {
                all -= self.product()?;
            } else {
                return Some(all);
            }
            self.operations += 1;
        }
    }

    fn product(&mut self) -> Option<f64> {
        let mut all = self.power()?;
        loop {
            let before = self.chars.clone();
            match self.sign() {
                Some(Sign::Times) => all *= self.power()?,
                Some(Sign::Over) => all /= self.power()?,
                Some(Sign::Root | Sign::Fraction | Sign::Pi | Sign::Open) => {
                    self.chars = before;
                    all *= self.power()?;
                }
                _ => {
                    self.chars = before;
                    return Some(all);
                }
            }
            self.operations += 1;
        }
    }

    /// The next sign, which is consumed.
    fn sign(&mut self) -> Option<Sign> {
        self.blanks();
        Some(match self.chars.next()? {
            '*' | '·' | '×' | '⋅' => Sign::Times,
            '/' | '÷' => Sign::Over,
            '√' => Sign::Root,
            'π' => Sign::Pi,
            '(' => Sign::Open,
            '\\' => {
                let mut name = String::new();
                while let Some(c) = self.chars.next_if(char::is_ascii_alphabetic) {
                    name.push(c);
                }
                match name.as_str() {
                    "cdot" | "times" => Sign::Times,
                    "div" => Sign::Over,
                    "sqrt" => Sign::Root,
                    "frac" | "tfrac" | "dfrac" => Sign::Fraction,
                    "pi" => Sign::Pi,
                    "left" if self.take('(') => Sign::Open,
                    _ => Sign::Other,
                }
            }
            _ => Sign::Other,
        })
    }

    fn power(&mut self) -> Option<f64> {
        let base = self.factor()?;
        let exponent = match () {
            () if self.chars.next_if_eq(&'²').is_some() => 2.0,
            () if self.chars.next_if_eq(&'³').is_some() => 3.0,
            () if self.take('^') => {
                if self.take('{') {
                    self.inner('}')?
                } else {
                    f64::from(self.chars.next()?.to_digit(10)?)
                }
            }
            () => return Some(base),
        };
        self.operations += 1;
        Some(base.powf(exponent))
    }

    fn factor(&mut self) -> Option<f64> {
        self.blanks();
        if self.take('-') || self.take('−') {
            return Some(-self.factor()?);
        }
        if self.chars.peek().is_some_and(|c| c.is_ascii_digit() || *c == '.') {
            return self.number();
        }
        match self.sign()? {
            Sign::Pi => Some(std::f64::consts::PI),
            Sign::Open => self.inner(')'),
            Sign::Root => {
                self.operations += 1;
                let inside = if self.take('{') { self.inner('}') } else { self.factor() };
                inside.map(f64::sqrt)
            }
            Sign::Fraction => {
                self.operations += 1;
                let above = self.take('{').then(|| self.inner('}'))??;
                let below = self.take('{').then(|| self.inner('}'))??;
                Some(above / below)
            }
            Sign::Times | Sign::Over | Sign::Other => None,
        }
    }

    /// The arithmetic before a closing bracket.
    fn inner(&mut self, close: char) -> Option<f64> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return None;
        }
        let value = self.sum()?;
        self.depth -= 1;
        let before = self.chars.clone();
        // `\right)`
        if !"\\right".chars().all(|c| self.chars.next_if_eq(&c).is_some()) {
            self.chars = before;
        }
        self.take(close).then_some(value)
    }

    fn number(&mut self) -> Option<f64> {
        let mut digits = String::new();
        while let Some(c) = self.chars.next_if(|c| c.is_ascii_digit() || *c == '.') {
            digits.push(c);
        }
        digits.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_arithmetic_before_a_number_is_computed() {
        let value = |text: &str| value_before(text, text.len());
        for (text, expected) in [
            (r"$t = \sqrt{2h/g} = \sqrt{2 \cdot 3.5 / 1.62} = ", 2.0787),
            (r"$t = \\sqrt{2 \\cdot 3.5 / 1.62} = ", 2.0787),
            (r"$= 2\pi\sqrt{\frac{0.5}{9.81}} =", 1.4185),
            (r"$v = \left(3 + 1\right)^2 \cdot 2 = $", 32.0),
            ("= √(2 · 9.81 · 0.8) = ", 3.9618),
            ("$2^{3} - 1 = ", 7.0),
            (r"$$ v &= 2 \times 3 \\ &= ", 6.0),
        ] {
            assert!(
                value(text).is_some_and(|x| (x / expected - 1.0).abs() < 1e-4),
                "{text}: {:?}",
                value(text)
            );
        }
        for text in [
            "$t = \\sqrt{2h/g} = ",
            "$t = ",
            "$3 = ",
            "it is 2 + 3 = ",
            "$2 + 3",
            "$2 3 = ",
            "$\\sqrt{2 = ",
            "$30° = ",
            "=",
        ] {
            assert_eq!(value(text), None, "{text}");
        }
        assert!(value(&format!("${}1 + 1 = ", "(".repeat(100))).is_none());
    }
}
