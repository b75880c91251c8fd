//! Finds the unit of a number elsewhere in its clause: `t / ms = 0.442`, `in milliseconds: 0.442`, `0.442, counted in ms`.

use super::numeral::Chars;
use super::unit_text::{Link, Unit};
use labspec_bind::units;
use std::ops::Range;

/// Number of characters of the clause that are read on either side.
const MAX_CONTEXT: usize = 60;

/// The unit that the clause of a number without a unit names; `None` where it names none, or several.
pub(super) fn clause_unit(chars: Chars<'_>, number: Range<usize>) -> Option<Unit> {
    let before = chars.text(number.start.saturating_sub(MAX_CONTEXT), number.start);
    let behind = chars.text(number.end, number.end + MAX_CONTEXT);
    let before = before.get(last_end(&before)..)?;
    // A unit after the next number belongs to that number.
    let until = next_number(&behind);
    let behind = behind.get(..first_end(&behind).min(until))?;
    let mut named = Vec::new();
    named.extend(unit_directly_before(before));
    named.extend(unit_directly_after(behind));
    for part in [before, behind] {
        named.extend(part.match_indices(['(', '[']).filter_map(|(start, _)| in_brackets(part.get(start..)?)));
        let words = [" in ", " as ", "In "].into_iter().flat_map(|word| {
            part.match_indices(word).map(move |(end, word)| end + word.len()).collect::<Vec<_>>()
        });
        named.extend(words.filter_map(|end| after_in(part.get(end..)?)));
    }
    let first = named.first().cloned()?;
    let one = named.iter().all(|unit| *unit == first);
    one.then(|| Unit {
        dimension: units::read(&first).and_then(|unit| unit.dimension),
        text: first,
        link: Link::Clause,
    })
}

/// The index of the next number in a text. The power of a unit does not count.
fn next_number(text: &str) -> usize {
    let mut before = ' ';
    for (offset, c) in text.char_indices() {
        if c.is_ascii_digit() && !before.is_alphanumeric() && !matches!(before, '^' | '*') {
            return offset;
        }
        // The exponent of `s^-1`.
        before = if c == '-' && before == '^' { before } else { c };
    }
    text.len()
}

/// The index at which the last clause of a text begins.
fn last_end(text: &str) -> usize {
    let mut ends = text.rmatch_indices(['.', ';', '!', '?', '\n', '|']);
    ends.find(|(offset, mark)| is_end(text, *offset, mark)).map_or(0, |(offset, mark)| offset + mark.len())
}

/// The index at which the first clause of a text ends.
fn first_end(text: &str) -> usize {
    let mut ends = text.match_indices(['.', ';', '!', '?', '\n', '|']);
    ends.find(|(offset, mark)| is_end(text, *offset, mark)).map_or(text.len(), |(offset, _)| offset)
}

/// Whether a punctuation mark ends a clause. A decimal point, or a point without a following space, does not.
fn is_end(text: &str, offset: usize, mark: &str) -> bool {
    mark != "." || text.get(offset + 1..).is_none_or(|tail| tail.is_empty() || tail.starts_with([' ', '\n']))
}

/// Whether a unit cannot be a symbol, because it has more than one letter.
pub(super) fn is_sure(unit: &str) -> bool {
    unit == "°" || unit.chars().count() > 1
}

/// Whether a unit without a number before it is more likely another word.
pub(super) fn is_word(unit: &str) -> bool {
    matches!(
        unit.to_lowercase().as_str(),
        "turn" | "second" | "bar" | "degree" | "minute" | "day" | "tag" | "stone" | "mil"
    )
}

/// The text, if all of it is a unit.
fn whole(text: &str) -> Option<String> {
    let text = text.trim();
    let inner = text.strip_prefix('(').and_then(|t| t.strip_suffix(')'));
    let text = inner.filter(|t| !t.contains(['(', ')'])).unwrap_or(text);
    units::is_unit(text).then(|| text.to_string())
}

/// A unit in brackets at the beginning of a text: `(ms)`, `[in ms]`.
fn in_brackets(text: &str) -> Option<String> {
    let close = if text.starts_with('(') { ')' } else { ']' };
    let inner = text.get(1..)?.split(close).next()?.trim();
    whole(inner.strip_prefix("in ").unwrap_or(inner))
}

/// A unit after `in`, unless it could be a word or a name.
fn after_in(text: &str) -> Option<String> {
    let length = units::read(text)?.length;
    let unit = text.get(..length)?;
    let name = unit.chars().count() == 1 && unit.starts_with(char::is_uppercase);
    let goes_on = text.get(length..)?.starts_with(|c: char| c.is_alphanumeric() || c == '-');
    (!is_word(unit) && !name && !goes_on).then(|| unit.to_string())
}

