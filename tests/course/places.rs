//! The locations of the claimed numbers in the bytes of a lesson. They are determined independently of the tested code.

use std::ops::Range;

/// One occurrence of a claimed number in the text.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// The bytes of the quoted text.
    pub(super) at: Range<usize>,
    /// The text.
    pub(super) quote: String,
}

/// The byte ranges of all `verify` objects.
pub(super) fn verifies(text: &str) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    for (start, _) in text.match_indices("\"verify\":") {
        let open = start + text[start..].find('{').unwrap();
        let (mut depth, mut quoted, mut escaped) = (0, false, false);
        for (i, c) in text[open..].char_indices() {
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = quoted,
                '"' => quoted = !quoted,
                '{' if !quoted => depth += 1,
                '}' if !quoted => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                all.push(start..open + i + 1);
                break;
            }
        }
    }
    all
}

/// The quotes of a `verify` object: the texts before the comma of each pair under `says`.
pub(super) fn quotes(object: &str) -> Vec<String> {
    let json: serde_json::Value = serde_json::from_str(&object[object.find('{').unwrap()..]).unwrap();
    let says = json["says"].as_array().cloned().unwrap_or_default();
    says.iter().map(|pair| pair[0].as_str().unwrap().to_string()).collect()
}

/// All occurrences of claimed numbers outside of claims, in order.
pub(super) fn places(text: &str) -> Vec<Place> {
    let hidden = verifies(text);
    let mut all: Vec<Place> = Vec::new();
    for object in &hidden {
        for quote in quotes(&text[object.clone()]) {
            let before = all.len();
            for (start, _) in text.match_indices(&quote) {
                let at = start..start + quote.len();
                let inside = hidden.iter().any(|h| h.start < at.end && at.start < h.end);
                if !inside && alone(text, &at) {
                    all.push(Place { at, quote: quote.clone() });
                }
            }
            assert!(all.len() > before, "{quote} is nowhere");
        }
    }
    all.sort_by_key(|p| p.at.start);
    all.dedup_by_key(|p| p.at.start);
    all
}

/// Whether a text is a complete number, not a part of a longer one.
fn alone(text: &str, at: &Range<usize>) -> bool {
    let before = text[..at.start].chars().next_back();
    let mut after = text[at.end..].chars();
    let next = after.next();
    let joined = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '/' || c == '²');
    let signed = before == Some('-') && !text[at.clone()].starts_with('-');
    let goes_on = next == Some('.') && after.next().is_some_and(|c| c.is_ascii_digit());
    // `N` is not the unit of `40 N s/m`.
    let longer = text[at.end..].strip_prefix(' ').is_some_and(|rest| {
        ["s/m", "m²", "m ", "m/s"].iter().any(|unit| rest.starts_with(unit))
            && text[at.clone()].ends_with(['N', 'g'])
    });
    !(joined(before) || before == Some('.') || signed || joined(next) || goes_on || longer)
}

/// The digits of a quote: those after its last `=`, otherwise the first ones.
pub(super) fn digits(quote: &str) -> Range<usize> {
    let from = quote.rfind('=').map_or(0, |i| i + 1);
    let start = from + quote[from..].find(|c: char| c.is_ascii_digit()).unwrap();
    let end =
        quote[start..].find(|c: char| !(c.is_ascii_digit() || c == '.')).map_or(quote.len(), |n| start + n);
    start..end
}
