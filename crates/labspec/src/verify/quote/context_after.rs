//! Finds text after a quantity that makes it part of another expression.

use super::arithmetic::computes;
use super::clause_unit::{is_sure, is_word};
use super::context::{BOUND, DIFFERENCE, FIGURES, FORMULA, LETTERS, MAX_CONTEXT};
use super::denial::is_denied_after;
use super::numeral::{Chars, fraction};
use labspec_bind::units::{self, is_wide};

/// Words after a number that change its value.
const CHANGING_WORDS: [&str; 48] = [
    "or more",
    "or less",
    "or longer",
    "or higher",
    "or above",
    "or below",
    "or lower",
    "and more",
    "and above",
    "squared",
    "cubed",
    "to the power",
    "dozen",
    "score",
    "times ten",
    "at most",
    "at least",
    "and a half",
    "oder mehr",
    "ou plus",
    "divided by",
    "multiplied by",
    "geteilt durch",
    "dividiert durch",
    "multipliziert mit",
    "divisé par",
    "multiplié par",
    "at the latest",
    "at the earliest",
    "at best",
    "at worst",
    "and below",
    "and up",
    "höchstens",
    "mindestens",
    "oder weniger",
    "au plus",
    "au moins",
    "ou moins",
    "como máximo",
    "como mínimo",
    "o más",
    "o menos",
    "al massimo",
    "almeno",
    "o più",
    "o meno",
    "mach",
];

const UNSPACED_CHANGING_WORDS: [&str; 19] = [
    "以上", "以下", "以内", "以內", "未満", "未满", "不到", "多", "余", "餘", "半", "平方", "立方", "次方",
    "乗", "之", "分之", "分の", "割",
];

