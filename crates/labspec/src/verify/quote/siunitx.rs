//! Numbers with units in the notation of LaTeX's `siunitx`: `\SI{0.5}{\metre\per\second}` is rendered as `0.5 m/s`.

use crate::markdown::tex;
use nom::bytes::complete::take_while_m_n;
use nom::character::complete::char;
use nom::combinator::{fail, map, map_opt, opt};
use nom::sequence::delimited;
use nom::{IResult, Parser};

/// Maximum length of an argument, in bytes.
const MAX_ARGUMENT_LENGTH: usize = 80;

/// The rendered text of the command at the beginning of a text.
pub(super) fn quantity(text: &str) -> IResult<&str, String> {
    let (rest, name) = tex::command(text)?;
    let options = delimited(char('['), take_while_m_n(0, MAX_ARGUMENT_LENGTH, |c| c != ']'), char(']'));
    let (rest, _) = opt(options).parse(rest)?;
    let argument = |text| tex::group(text, MAX_ARGUMENT_LENGTH);
    let number = || map_opt(argument, number);
    let unit = || map_opt(argument, unit);
    match name {
        "SI" | "qty" => map((number(), unit()), |(n, unit)| format!("{n} {unit}")).parse(rest),
        "num" => number().parse(rest),
        "si" | "unit" => unit().parse(rest),
        "ang" => map(number(), |n| format!("{n}°")).parse(rest),
        "SIrange" | "qtyrange" => {
            map((number(), number(), unit()), |(a, b, unit)| format!("{a} to {b} {unit}")).parse(rest)
        }
        "numrange" => map((number(), number()), |(a, b)| format!("{a} to {b}")).parse(rest),
        _ => fail().parse(text),
    }
}

/// A number: `1.5e-3`, `-0.5`, `0.44 \pm 0.01`; `None` for other texts.
fn number(number: &str) -> Option<String> {
    let text = number.replace("\\pm", "±").replace("+-", "±").replace(' ', "").replace("\\,", "");
    let text = text.replace(['−', '–'], "-");
    let is_number_char =
        |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+' | '±' | 'e' | 'E' | '(' | ')');
    (!text.is_empty() && text.chars().all(is_number_char)).then_some(text)
}

/// Macros of units with their symbols, and those of prefixes.
const UNITS: &str = "metre=m meter=m second=s minute=min hour=h day=day gram=g kilogram=kg kelvin=K ampere=A newton=N joule=J \
    watt=W pascal=Pa hertz=Hz volt=V tesla=T coulomb=C litre=L liter=L radian=rad degree=° percent=% celsius=°C kg=kg g=g \
    m=m cm=cm mm=mm km=km s=s ms=ms N=N Hz=Hz";
const PREFIXES: &str = "pico=p nano=n micro=μ milli=m centi=c deci=d kilo=k mega=M giga=G";

/// The symbol of a macro.
fn symbol(table: &'static str, name: &str) -> Option<&'static str> {
    let mut pairs = table.split(' ').filter_map(|pair| pair.split_once('='));
    pairs.find(|(word, _)| *word == name).map(|(_, symbol)| symbol)
}

/// A unit in letters or in macros: `m/s`, `m.s^{-1}`, `\metre\per\second\squared`. `None` for an unknown macro.
fn unit(text: &str) -> Option<String> {
    let mut out = String::new();
    // The separator before the next macro of a unit, and the power after it.
    let (mut joint, mut power, mut rest) = ("", "", text);
    while let Some(c) = rest.chars().next() {
        let Ok((tail, name)) = tex::command(rest) else {
            match c {
                '.' | '~' | '·' => out.push('·'),
                '{' | '}' => {}
                c => out.push(c),
            }
            // After letters, another factor needs no separator.
            joint = if joint == "·" { "" } else { joint };
            rest = rest.get(c.len_utf8()..)?;
            continue;
        };
        rest = tail;
        match name {
            "per" => joint = if out.is_empty() { "1/" } else { "/" },
            "squared" => out += "^2",
            "cubed" => out += "^3",
            "square" => power = "^2",
            "cubic" => power = "^3",
            "cdot" => joint = "·",
            name => {
                out += std::mem::take(&mut joint);
                if let Some(prefix) = symbol(PREFIXES, name) {
                    out += prefix;
                } else {
                    out += symbol(UNITS, name)?;
                    out += std::mem::take(&mut power);
                    joint = "·";
                }
            }
        }
    }
    (!out.is_empty()).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_rendered_as_on_a_page() {
        for (text, expected) in [
            ("\\SI{0.5}{s}", "0.5 s"),
            ("\\SI{0.5}{\\second}", "0.5 s"),
            ("\\qty{-0.5}{\\milli\\second}", "-0.5 ms"),
            ("\\qty[mode=text]{9.81}{\\metre\\per\\second\\squared}", "9.81 m/s^2"),
            ("\\SI{3}{\\newton\\metre}", "3 N·m"),
            ("\\SI{3}{m.s^{-1}}", "3 m·s^-1"),
            ("\\SI{3}{\\per\\second}", "3 1/s"),
            ("\\num{1.5e-3}", "1.5e-3"),
            ("\\si{\\kilo\\gram}", "kg"),
            ("\\ang{30}", "30°"),
            ("\\SIrange{0.4}{0.5}{s}", "0.4 to 0.5 s"),
        ] {
            assert_eq!(quantity(&format!("{text} x")), Ok((" x", expected.to_string())), "{text}");
        }
        for text in
            ["\\SI{0.5", "\\SI{0.5}", "\\SI{x}{s}", "\\SI{0.5}{\\furlong}", "\\num{}", "\\sin{2}", "\\"]
        {
            assert!(quantity(text).is_err(), "{text}");
        }
    }
}
