//! The result of a proposal.

use crate::trace::ProposedVerify;
use labspec::verify::Verdict;

/// The result for a question or a lab.
#[derive(Clone, Debug)]
pub enum ScaffoldOutcome {
    /// A proposed object.
    Proposed {
        /// The object.
        verify: ProposedVerify,
        /// The names of the measures in the object, and their values.
        values: Vec<(String, f64)>,
        /// Options, counted from 1, that the runs do not decide.
        undecided: Vec<usize>,
        /// The verdict of a check; `None` for a lab, whose object contains only quotes.
        verdict: Option<(Verdict, String)>,
    },
    /// The runs support another option than the key.
    Contradicted {
        /// The option, from 0.
        option: usize,
        /// The measures and their values.
        values: Vec<(String, f64)>,
    },
    /// Nothing could be proposed, for this reason.
    Open(String),
    /// Only a skeleton: the runs and the measure that the question names, without conditions that hold.
    Skeleton {
        /// Why it is not decided.
        why: String,
        /// The object.
        verify: ProposedVerify,
    },
}

/// Added to the places of the runs of the trace.
pub(super) const OF_TRACE: usize = 1000;
