//! A piece of the text that a reader sees.

use crate::source::Text;

/// A piece of text that is shown apart from others.
#[derive(Debug)]
pub(super) struct ShownPiece {
    pub(super) text: Text,
    /// It holds tags and entities.
    pub(super) html: bool,
}
