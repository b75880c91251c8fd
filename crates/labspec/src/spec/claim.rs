//! What a `verify` object claims, part by part: values that are searched for, closed forms, quoted numbers, columns of tables; and what
//! its runs change. None of these holds a lab.

use crate::json::Number;
use crate::source::Text;

/// What a run is made with several values of.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The label of a control, or an attribute of the model.
    pub what: Text,
    /// The values, in order.
    pub values: Vec<f64>,
}

/// A value that is searched for: the largest or the smallest one with which a condition holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Find {
    /// Its name, by which it is read like a measure.
    pub name: Text,
    /// The largest one is wanted.
    pub largest: bool,
    /// The label of a control, an attribute of the model, or `timestep`.
    pub what: Text,
    /// The smallest and the largest value that are tried.
    pub range: [f64; 2],
    /// The run; `None` for the only one.
    pub run: Option<Text>,
    /// The condition.
    pub holds: Text,
    /// How near the found value is to the true one.
    pub tol: Number,
}

/// Most runs of a sweep.
pub const MOST_SWEPT: usize = 50;

/// A change of a model: an attribute of an element, and what stands in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Kind, name and attribute: `geom ball friction`.
    pub path: Text,
    /// The attribute as a model's text has it.
    pub value: String,
}

/// A closed form of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    /// Label of the trace.
    pub trace: Text,
    /// The closed form, in the language of the lab.
    pub form: Text,
    /// How far the trace may be from it at most, in the trace's unit; `None` to judge by convergence.
    pub tol: Option<Number>,
}

/// A column of a table, or one cell of it, and where its numbers come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The heading of the column.
    pub column: Text,
    /// The heading of the column that tells the rows apart, and the list of its numbers.
    pub by: Option<(Text, Text)>,
    /// What stands in the first column of the one row that is meant.
    pub row: Option<Text>,
    /// What stands in the cells.
    pub is: Stands,
}

/// What stands in the cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Stands {
    /// Numbers: a list of them, or one for one cell.
    Number(Text),
    /// Words, each with the list of what must hold for it, or one condition for one cell.
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

/// What the text says and where that comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// The quoted text, such as `0.442 s`.
    pub quote: Text,
    /// The expressions whose values it states, in the order of its numbers; a condition is what its words say.
    pub exprs: Vec<Text>,
}
