//! Units: what their names mean, and how a dimension is written.

pub use crate::unit_table::PREFIXES;
use crate::unit_table::{A, K, KG, M, S, is_other, symbol};
use labspec_expr::dimension::{ANGLE, BASES, Dimension};
use std::f64::consts::PI;

/// The base units, by their places in a [`Dimension`]; the order in which they are written is another.
const NAMES: [&str; BASES] = ["rad", "kg", "m", "s", "K", "A"];
const WRITTEN: [usize; BASES] = [KG, M, S, K, A, ANGLE];

/// A unit expression at the beginning of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitText {
    /// Its length in bytes.
    pub length: usize,
    /// What it means; `None` where it is a unit of something else (`dB`), or can be read in two ways (`N m/rad s`).
    pub dimension: Option<Dimension>,
}

/// What a unit means: `m/s^2`, `N m s/rad`, `kg·m²`, `1/(kg m^2)`, `m s⁻¹`; `None` for what is no unit.
pub fn parse(text: &str) -> Option<Dimension> {
    let text = text.trim();
    let found = read(text)?;
    found.dimension.filter(|_| found.length == text.len())
}

/// Whether a text is a unit as a whole, of ours or of something else.
pub fn is_unit(text: &str) -> bool {
    read(text).is_some_and(|found| found.length == text.len())
}

/// Reads the longest unit expression that a text begins with.
///
/// ```text
/// unit   = factor { [ "/" | "per" | "·" | "*" | "×" | " " | "" ] factor }
/// factor = ( symbol | name | "%" | "1" | "(" unit ")" ) [ power ]
/// power  = [ "^" | "**" ] integer | raised digits | "squared" | "cubed"
/// ```
pub fn read(text: &str) -> Option<UnitText> {
    let mut reader = UnitReader { text, at: 0, depth: 0 };
    let first = reader.product()?;
    // A `1` alone is a number; before a stroke it is a part of a unit.
    let consumed = text.get(..reader.at)?;
    (consumed != "1" || consumed.len() == text.len())
        .then_some(UnitText { length: reader.at, dimension: first.dimension() })
}

/// What was read so far.
#[derive(Clone, Copy)]
enum UnitPart {
    Known(Dimension),
    /// A unit that is none of ours, or one that may be read in two ways.
    Other,
}

impl UnitPart {
    fn dimension(self) -> Option<Dimension> {
        match self {
            UnitPart::Known(dimension) => Some(dimension),
            UnitPart::Other => None,
        }
    }

    fn with(self, other: UnitPart, power: f64) -> UnitPart {
        match (self, other) {
            (UnitPart::Known(a), UnitPart::Known(b)) => {
                b.power(power).and_then(|b| a.product(b)).map_or(UnitPart::Other, UnitPart::Known)
            }
            _ => UnitPart::Other,
        }
    }
}

struct UnitReader<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
}

/// Brackets within brackets, factors of one unit, and bytes of a word.
const DEEP: usize = 4;
const MANY: usize = 8;
const WORD: usize = 40;

