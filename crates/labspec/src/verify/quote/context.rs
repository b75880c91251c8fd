//! Finds text before a quantity that makes it part of another expression. Text that is not understood is refused: a number
//! counts as quoted only where the text certainly states it.

use super::arithmetic::is_multiplied;
use super::denial::is_denied;
use super::numeral::Chars;
use crate::language::Languages;
use crate::language::words::ends_with;
use labspec_bind::units::{self, is_wide};

pub(super) const BOUND: &str = "a bound, not a number";
const COMPARISON: &str = "a number that something is compared with";
pub(super) const PLUS_MINUS: &str = "a plus-minus sign without its number";
pub(super) const FORMULA: &str = "a formula";
pub(super) const DIFFERENCE: &str = "a difference or a range";
const UNKNOWN_PREFIX: &str = "a number after a prefix that is not understood";
pub(super) const LETTERS: &str = "a number followed by letters";

/// Number of characters that are read on either side.
pub(super) const MAX_CONTEXT: usize = 40;

/// Words before a number that exclude it, or compare something with it.
const EXCLUSIONS: [&str; 40] = [
    "different from",
    "differs from",
    "differ from",
    "outside",
    "outside of",
    "except",
    "except for",
    "excluding",
    "apart from",
    "unlike",
    "contrary to",
    "far off",
    "way off",
    "misses",
    "avoids",
    "fails to reach",
    "failing to reach",
    "fails to attain",
    "unable to reach",
    "scarcely",
    "rarely",
    "seldom",
    "außerhalb",
    "außerhalb von",
    "außer",
    "anders als",
    "verfehlt",
    "abgesehen von",
    "hors de",
    "en dehors de",
    "sauf",
    "loin de",
    "excepté",
    "fuera de",
    "excepto",
    "salvo",
    "lejos de",
    "fuori da",
    "eccetto",
    "tranne",
];

/// Adverbs between a bound and its number: `more than about 3 m/s`, `surpasses even 3 m/s`.
const ADVERBS: [&str; 12] = [
    "only",
    "just",
    "even",
    "still",
    "exactly",
    "precisely",
    "sogar",
    "selbst",
    "genau",
    "même",
    "incluso",
    "persino",
];

/// Words before a number that change its value.
const CHANGING_WORDS: [&str; 71] = [
    "hundred",
    "thousand",
    "million",
    "billion",
    "dozen",
    "minus",
    "negative",
    "plus",
    "times",
    "half",
    "half of",
    "half the",
    "half a",
    "twice",
    "twice the",
    "thrice",
    "double",
    "double the",
    "triple",
    "triple the",
    "quadruple",
    "third of",
    "thirds of",
    "quarter of",
    "quarters of",
    "fifth of",
    "tenth of",
    "hundredth of",
    "thousandth of",
    "square of",
    "cube of",
    "mach",
    "root of",
    "root",
    "inverse of",
    "reciprocal of",
    "logarithm of",
    "log",
    "ln",
    "lg",
    "exp",
    "sin",
    "cos",
    "tan",
    "sqrt",
    "one over",
    "divided by",
    "multiplied by",
    "percent of",
    "fraction of",
    "power of",
    "power",
    "multiple of",
    "multiples of",
    "opposite of",
    "far from",
    "anything but",
    "nowhere near",
    "not",
    "never",
    "nor",
    "moins",
    "meno",
    "menos",
    "halb",
    "halbe",
    "doppelt",
    "mal",
    "fois",
    "per",
    "hardly",
];

/// Words that change the meaning of a number after them, in scripts without spaces: `负0.5秒`, `每秒0.5米`.
const UNSPACED_CHANGING_WORDS: [&str; 49] = [
    "负",
    "負",
    "减",
    "減",
    "减去",
    "マイナス",
    "零下",
    "第",
    "每",
    "毎",
    "每秒",
    "毎秒",
    "每分",
    "毎分",
    "每米",
    "每小时",
    "秒速",
    "时速",
    "時速",
    "分速",
    "半",
    "倍",
    "大于",
    "大於",
    "小于",
    "小於",
    "超过",
    "超過",
    "不到",
    "不足",
    "至少",
    "至多",
    "最多",
    "最少",
    "低于",
    "低於",
    "高于",
    "高於",
    "以上",
    "以下",
    "加",
    "乘",
    "乘以",
    "除以",
    "一半",
    "不是",
    "并非",
    "点",
    "點",
];

/// Numerals of these scripts.
pub(super) const FIGURES: &str = "零〇一二三四五六七八九十百千万萬亿億兆两";

