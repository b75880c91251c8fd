//! Words of texts, and texts without a file.

use labspec::source::{SourceMap, Text};

/// A text without a file.
pub(super) fn text(value: &str) -> Text {
    Text { value: value.to_string(), map: SourceMap::point(0) }
}

/// The words of a text in lower case, with at least three letters.
pub(crate) fn split_words(text: &str) -> impl Iterator<Item = String> + '_ {
    let parts = text.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 2);
    parts.map(str::to_lowercase)
}