impl<'t> UnitReader<'t> {
    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or("")
    }

    fn product(&mut self) -> Option<UnitPart> {
        let mut all = self.factor()?;
        let mut divided = false;
        for _ in 1..MANY {
            let was = self.at;
            let (link, sign) = self.link();
            self.at += link;
            let Some(next) = self.factor() else {
                self.at = was;
                break;
            };
            all = match sign {
                '/' => all.with(next, -1.0),
                // What stands behind a stroke is one unit, or in brackets, or every one has a stroke of its own.
                ' ' if divided => UnitPart::Other,
                _ if divided => UnitPart::Other,
                _ => all.with(next, 1.0),
            };
            divided |= sign == '/';
        }
        Some(all)
    }

    /// How two factors are joined: the length of what stands between them, and `/` or a space.
    fn link(&self) -> (usize, char) {
        let rest = self.rest();
        let trimmed = rest.trim_start_matches(' ');
        let space = rest.len() - trimmed.len();
        if space > 1 {
            return (0, ' ');
        }
        let spaced = |length: usize| {
            let tail = trimmed.get(length..).unwrap_or("");
            space + length + (tail.len() - tail.trim_start_matches(' ').len())
        };
        let per = ["per ", "pro ", "par ", "por "].iter().find(|w| space > 0 && trimmed.starts_with(**w));
        if let Some(per) = per {
            return (space + per.len(), '/');
        }
        match trimmed.chars().next() {
            Some(c @ ('/' | '⁄' | '÷' | '∕' | '每' | '毎')) => (spaced(c.len_utf8()), '/'),
            Some(c @ ('·' | '⋅' | '*' | '×' | '∙' | '•')) => (spaced(c.len_utf8()), ' '),
            // `m.s^-1`: a point parts factors where the next one has a power.
            Some('.') if space == 0 && dotted(trimmed.get(1..).unwrap_or("")) => (1, ' '),
            _ => (space, ' '),
        }
    }

    fn factor(&mut self) -> Option<UnitPart> {
        let rest = self.rest();
        let c = rest.chars().next()?;
        let found = match c {
            '(' if self.depth < DEEP => {
                let was = self.at;
                self.at += 1;
                self.depth += 1;
                let inner = self.product();
                self.depth -= 1;
                let Some(inner) = inner.filter(|_| self.rest().starts_with(')')) else {
                    self.at = was;
                    return None;
                };
                self.at += 1;
                inner
            }
            '%' | '‰' => {
                self.at += c.len_utf8();
                UnitPart::Known(Dimension::NUMBER.times(if c == '%' { 100.0 } else { 1000.0 }))
            }
            '1' => {
                let next = rest.get(1..).unwrap_or("").trim_start_matches(' ');
                // Of `1/s` a part; in `m 1` it is a number.
                if !(next.starts_with('/') || rest.len() == 1) || self.at > 0 && self.depth == 0 {
                    return None;
                }
                self.at += 1;
                UnitPart::Known(Dimension::NUMBER)
            }
            _ => self.word()?,
        };
        Some(match self.power() {
            Some(power) => UnitPart::Known(Dimension::NUMBER).with(found, power),
            None => found,
        })
    }

    /// A symbol or a name: letters up to the next character that is none.
    fn word(&mut self) -> Option<UnitPart> {
        let rest = self.rest();
        let wide = rest.chars().next().is_some_and(is_wide);
        let letter = |c: &char| {
            c.is_alphabetic() && is_wide(*c) == wide && !raised(*c) || matches!(c, '°' | 'µ' | '℃' | '℉')
        };
        let mut ends: Vec<usize> = rest
            .chars()
            .take_while(letter)
            .scan(0, |at, c| {
                *at += c.len_utf8();
                Some(*at)
            })
            .take(WORD)
            .collect();
        // `square metre`
        for (square, power) in [("square ", 2.0), ("cubic ", 3.0)] {
            if let Some(tail) = rest.strip_prefix(square) {
                let length = tail.chars().take_while(char::is_ascii_alphabetic).count();
                let found = tail.get(..length).and_then(symbol)?;
                self.at += square.len() + length;
                return Some(UnitPart::Known(Dimension::NUMBER).with(UnitPart::Known(found), power));
            }
        }
        // Where words are not parted by spaces, the longest beginning that is a unit; `°C` and `°/s` else.
        if !wide {
            let last = ends.pop()?;
            ends = vec![last];
        }
        ends.into_iter().rev().find_map(|end| {
            let text = rest.get(..end)?;
            let found = if is_other(text) {
                UnitPart::Other
            } else {
                UnitPart::Known(symbol(&text.replace('µ', "μ"))?)
            };
            self.at += end;
            Some(found)
        })
    }

    /// The power behind a symbol.
    fn power(&mut self) -> Option<f64> {
        let rest = self.rest();
        for (word, power) in [(" squared", 2.0), (" cubed", 3.0), ("平方", 2.0)] {
            if rest.strip_prefix(word).is_some_and(|tail| !tail.starts_with(char::is_alphanumeric)) {
                self.at += word.len();
                return Some(power);
            }
        }
        let marked = rest.strip_prefix("**").or_else(|| rest.strip_prefix('^'));
        let mut plain = String::new();
        let body = marked.unwrap_or(rest);
        let open = marked.is_some() && body.starts_with(['(', '{']);
        let body = if open { body.get(1..)? } else { body };
        let mut used = 0;
        for c in body.chars() {
            let digit = RAISED.chars().position(|r| r == c).and_then(|n| char::from_digit(n as u32, 10));
            match (digit, c) {
                (Some(d), _) => plain.push(d),
                (None, '⁻' | '-' | '−' | '–') if plain.is_empty() => plain.push('-'),
                (None, '⁺' | '+') if plain.is_empty() && (marked.is_some() || c == '⁺') => {}
                (None, '0'..='9') => plain.push(c),
                _ => break,
            }
            used += c.len_utf8();
        }
        let tail = body.get(used..)?;
        let close = usize::from(open && tail.starts_with([')', '}']));
        let digits = plain.trim_start_matches('-');
        let decimal =
            tail.strip_prefix(['.', ',']).is_some_and(|t| t.starts_with(|c: char| c.is_ascii_digit()));
        // `s-1` is a power, `s-0.5 s` and `s-12` are none.
        let bare = marked.is_none()
            && rest.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '−' | '–'));
        if digits.is_empty() || decimal || open && close == 0 || bare && !bare_power(digits, tail) {
            return None;
        }
        let power = plain.parse::<i8>().ok()?;
        self.at += rest.len() - tail.len() + close;
        Some(f64::from(power))
    }
}

