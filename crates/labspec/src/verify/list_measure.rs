//! Measures of whole arrays. A measure that names an array, `final(data.qpos)`, or that is a list, `[max(x), min(x)]`, has one
//! element for each element of the array. Each is a measure of its own: the text with the index of the element,
//! `final(data.qpos[3])`. The elements of a matrix follow each other row by row, as in the engine.

use crate::source::{SourceMap, Text};
use labspec_expr::{Compiled, rules};
use std::ops::Range;

/// Maximum number of elements of a measure, and of the lists of one object together.
const MAX_ELEMENTS: usize = 400;
pub(super) const MAX_OF_OBJECT: usize = 4000;
/// Maximum number of arrays that a measure names.
const MAX_ARRAYS: usize = 8;

/// What the elements of a list need from the language and the lab.
pub(super) trait ArrayLanguage {
    /// Compiles an expression.
    fn compile(&mut self, text: &Text) -> Option<Compiled>;
    /// The number that an expression has in the initial state of the lab.
    fn number(&mut self, text: &Text) -> Option<f64>;
}

/// The texts of the elements of a measure that the language has refused as a whole array; `None` if its arrays have no common
/// length, or fewer than two elements.
pub(super) fn elements(text: &Text, language: &mut dyn ArrayLanguage) -> Option<Vec<Text>> {
    let mut arrays: Vec<Range<usize>> = Vec::new();
    let mut shape: Option<Shape> = None;
    for _ in 0..=MAX_ARRAYS {
        let index = shape.map_or(String::new(), |shape| shape.index(0));
        let (element, origin) = with_index(text, &arrays, &index);
        let compiled = language.compile(&element)?;
        let Some(array) = refused_array(&compiled) else {
            compiled.program?;
            let shape = shape?;
            return Some((0..shape.count()).map(|i| with_index(text, &arrays, &shape.index(i)).0).collect());
        };
        let array = origin.span(array);
        if arrays.iter().any(|other| other.start < array.end && array.start < other.end) {
            return None;
        }
        let of_array = Shape::from_array(text, &array, language)?;
        if *shape.get_or_insert(of_array) != of_array {
            return None;
        }
        arrays.push(array);
        arrays.sort_by_key(|array| array.start);
    }
    None
}

/// The shape of an array.
#[derive(Clone, Copy, PartialEq)]
struct Shape {
    rows: usize,
    /// The length of each row of a matrix.
    columns: Option<usize>,
}

impl Shape {
    /// The shape of an array in a text; `None` if it has fewer than two elements, too many, or rows of different lengths.
    fn from_array(text: &Text, array: &Range<usize>, language: &mut dyn ArrayLanguage) -> Option<Shape> {
        let code = text.value.get(array.clone())?;
        let mut length = |behind: &str| -> Option<usize> {
            let value = format!("({code}){behind}.length");
            let map = SourceMap::whole(value.len(), text.map.span(array.clone()));
            let length = language.number(&Text { value, map })?;
            (length >= 1.0 && length <= MAX_ELEMENTS as f64).then_some(length as usize)
        };
        let rows = length("")?;
        let columns = length("[0]");
        if columns.is_some() && (1..rows).any(|row| length(&format!("[{row}]")) != columns) {
            return None;
        }
        let shape = Shape { rows, columns };
        (2..=MAX_ELEMENTS).contains(&shape.count()).then_some(shape)
    }

    fn count(self) -> usize {
        self.rows * self.columns.unwrap_or(1)
    }

    /// The index of an element: `[3]`, or `[1][0]` for a matrix.
    fn index(self, element: usize) -> String {
        match self.columns {
            None => format!("[{element}]"),
            Some(columns) => format!("[{}][{}]", element / columns, element % columns),
        }
    }
}

/// The array that an expression names where a number must stand.
fn refused_array(compiled: &Compiled) -> Option<Range<usize>> {
    let mut errors = compiled.diagnostics.iter().filter(|finding| finding.is_error());
    errors.find(|finding| finding.code == rules::WHOLE_ARRAY.code).map(|finding| finding.span.clone())
}

/// The text with an index behind each array, and the map from it to the text.
fn with_index(text: &Text, arrays: &[Range<usize>], index: &str) -> (Text, SourceMap) {
    let (mut value, mut origin, mut offset) = (String::new(), SourceMap::default(), 0);
    let insert = |value: &mut String, origin: &mut SourceMap, piece: &str, offset: usize| {
        value.push_str(piece);
        origin.push_whole(piece.len(), offset..offset);
    };
    let copy = |value: &mut String, origin: &mut SourceMap, range: Range<usize>| {
        value.push_str(text.value.get(range.clone()).unwrap_or(""));
        origin.push_verbatim(range);
    };
    for array in arrays {
        copy(&mut value, &mut origin, offset..array.start);
        let is_plain = text.value.get(array.clone()).is_some_and(is_plain);
        let [open, close] = if is_plain { ["", ""] } else { ["(", ")"] };
        insert(&mut value, &mut origin, open, array.start);
        copy(&mut value, &mut origin, array.clone());
        insert(&mut value, &mut origin, &format!("{close}{index}"), array.end);
        offset = array.end;
    }
    copy(&mut value, &mut origin, offset..text.value.len());
    let map = origin.then(&text.map);
    (Text { value, map }, origin)
}

/// Whether an index can follow an expression without parentheses around it, as `data.qpos`.
fn is_plain(array: &str) -> bool {
    array.chars().all(|c| c.is_alphanumeric() || "._$()'\"".contains(c))
}

/// The name of an element of a measure.
pub(super) fn element_name(name: &str, index: usize) -> String {
    format!("{name}[{index}]")
}

/// The name of the measure to which a measure with this name belongs, and its index there.
pub(super) fn measure_of_element(name: &str) -> Option<(&str, usize)> {
    let (name, index) = name.strip_suffix(']')?.rsplit_once('[')?;
    Some((name, index.parse().ok()?))
}
