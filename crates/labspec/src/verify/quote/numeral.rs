//! Digits with their separators, decimals and power of ten, at one place of a text.

use super::number::{Form, Quoted, Style, ten};
use labspec_bind::units::is_wide;

/// A number and where it stands, in characters.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numeral {
    pub(super) quoted: Quoted,
    /// First character, the sign included.
    pub(super) start: usize,
    /// Behind the last character.
    pub(super) end: usize,
    /// What else it could mean.
    pub(super) doubts: Vec<f64>,
    /// Why it should not be called wrong, or not be read at all.
    pub(super) unsure: Option<&'static str>,
    pub(super) refused: Option<&'static str>,
}

/// Most digits of a number: more than any computation has.
const MAX_DIGITS: usize = 30;
/// Largest power of ten, so that no print of it overflows.
const MAX_EXPONENT: i32 = 290;

/// What stands for a fraction.
pub(super) fn fraction(c: char) -> Option<f64> {
    Some(match c {
        '½' => 0.5,
        '¼' => 0.25,
        '¾' => 0.75,
        '⅓' => 1.0 / 3.0,
        '⅔' => 2.0 / 3.0,
        '⅕' => 0.2,
        '⅖' => 0.4,
        '⅗' => 0.6,
        '⅘' => 0.8,
        '⅙' => 1.0 / 6.0,
        '⅚' => 5.0 / 6.0,
        '⅛' => 0.125,
        '⅜' => 0.375,
        '⅝' => 0.625,
        '⅞' => 0.875,
        _ => return None,
    })
}

/// Characters of a text, and what stands at each of them.
#[derive(Clone, Copy)]
pub(super) struct Chars<'a>(pub(super) &'a [char]);

impl Chars<'_> {
    pub(super) fn at(&self, i: usize) -> Option<char> {
        self.0.get(i).copied()
    }

    pub(super) fn before(&self, i: usize) -> Option<char> {
        self.at(i.checked_sub(1)?)
    }

    pub(super) fn digit(&self, i: usize) -> bool {
        self.at(i).is_some_and(|c| c.is_ascii_digit())
    }

    /// Behind the spaces that begin at `i`; what is shown apart stands in another line.
    pub(super) fn skip_blanks(&self, mut i: usize) -> usize {
        while self.at(i) == Some(' ') {
            i += 1;
        }
        i
    }

    /// Whether this word begins at `i`.
    pub(super) fn has(&self, i: usize, word: &str) -> bool {
        word.chars().enumerate().all(|(k, c)| self.at(i + k).is_some_and(|x| x.eq_ignore_ascii_case(&c)))
    }

    /// Behind the digits that begin at `i`.
    pub(super) fn digits(&self, mut i: usize) -> usize {
        while self.digit(i) {
            i += 1;
        }
        i
    }

    pub(super) fn text(&self, from: usize, to: usize) -> String {
        self.0.get(from..to.min(self.0.len())).unwrap_or_default().iter().collect()
    }

    /// Behind a separator at `i` and exactly three digits.
    fn group(&self, i: usize, separator: char) -> Option<usize> {
        let end = self.digits(i + 1);
        (self.at(i) == Some(separator) && end == i + 4).then_some(end)
    }
}

/// Reads the number whose first digit, point or fraction stands at `from`.
pub(super) fn numeral(chars: Chars<'_>, from: usize, negative: bool) -> Numeral {
    let mut number = Digits::whole(chars, from);
    number.read_decimals(chars);
    number.read_fraction(chars);
    number.read_power(chars);
    number.read_factor(chars);
    number.finish(from, negative)
}

/// A number on its way: its digits, as far as they are read.
struct Digits {
    /// The digits before the first separator.
    first: String,
    /// All digits, with a point before the decimals.
    digits: String,
    decimals: usize,
    exponent: i32,
    /// The value of a fraction behind the digits: `2½`.
    fraction: Option<f64>,
    style: Style,
    /// Behind the last character that belongs to it.
    end: usize,
    doubts: Vec<f64>,
    unsure: Option<&'static str>,
    refused: Option<&'static str>,
}

