//! Reads the parts of a `verify` object that contain no lab.

use super::claim::{
    Change, Column, ColumnCells, Exact, Find, MOST_AXES, MOST_SWEPT, QuotedClaim, Sweep, SweepAxis,
    SweepValue,
};
use super::fields::Fields;
use super::format::{CLOSED_FORM, COLUMN, FIND, SPAN};
use super::lab::BreakExpectation;
use super::problem::{Mistake, Problem};
use super::read;
use crate::json::read::shorten;
use crate::json::{Json, Member, Node, Number, Scalar};
use crate::source::Text;

/// A change of the model. Several numbers are given as a list.
pub(super) fn read_change(member: &Member, problems: &mut Vec<Problem>) -> Option<Change> {
    let what = "the value of an attribute";
    let value = match &member.value.json {
        Json::Array(items) => {
            let numbers = items.iter().map(|n| read::number(n, what, problems).map(|n| n.value.to_string()));
            numbers.collect::<Option<Vec<_>>>()?.join(" ")
        }
        _ => match read::scalar(&member.value, what, problems)? {
            Scalar::Number(n) => n.value.to_string(),
            Scalar::Text(t) => t.value,
            Scalar::Bool(b, _) => b.to_string(),
        },
    };
    Some(Change { path: member.key.clone(), value })
}

/// The axes of a sweep.
pub(super) fn read_sweep(node: &Node, problems: &mut Vec<Problem>) -> Option<Sweep> {
    let members = node.members();
    if !(1..=MOST_AXES).contains(&members.len()) {
        if !node.is_broken() {
            problems.push(Mistake::NoSweep.at(node.span.clone()));
        }
        return None;
    }
    let axes: Vec<SweepAxis> =
        members.iter().map(|member| read_axis(member, problems)).collect::<Option<_>>()?;
    let sweep = Sweep { axes };
    if sweep.count() > MOST_SWEPT {
        problems.push(Mistake::SweptValues(sweep.count()).at(node.span.clone()));
        return None;
    }
    Some(sweep)
}

/// The parameter of a sweep and its values: a list, or a number of values between two ends, equidistant or drawn at random.
fn read_axis(member: &Member, problems: &mut Vec<Problem>) -> Option<SweepAxis> {
    let mut drawn = false;
    let values: Vec<SweepValue> = match &member.value.json {
        Json::Array(items) => {
            let value = |n: &Node, problems: &mut Vec<Problem>| match &n.json {
                Json::Text(text) => Some(SweepValue::Text(text.value.clone())),
                _ => Some(SweepValue::Number(read::number(n, "a value of a sweep", problems)?.value)),
            };
            items.iter().map(|n| value(n, problems)).collect::<Option<_>>()?
        }
        _ => {
            let mut fields = Fields::open(&member.value, &SPAN, problems)?;
            let [from, to] = ["from", "to"].map(|key| fields.number(key));
            let [count, seed] = ["count", "seed"].map(|key| fields.whole(key));
            fields.finish();
            let ([from, to], count) = ([from?.value, to?.value], count?.value.clamp(0.0, 1e6) as usize);
            let part = |i: usize| i as f64 / count.saturating_sub(1).max(1) as f64;
            drawn = seed.is_some();
            let mut draw = seed.map(|seed| random_parts(seed.value));
            let parts = (0..count.min(MOST_SWEPT + 1)).map(|i| draw.as_mut().map_or(part(i), |draw| draw()));
            parts.map(|part| SweepValue::Number(from + (to - from) * part)).collect()
        }
    };
    if !(2..=MOST_SWEPT).contains(&values.len()) {
        problems.push(Mistake::SweptValues(values.len()).at(member.value.span.clone()));
        return None;
    }
    Some(SweepAxis { what: member.key.clone(), values, drawn })
}

