//! The only reader of quantities: sign, number, factor, unit and context, with the exact position of each. The grammar is
//! in `docs/quantities.md`.

use super::clause_unit::clause_unit;
use super::context::before;
use super::context_after::{after, denied_after};
use super::number::{NumberForm, Quoted, Style, ten};
use super::numeral::{Chars, DECIMAL_COMMA, Numeral, numbers};
use super::unit_text::{Link, Unit, unit_after};
use crate::language::Languages;
use std::ops::Range;

/// A quantity with its position, in characters.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    /// Its number, with sign, power of ten and factor; both ends of a range.
    pub(super) quoted: Quoted,
    /// Other possible values of the number.
    pub(super) ambiguities: Vec<f64>,
    /// Why it must not be reported as wrong.
    pub(super) is_ambiguous: Option<&'static str>,
    /// The whole quantity, including sign and unit.
    pub(super) whole: Range<usize>,
    /// Index of the first digit.
    pub(super) digits: usize,
    /// Index after the number and before the unit.
    pub(super) number_end: usize,
    /// Its unit, if it has one.
    pub(super) unit: Option<Unit>,
    /// Why it is not a separate number: it is part of another expression, or modified by the text around it.
    pub(super) refused: Option<&'static str>,
    /// Whether it begins a change from one number to another. Used only for quotes.
    pub(super) change: bool,
}

impl Quantity {
    /// Whether both state the same number, ignoring their units.
    pub(super) fn states(&self, other: &Quantity) -> bool {
        let (a, b) = (&self.quoted, &other.quoted);
        a.value.to_bits() == b.value.to_bits() && a.half_unit == b.half_unit && a.form == b.form
    }
}

impl Quantity {
    /// The quantity in languages that agree on the meaning of a comma: `1,500` is 1500 in English and 1.5 in German.
    pub(super) fn with_comma(mut self, languages: Languages) -> Quantity {
        let Some(is_decimal) = languages.decimal_comma() else { return self };
        if is_decimal && self.is_ambiguous == Some(DECIMAL_COMMA) {
            self.is_ambiguous = None;
        }
        let NumberForm::Plain(style) = self.quoted.form else { return self };
        if style.group != Some(',') || self.quoted.exponent != 0 {
            return self;
        }
        if let (true, [value]) = (is_decimal, self.ambiguities.as_slice()) {
            let form = NumberForm::Plain(Style { group: None, ..style });
            self.quoted =
                Quoted { value: *value, half_unit: 0.5 * ten(-3), decimals: 3, form, ..self.quoted };
        }
        self.ambiguities.clear();
        self
    }
}

/// All quantities of a text, in order. Pairs that state one quantity (`0.4 to 0.5 s`, `0.44 ± 0.01 s`) are one.
pub(super) fn quantities(chars: Chars<'_>) -> Vec<Quantity> {
    read(chars, false)
}

/// Like [`quantities`], but the ends of a range in words with two units (`between 0.4 s and 0.5 s`) are separate
/// quantities, because a text states each of them.
pub(super) fn separate_quantities(chars: Chars<'_>) -> Vec<Quantity> {
    read(chars, true)
}

fn read(chars: Chars<'_>, separate: bool) -> Vec<Quantity> {
    let singles = singles(chars);
    let mut all: Vec<Quantity> = Vec::with_capacity(singles.len());
    let mut rest = singles.into_iter().peekable();
    while let Some(mut first) = rest.next() {
        match rest.peek().map(|second| pair(chars, &first, second)) {
            Some(NumberRelation::One(_) | NumberRelation::Refused(_))
                if separate && in_words(chars, &first, rest.peek()) =>
            {
                all.push(first);
            }
            Some(NumberRelation::One(one)) => {
                rest.next();
                all.push(one);
            }
            Some(NumberRelation::Refused(form)) => {
                first.refused = Some(form);
                if let Some(second) = rest.peek_mut() {
                    second.refused = Some(form);
                }
                all.push(first);
            }
            Some(NumberRelation::Change) => {
                first.change = true;
                all.push(first);
            }
            Some(NumberRelation::Two) | None => all.push(first),
        }
    }
    for q in &mut all {
        q.refused = q
            .refused
            .or_else(|| before(chars, q.whole.start))
            .or_else(|| after(chars, q.whole.end, q.unit.is_some()))
            .or_else(|| denied_after(chars, q.whole.end));
    }
    refuse_compounds(chars, &mut all);
    share(chars, &mut all);
    for q in all.iter_mut().filter(|q| q.unit.is_none()) {
        q.unit = clause_unit(chars, q.whole.clone());
    }
    all
}