/// A unit directly before a number: `milliseconds: `, `t/ms = `, `kg `.
fn unit_directly_before(text: &str) -> Option<String> {
    let bare = text.trim_end_matches([' ', ':', '=', '≈', '~', '"', '“', '(']);
    let bare =
        [" is", " are", " was", " were"].into_iter().find_map(|verb| bare.strip_suffix(verb)).unwrap_or(bare);
    // `t/ms = 0.442`
    let marked = text.get(bare.len()..)?.contains(['=', ':', '≈']);
    if marked && let Some(unit) = divisor(bare) {
        return Some(unit);
    }
    let mut words = bare.rsplit(' ');
    let unit = whole(words.next()?)?;
    let owned = words.next().is_some_and(|w| w.ends_with(|c: char| c.is_ascii_digit()) || is_spelled(w));
    (is_sure(&unit) && !owned && !is_word(&unit)).then_some(unit)
}

/// The unit by which a symbol is divided at the end of a text, as in `t / ms` or `v/(m/s)`. `4.3 m/s` has no such unit.
fn divisor(text: &str) -> Option<String> {
    let mut strokes = text.match_indices(['/', '∕', '⁄']);
    strokes.find_map(|(offset, stroke)| {
        let unit = whole(text.get(offset + stroke.len()..)?)?;
        let head = text.get(..offset)?.trim_end().rsplit(' ').next()?;
        let symbol = head.starts_with(char::is_alphabetic) && whole(head).is_none();
        symbol.then_some(unit)
    })
}

/// A unit directly after punctuation: `) ms`, `” ms`, `… ms`.
fn unit_directly_after(text: &str) -> Option<String> {
    let exact = text.strip_prefix(" or so ").unwrap_or(text);
    let bare = exact.trim_start_matches([' ', ')', ']', '"', '”', '’', '»', '…', ':', '–', '—', ',', '`']);
    let marked = text.len() > bare.len() && !text.get(..text.len() - bare.len())?.trim().is_empty();
    if !marked {
        return None;
    }
    let length = units::read(bare)?.length;
    let unit = bare.get(..length)?;
    let ends = bare.get(length..)?.starts_with(|c: char| !c.is_alphanumeric()) || length == bare.len();
    (ends && is_sure(unit)).then(|| unit.to_string())
}

/// Whether a word is a numeral or another quantifier.
fn is_spelled(word: &str) -> bool {
    const COUNTS: [&str; 24] = [
        "a", "an", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "twelve",
        "twenty", "hundred", "thousand", "few", "some", "several", "many", "per", "half", "more", "another",
    ];
    COUNTS.contains(&word.to_lowercase().as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clause_names_the_unit_of_its_number() {
        let named = |text: &str| {
            let chars: Vec<char> = text.chars().collect();
            let start = text.find("0.442").map(|offset| text[..offset].chars().count()).unwrap();
            clause_unit(Chars(&chars), start..start + 5).map(|unit| unit.text)
        };
        for (text, unit) in [
            ("t/ms = 0.442", "ms"),
            ("t / ms = 0.442", "ms"),
            ("t [ms] = 0.442", "ms"),
            ("t (ms): 0.442", "ms"),
            ("v/m/s = 0.442", "m/s"),
            ("v / m/s = 0.442", "m/s"),
            ("In ms: 0.442", "ms"),
            ("milliseconds: 0.442", "milliseconds"),
            ("the time in ms is 0.442", "ms"),
            ("the number of milliseconds is 0.442", "milliseconds"),
            ("a time (in ms) of 0.442", "ms"),
            ("kg: 0.442", "kg"),
            ("(0.442) ms", "ms"),
            ("0.442, in ms", "ms"),
            ("0.442… ms", "ms"),
            ("0.442 given in ms", "ms"),
            ("0.442, in m^2, here", "m^2"),
            ("v/(m/s) = 0.442", "m/s"),
        ] {
            assert_eq!(named(text).as_deref(), Some(unit), "{text}");
        }
        for text in [
            "with 2 kg: 0.442",
            "after two seconds: 0.442",
            "In turn 0.442",
            "in A it is 0.442",
            "at 4.3 m/s: 0.442",
            "in ms. It is 0.442",
            "0.442. In ms it is 442",
            "x (m) over t (s): 0.442",
            "m = 0.442",
            "0.442 in the second run",
            "0.442 in a vacuum",
        ] {
            assert_eq!(named(text), None, "{text}");
        }
    }
}
