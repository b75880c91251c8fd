//! The results of the dimension analysis, and its inputs from outside the program.

use std::collections::BTreeMap;

use crate::dimension::{Dimension, Measure};
use crate::effects::Access;
use crate::types::Type;

use labspec_finding::Span;

/// Known measures of names that are defined outside the program.
#[derive(Clone, Debug, Default)]
pub struct KnownDimensions {
    /// Measures of the variables, by slot. A variable that is missing here was never stored.
    pub variables: BTreeMap<u32, Measure>,
    /// The measure of `value`, which a control supplies.
    pub value: Measure,
}

/// The dimensions in a program.
#[derive(Clone, Debug, Default)]
pub struct TextDimensions {
    /// The measure of the result.
    pub value: Measure,
    /// The measures of all variables that the program stores.
    pub variables: BTreeMap<u32, Measure>,
    /// The measures of the numbers that the program stores in fields.
    pub stores: Vec<DimensionStore>,
    /// Additions and comparisons of quantities with different dimensions.
    pub clashes: Vec<DimensionClash>,
    /// The arguments of functions that take an angle in radians.
    pub angles: Vec<AngleArgument>,
}

/// The argument of a function that takes an angle in radians, as `Math.sin`.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleArgument {
    /// The location of the call.
    pub span: Span,
    /// The function.
    pub function: String,
    /// The measure of the argument.
    pub measure: Measure,
}

/// A number that is stored in a field.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionStore {
    /// The elements that are written.
    pub access: Access,
    /// The measure of the number.
    pub measure: Measure,
    /// The location of the assignment.
    pub span: Span,
}

/// Two quantities of different dimensions that are added or compared.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionClash {
    /// The location of the operation.
    pub span: Span,
    /// The dimension of the left operand.
    pub left: Dimension,
    /// The dimension of the right operand.
    pub right: Dimension,
}

/// The measures of the aggregates of a program, by slot.
pub(crate) type Aggregates = BTreeMap<usize, Measure>;

impl TextDimensions {
    /// The same dimensions for a result of type `result`: a boolean is dimensionless, and the measure of a string is
    /// unknown.
    pub(crate) fn of_type(self, result: Type) -> TextDimensions {
        match result {
            Type::Boolean | Type::Void => TextDimensions { value: Measure::NUMBER, ..self },
            Type::String => TextDimensions { value: Measure::Unknown, ..self },
            _ => self,
        }
    }
}
