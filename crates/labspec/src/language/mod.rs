//! The languages of lessons: the words before a number that state an interval or compute with it, and the decimal separator.
//!
//! One table for each language. Words that make a number unreadable are recognized in every text, whatever its language.

mod chinese;
mod comparison;
pub(crate) mod degrees;
mod english;
mod french;
mod german;
mod italian;
mod ratios;
mod spanish;
pub(crate) mod words;

pub use comparison::Comparison;
use degrees::Degree;
pub use ratios::Ratios;

/// One kind of words that compare.
pub(crate) type ComparisonWords = fn(&'static Comparison) -> &'static [&'static str];

/// The words of a language.
#[derive(Debug, PartialEq)]
pub struct Language {
    /// The code of ISO 639: `de`.
    pub code: &'static str,
    /// Its English name.
    pub name: &'static str,
    /// Whether decimals follow a comma: `0,44 s`.
    pub decimal_comma: bool,
    /// Before an approximate number. Trailing zeros before the point are then not digits of it: `about 200 ms`.
    pub approximate: &'static [&'static str],
    /// Before a number that is slightly larger than the value: `nearly 1.5 s`.
    pub slightly_less: &'static [&'static str],
    /// Before a number that is slightly smaller than the value: `just over 2 s`.
    pub slightly_more: &'static [&'static str],
    /// Before the largest value: `up to 0.45 rad/s`.
    pub largest: &'static [&'static str],
    /// Before a lower bound: `more than 3 N`.
    pub lower_bounds: &'static [&'static str],
    /// Before an upper bound: `less than 1 mm`.
    pub upper_bounds: &'static [&'static str],
    /// Numbers in words, except one: `three`.
    pub numerals: &'static [&'static str],
    /// After a numeral they make a factor of it: `tenfold`, `zehnmal`.
    pub factor_suffixes: &'static [&'static str],
    /// Before a number, they multiply it: `twice`.
    pub multiples: &'static [&'static str],
    /// Before a number and a word of `of`, they denote a part or a multiple: `half of`.
    pub parts: &'static [&'static str],
    /// Between a part and its whole.
    pub of: &'static [&'static str],
    /// Between two numbers, they compute with them: `times`.
    pub operators: &'static [&'static str],
    /// They state something about every moment: `never`.
    pub never: &'static [&'static str],
    /// Before the first number of a range, and between its two numbers: `between 3 and 5`.
    pub between: &'static [(&'static str, &'static str)],
    /// The same, where the words may also state a change from one number to the other: `von 3 bis 5`.
    pub from: &'static [(&'static str, &'static str)],
    /// Words that compare values.
    pub comparison: Comparison,
    /// Words of ratios.
    pub ratios: Ratios,
}

/// All languages.
pub static LANGUAGES: [&Language; 6] = [
    &english::ENGLISH,
    &german::GERMAN,
    &french::FRENCH,
    &spanish::SPANISH,
    &italian::ITALIAN,
    &chinese::CHINESE,
];

/// A set of languages, in which a lesson may be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Languages(u8);

impl Default for Languages {
    /// All languages.
    fn default() -> Languages {
        Languages::ALL
    }
}

impl Languages {
    /// All languages.
    pub const ALL: Languages = Languages((1 << LANGUAGES.len()) - 1);

    /// The languages with these codes.
    ///
    /// # Errors
    /// A code is unknown, which is returned.
    pub fn with_codes<'c>(codes: impl IntoIterator<Item = &'c str>) -> Result<Languages, &'c str> {
        codes.into_iter().try_fold(Languages(0), |all, code| {
            let index = LANGUAGES.iter().position(|language| language.code == code).ok_or(code)?;
            Ok(Languages(all.0 | 1 << index))
        })
    }

    /// The languages of the set.
    pub fn iter(self) -> impl Iterator<Item = &'static Language> {
        let is_one = move |(index, _): &(usize, &&'static Language)| self.0 & 1 << index != 0;
        LANGUAGES.iter().enumerate().filter(is_one).map(|(_, language)| *language)
    }

    /// Whether decimals follow a comma; `None` if the languages differ.
    pub fn decimal_comma(self) -> Option<bool> {
        let mut all = self.iter().map(|language| language.decimal_comma);
        let first = all.next()?;
        all.all(|comma| comma == first).then_some(first)
    }

    /// The words of one kind with which the languages of the set compare values.
    pub(crate) fn comparisons(
        self,
        of: impl Fn(&'static Comparison) -> &'static [&'static str],
    ) -> impl Iterator<Item = &'static str> {
        self.words_of(move |language| of(&language.comparison))
    }

    /// Words for larger and smaller values in the languages of the set.
    pub(crate) fn degrees(self) -> impl Iterator<Item = (&'static str, Degree)> {
        self.iter().flat_map(|language| language.comparison.degrees.iter().copied())
    }

    /// Ordinal numbers of the languages of the set.
    pub(crate) fn ordinals(self) -> impl Iterator<Item = (&'static str, usize)> {
        self.iter().flat_map(|language| language.comparison.ordinals.iter().copied())
    }

    /// The words of one kind with which the languages of the set state ratios.
    pub(crate) fn ratios<T: Copy + 'static>(
        self,
        of: impl Fn(&'static Ratios) -> &'static [T],
    ) -> impl Iterator<Item = T> {
        self.iter().flat_map(move |language| of(&language.ratios).iter().copied())
    }

    /// The words of one kind in all languages of the set.
    pub(crate) fn words_of(
        self,
        of: impl Fn(&'static Language) -> &'static [&'static str],
    ) -> impl Iterator<Item = &'static str> {
        self.iter().flat_map(move |language| of(language).iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_have_the_words_of_their_languages() {
        let german = Languages::with_codes(["de"]).unwrap_or_default();
        assert_eq!(german.decimal_comma(), Some(true));
        assert!(german.words_of(|l| l.approximate).any(|word| word == "etwa"));
        assert!(!german.words_of(|l| l.approximate).any(|word| word == "about"));
        assert_eq!(Languages::ALL.iter().count(), LANGUAGES.len());
        assert_eq!(Languages::ALL.decimal_comma(), None);
        assert_eq!(Languages::with_codes(["en", "xx"]), Err("xx"));
    }

    #[test]
    fn words_are_in_lower_case_and_have_one_meaning_in_a_language() {
        for language in LANGUAGES {
            let lists = [
                language.approximate,
                language.slightly_less,
                language.slightly_more,
                language.largest,
                language.lower_bounds,
                language.upper_bounds,
            ];
            let mut all: Vec<&str> = lists.concat();
            assert!(all.iter().all(|word| *word == word.to_lowercase()), "{}", language.name);
            all.sort_unstable();
            let count = all.len();
            all.dedup();
            assert_eq!(all.len(), count, "{}", language.name);
            let computing = [
                language.numerals,
                language.factor_suffixes,
                language.multiples,
                language.parts,
                language.of,
                language.operators,
                language.never,
            ];
            let Comparison { smaller, larger, loses, is_lost, keeps, remains, asks_percent, .. } =
                language.comparison;
            let comparing = [smaller, larger, loses, is_lost, keeps, remains, asks_percent].concat();
            assert!(comparing.iter().all(|word| *word == word.to_lowercase()), "{}", language.name);
            assert!(computing.concat().iter().all(|word| *word == word.to_lowercase()), "{}", language.name);
        }
    }
}