/// Whether a factor with a power begins here: of `m.s^-1` the second.
fn dotted(text: &str) -> bool {
    let letters =
        text.chars().take_while(|c| c.is_alphabetic() && !raised(*c)).map(char::len_utf8).sum::<usize>();
    letters > 0
        && text.get(..letters).and_then(symbol).is_some()
        && text
            .get(letters..)
            .is_some_and(|t| t.starts_with(|c: char| c == '^' || c == '-' || raised(c) || c.is_ascii_digit()))
}

/// Whether digits behind a symbol without a sign for it are its power: one from 1 to 6, and no number that goes on.
fn bare_power(digits: &str, tail: &str) -> bool {
    let goes_on = tail.starts_with(|c: char| c.is_alphanumeric() && !is_wide(c))
        || tail.strip_prefix(' ').and_then(read).is_some();
    matches!(digits, "1" | "2" | "3" | "4" | "5" | "6") && !goes_on
}

const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";

fn raised(c: char) -> bool {
    RAISED.contains(c) || matches!(c, '⁻' | '⁺')
}

/// Letters of scripts that write words without spaces between them.
pub fn is_wide(c: char) -> bool {
    matches!(c, '\u{3005}'..='\u{30ff}' | '\u{3400}'..='\u{9fff}' | '\u{f900}'..='\u{faff}' | '\u{ff66}'..='\u{ff9f}')
}

/// Units that are written for the powers that they stand for.
const USUAL: [&str; 9] = ["N", "N m", "N/m", "N s/m", "W", "Pa", "N s", "1/s", "m"];

/// How a dimension is written: `mm/s`, `N m`, `deg`; a plain number is `1`. What a factor does that is no power of ten is said in
/// words.
pub fn written(dimension: &Dimension) -> String {
    let usual = USUAL
        .iter()
        .find(|u| parse(u).is_some_and(|d| d.agrees(dimension) && d.has_angle() == dimension.has_angle()));
    let base = usual.map_or_else(|| from_bases(dimension), |u| u.to_string());
    let factor = dimension.factor.abs();
    let near = |x: f64| (factor / x - 1.0).abs() < 1e-3;
    if factor.is_nan() {
        return format!("{base}, times a number");
    }
    if near(1.0) {
        return base;
    }
    if near(180.0 / PI) && base.contains("rad") {
        return base.replacen("rad", "deg", 1);
    }
    let prefix = PREFIXES.iter().find(|(p, n)| near(10f64.powi(-n)) && *p != "u");
    let plain = !base.starts_with("1") && !base.starts_with("kg") && !base.contains('^');
    match prefix.filter(|_| plain || base.starts_with("m/s") || base.starts_with("rad/s")) {
        Some((prefix, _)) => format!("{prefix}{base}"),
        None => format!("{base}, times {}", shortest(dimension.factor)),
    }
}