impl Digits {
    /// The digits before a point, with groups of three.
    fn whole(chars: Chars<'_>, from: usize) -> Digits {
        let mut end = chars.digits(from);
        let first = chars.text(from, end);
        let mut digits = first.clone();
        let mut style = Style::default();
        let mut doubts = Vec::new();
        let groups = !first.is_empty() && first.len() <= 3 && !first.starts_with('0');
        for separator in [',', ' ', '\''] {
            if !groups || style.group.is_some() {
                break;
            }
            while let Some(stop) = chars.group(end, separator) {
                digits += &chars.text(end + 1, stop);
                end = stop;
                style.group = Some(separator);
            }
        }
        if style.group == Some(' ') {
            doubts.extend(first.parse::<f64>());
            doubts.extend(chars.text(end - 3, end).parse::<f64>());
        }
        Digits {
            first,
            digits,
            decimals: 0,
            exponent: 0,
            fraction: None,
            style,
            end,
            doubts,
            unsure: None,
            refused: None,
        }
    }

    /// The digits behind a point or a comma.
    fn read_decimals(&mut self, chars: Chars<'_>) {
        if chars.at(self.end) == Some('.') && chars.digit(self.end + 1) {
            self.read_behind_point(chars);
        } else if chars.at(self.end) == Some(',') && chars.digit(self.end + 1) {
            self.read_behind_comma(chars);
        } else if self.style.group == Some(',') && self.digits.len() == self.first.len() + 3 {
            // 1,500: thousands in English, decimals elsewhere.
            let decimals = self.digits.get(self.first.len()..).unwrap_or("");
            self.doubts.extend(format!("{}.{decimals}", self.first).parse::<f64>());
        }
    }

    fn read_behind_point(&mut self, chars: Chars<'_>) {
        let whole_end = self.end;
        self.end = chars.digits(whole_end + 1);
        let mut after = chars.text(whole_end + 1, self.end);
        // 0.000 833: decimals in groups of three.
        while after.len().is_multiple_of(3)
            && let Some(more) = chars.group(self.end, ' ')
        {
            self.doubts.extend(format!("{}.{after}", self.digits).parse::<f64>());
            after += &chars.text(self.end + 1, more);
            self.end = more;
        }
        self.decimals = after.len();
        self.digits = format!("{}.{after}", self.digits);
        if chars.at(self.end) == Some('.') && chars.digit(self.end + 1) {
            self.refused = Some("digits with several points");
        } else if chars.at(self.end) == Some(',') && chars.digit(self.end + 1) {
            self.refused = Some("digits with a comma after a point");
        }
    }

    /// No thousands: a decimal comma, or a list.
    fn read_behind_comma(&mut self, chars: Chars<'_>) {
        let stop = chars.digits(self.end + 1);
        let again = matches!(chars.at(stop), Some(',' | '.')) && chars.digit(stop + 1);
        if self.style.group.is_some() || again {
            self.refused = Some("digits with several commas");
        } else {
            let after = chars.text(self.end + 1, stop);
            self.decimals = after.len();
            if self.first != "0" {
                self.unsure = Some("its comma may separate decimals or two numbers");
            }
            self.digits = format!("{}.{after}", self.digits);
        }
        self.end = stop;
    }

    /// A fraction behind whole digits, or alone: `2½`, `½`.
    fn read_fraction(&mut self, chars: Chars<'_>) {
        let mark = if self.first.is_empty() { self.end } else { chars.skip_blanks(self.end) };
        if let Some(x) = chars.at(mark).and_then(fraction)
            && self.decimals == 0
            && self.style.group.is_none()
        {
            (self.fraction, self.end, self.decimals) = (Some(x), mark + 1, 2);
        }
    }

