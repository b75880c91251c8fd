//! Factors and shares in words: `doubles`, `four times as long`, `2.5 times`, `a third slower`, `10 % of it is lost`.

use super::words::contains_words;

/// Words for numbers.
const NUMBERS: [(&str, f64); 16] = [
    ("two", 2.0),
    ("three", 3.0),
    ("four", 4.0),
    ("five", 5.0),
    ("six", 6.0),
    ("seven", 7.0),
    ("eight", 8.0),
    ("nine", 9.0),
    ("ten", 10.0),
    ("twelve", 12.0),
    ("sixteen", 16.0),
    ("twenty", 20.0),
    ("hundred", 100.0),
    ("a hundred", 100.0),
    ("a thousand", 1000.0),
    ("ten thousand", 10000.0),
];

/// Verbs and adverbs that state a factor by themselves.
const FACTORS: [(&str, f64); 14] = [
    ("doubled", 2.0),
    ("doubles", 2.0),
    ("double", 2.0),
    ("twice", 2.0),
    ("tripled", 3.0),
    ("triples", 3.0),
    ("triple", 3.0),
    ("quadrupled", 4.0),
    ("quadruples", 4.0),
    ("quadruple", 4.0),
    ("tenfold", 10.0),
    ("halved", 0.5),
    ("halves", 0.5),
    ("halve", 0.5),
];

/// Words for shares.
const SHARES: [(&str, f64); 7] = [
    ("half", 0.5),
    ("a third", 1.0 / 3.0),
    ("two thirds", 2.0 / 3.0),
    ("a quarter", 0.25),
    ("three quarters", 0.75),
    ("a fifth", 0.2),
    ("a tenth", 0.1),
];

/// The factor above one, or its inverse, that a text states, without a direction: `doubled`, `four times`, `6 × higher`.
pub(super) fn times(text: &str) -> Option<f64> {
    if let Some((_, factor)) = FACTORS.iter().find(|(words, _)| contains_words(text, words)) {
        return Some(*factor);
    }
    let word = |(number, factor): &(&str, f64)| {
        let phrases = [format!("{number} times"), format!("{number}fold"), format!("a factor of {number}")];
        phrases.iter().any(|words| contains_words(text, words)).then_some(*factor)
    };
    // "ten thousand times" contains "thousand times", so the longest words count.
    let named = NUMBERS.iter().rev().find_map(word);
    named.or_else(|| digits_before(text, &[" times", " ×", "×"]))
}

/// The share that a text states: `half`, `a third`, `60 %`.
pub(super) fn share(text: &str) -> Option<f64> {
    let named = SHARES.iter().filter(|(words, _)| contains_words(text, words));
    // "two thirds" is no third.
    named.max_by_key(|(words, _)| words.len()).map(|(_, share)| *share).or_else(|| percent(text))
}

/// The first number before a percent sign, as a share.
pub(super) fn percent(text: &str) -> Option<f64> {
    let before = text.split('%').next().filter(|_| text.contains('%'))?.trim_end();
    let digits = before.rsplit(|c: char| !c.is_ascii_digit() && c != '.').next()?;
    digits.parse::<f64>().ok().map(|p| p / 100.0)
}

/// The number before one of these words.
fn digits_before(text: &str, words: &[&str]) -> Option<f64> {
    let (before, _) = words.iter().find_map(|word| text.split_once(word))?;
    let digits = before.trim_end().rsplit(|c: char| !c.is_ascii_digit() && c != '.').next()?;
    digits.parse::<f64>().ok().filter(|x| *x > 0.0 && x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_read() {
        for (text, factor) in [
            ("it doubles", Some(2.0)),
            ("eight times as long", Some(8.0)),
            ("ten thousand times as long", Some(10000.0)),
            ("about 2.5 times as long", Some(2.5)),
            ("6 × higher", Some(6.0)),
            ("sometimes", None),
            ("three wheels", None),
        ] {
            assert_eq!(times(text), factor, "{text}");
        }
        for (text, value) in [
            ("half of it", Some(0.5)),
            ("two thirds", Some(2.0 / 3.0)),
            ("about 60%", Some(0.6)),
            ("whole", None),
        ] {
            assert_eq!(share(text), value, "{text}");
        }
    }
}
