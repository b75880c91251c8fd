//! The words and numbers of a rendered text: the common words of two texts, and the last number of a sentence.

use crate::markdown::html::{HtmlToken, tokens};
use std::ops::Range;

/// A text of HTML without its tags, entities and repeated spaces.
pub(super) fn plain(html: &str) -> String {
    let mut out = String::new();
    for token in tokens(html) {
        match token {
            HtmlToken::Text(span) => out.push_str(html.get(span).unwrap_or("")),
            HtmlToken::Decoded(text, _) => out.push_str(&text),
            HtmlToken::Tag(_) => out.push(' '),
        }
    }
    out.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A text without capitals, punctuation and articles. Code and formulas are kept: in them, every character counts, except a
/// preceding article and a following full stop.
pub(super) fn visible_text(html: &str) -> String {
    if html.contains("<code") || html.contains('$') || html.contains('`') {
        let text = plain(html);
        let mut text = text.as_str();
        while let Some(rest) = text.strip_prefix("The ").or_else(|| text.strip_prefix("the ")) {
            text = rest;
        }
        return text.trim_end_matches('.').trim_end().to_string();
    }
    let text = normalized_words(html);
    text.split(' ').filter(|w| !["a", "an", "the"].contains(w)).collect::<Vec<_>>().join(" ")
}

/// The words of a text without capitals and punctuation, also in code and formulas.
pub(super) fn normalized_words(html: &str) -> String {
    let lower = plain(html).to_lowercase();
    let without_punctuation: String =
        lower.chars().map(|c| if ",;:!?'\"“”‘’()".contains(c) { ' ' } else { c }).collect();
    let words = without_punctuation.split_whitespace().map(|w| w.trim_end_matches('.'));
    words.filter(|w| !w.is_empty()).collect::<Vec<_>>().join(" ")
}

/// A number in a text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextNumber {
    /// The byte range in the text.
    pub(super) span: Range<usize>,
    pub(super) value: f64,
    /// The number of digits after the decimal point.
    pub(super) decimals: usize,
    /// The number of significant digits.
    pub(super) significant: usize,
}

/// The numbers of a text of HTML, without powers of ten, indices and exponents.
pub(super) fn numbers(html: &str) -> Vec<TextNumber> {
    let texts = tokens(html).into_iter().filter_map(|token| match token {
        HtmlToken::Text(span) => Some(span),
        HtmlToken::Decoded(..) | HtmlToken::Tag(_) => None,
    });
    let length_of = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let mut all = Vec::new();
    for Range { start: mut offset, end } in texts {
        while let Some(rest) = html.get(offset..end) {
            let Some(from) = rest.find(|c: char| c.is_ascii_digit()) else { break };
            offset += from;
            let tail = html.get(offset..end).unwrap_or("");
            let whole = length_of(tail);
            let behind =
                |mark: char| tail.get(whole..).and_then(|tail| tail.strip_prefix(mark)).map_or(0, length_of);
            // A comma before three digits groups them, except behind a zero.
            let comma = Some(behind(',')).filter(|n| *n != 3 || tail.starts_with("0,")).unwrap_or(0);
            let part = behind('.').max(comma);
            let length = whole + if part > 0 { part + 1 } else { 0 };
            all.extend(number(html, offset..offset + length, part));
            offset += length;
        }
    }
    all
}

fn number(html: &str, span: Range<usize>, decimals: usize) -> Option<TextNumber> {
    let (before, after) = (html.get(..span.start)?, html.get(span.end..)?);
    let digits = html.get(span.clone())?;
    let negative = before.ends_with(['-', '−']);
    let outer = before.trim_end_matches(['-', '−']);
    // An exponent, an index, or a part of a name.
    let part = outer.ends_with(['^', '_', '.', '\\']) || outer.ends_with(|c: char| c.is_alphabetic());
    let inner = outer.ends_with("^{") || outer.ends_with("_{") || outer.ends_with("{,}");
    let joined = after.starts_with(['^', '_', '/', '×', '*', 'e', 'E', ',']) && !after.starts_with(", ");
    let power = [" ×", "×", "\\times", " \\times", "\\cdot", " \\cdot", " *", " /", " x 1"]
        .iter()
        .any(|p| after.starts_with(p));
    if part || inner || joined || power || after.starts_with("{,}") {
        return None;
    }
    // `a - b` is a difference, `a = -b` a negative number.
    let sign = negative && !outer.trim_end().ends_with(|c: char| c.is_alphanumeric() || ")}".contains(c));
    let value: f64 = digits.replace(',', ".").parse().ok()?;
    let significant = digits.bytes().filter(u8::is_ascii_digit).skip_while(|b| *b == b'0').count();
    Some(TextNumber { span, value: if sign { -value } else { value }, decimals, significant })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_distinguished_from_indices_and_powers() {
        let values = |text: &str| numbers(text).into_iter().map(|n| n.value).collect::<Vec<_>>();
        assert_eq!(
            values("<p>7 + 2 = 9, plus 21: 30. And x_1 = -4.50 m</p>"),
            [7.0, 2.0, 9.0, 21.0, 30.0, -4.5]
        );
        assert_eq!(values("$10^{-11}$ and $2 \\times 9.81 \\times 0.3$ = 5.886 N m"), [0.3, 5.886]);
        assert_eq!(values("5 − 0.367 = 4.633"), [5.0, 0.367, 4.633]);
        assert_eq!(values("v = g t = 0,49 m/s, 3,26 m und 0,375 s"), [0.49, 3.26, 0.375]);
    }

    #[test]
    fn texts_are_compared_without_punctuation() {
        assert_eq!(visible_text("The <b>ball</b>, falls."), visible_text("ball falls"));
        assert_ne!(visible_text("it rises"), visible_text("it does not rise"));
        assert_ne!(visible_text("-1"), visible_text("1"));
        assert_ne!(visible_text("<code>Data</code>"), visible_text("<code>data</code>"));
        assert_eq!(visible_text("The <code>Data</code>."), visible_text("<code>Data</code>"));
    }
}