/// The reason why the text before a number or its sign changes its meaning; `None` if it does not.
/// The function is long because it is one table: a row for each character that may precede a number.
pub(super) fn before(chars: Chars<'_>, start: usize) -> Option<&'static str> {
    let (mut index, mut attached, mut within) = (start, true, false);
    let c = loop {
        let c = chars.before(index).filter(|c| *c != '\n')?;
        match c {
            ' ' => attached = false,
            '(' | '[' => {
                let outer = index.checked_sub(1).and_then(|k| chars.before(k));
                if outer.is_some_and(|c| c.is_alphanumeric() && !is_wide(c) || matches!(c, '^' | '_' | '√'))
                {
                    return Some(FORMULA);
                }
                (attached, within) = (false, true);
            }
            '"' | '“' | '”' | '\'' | '‘' | '«' | '»' | '„' | '「' | '『' | '‹' | '›' => {}
            c => break c,
        }
        index -= 1;
        if start - index > MAX_CONTEXT {
            return Some(UNKNOWN_PREFIX);
        }
    };
    let previous = index.checked_sub(1).and_then(|k| chars.before(k));
    let digit_before = previous.is_some_and(|c| c.is_numeric());
    match c {
        '<' | '>' if matches!(previous, Some('-' | '=')) && c == '>' => None,
        '<' | '>' | '≤' | '≥' | '≪' | '≫' | '≲' | '≳' => Some(BOUND),
        '=' if matches!(previous, Some('<' | '>' | '!' | '≠' | '+' | '-' | '*' | '/')) => Some(BOUND),
        '±' | '∓' => Some(PLUS_MINUS),
        '/' if previous == Some('+') => Some(PLUS_MINUS),
        '–' if !attached && is_dash(chars, index - 1) => None,
        '-' | '–' if c == '-' || attached || !is_dash(chars, index - 1) => Some(DIFFERENCE),
        '√' | '×' | '·' | '*' | '/' | '+' | '÷' | '^' | '_' | '∙' | '∕' | '⁄' | '|' | '\\' | '∝' | '≠'
        | '¬' | '#' | '@' | '!'
            if attached || c != '|' && c != '!' =>
        {
            Some(FORMULA)
        }
        ':' if attached && digit_before => Some("a ratio or a time of day"),
        '—' | ',' | '.' | '…' if attached && digit_before => Some(UNKNOWN_PREFIX),
        '.' if attached && matches!(previous, Some('.')) => Some(DIFFERENCE),
        '…' if attached => Some(DIFFERENCE),
        ')' | ']' if attached && !within => Some(FORMULA),
        ')' if matches!(previous, Some('-' | '–' | '+' | '±')) => Some(FORMULA),
        c if is_wide(c) => unspaced_before(chars, index),
        // A fraction character that multiplies the number.
        c if c.is_numeric() && !c.is_ascii_digit() && !c.is_alphabetic() => Some(FORMULA),
        c if c.is_alphanumeric() && attached => Some(UNKNOWN_PREFIX),
        c if c.is_alphanumeric() => words_before(chars, index, within),
        '%' => None,
        '\u{2200}'..='\u{22ff}' | '\u{2a00}'..='\u{2aff}'
            if !matches!(c, '≈' | '≃' | '≅' | '∼' | '≡' | '⇒' | '∴') =>
        {
            Some(FORMULA)
        }
        '=' | '≈' | '~' | ':' | ';' | ',' | '.' | '?' | '!' | '…' | '—' | '→' | '⇒' | '|' | '•' | ')'
        | ']' | '、' | '。' | '，' | '：' | '；' | '」' | '』' | '≡' | '∴' | '≃' | '≅' | '∼' => {
            None
        }
        c if attached || c.is_alphanumeric() => Some(UNKNOWN_PREFIX),
        _ => None,
    }
}

/// Whether a spaced dash at an index is punctuation: it follows a word that is not part of a formula or a unit.
fn is_dash(chars: Chars<'_>, index: usize) -> bool {
    if chars.before(index) != Some(' ') {
        return false;
    }
    let near = chars.text(index.saturating_sub(MAX_CONTEXT), index);
    let line = near.rsplit(['\n', ';']).next().unwrap_or("").trim_end();
    let mut words = line.rsplit(' ');
    let last = words.next().unwrap_or("").trim_end_matches(|c: char| !c.is_alphanumeric());
    let number = |word: &str| word.contains(|c: char| c.is_numeric());
    let of_unit = units::is_unit(last) && words.next().is_some_and(number);
    let is_word =
        last.chars().count() > 1 && last.chars().all(|c| c.is_alphabetic() || matches!(c, '-' | '\''));
    is_word && !of_unit && !line.contains(['=', '\\', '+'])
}

fn unspaced_before(chars: Chars<'_>, index: usize) -> Option<&'static str> {
    let near = chars.text(index.saturating_sub(8), index);
    let figure = near.chars().next_back().is_some_and(|c| FIGURES.contains(c));
    (figure || UNSPACED_CHANGING_WORDS.into_iter().any(|w| near.ends_with(w))).then_some(UNKNOWN_PREFIX)
}

/// Whether a text ends with a bound or an exclusion, in any language: a bound is no number.
fn is_bound(line: &str) -> bool {
    let lower = Languages::ALL.words_of(|language| language.lower_bounds);
    let mut bounds = lower.chain(Languages::ALL.words_of(|language| language.upper_bounds)).chain(EXCLUSIONS);
    bounds.any(|word| ends_with(line, word))
        || ends_with(line, "than") && !ends_with(line, "no more than") && !ends_with(line, "rather than")
}

/// The text without the adverbs at its end.
fn without_adverbs(line: &str) -> &str {
    let approximate = || Languages::ALL.words_of(|language| language.approximate);
    let mut line = line;
    while let Some(word) = ADVERBS.into_iter().chain(approximate()).find(|word| ends_with(line, word)) {
        line = line.strip_suffix(word).unwrap_or("").trim_end();
    }
    line
}

/// The text without an article at its end. In English an article names a number that is stated: `less than the 3 N that are
/// needed`.
fn without_article(line: &str) -> &str {
    const ARTICLES: [&str; 9] = ["die", "der", "den", "les", "la", "los", "las", "i", "gli"];
    let article = ARTICLES.into_iter().find(|word| ends_with(line, word));
    article.and_then(|word| line.strip_suffix(word)).map_or(line, str::trim_end)
}

/// Whether a bound may be a place or a time: `über die 2 s`.
fn is_place(line: &str) -> bool {
    ["über", "unter", "oltre", "au-dessus de", "por encima de"].into_iter().any(|word| ends_with(line, word))
}

/// Whether a text ends with a comparison that makes the number another one: `half as fast as`, `halb so schnell wie`,
/// `plus rapide que`.
fn is_compared(line: &str) -> bool {
    let clause = line.rsplit(['.', ',', ';', ':', '(', '—']).next().unwrap_or("");
    let Some((rest, last)) = clause.trim_end().rsplit_once(' ') else { return false };
    let words: Vec<&str> = rest.split(' ').rev().take(6).collect();
    let is_factor = |word: &&str| {
        let listed = |list: &[&str]| list.contains(word);
        let number = word.starts_with(|c: char| c.is_ascii_digit());
        number || Languages::ALL.iter().any(|l| listed(l.multiples) || listed(l.parts) || listed(l.numerals))
    };
    let is_degree = |word: &&str| {
        const DEGREES: [&str; 11] = [
            "plus",
            "moins",
            "más",
            "menos",
            "mayor",
            "menor",
            "mejor",
            "supérieur",
            "supérieure",
            "più",
            "meno",
        ];
        DEGREES.contains(word)
    };
    let times = |word: &&str| matches!(*word, "fois" | "veces" | "volte" | "mal") || word.ends_with("mal");
    match last {
        "as" | "wie" | "come" => words.iter().any(is_factor) || words.iter().any(times),
        "que" => words.iter().any(is_factor) || words.iter().any(is_degree) || words.iter().any(times),
        "als" => true,
        _ => false,
    }
}

/// The reason why the words that end at `index` change the meaning of the number. `is_apart`: a parenthesis is between them, so that a
/// single letter is a name: `ball B (2 kg)`.
fn words_before(chars: Chars<'_>, index: usize, is_apart: bool) -> Option<&'static str> {
    let near = chars.text(index.saturating_sub(MAX_CONTEXT), index);
    let line = near.rsplit('\n').next().unwrap_or("").to_lowercase();
    let ends =
        |word: &str| line.strip_suffix(word).is_some_and(|rest| !rest.ends_with(char::is_alphanumeric));
    // `up to` and `no more than` state the largest value itself.
    let largest = ends("no more than");
    if is_bound(&line) && !largest {
        return Some(BOUND);
    }
    let head = without_adverbs(&line);
    if head.len() < line.len() && (is_bound(head) || is_denied(head)) {
        return Some(COMPARISON);
    }
    let bare = without_article(head);
    if is_compared(&line) || bare.len() < head.len() && is_bound(bare) && !is_place(bare) {
        return Some(COMPARISON);
    }
    if CHANGING_WORDS.into_iter().any(ends)
        || is_multiplied(&line)
        || line.ends_with("n't")
        || is_denied(&line) && !largest
        || line.ends_with("% of")
        || line.ends_with("½ of")
    {
        return Some("a number that the words before it modify");
    }
    let last = line.rsplit(' ').next().unwrap_or("");
    // Two numbers without a word between them: `3 0.5 s`.
    if last.starts_with(|c: char| c.is_ascii_digit())
        && last.chars().all(|c| c.is_ascii_digit() || ".,'".contains(c))
    {
        return Some(UNKNOWN_PREFIX);
    }
    // A TeX command, or a symbol of a formula.
    let command = last.starts_with('\\') || last.contains('\\');
    let mut letters = last.chars();
    let symbol = match (letters.next(), letters.next()) {
        (Some(c), None) => {
            let is_word = matches!(c, 'a' | 'i' | 'à' | 'y' | 'e' | 'é' | 'è' | 'o' | 'u' | 's' | 'm');
            c.is_alphabetic() && !is_word && !is_apart
        }
        _ => false,
    };
    (command || symbol).then_some(FORMULA)
}
