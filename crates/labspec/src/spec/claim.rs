//! The parts of a `verify` object: searches, closed forms, quoted numbers, columns of tables, and the modifications of its
//! runs. None of them contains a lab.

use crate::json::Number;
use crate::source::Text;

/// A quantity that a run takes several values of.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The label of a control, or an attribute of the model.
    pub what: Text,
    /// The values, in order.
    pub values: Vec<f64>,
}

/// A search for the largest or the smallest value for which a condition holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Find {
    /// Its name, which is read like a measure.
    pub name: Text,
    /// Whether the largest value is searched.
    pub largest: bool,
    /// The label of a control, an attribute of the model, or `timestep`.
    pub what: Text,
    /// The smallest and the largest tested value.
    pub range: [f64; 2],
    /// The name of the run; `None` for the only one.
    pub run: Option<Text>,
    /// The condition.
    pub holds: Text,
    /// Maximum distance of the found value from the true one.
    pub tol: Number,
}

/// Maximum number of runs of a sweep.
pub const MOST_SWEPT: usize = 50;

/// A modification of a model: an attribute of an element, and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Kind, name and attribute: `geom ball friction`.
    pub path: Text,
    /// The attribute value in MJCF.
    pub value: String,
}

/// A closed form of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    /// Label of the trace.
    pub trace: Text,
    /// The closed form, in the language of the lab.
    pub form: Text,
    /// Maximum distance of the trace from it, in the unit of the trace; `None` to decide by convergence.
    pub tol: Option<Number>,
}

/// A column of a table, or one cell of it, and the expressions for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The heading of the column.
    pub column: Text,
    /// The heading of the column that distinguishes the rows, and the list of its numbers.
    pub by: Option<(Text, Text)>,
    /// The text in the first column of the one row that is claimed.
    pub row: Option<Text>,
    /// The content of the cells.
    pub is: Stands,
}

/// The content of the cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Stands {
    /// Numbers: a list of them, or one number for one cell.
    Number(Text),
    /// Words, each with the list of its conditions, or one condition for one cell.
    Words(Vec<(Text, Text)>),
}

impl Column {
    /// Its expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Text> {
        let (number, words) = match &self.is {
            Stands::Number(text) => (Some(text), &[][..]),
            Stands::Words(words) => (None, words.as_slice()),
        };
        self.by.iter().map(|(_, list)| list).chain(number).chain(words.iter().map(|(_, holds)| holds))
    }
}

/// A quote of the text, and the expressions for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// The quoted text, such as `0.442 s`.
    pub quote: Text,
    /// The expressions for its numbers, in order; a condition belongs to its words.
    pub exprs: Vec<Text>,
}
