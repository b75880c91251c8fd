//! Text for pictures: escaping of untrusted labels, and widths.
//!
//! The renderer chooses the font, so widths are estimated from the classes of glyphs in common sans-serif fonts. They are
//! rather too large, because a slightly larger margin looks better than a truncated label.

/// The maximum number of characters of a label. Longer ones are truncated, because no picture has space for more.
const LONGEST: usize = 160;

/// A label on one line, without characters that XML forbids or that change the direction of the surrounding text.
pub(super) fn clean_label(label: &str) -> String {
    let mut text: String = label.chars().take(LONGEST).map(printable_character).collect();
    if label.chars().nth(LONGEST).is_some() {
        text.push('…');
    }
    text.trim().to_owned()
}

fn printable_character(c: char) -> char {
    match c {
        '\t' | '\n' | '\r' | '\u{2028}' | '\u{2029}' => ' ',
        '\u{61c}'
        | '\u{200e}'
        | '\u{200f}'
        | '\u{202a}'..='\u{202e}'
        | '\u{2066}'..='\u{2069}'
        | '\u{fffe}'
        | '\u{ffff}' => '\u{fffd}',
        c if c.is_control() => '\u{fffd}',
        c => c,
    }
}

/// Escapes the characters that have a meaning in XML.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// The estimated width in pixels for a font size in pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size
}

/// The estimated width of a glyph in units of the font size.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 0.31,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' | '/' => 0.40,
        'm' | 'w' | 'M' | 'W' | '@' | '%' | '+' | '=' | '<' | '>' | '−' | '×' => 0.88,
        'A'..='Z' => 0.70,
        '\u{1100}'..='\u{11ff}' | '\u{2e80}'..='\u{d7ff}' | '\u{f900}'..='\u{faff}' => 1.0,
        '\u{ff00}'..='\u{ff60}' | '\u{1f000}'..='\u{3ffff}' => 1.1,
        _ => 0.61,
    }
}

/// The text, truncated with an ellipsis if it is wider than `limit` pixels. Empty if not even one character fits.
pub(super) fn fit(text: &str, size: f64, limit: f64) -> String {
    if width(text, size) <= limit {
        return text.to_owned();
    }
    let mut cut = String::new();
    let mut used = width("…", size);
    for c in text.chars() {
        used += advance(c) * size;
        if used > limit {
            break;
        }
        cut.push(c);
    }
    let cut = cut.trim_end();
    if cut.is_empty() { String::new() } else { format!("{cut}…") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_labels_become_text() {
        assert_eq!(
            escape(&clean_label("<b a='1' b=\"2\">&\u{0}\n</b>")),
            "&lt;b a=&#39;1&#39; b=&quot;2&quot;&gt;&amp;\u{fffd} &lt;/b&gt;"
        );
        for turns in ['\u{61c}', '\u{200e}', '\u{200f}', '\u{202a}', '\u{202e}', '\u{2066}', '\u{2069}'] {
            assert_eq!(clean_label(&format!("a{turns}b")), "a\u{fffd}b");
        }
        assert_eq!(clean_label(&"x".repeat(1_000_000)).chars().count(), LONGEST + 1);
    }

    #[test]
    fn long_text_is_truncated_to_its_width() {
        assert_eq!(fit("energy", 12.0, 100.0), "energy");
        let cut = fit("kinetic energy of the heavy ball", 12.0, 100.0);
        assert_eq!(cut, "kinetic energy…");
        assert!(width(&cut, 12.0) <= 100.0);
        assert_eq!(fit("energy", 12.0, 3.0), "");
    }
}