    /// A power of ten in figures.
    fn read_power(&mut self, chars: Chars<'_>) {
        if self.fraction.is_some() {
            return;
        }
        let Some((power, behind, times)) = power(chars, self.end, &self.digits) else { return };
        self.exponent = power;
        // A power of ten alone: 10^-3 is 1e-3.
        if behind > self.end && self.digits == "10" && chars.at(self.end) == Some('^') {
            self.digits = "1".into();
        }
        self.end = behind;
        self.style.times = times;
    }

    /// A power of ten in words.
    fn read_factor(&mut self, chars: Chars<'_>) {
        let Some((power, behind)) = factor(chars, self.end) else { return };
        if self.fraction.is_some() {
            self.refused = Some("a fraction of a word for a power of ten");
        } else {
            self.exponent += power;
            self.style.times = true;
        }
        self.doubts.clear();
        self.end = behind;
    }

    /// The number that begins at `start`.
    fn finish(mut self, start: usize, negative: bool) -> Numeral {
        let count = self.digits.bytes().filter(u8::is_ascii_digit).count();
        if count > MAX_DIGITS || self.exponent.abs() > MAX_EXPONENT {
            self.refused = Some("a number with more digits than a computation has");
            (self.exponent, self.decimals) = (0, 0);
        }
        let Digits { exponent, decimals, end, unsure, refused, mut doubts, .. } = self;
        let sign = if negative { -1.0 } else { 1.0 };
        let digits = if self.digits.is_empty() { "0" } else { &self.digits };
        let extra = self.fraction.unwrap_or(0.0);
        let value = sign * (format!("{digits}e{exponent}").parse::<f64>().unwrap_or(f64::NAN) + extra);
        let half_unit = 0.5 * ten(exponent.saturating_sub(decimals as i32));
        doubts.iter_mut().for_each(|x| *x *= sign);
        let form = if self.fraction.is_some() { Form::Fraction } else { Form::Plain(self.style) };
        let quoted = Quoted { value, half_unit, decimals, exponent, form };
        Numeral { quoted, start, end, doubts, unsure, refused }
    }
}

/// The power of ten that follows at `at`, where it ends, and whether it is written out (`×10^3`).
fn power(chars: Chars<'_>, at: usize, digits: &str) -> Option<(i32, usize, bool)> {
    let signed = |i: usize| -> Option<(i32, usize)> {
        let negative = matches!(chars.at(i), Some('-' | '–'));
        let from = i + usize::from(negative || chars.at(i) == Some('+'));
        let end = chars.digits(from);
        let n: i32 = chars.text(from, end).parse().ok().filter(|_| end > from && end - from < 9)?;
        Some((if negative { -n } else { n }, end))
    };
    // `0.5e3`, and `0.5 e3`
    let letter = if chars.at(at) == Some(' ') { at + 1 } else { at };
    if matches!(chars.at(letter), Some('e' | 'E'))
        && let Some((n, end)) = signed(letter + 1)
        && !chars.at(end).is_some_and(char::is_alphanumeric)
    {
        return Some((n, end, false));
    }
    // The base, with its sign of multiplication unless it is all there is.
    let mark = chars.skip_blanks(at);
    let base = if digits == "10" && chars.at(at) == Some('^') {
        at
    } else {
        let from = chars.skip_blanks(mark + 1);
        let times = matches!(chars.at(mark), Some('×' | '·' | '*' | 'x' | 'X'));
        if !(times && chars.has(from, "10")) {
            return None;
        }
        from + 2
    };
    let raised = if chars.has(base, "**") { base + 2 } else { base + 1 };
    if raised == base + 1 && chars.at(base) != Some('^') {
        return None;
    }
    let (n, end) = signed(raised)?;
    Some((n, end, true))
}

