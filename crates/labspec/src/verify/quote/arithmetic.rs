//! Words that compute with a number: `twice 0.5 s`, `tenfold 0.5 s`, `a tenth of 0.5 s`, `0.5 s times 10`. They are read in every
//! language, whatever that of the lesson.

use crate::language::words::ends_with;
use crate::language::{Language, Languages};

/// Whether the words at the end of a text in lower case multiply the number after them.
pub(super) fn is_multiplied(before: &str) -> bool {
    let before = before.trim_end();
    Languages::ALL.iter().any(|language| {
        let mut direct = language.numerals.iter().chain(language.multiples);
        direct.any(|word| ends_with(before, word))
            || is_part_of(before, language)
            || is_factor(before, language)
    })
}

/// Whether a text ends with a part or a factor and a preposition: `a tenth of`, `das Zehnfache von`.
fn is_part_of(before: &str, language: &Language) -> bool {
    language.of.iter().filter(|of| ends_with(before, of)).any(|of| {
        let rest = before.strip_suffix(of).unwrap_or(before).trim_end();
        language.parts.iter().chain(language.multiples).any(|word| ends_with(rest, word))
            || is_factor(rest, language)
    })
}

/// Whether the last word of a text is a numeral with a suffix: `tenfold`, `10-fold`, `3x`.
fn is_factor(before: &str, language: &Language) -> bool {
    let last = before.rsplit([' ', '(']).next().unwrap_or("");
    let is_numeral = |word: &str| {
        let digits = word.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | ','));
        digits && word.starts_with(|c: char| c.is_ascii_digit()) || language.numerals.contains(&word)
    };
    let mut stems = language.factor_suffixes.iter().filter_map(|suffix| last.strip_suffix(suffix));
    stems.any(|stem| is_numeral(stem.trim_end_matches('-')))
}

/// Whether the words at the beginning of a text in lower case compute with the number before them and another one.
pub(super) fn computes(behind: &str) -> bool {
    Languages::ALL.iter().any(|language| {
        let mut rests =
            language.operators.iter().filter_map(|word| behind.strip_prefix(word)?.strip_prefix(' '));
        rests.any(|rest| begins_with_number(rest.trim_start(), language))
    })
}

fn begins_with_number(text: &str, language: &Language) -> bool {
    let number = text.trim_start_matches(['-', '+', '.', '√', '(']);
    let word = text.split(|c: char| !c.is_alphabetic()).next().unwrap_or("");
    number.starts_with(char::is_numeric) || language.numerals.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_multiply_a_number() {
        for before in [
            "three",
            "twenty-five",
            "3x",
            "tenfold",
            "10-fold",
            "twice",
            "a tenth of",
            "half of the",
            "zehnmal",
            "zweimal",
            "das doppelte von",
            "die hälfte von",
            "ein zehntel von",
            "das zehnfache von",
            "la moitié de",
            "dix fois",
            "el doble de",
            "la metà di",
        ] {
            assert!(is_multiplied(before), "{before}");
        }
        for before in
            ["normal", "maximal", "one", "it takes", "the box", "manifold", "wood", "after", "the third:"]
        {
            assert!(!is_multiplied(before), "{before}");
        }
    }

    #[test]
    fn words_compute_with_the_number_before_them() {
        for behind in ["times 10", "plus 10 s", "minus 10 s", "mal 10", "times ten", "fois 10", "durch 2"] {
            assert!(computes(behind), "{behind}");
        }
        for behind in ["plus tard", "timestep 10", "times", "over 10 runs", "and 10 s"] {
            assert!(!computes(behind), "{behind}");
        }
    }
}
