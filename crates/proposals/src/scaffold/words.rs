//! Whole words in texts.

/// Whether a text contains words, as whole words.
pub(super) fn contains_words(text: &str, words: &str) -> bool {
    let part = |c: char| c.is_alphanumeric();
    text.match_indices(words).any(|(start, _)| {
        let before = text.get(..start).and_then(|t| t.chars().next_back());
        let after = text.get(start + words.len()..).and_then(|t| t.chars().next());
        !before.is_some_and(part) && !after.is_some_and(part)
    })
}

/// Whether a text contains one of several words.
pub(super) fn contains_any(text: &str, words: &[&str]) -> bool {
    words.iter().any(|w| contains_words(text, w))
}

/// The place of the first of these words in a text.
pub(super) fn place(text: &str, words: &[&str]) -> usize {
    let found = words.iter().filter(|w| contains_words(text, w)).filter_map(|w| text.find(w));
    found.min().unwrap_or(usize::MAX)
}
