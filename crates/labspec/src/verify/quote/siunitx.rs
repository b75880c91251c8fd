//! Numbers with units as LaTeX's `siunitx` writes them: `\SI{0.5}{\metre\per\second}` is shown as `0.5 m/s`.

/// Commands that take a number, a unit, or both, and how many arguments that is.
const COMMANDS: [(&str, usize); 9] = [
    ("SI", 2),
    ("qty", 2),
    ("num", 1),
    ("si", 1),
    ("unit", 1),
    ("ang", 1),
    ("SIrange", 3),
    ("qtyrange", 3),
    ("numrange", 2),
];

/// What a page shows of the command that `text` begins with (at its backslash), and its length.
pub(super) fn command(text: &str) -> Option<(String, usize)> {
    let name: String = text.chars().skip(1).take_while(char::is_ascii_alphabetic).collect();
    let (_, count) = COMMANDS.iter().find(|(command, _)| *command == name)?;
    let mut at = 1 + name.len();
    // Options, in brackets.
    if let Some(inside) = text.get(at..)?.strip_prefix('[') {
        at += inside.find(']')? + 2;
    }
    let mut arguments = Vec::new();
    for _ in 0..*count {
        let (argument, end) = group(text, at)?;
        arguments.push(argument);
        at = end;
    }
    let text = match (name.as_str(), arguments.as_slice()) {
        ("SI" | "qty", [number, unit]) => format!("{} {}", plain(number)?, units(unit)?),
        ("num", [number]) => plain(number)?,
        ("si" | "unit", [unit]) => units(unit)?,
        ("ang", [number]) => format!("{}°", plain(number)?),
        ("SIrange" | "qtyrange", [a, b, unit]) => format!("{} to {} {}", plain(a)?, plain(b)?, units(unit)?),
        ("numrange", [a, b]) => format!("{} to {}", plain(a)?, plain(b)?),
        _ => return None,
    };
    Some((text, at))
}

/// Longest argument, in bytes.
const LONG: usize = 80;

/// What stands between the braces that begin at a byte, and where it goes on.
fn group(text: &str, at: usize) -> Option<(&str, usize)> {
    let inside = text.get(at..)?.strip_prefix('{')?;
    let mut depth = 1;
    for (i, c) in inside.char_indices().take_while(|(i, _)| *i <= LONG) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some((inside.get(..i)?, at + 1 + i + 1));
        }
    }
    None
}

/// A number: `1.5e-3`, `-0.5`, `0.44 \pm 0.01`; `None` where it is none.
fn plain(number: &str) -> Option<String> {
    let text = number.replace("\\pm", "±").replace("+-", "±").replace(' ', "").replace("\\,", "");
    let text = text.replace(['−', '–'], "-");
    let is_number_char =
        |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+' | '±' | 'e' | 'E' | '(' | ')');
    (!text.is_empty() && text.chars().all(is_number_char)).then_some(text)
}

/// Macros of units, with their symbols; prefixes end without one.
const UNITS: [(&str, &str); 34] = [
    ("metre", "m"),
    ("meter", "m"),
    ("second", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("day", "day"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("kelvin", "K"),
    ("ampere", "A"),
    ("newton", "N"),
    ("joule", "J"),
    ("watt", "W"),
    ("pascal", "Pa"),
    ("hertz", "Hz"),
    ("volt", "V"),
    ("tesla", "T"),
    ("coulomb", "C"),
    ("litre", "L"),
    ("liter", "L"),
    ("radian", "rad"),
    ("degree", "°"),
    ("percent", "%"),
    ("celsius", "°C"),
    ("kg", "kg"),
    ("g", "g"),
    ("m", "m"),
    ("cm", "cm"),
    ("mm", "mm"),
    ("km", "km"),
    ("s", "s"),
    ("ms", "ms"),
    ("N", "N"),
    ("Hz", "Hz"),
];

const PREFIXES: [(&str, &str); 9] = [
    ("pico", "p"),
    ("nano", "n"),
    ("micro", "μ"),
    ("milli", "m"),
    ("centi", "c"),
    ("deci", "d"),
    ("kilo", "k"),
    ("mega", "M"),
    ("giga", "G"),
];

/// A unit in letters or in macros: `m/s`, `m.s^{-1}`, `\metre\per\second\squared`. What is not known is `None`.
fn units(text: &str) -> Option<String> {
    let mut out = String::new();
    // A factor stands before: another one needs a point.
    let (mut after, mut raise, mut below) = (false, "", false);
    let mut at = 0;
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let Some(name) = rest.strip_prefix('\\') else {
            let c = rest.chars().next()?;
            match c {
                '.' | '~' | '·' => out.push('·'),
                '{' | '}' => {}
                c => out.push(c),
            }
            after = false;
            at += c.len_utf8();
            continue;
        };
        let name: String = name.chars().take_while(char::is_ascii_alphabetic).collect();
        at += 1 + name.len();
        match name.as_str() {
            "per" => below = true,
            "squared" => out.push_str("^2"),
            "cubed" => out.push_str("^3"),
            "square" => raise = "^2",
            "cubic" => raise = "^3",
            "cdot" => after = true,
            _ => {
                if let Some((_, sign)) = PREFIXES.iter().find(|(prefix, _)| *prefix == name) {
                    join(&mut out, std::mem::take(&mut after), std::mem::take(&mut below));
                    out.push_str(sign);
                    continue;
                }
                let (_, sign) = UNITS.iter().find(|(unit, _)| *unit == name)?;
                join(&mut out, after, std::mem::take(&mut below));
                out.push_str(sign);
                out.push_str(std::mem::take(&mut raise));
                after = true;
            }
        }
    }
    (!out.is_empty()).then_some(out)
}

fn join(out: &mut String, after: bool, below: bool) {
    if below {
        out.push_str(if out.is_empty() { "1/" } else { "/" });
    } else if after {
        out.push('·');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_shown_as_a_page_shows_them() {
        let of = |text: &str| {
            command(text).map(|(shown, length)| (shown, text.get(length..).unwrap_or("").to_string()))
        };
        for (text, shown) in [
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
            assert_eq!(of(&format!("{text} x")), Some((shown.to_string(), " x".to_string())), "{text}");
        }
        for text in
            ["\\SI{0.5", "\\SI{0.5}", "\\SI{x}{s}", "\\SI{0.5}{\\furlong}", "\\num{}", "\\sin{2}", "\\"]
        {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
