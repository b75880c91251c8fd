//! Words and phrases of texts. Phrases are in lower case, and so are the texts in which they are looked for.

/// The words of a text in lower case.
pub(crate) fn words_of(text: &str) -> Vec<String> {
    split_words(text).map(str::to_lowercase).collect()
}

/// The words of a text as they are written.
pub(crate) fn split_words(text: &str) -> impl DoubleEndedIterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// Whether a text begins with a phrase.
pub(crate) fn starts_with(text: &str, phrase: &str) -> bool {
    text.strip_prefix(phrase).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

/// Whether a text ends with a phrase.
pub(crate) fn ends_with(text: &str, phrase: &str) -> bool {
    text.strip_suffix(phrase).is_some_and(|rest| !rest.ends_with(char::is_alphanumeric))
}

/// Where a phrase begins in a text.
pub(crate) fn find(text: &str, phrase: &str) -> Option<usize> {
    let mut all = text.match_indices(phrase).map(|(start, _)| start);
    all.find(|start| {
        let (before, behind) = text.split_at(*start);
        starts_with(behind, phrase) && !before.ends_with(char::is_alphanumeric)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phrases_are_whole_words() {
        assert!(starts_with("is lost again", "is lost") && !starts_with("is lostly", "is lost"));
        assert!(ends_with("by about", "about") && !ends_with("roundabout", "about"));
        assert_eq!(find("unless less is lost", "less"), Some(7));
        assert_eq!(find("unless", "less"), None);
        assert_eq!(words_of("It's 5 m/s, Grün."), ["it", "s", "5", "m", "s", "grün"]);
    }
}