/// The reason why the text after a quantity changes its meaning; `None` if it does not.
/// The function is long because it is one table: a row for each character that may follow a quantity.
pub(super) fn after(chars: Chars<'_>, end: usize, has_unit: bool) -> Option<&'static str> {
    let c = chars.at(end)?;
    let next = chars.skip_blanks(end);
    let after_blank = next > end;
    let number_at = |i: usize| {
        let i = chars.skip_blanks(i);
        chars.digit(i)
            || chars.at(i) == Some('.') && chars.digit(i + 1)
            || chars.at(i).is_some_and(|c| fraction(c).is_some())
    };
    if !after_blank {
        match c {
            '^' => return Some("a power"),
            '_' | '′' | '″' | '\\' | '#' | '@' | '$' | '&' => return Some(FORMULA),
            '(' | '[' if chars.digit(end + 1) => return Some("an uncertainty in brackets"),
            '(' if !has_unit => return Some(FORMULA),
            ':' if chars.digit(end + 1) => return Some("a ratio or a time of day"),
            '.' | ',' | '\'' if chars.digit(end + 1) => return Some("digits with several points"),
            ')' | ']' => return after_bracket(chars, end + 1),
            c if is_wide(c) => return unspaced_after(chars, end),
            'π' => return Some(FORMULA),
            c if c.is_alphanumeric() || combines(c) => return Some(LETTERS),
            '-' | '–' | '—' if number_at(end + 1) => return Some(DIFFERENCE),
            '-' | '‑' if has_unit && is_unit_at(chars, end + 1) => return Some("a product"),
            '/' => return Some(if number_at(end + 1) { "a fraction with a slash" } else { "a quotient" }),
            _ => {}
        }
    }
    let c = chars.at(next).filter(|c| *c != '\n')?;
    let then = number_at(next + 1);
    match c {
        '-' if chars.at(next + 1) == Some('>') => None,
        '^' | 'π' | '√' | '\\' | '÷' | '∙' | '⁄' | '∕' | '∓' | '±' | '%' | '‰' | '≠' => {
            Some(FORMULA)
        }
        '×' | '·' | '*' => Some(if then { "a product" } else { FORMULA }),
        '/' => Some(if then { "a fraction with a slash" } else { "a quotient" }),
        'x' | 'X' if then => Some("a product"),
        '+' => Some(if then { "a sum" } else { FORMULA }),
        '-' | '–' if then => Some(DIFFERENCE),
        '<' | '>' | '≤' | '≥' | '≪' | '≫' => Some(BOUND),
        '(' if matches!(chars.at(next + 1), Some('-' | '–' | '+')) && chars.at(next + 2) == Some(')') => {
            Some(FORMULA)
        }
        c if fraction(c).is_some() => Some("a product"),
        // Examples: `0.5 10^3`, `3 0.5 s`.
        c if c.is_ascii_digit() => {
            let end = chars.digits(next);
            let power = chars.at(end) == Some('^') || chars.has(end, "**");
            if power { Some("a product") } else { (!has_unit).then_some(ADJACENT_NUMBER) }
        }
        c if is_wide(c) => unspaced_after(chars, next),
        c if c.is_alphabetic() && !has_unit && has_unit_nearby(&chars.text(next, next + MAX_CONTEXT)) => {
            Some(UNIT_SOON)
        }
        '-' | '–' if after_blank => letter(chars, chars.skip_blanks(next + 1)),
        c if c.is_alphabetic() => words_after(chars, next),
        // A symbol after the whole quantity, such as a check mark in a list.
        '\u{2600}'..='\u{27bf}' | '\u{1f000}'..='\u{1faff}' if has_unit => None,
        c if c.is_ascii() && !matches!(c, '$' | '#' | '@' | '&') || PUNCTUATION.contains(c) => None,
        _ => Some("a number followed by something that is not understood"),
    }
}

/// The reason why the words after a quantity deny it; `None` if they do not.
pub(super) fn denied_after(chars: Chars<'_>, end: usize) -> Option<&'static str> {
    is_denied_after(&chars.text(end, end + MAX_CONTEXT).to_lowercase()).then_some(DENIED)
}

/// Non-ASCII characters that may follow a quantity.
const PUNCTUATION: &str = "”’»›“‘„«—–‑…†‡§≈≃≅∼≡→⇒∴•·、。，：；！？）」』】（「『【．～〜";

/// Whether the word at an index is a unit.
fn is_unit_at(chars: Chars<'_>, index: usize) -> bool {
    let near = chars.text(index, index + MAX_CONTEXT);
    let word: String = near.chars().take_while(|c| c.is_alphabetic()).collect();
    units::is_unit(&word)
}

/// Combining characters, which change the character before them.
fn combines(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}' | '\u{20d0}'..='\u{20ff}' | '\u{1ab0}'..='\u{1aff}' | '\u{fe20}'..='\u{fe2f}')
}

/// The reason for text after the bracket that closes directly after a quantity.
fn after_bracket(chars: Chars<'_>, mut index: usize) -> Option<&'static str> {
    while matches!(chars.at(index), Some(')' | ']')) {
        index += 1;
    }
    let next = chars.skip_blanks(index);
    match chars.at(next) {
        Some('^' | '×' | '·' | '*' | '÷' | '/' | '⁄' | '∕' | '∙' | '√' | '²' | '³') => {
            Some(FORMULA)
        }
        Some(c) if next == index && (c.is_alphanumeric() && !is_wide(c) || c == '(' || c == '\\') => {
            Some(FORMULA)
        }
        Some('+') => Some(FORMULA),
        Some('-' | '–') if chars.digit(chars.skip_blanks(next + 1)) => Some(FORMULA),
        _ => None,
    }
}

fn unspaced_after(chars: Chars<'_>, index: usize) -> Option<&'static str> {
    let near = chars.text(index, index + 4);
    let figure = near.chars().next().is_some_and(|c| FIGURES.contains(c) || c == '每' || c == '毎');
    let fraction = near
        .strip_prefix('の')
        .is_some_and(|t| t.starts_with(|c: char| c.is_numeric() || FIGURES.contains(c)));
    (figure || fraction || UNSPACED_CHANGING_WORDS.into_iter().any(|w| near.starts_with(w)))
        .then_some(UNKNOWN_SUFFIX)
}

const UNIT_SOON: &str = "a number with words between it and its unit";

/// Words that begin another phrase: a unit after them does not belong to the number before them.
const PHRASES: [&str; 55] = [
    "in", "at", "after", "on", "for", "to", "from", "by", "with", "before", "and", "or", "but", "when",
    "while", "as", "is", "are", "was", "were", "the", "this", "that", "these", "if", "than", "then", "until",
    "within", "during", "between", "above", "below", "over", "under", "up", "down", "here", "there", "now",
    "which", "who", "because", "since", "so", "not", "instead", "rather", "too", "also", "only", "later",
    "earlier", "each", "every",
];

/// Whether a number without a unit is followed by words and a unit that belongs to them: `half seconds`, `of a minute`,
/// `light-seconds`.
fn has_unit_nearby(line: &str) -> bool {
    let phrase =
        line.split(['.', ',', ';', ':', '(', ')', '!', '?', '\n', '—', '"', '|', '=']).next().unwrap_or("");
    let mut words = phrase.split(' ').filter(|word| !word.is_empty());
    let Some(first) = words.next() else { return false };
    if let Some((_, last)) = first.rsplit_once('-') {
        return units::is_unit(last);
    }
    let first = first.to_lowercase();
    if PHRASES.contains(&first.as_str()) {
        return false;
    }
    let of_one = |word: &&str| matches!(*word, "of" | "a" | "an" | "one" | "per" | "the" | "each" | "every");
    // In `makes A move` and `gives a second bounce` these words are not units. They are units only after a word of
    // `PART_WORDS`.
    let part = PART_WORDS.contains(&first.as_str());
    let is_unit = |word: &str| units::is_unit(word) && (part || is_sure(word) && !is_word(word));
    words.find(|word| !of_one(word)).is_some_and(is_unit)
}

/// Words that denote a part or another power of the following unit.
const PART_WORDS: [&str; 18] = [
    "of",
    "half",
    "quarter",
    "quarters",
    "third",
    "thirds",
    "tenth",
    "tenths",
    "hundredths",
    "thousandths",
    "double",
    "triple",
    "inverse",
    "reciprocal",
    "square",
    "cubic",
    "times",
    "pairs",
];

const ADJACENT_NUMBER: &str = "a number directly followed by another one";
const DENIED: &str = "a number that the words after it deny";
const UNKNOWN_SUFFIX: &str = "a number that the words after it modify";

fn words_after(chars: Chars<'_>, index: usize) -> Option<&'static str> {
    let near = chars.text(index, index + MAX_CONTEXT);
    let line = near.split('\n').next().unwrap_or("").to_lowercase();
    let begins =
        |word: &str| line.strip_prefix(word).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric));
    if CHANGING_WORDS.into_iter().any(begins) || computes(&line) {
        return Some(UNKNOWN_SUFFIX);
    }
    letter(chars, index)
}

/// A single letter is a symbol of a formula, unless it is a word.
fn letter(chars: Chars<'_>, index: usize) -> Option<&'static str> {
    let alone =
        !chars.at(index + 1).is_some_and(|c| c.is_alphanumeric() || c == '\'' || c == '-' || c == '.');
    let c = chars.at(index)?;
    let digits = matches!(c, 'e' | 'E') && chars.digit(index + 1);
    let symbol = c.is_alphabetic()
        && !is_wide(c)
        && alone
        && !matches!(c, 'a' | 'I' | 'à' | 'y' | 'e' | 'é' | 'è' | 'o' | 'u' | 'A' | 'i');
    let indexed = c.is_alphabetic() && matches!(chars.at(index + 1), Some('_' | '^' | '('));
    (symbol || digits || indexed).then_some(FORMULA)
}