/// A generator of numbers from 0 to 1, the same for every seed everywhere (SplitMix64: Steele, Lea, Flood 2014).
fn random_parts(seed: f64) -> impl FnMut() -> f64 {
    let mut state = seed.to_bits();
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// The range of a slider over which the answer must hold.
pub(super) fn read_over(member: &Member, problems: &mut Vec<Problem>) -> Option<(Text, [f64; 2])> {
    if member.value.is_broken() {
        return None;
    }
    if let Json::Array(items) = &member.value.json
        && let [low, high] = items.as_slice()
    {
        let [low, high] = [low, high].map(|n| read::number(n, "an end of the range", problems));
        let ends = [low?.value, high?.value];
        if ends[0] < ends[1] {
            return Some((member.key.clone(), ends));
        }
    }
    problems.push(Mistake::NoRange.at(member.value.span.clone()));
    None
}

/// A value determined by a search.
pub(super) fn read_find(member: &Member, problems: &mut Vec<Problem>) -> Option<Find> {
    let mut fields = Fields::open(&member.value, &FIND, problems)?;
    let f = &mut fields;
    let ends = [f.text("largest"), f.text("smallest")];
    let [from, to, tol] = ["from", "to", "tol"].map(|key| f.number(key));
    let (run, holds) = (f.text("run"), f.text("while"));
    let largest = ends[0].is_some();
    let what = match ends {
        [Some(what), None] | [None, Some(what)] => Some(what),
        _ => {
            let mistake = Mistake::FindsNothing.at(f.span());
            f.problems.push(mistake);
            None
        }
    };
    let range = from.zip(to).map(|(from, to)| [from.value, to.value]);
    if let Some([from, to]) = range
        && from >= to
    {
        let mistake = Mistake::FindsBackwards.at(f.span());
        f.problems.push(mistake);
        return None;
    }
    fields.finish();
    let name = member.key.clone();
    Some(Find { name, largest, what: what?, range: range?, run, holds: holds?, tol: tol? })
}

/// Whether the run is expected to break.
pub(super) fn read_expectation(text: &Text, problems: &mut Vec<Problem>) -> BreakExpectation {
    match text.as_str() {
        "breaks" => BreakExpectation::Breaks,
        "may break" => BreakExpectation::MayBreak,
        _ => {
            problems.push(Mistake::RunExpects(text.value.clone()).at(text.span()));
            BreakExpectation::None
        }
    }
}

/// The closed form of a trace: an expression, or an object with a tolerance.
pub(super) fn read_exact(member: &Member, problems: &mut Vec<Problem>) -> Option<Exact> {
    let trace = member.key.clone();
    if !matches!(member.value.json, Json::Object(_)) {
        let form = read::text(&member.value, &shorten(&trace.value), problems)?;
        return Some(Exact { trace, form, tol: None });
    }
    let mut fields = Fields::open(&member.value, &CLOSED_FORM, problems)?;
    let form = fields.text("is");
    let tol = fields.number("tol");
    fields.finish();
    Some(Exact { trace, form: form?, tol })
}

pub(super) fn read_press(node: &Node, problems: &mut Vec<Problem>) -> Option<(Text, Number)> {
    if node.is_broken() {
        return None;
    }
    if let Json::Array(pair) = &node.json
        && let [label, time] = pair.as_slice()
    {
        let label = read::text(label, "the label of a button", problems);
        let time = read::number(time, "the time of a press", problems);
        return Some((label?, time?));
    }
    problems.push(Mistake::NoPress.at(node.span.clone()));
    None
}

/// Reads the entries of `says`. A single entry that is not in a list of its own is one mistake.
pub(super) fn read_all_says(nodes: &[Node], problems: &mut Vec<Problem>) -> Vec<QuotedClaim> {
    if let [Node { json: Json::Text(quote), span }, Node { json: Json::Text(expression), span: last }] = nodes
    {
        let texts = [quote.value.clone(), expression.value.clone()];
        problems.push(Mistake::QuoteWithoutList(texts).at(span.start..last.end));
        return Vec::new();
    }
    nodes.iter().filter_map(|node| read_says(node, problems)).collect()
}

fn read_says(node: &Node, problems: &mut Vec<Problem>) -> Option<QuotedClaim> {
    if node.is_broken() {
        return None;
    }
    if let Json::Array(pair) = &node.json
        && let [quote, expr] = pair.as_slice()
    {
        let quote = read::text(quote, "a quoted number", problems);
        let mut expression = |node: &Node| read::text(node, "the expression of a quoted number", problems);
        let exprs = match &expr.json {
            Json::Array(items) if !items.is_empty() => items.iter().map(&mut expression).collect(),
            _ => expression(expr).map(|one| vec![one]),
        };
        return Some(QuotedClaim { quote: quote?, exprs: exprs? });
    }
    problems.push(Mistake::NoQuote.at(node.span.clone()));
    None
}

/// The heading of the column that distinguishes the rows, and the list of its values.
fn read_row_keys(node: &Node, problems: &mut Vec<Problem>) -> Option<(Text, Text)> {
    if let Json::Array(pair) = &node.json
        && let [heading, list] = pair.as_slice()
    {
        let heading = read::text(heading, "a heading", problems);
        let list = read::text(list, "the list of its values", problems);
        return Some((heading?, list?));
    }
    if !node.is_broken() {
        problems.push(Mistake::NoQuote.at(node.span.clone()));
    }
    None
}

/// The contents of cells: numbers, or words with the condition for each.
fn read_cells(node: &Node, problems: &mut Vec<Problem>) -> Option<ColumnCells> {
    let text = |node: &Node, problems: &mut Vec<Problem>| read::text(node, "what the cells state", problems);
    match &node.json {
        Json::Object(members) => {
            let one = |m: &Member| Some((m.key.clone(), text(&m.value, problems)?));
            members.iter().map(one).collect::<Option<_>>().map(ColumnCells::Words)
        }
        _ => text(node, problems).map(ColumnCells::Number),
    }
}

/// Columns of a table, or cells of a row: those of one entry.
pub(super) fn read_columns(node: &Node, problems: &mut Vec<Problem>) -> Option<Vec<Column>> {
    let mut fields = Fields::open(node, &COLUMN, problems)?;
    let f = &mut fields;
    let (column, row) = (f.text("column"), f.text("row"));
    let columns = f.map("columns");
    let is = f.node("is");
    let by = f.node("by").and_then(|n| read_row_keys(n, f.problems));
    let of = |column: Text, cell: Option<usize>, is: ColumnCells| {
        let (by, row) = (by.clone(), row.clone());
        Column { column, cell, by, row, is }
    };
    let mut all = Vec::new();
    match (&column, columns, is.map(|n| &n.json)) {
        (Some(column), [], Some(_)) => {
            all.extend(is.and_then(|n| read_cells(n, f.problems)).map(|is| of(column.clone(), None, is)));
        }
        (None, [], Some(Json::Array(cells))) if row.is_some() => {
            for (i, cell) in cells.iter().enumerate().filter(|(_, cell)| cell.json != Json::Null) {
                all.extend(
                    read_cells(cell, f.problems).zip(row.clone()).map(|(is, row)| of(row, Some(i + 1), is)),
                );
            }
        }
        (None, [_, ..], None) => {
            for member in columns {
                all.extend(read_cells(&member.value, f.problems).map(|is| of(member.key.clone(), None, is)));
            }
        }
        _ => {
            let mistake = Mistake::NoColumn.at(f.span());
            f.problems.push(mistake);
        }
    }
    if by.is_some() == row.is_some() {
        let mistake = Mistake::NoRows.at(f.span());
        f.problems.push(mistake);
        all.clear();
    }
    fields.finish();
    Some(all)
}

pub(super) fn read_measures(fields: &mut Fields<'_, '_>, key: &'static str) -> Vec<(Text, Text)> {
    let mut all = Vec::new();
    for member in fields.map(key) {
        if let Some(text) = read::text(&member.value, &shorten(&member.key.value), fields.problems) {
            all.push((member.key.clone(), text));
        }
    }
    all
}
