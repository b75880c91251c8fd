//! The findings about damaged, missing and mislabelled fences. `markdown/` detects the damage.

use crate::finding::Finding;
use crate::markdown::{MAX_BLOCKS, MAX_MARKUP, Problem};
use crate::rules::{
    self, fence_line, fence_listing, fence_missing, fence_name, fence_unclosed, fence_unseen,
};

/// The finding about a damaged fence.
pub(super) fn to_finding(text: &str, problem: &Problem) -> Finding {
    match problem {
        Problem::TooMuchMarkup => {
            Finding::new(rules::LESSON_LIMIT, 0..0, "this lesson is not checked at all")
                .why(format!("it has more than {MAX_MARKUP} characters of markup"))
                .help("split the lesson")
        }
        Problem::TooManyBlocks(from) => {
            Finding::new(rules::LESSON_LIMIT, *from..*from, "the rest of the lesson is not checked")
                .why(format!("the lesson has more than {MAX_BLOCKS} fences, or too many damaged ones"))
                .help("split the lesson, or fix the first fences and check again")
        }
        Problem::Listed { open, right } => fence_listing::listed(open, right),
        Problem::Misspelt { open, right } => fence_name::misspelt(open, right),
        Problem::TextOnLine { open, rest, kind } => fence_line::text_on_line(text, open, rest.clone(), kind),
        Problem::Unclosed { open, end, resume, kind } => {
            fence_unclosed::unclosed(text, open, *end, *resume, kind)
        }
        Problem::Missing { object, kind } => fence_missing::missing(text, object, kind),
        Problem::Unseen(open) => fence_unseen::unseen(open),
        Problem::Indented(open) => fence_unseen::indented(open),
    }
}
