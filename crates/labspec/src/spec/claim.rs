//! The parts of a `verify` object: searches, closed forms, quoted numbers, columns of tables, and the modifications of its
//! runs. None of them contains a lab.

use crate::json::Number;
use crate::source::Text;

/// The quantities that a run takes several values of. There is a run for each combination of their values.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The quantities, at least one.
    pub axes: Vec<SweepAxis>,
}

/// A quantity that a run takes several values of.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    /// The label of a control, or an attribute of the model.
    pub what: Text,
    /// The values, in order.
    pub values: Vec<SweepValue>,
    /// Whether the values are drawn at random. Those of a slider are rounded to its steps.
    pub drawn: bool,
}

/// A value of a swept quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum SweepValue {
    /// A number.
    Number(f64),
    /// The text of an option, or of an attribute.
    Text(String),
}

impl std::fmt::Display for SweepValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SweepValue::Number(x) => x.fmt(f),
            SweepValue::Text(text) => text.fmt(f),
        }
    }
}

impl Sweep {
    /// What it changes.
    pub fn subjects(&self) -> impl Iterator<Item = &Text> {
        self.axes.iter().map(|axis| &axis.what)
    }

    /// Number of its runs.
    pub fn count(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).fold(1, usize::saturating_mul)
    }

    /// Whether a measure is a list of the values of all runs. A run with a name of its own has one value of each quantity.
    pub fn is_list(&self) -> bool {
        self.count() > 1
    }

    /// The sweep of a single run: each quantity with its value in the run with this index.
    pub fn member(&self, index: usize) -> Sweep {
        let axes = self.values(index).map(|(axis, value)| SweepAxis {
            what: axis.what.clone(),
            values: vec![value.clone()],
            drawn: axis.drawn,
        });
        Sweep { axes: axes.collect() }
    }

    /// Each axis with its value in the run with this index. The last axis changes fastest.
    pub fn values(&self, index: usize) -> impl Iterator<Item = (&SweepAxis, &SweepValue)> {
        let mut faster = self.count();
        self.axes.iter().filter_map(move |axis| {
            let count = axis.values.len().max(1);
            faster /= count;
            Some((axis, axis.values.get(index / faster.max(1) % count)?))
        })
    }
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
pub const MOST_SWEPT: usize = 100;
/// Maximum number of axes of a sweep.
pub const MOST_AXES: usize = 4;

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
    /// The heading of the column. For a cell that is given by its number, the text in the first cell of its row.
    pub column: Text,
    /// The number of the cell in its row, counted from 0, where it is not given by a heading.
    pub cell: Option<usize>,
    /// The heading of the column that distinguishes the rows, and the list of its numbers.
    pub by: Option<(Text, Text)>,
    /// The text in the first column of the one row that is claimed.
    pub row: Option<Text>,
    /// The content of the cells.
    pub is: ColumnCells,
}

/// The content of the cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnCells {
    /// Numbers: a list of them, or one number for one cell.
    Number(Text),
    /// Words, each with the list of its conditions, or one condition for one cell.
    Words(Vec<(Text, Text)>),
}

impl Column {
    /// Its expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Text> {
        let (number, words) = match &self.is {
            ColumnCells::Number(text) => (Some(text), &[][..]),
            ColumnCells::Words(words) => (None, words.as_slice()),
        };
        self.by.iter().map(|(_, list)| list).chain(number).chain(words.iter().map(|(_, holds)| holds))
    }
}

/// A quote of the text, and the expressions for it.
#[derive(Clone, Debug, PartialEq)]
pub struct QuotedClaim {
    /// The quoted text, such as `0.442 s`.
    pub quote: Text,
    /// The expressions for its numbers, in order; a condition belongs to its words.
    pub exprs: Vec<Text>,
}
