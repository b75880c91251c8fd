//! What is known of the dimensions in a text, and what its surroundings are known to measure.

use std::collections::BTreeMap;

use crate::dimension::{Dimension, Measure};
use crate::effects::Access;
use crate::types::Type;

use labspec_finding::Span;

/// What is known of the surroundings of a text.
#[derive(Clone, Debug, Default)]
pub struct KnownDimensions {
    /// The variables, by their slots. What is not here was never stored.
    pub variables: BTreeMap<u32, Measure>,
    /// What a control gives.
    pub value: Measure,
}

/// The dimensions in a text.
#[derive(Clone, Debug, Default)]
pub struct TextDimensions {
    /// Of its value.
    pub value: Measure,
    /// Of every variable that it stores.
    pub variables: BTreeMap<u32, Measure>,
    /// Of what it stores in fields.
    pub stores: Vec<DimensionStore>,
    /// Sums and comparisons of what cannot be added or compared.
    pub clashes: Vec<DimensionClash>,
}

/// A number that is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionStore {
    /// Where to.
    pub access: Access,
    /// What it is.
    pub measure: Measure,
    /// Where this stands.
    pub span: Span,
}

/// Two quantities of different dimensions that are added or compared.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionClash {
    /// Where.
    pub span: Span,
    /// The one.
    pub left: Dimension,
    /// The other.
    pub right: Dimension,
}

/// What the aggregates of a text give, by their slots.
pub(crate) type Aggregates = BTreeMap<usize, Measure>;

impl TextDimensions {
    /// A text whose value is a truth value measures nothing.
    pub(crate) fn of_type(self, result: Type) -> TextDimensions {
        match result {
            Type::Boolean | Type::Void => TextDimensions { value: Measure::NUMBER, ..self },
            Type::String => TextDimensions { value: Measure::Unknown, ..self },
            _ => self,
        }
    }
}
