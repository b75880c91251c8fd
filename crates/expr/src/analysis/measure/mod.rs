//! Which dimension every number of a text has, as far as it is certain, read off its form.
//!
//! Numbers of the text may stand for quantities of any dimension; what cannot be known is unknown. A list and a record have the
//! dimension that all of their elements have, a text that of the number which it was made from.
//!
//! | piece | module |
//! |---|---|
//! | one function: its blocks again and again, until nothing changes; calls of others | `flow` |
//! | one operation | `operation` |
//! | what methods and free functions hand on | `natives` |

mod flow;
mod natives;
mod operation;

use std::cell::Cell;
use std::collections::BTreeMap;

use crate::dimension::{Dimension, Measure};
use crate::effects::Access;
use crate::schema::Schema;
use crate::ssa::SsaProgram;
use crate::types::Type;

use flow::{Around, Work};
use labspec_finding::Span;

/// What is known of the surroundings of a text.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// The variables, by their slots. What is not here was never stored.
    pub variables: BTreeMap<u32, Measure>,
    /// What a control gives.
    pub value: Measure,
}

/// The dimensions in a text.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Of its value.
    pub value: Measure,
    /// Of every variable that it stores.
    pub variables: BTreeMap<u32, Measure>,
    /// Of what it stores in fields.
    pub stores: Vec<Stored>,
    /// Sums and comparisons of what cannot be added or compared.
    pub clashes: Vec<Clash>,
}

/// A number that is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// Where to.
    pub access: Access,
    /// What it is.
    pub measure: Measure,
    /// Where this stands.
    pub span: Span,
}

/// Two quantities of different dimensions that are added or compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Clash {
    /// Where.
    pub span: Span,
    /// The one.
    pub left: Dimension,
    /// The other.
    pub right: Dimension,
}

/// What the aggregates of a text give, by their slots.
pub(crate) type Aggregates = BTreeMap<usize, Measure>;

/// The dimensions in a text.
pub(crate) fn measured(
    form: &SsaProgram,
    schema: &dyn Schema,
    given: &Given,
    aggregates: &Aggregates,
) -> Measured {
    let around = Around { form, schema, given, aggregates, left: Cell::new(flow::MOST) };
    let mut all = Measured::default();
    for (id, unit) in form.units.iter().enumerate() {
        let mut work = Work::new(&around, id as u32, unit);
        work.look();
        let found = work.found;
        if id == 0 {
            all.value = found.value;
        }
        for (slot, measure) in found.variables {
            let known = all.variables.entry(slot).or_insert(Measure::Anything);
            *known = known.or(measure);
        }
        all.stores.extend(found.stores);
        all.clashes.extend(found.clashes);
    }
    all
}

impl Measured {
    /// A text whose value is a truth value measures nothing.
    pub(crate) fn of_type(self, result: Type) -> Measured {
        match result {
            Type::Boolean | Type::Void => Measured { value: Measure::NUMBER, ..self },
            Type::String => Measured { value: Measure::Unknown, ..self },
            _ => self,
        }
    }
}