/// A factor in few digits.
fn shortest(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "0" || text == "-0" { format!("{x:e}") } else { text.to_string() }
}

fn from_bases(dimension: &Dimension) -> String {
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for base in WRITTEN {
        let name = NAMES[base];
        match dimension.whole_power(base) {
            Some(0) => {}
            Some(1) => above.push(name.to_string()),
            Some(-1) => below.push(name.to_string()),
            Some(n) if n > 0 => above.push(format!("{name}^{n}")),
            Some(n) => below.push(format!("{name}^{}", -n)),
            None => above.push(format!("a root of {name}")),
        }
    }
    let above = if above.is_empty() { "1".to_string() } else { above.join(" ") };
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        _ => format!("{above}/({})", below.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_and_written() {
        for (text, shown) in [
            ("m", "m"),
            ("mm", "mm"),
            ("mm/s", "mm/s"),
            ("m/s^2", "m/s^2"),
            ("m/s²", "m/s^2"),
            ("m s⁻¹", "m/s"),
            ("kg m/s", "N s"),
            ("kg m²/s²", "N m"),
            ("J", "N m"),
            ("mN", "mN"),
            ("N·m", "N m"),
            ("N m s/rad", "kg m^2/(s rad)"),
            ("rad/s", "rad/s"),
            ("deg", "deg"),
            ("°/s", "deg/s"),
            ("mrad", "mrad"),
            ("1/(kg m^2)", "1/(kg m^2)"),
            ("1/kg", "1/kg"),
            ("Hz", "1/s"),
            ("%", "1, times 100"),
            ("g", "kg, times 1000"),
            ("cm^2", "m^2, times 10000"),
            ("kN", "kN"),
            ("s-1", "1/s"),
            ("m per second squared", "m/s^2"),
            ("metres per second", "m/s"),
            ("Kilometer", "km"),
            ("millim", "mm"),
            ("KiloN", "kN"),
            ("毫秒", "ms"),
            ("米/秒", "m/s"),
            ("キログラム", "kg"),
            ("ミリメートル", "mm"),
            ("千克", "kg"),
            ("rpm", "rad/s, times 9.549"),
        ] {
            let d = parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(written(&d), shown, "{text}");
        }
        for text in [
            "",
            "ramp and block",
            "qvel[3]",
            "N m/rad s",
            "m//s",
            "x",
            "m^",
            "m^x",
            "1/",
            "mmin",
            "degree or m",
            "dB",
            "s-12",
            "m.",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    #[test]
    fn the_longest_unit_is_read() {
        let of = |text: &str| read(text).map(|u| (u.length, u.dimension.map(|d| written(&d))));
        let symbol = |length, unit: &str| Some((length, Some(unit.to_string())));
        assert_eq!(of("s, and"), symbol(1, "s"));
        assert_eq!(of("N m at"), symbol(3, "N m"));
        assert_eq!(of("s / m high"), symbol(5, "s/m"));
        assert_eq!(of("s per m"), symbol(7, "s/m"));
        assert_eq!(of("s m"), symbol(3, "m s"));
        assert_eq!(of("s-1."), symbol(3, "1/s"));
        assert_eq!(of("s-0.5 s"), symbol(1, "s"));
        assert_eq!(of("s 2 m"), symbol(1, "s"));
        assert_eq!(of("秒的时间"), symbol(3, "s"));
        assert_eq!(of("千克"), symbol(6, "kg"));
        assert_eq!(of("°C"), Some((3, None)));
        assert_eq!(of("N m/rad s"), Some((9, None)));
        assert_eq!(of("balls"), None);
    }
}
