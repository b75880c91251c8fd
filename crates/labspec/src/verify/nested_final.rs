//! Finds `final` in the arguments of other aggregates, where it is the value of the current sample.

use super::aggregate::AggregateKind;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_expr::{Aggregate, Program};

/// The findings about a measure.
pub(super) fn nested_finals(program: &Program, text: &Text) -> Vec<Finding> {
    let inner = program.aggregates().iter().flat_map(|outer| &outer.args).flat_map(Program::aggregates);
    let is_final = |one: &&Aggregate| AggregateKind::of_aggregate(one) == Some(AggregateKind::Final);
    let one = |found: &Aggregate| {
        let part = text.value.get(found.span.start..found.span.end).unwrap_or("final(…)").to_string();
        Finding::new(
            rules::NESTED_FINAL,
            text.span_of(found.span.into()),
            format!(
                "`{part}` inside another aggregate is the value of the current sample, not of the last one"
            ),
        )
        .help(
            "write the value of the end as a number, or as a measure of its own that the condition compares",
        )
    };
    inner.filter(is_final).map(one).collect()
}