/// The numbers of a text with their units, without joining pairs.
pub(super) fn singles(chars: Chars<'_>) -> Vec<Quantity> {
    let one = |(number, digits): (Numeral, usize)| {
        let unit = unit_after(chars, number.end);
        let end = unit.as_ref().map_or(number.end, |(_, end)| *end);
        Quantity {
            quoted: number.quoted,
            ambiguities: number.ambiguities,
            is_ambiguous: number.is_ambiguous,
            whole: number.start..end,
            digits,
            number_end: number.end,
            unit: unit.map(|(unit, _)| unit),
            refused: number.refused,
            change: false,
        }
    };
    numbers(chars).into_iter().map(one).collect()
}

/// In `2 h 3 min 0.45 s` no part is the whole time.
fn refuse_compounds(chars: Chars<'_>, all: &mut [Quantity]) {
    let dimension = |q: &Quantity| q.unit.as_ref().and_then(|unit| unit.dimension);
    for i in 1..all.len() {
        let Some([first, second]) = all.get_mut(i - 1..=i) else { continue };
        let beside = chars.text(first.whole.end, second.whole.start).trim().is_empty();
        let units = dimension(first).zip(dimension(second));
        // A number in a larger unit is smaller.
        let larger = units.is_some_and(|(a, b)| a.agrees(&b) && a.factor < 0.999 * b.factor);
        if beside && larger {
            first.refused = first.refused.or(Some(COMPOUND));
            second.refused = second.refused.or(Some(COMPOUND));
        }
    }
}

const COMPOUND: &str = "a part of a quantity in several units";

/// In `2.31 to 3.73 N m` and `0.1, 0.2 and 0.3 s` the first numbers get the unit of the last.
fn share(chars: Chars<'_>, all: &mut [Quantity]) {
    let mut next: Option<(usize, Option<Unit>)> = None;
    for q in all.iter_mut().rev() {
        if q.unit.is_none()
            && let Some((start, Some(unit))) = &next
        {
            let gap = chars.text(q.whole.end, *start);
            if ["to", "and", "or", ",", "–", "-", "→", "->", "、", "到", "至", "和"].contains(&gap.trim())
            {
                q.unit = Some(Unit { link: Link::Shared, ..unit.clone() });
            }
        }
        next = Some((q.whole.start, q.unit.clone()));
    }
}

/// Whether two numbers with their own units are linked by a word.
fn in_words(chars: Chars<'_>, first: &Quantity, second: Option<&Quantity>) -> bool {
    second.is_some_and(|second| {
        let gap = chars.text(first.whole.end, second.whole.start);
        let is_word = |pairs: &[(&str, &str)]| pairs.iter().any(|(_, link)| *link == gap.trim());
        let is_link = matches!(gap.trim(), "and" | "to" | "bis")
            || Languages::ALL.iter().any(|language| is_word(language.between));
        first.unit.is_some() && second.unit.is_some() && is_link
    })
}

