//! The findings about invalid JSON, from the pages of the rules. `json/` detects the errors and determines the repairs.

use crate::finding::Finding;
use crate::json::{Mistake, Problem};
use crate::rules::{duplicate_key, json_limit, json_syntax, typographic_quote};

/// The finding about invalid JSON.
pub(crate) fn to_finding(problem: &Problem) -> Finding {
    let (span, related) = (problem.span.clone(), problem.related.clone());
    let finding = match &problem.mistake {
        Mistake::TooDeep => json_limit::too_deep(span),
        Mistake::TooMany => json_limit::too_many(span),
        Mistake::Twice(key) => duplicate_key::duplicate(span, key, related),
        Mistake::Typographic(count) => typographic_quote::quotes_of_json(span, *count, related),
        _ => json_syntax::describe_problem(problem),
    };
    match &problem.repair {
        Some((span, text)) => finding.fix(span.clone(), text.clone()),
        None => finding,
    }
}