/// Words for powers of ten.
const FACTORS: [(&str, i32); 25] = [
    ("hundred", 2),
    ("thousand", 3),
    ("million", 6),
    ("millions", 6),
    ("billion", 9),
    ("trillion", 12),
    ("hundert", 2),
    ("tausend", 3),
    ("Millionen", 6),
    ("Milliarden", 9),
    ("mille", 3),
    ("milliards", 9),
    ("mil", 3),
    ("hundredths", -2),
    ("thousandths", -3),
    ("millionths", -6),
    ("hundredth", -2),
    ("thousandth", -3),
    ("millionth", -6),
    ("万", 4),
    ("萬", 4),
    ("億", 8),
    ("亿", 8),
    ("百万", 6),
    ("千万", 7),
];

/// The words for powers of ten that follow at `at`, and where they end: `0.5 thousand`, `2 hundred million`, `3万`.
fn factor(chars: Chars<'_>, at: usize) -> Option<(i32, usize)> {
    let (mut power, mut end) = (0, at);
    for _ in 0..3 {
        let from = chars.skip_blanks(end);
        let found = FACTORS.iter().find_map(|(word, n)| {
            let stop = from + word.chars().count();
            let wide = word.chars().all(is_wide);
            let whole = wide || from > end && !chars.at(stop).is_some_and(char::is_alphanumeric);
            (chars.has(from, word) && whole).then_some((*n, stop))
        });
        let Some((n, stop)) = found else { break };
        (power, end) = (power + n, stop);
    }
    (end > at).then_some((power, end))
}

/// All numbers of a text, each with its first digit. Digits of words, indexes and exponents (`H2O`, `x_1`, `L^2`, `3D`, `2nd`) are none.
pub(super) fn numbers(chars: Chars<'_>) -> Vec<(Numeral, usize)> {
    let mut all: Vec<(Numeral, usize)> = Vec::new();
    let mut i = 0;
    while let Some(c) = chars.at(i) {
        let point = c == '.' && chars.digit(i + 1) && chars.before(i) != Some('.');
        if !(c.is_ascii_digit() || point || fraction(c).is_some()) {
            i += 1;
            continue;
        }
        let sign = chars.before(i).filter(|c| matches!(c, '-' | '–' | '+'));
        let word = |c: char| c.is_alphabetic() && !is_wide(c) || matches!(c, '_' | '^' | '#');
        let front = i - usize::from(sign.is_some());
        if chars.before(front).is_some_and(word) {
            let part = |c: char| c.is_alphanumeric() && !is_wide(c) || matches!(c, '_' | '^' | '.');
            while chars.at(i).is_some_and(part) {
                i += 1;
            }
            continue;
        }
        let adjacent = chars.before(front).is_some_and(|c| c.is_ascii_digit() || c == ')');
        let mut negative = matches!(sign, Some('-' | '–')) && !adjacent;
        let mut start = if adjacent { i } else { front };
        // `= - 0.5`, `-\,0.5`
        if sign.is_none() && chars.before(i) == Some(' ') && matches!(chars.before(i - 1), Some('-' | '–'))
        {
            let edge = i.saturating_sub(2);
            let opens = |c: char| matches!(c, '=' | '≈' | '(' | ':' | '\n');
            let before = (0..edge).rev().find_map(|k| chars.at(k).filter(|c| *c != ' '));
            if before.is_none_or(opens) {
                (negative, start) = (true, edge);
            }
        }
        let mut found = numeral(chars, i, negative);
        found.start = start;
        let next = found.end.max(i + 1);
        if !is_word(chars, &found, i) {
            all.push((found, i));
        }
        i = next;
    }
    all
}

/// `2nd`, `3D`: digits that count and do not measure.
fn is_word(chars: Chars<'_>, number: &Numeral, first_digit: usize) -> bool {
    let whole = (first_digit..number.end).all(|i| chars.digit(i));
    let letters: String =
        (number.end..).map_while(|i| chars.at(i)).take_while(|c| c.is_alphabetic()).take(3).collect();
    whole && matches!(letters.as_str(), "st" | "nd" | "rd" | "th" | "D")
}