/// How two adjacent numbers are related.
enum NumberRelation {
    Two,
    One(Quantity),
    /// A change from the first to the second.
    Change,
    Refused(&'static str),
}

/// The relation of two numbers: one quantity if they form a plus-minus value or a range.
fn pair(chars: Chars<'_>, first: &Quantity, second: &Quantity) -> NumberRelation {
    if second.whole.start < first.number_end || second.whole.start - first.number_end > 60 {
        return NumberRelation::Two;
    }
    let gap = chars.text(first.number_end, second.whole.start);
    let unit_text = |q: &Quantity| chars.text(q.number_end, q.whole.end).trim().to_string();
    let (first_unit, second_unit) = (unit_text(first), unit_text(second));
    let tight = gap.trim();
    let part = |sign: &str| tight.strip_suffix(sign).map(str::trim);
    if let Some(left) = part("±").or(part("+/-")).or(part("+/")) {
        return plus_minus(chars, [first, second], left, [&first_unit, &second_unit]);
    }
    let link = tight.strip_prefix(first_unit.as_str()).unwrap_or(tight).trim();
    let dash = matches!(link, "-" | "–" | "—" | "~");
    let spaced = gap.starts_with(' ');
    let preceded = |word: &str| word_before(chars, first.whole.start, word);
    let links = |pairs: &[(&str, &str)]| pairs.iter().any(|(word, to)| *to == link && preceded(word));
    if is_ratio([first, second], &gap) && !preceded("from") && !links_from(&links) {
        return ratio(first, second);
    }
    let between = Languages::ALL.iter().any(|language| links(language.between));
    let to = matches!(link, "to" | "bis" | "到" | "至" | "から");
    if !to && links_from(&links) {
        return NumberRelation::Change;
    }
    let is_range = between || to || link == "…" || link == "..." || dash && (link != "-" || !spaced);
    if !is_range {
        return NumberRelation::Two;
    }
    if to && preceded("from") || matches!(link, "から") || preceded("从") {
        return NumberRelation::Change;
    }
    range([first, second], [&first_unit, &second_unit], dash, chars)
}

/// Whether words such as `von … bis` link two numbers in any language.
fn links_from(links: &impl Fn(&[(&str, &str)]) -> bool) -> bool {
    Languages::ALL.iter().any(|language| links(language.from))
}

/// The range that the two numbers of a change state in a language without another word for a range: `de 3 à 5 m/s`.
pub(super) fn range_of_change(chars: Chars<'_>, first: &Quantity, second: &Quantity) -> Option<Quantity> {
    let gap = chars.text(first.whole.end, second.whole.start);
    let links = |pairs: &[(&str, &str)]| {
        pairs.iter().any(|(word, to)| *to == gap.trim() && word_before(chars, first.whole.start, word))
    };
    let unit_text = |q: &Quantity| chars.text(q.number_end, q.whole.end).trim().to_string();
    match range([first, second], [&unit_text(first), &unit_text(second)], false, chars) {
        NumberRelation::One(range) if links_from(&links) => Some(range),
        _ => None,
    }
}

/// Whether two numbers without a unit form a ratio to one: `2.45 to 1`, `2.45 : 1`.
fn is_ratio([first, second]: [&Quantity; 2], gap: &str) -> bool {
    let one = second.quoted.value == 1.0 && second.quoted.decimals == 0 && second.quoted.exponent == 0;
    let plain =
        matches!(first.quoted.form, NumberForm::Plain(_)) && first.unit.is_none() && second.unit.is_none();
    let colon = matches!(gap, ":" | " : " | "∶" | " ∶ ");
    let word = matches!(gap, " to " | "-to-" | " zu " | " à " | " contre " | " a ");
    one && plain && (colon || word && first.quoted.value > 1.0)
}

/// A ratio to one, which is a number without a unit.
fn ratio(first: &Quantity, second: &Quantity) -> NumberRelation {
    NumberRelation::One(Quantity {
        whole: first.whole.start..second.whole.end,
        number_end: second.number_end,
        unit: Some(Unit::ratio()),
        refused: first.refused.or(second.refused),
        ..first.clone()
    })
}

/// A range of numbers. `dash` states that a dash links them.
fn range(
    [first, second]: [&Quantity; 2],
    [first_unit, second_unit]: [&str; 2],
    dash: bool,
    chars: Chars<'_>,
) -> NumberRelation {
    let (a, b) = (first.quoted, second.quoted);
    let one_unit = first_unit.is_empty() || first_unit == second_unit;
    if !one_unit || a.exponent != b.exponent && a.exponent == 0 {
        return NumberRelation::Refused("a range whose ends have different units or powers of ten");
    }
    if dash && a.value > b.value {
        return NumberRelation::Refused("a difference or a range");
    }
    let form = NumberForm::Range(a.value.min(b.value), a.value.max(b.value));
    let joined = join_pair(first, second, form, (a.value + b.value) / 2.0, second.unit.clone());
    with_bracketed_unit(joined, chars)
}

/// The quantity with the unit after its bracket: `(3.96 ± 0.01) m/s`.
fn with_bracketed_unit(relation: NumberRelation, chars: Chars<'_>) -> NumberRelation {
    let NumberRelation::One(mut q) = relation else { return relation };
    let in_brackets = chars.before(q.whole.start) == Some('(') && chars.at(q.whole.end) == Some(')');
    if q.unit.is_none()
        && in_brackets
        && let Some((unit, end)) = unit_after(chars, q.whole.end + 1)
    {
        q.unit = Some(unit);
        q.whole = q.whole.start - 1..end;
    }
    NumberRelation::One(q)
}

/// A value with its uncertainty. `left` is the text between its number and the sign, followed by the texts of both units.
fn plus_minus(
    chars: Chars<'_>,
    [first, second]: [&Quantity; 2],
    left: &str,
    [first_unit, second_unit]: [&str; 2],
) -> NumberRelation {
    let (a, b) = (first.quoted, second.quoted);
    let relative = !left.is_empty() && !left.starts_with('%') && second_unit == "%";
    let one_unit = left == first_unit && (left.is_empty() || left == second_unit || relative);
    if !one_unit || left.is_empty() && second_unit == "%" {
        return NumberRelation::Refused("a plus-minus value with an unclear unit");
    }
    if a.exponent != b.exponent && a.exponent == 0 {
        return NumberRelation::Refused("a plus-minus value with an unclear power of ten");
    }
    let about = if relative { a.value * b.value / 100.0 } else { b.value }.abs();
    let unit = if relative { first.unit.clone() } else { second.unit.clone() };
    let form = NumberForm::PlusMinus(a.value - about, a.value + about);
    with_bracketed_unit(join_pair(first, second, form, a.value, unit), chars)
}

/// Joins two numbers into one quantity.
fn join_pair(
    first: &Quantity,
    second: &Quantity,
    form: NumberForm,
    value: f64,
    unit: Option<Unit>,
) -> NumberRelation {
    NumberRelation::One(Quantity {
        quoted: Quoted { form, value, ..first.quoted },
        ambiguities: Vec::new(),
        is_ambiguous: first.is_ambiguous.or(second.is_ambiguous),
        whole: first.whole.start..second.whole.end,
        number_end: if unit.is_some() && first.unit.is_some() { first.number_end } else { second.number_end },
        unit,
        refused: first.refused.or(second.refused),
        ..first.clone()
    })
}

fn word_before(chars: Chars<'_>, index: usize, word: &str) -> bool {
    let near = chars.text(index.saturating_sub(20), index).to_lowercase();
    near.trim_end()
        .strip_suffix(word)
        .is_some_and(|rest| !rest.ends_with(char::is_alphanumeric) || !word.is_ascii())
}

/// A number of percent as a fraction of one, which an expression may give; `None` for other units.
pub(super) fn as_share(q: &Quoted, unit: &Unit) -> Option<Quoted> {
    let power = unit.share()?;
    let scale = |x: f64| x * ten(power);
    let form = match q.form {
        NumberForm::PlusMinus(a, b) => NumberForm::PlusMinus(scale(a), scale(b)),
        NumberForm::Range(a, b) => NumberForm::Range(scale(a), scale(b)),
        NumberForm::Interval(a, b) => NumberForm::Interval(scale(a), scale(b)),
        NumberForm::Magnitude => NumberForm::Magnitude,
        _ => NumberForm::Share,
    };
    Some(Quoted {
        value: scale(q.value),
        half_unit: scale(q.half_unit),
        decimals: (q.decimals as i32 - q.exponent - power).max(0) as usize,
        exponent: 0,
        form,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Text of 100 kB of any beginning of a number or a unit is read in linear time.
    #[test]
    fn hostile_texts_are_read_in_linear_time() {
        let pieces = "1|1,|1 |1,000|1 000|000 |1.|.|1e|1e9|10^|1×10^|½|-|- 1|1 million |1万|{|\\|s1 |1 (|1 m(|1 per |1 – |1 to |1±|秒|1秒|x|'|1'000";
        let length = if crate::takes_all() { 100_000 } else { 20_000 };
        for piece in pieces.split('|') {
            for head in ["", "1.000 ", "10^"] {
                let chars: Vec<char> =
                    head.chars().chain(piece.repeat(length / piece.len()).chars()).collect();
                let all = quantities(Chars(&chars));
                assert!(all.iter().all(|q| q.whole.end <= chars.len()), "{head}{piece}");
            }
        }
    }
}
