//! Writes tables of samples as JSON and as comma-separated values, row by row: a table of millions of rows is never copied
//! completely.
//!
//! Every number is written so that reading it gives the same bits. A column of JSON has values of one type. For a number
//! that JSON cannot represent it has `null`, and the list `nonfinite` contains the number.

use super::SCHEMA_VERSION;
#[cfg(feature = "report")]
use super::nonfinite::NonfiniteName;
use super::nonfinite::nonfinite;
use crate::printable::printable_json;
use crate::run::{Cell, Table};
use labspec_expr::Value;
use serde::{Serialize, Serializer};
use serde_json::ser::Formatter;
#[cfg(feature = "report")]
use std::collections::BTreeMap;
use std::io::{self, Write};
#[cfg(feature = "report")]
use std::num::NonZeroUsize;

/// The type of the cells of a column, ignoring empty ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
enum CellType {
    Number,
    Boolean,
    /// Texts, or values of several types, which are written as texts.
    Text,
}

impl CellType {
    /// The type of a cell; `None` for an empty cell.
    fn of_cell(cell: &Cell) -> Option<CellType> {
        match cell {
            Cell::Number(_) => Some(CellType::Number),
            Cell::Bool(_) => Some(CellType::Boolean),
            Cell::Text(_) => Some(CellType::Text),
            Cell::Nothing => None,
        }
    }
}

/// The types of all columns. An empty column is a column of missing numbers.
fn types(table: &Table) -> Vec<CellType> {
    let mut types: Vec<Option<CellType>> = vec![None; table.columns.len()];
    for row in &table.rows {
        for (column_type, cell) in types.iter_mut().zip(row) {
            *column_type = match (*column_type, CellType::of_cell(cell)) {
                (Some(a), Some(b)) if a != b => Some(CellType::Text),
                (a, b) => a.or(b),
            };
        }
    }
    types.into_iter().map(|t| t.unwrap_or(CellType::Number)).collect()
}

/// A number as text, in the format of JavaScript, except that `-0` keeps its sign.
pub fn number_in_table(x: f64) -> String {
    if x == 0.0 && x.is_sign_negative() { "-0".into() } else { Value::Number(x).to_string() }
}

/// The samples of a run: one row for each sample, one column for time, every trace and every readout.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
pub struct TableReport<'t, R: Serialize, N: Serialize> {
    schema_version: u32,
    report: &'t str,
    /// The program that wrote it.
    version: &'t str,
    /// The length of a step in seconds, at the end of the run.
    #[cfg_attr(feature = "report", schemars(with = "Option<f64>"))]
    timestep: f64,
    /// Names of the columns: `time`, `plot/0/LABEL` of the first plot, …, `readout/LABEL`.
    columns: &'t [String],
    /// What each column holds besides null. Values of several types in one column are written as texts.
    types: &'t [CellType],
    // Written without copying them.
    /// The samples. An entry is null where an expression gave nothing or threw, and where a number is none (see `nonfinite`).
    #[cfg_attr(feature = "report", schemars(with = "Vec<Vec<WrittenCell>>"))]
    rows: R,
    /// Warnings of the engine since its last reset, by MuJoCo's name, with how often each was raised.
    #[serde(serialize_with = "as_object")]
    #[cfg_attr(feature = "report", schemars(with = "BTreeMap<String, NonZeroUsize>"))]
    warnings: &'t [(&'t str, usize)],
    /// What threw, and why a run ended early.
    errors: &'t [String],
    /// The worst that broke; null when nothing did.
    breakdown: Option<&'t BreakdownRow<'t>>,
    /// Everything that broke, the worst first.
    breakdowns: &'t [BreakdownRow<'t>],
    /// What those numbers are that are null. Absent when every number is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "report", schemars(with = "NonfiniteCells<'t, N>"))]
    nonfinite: Option<NonfiniteCells<'t, N>>,
}

/// The report `run`, as the type that its schema is derived from.
#[cfg(feature = "report")]
pub type RunReport = TableReport<'static, (), ()>;

/// What broke.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
struct BreakdownRow<'t> {
    /// The code of the finding.
    code: &'t str,
    /// What is no number, what grows, passes or sinks, and when.
    what: &'t str,
    /// What the page shows.
    why: &'t str,
    /// The likely cause and what to change.
    help: String,
}

/// The numbers that JSON cannot represent.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
struct NonfiniteCells<'t, N: Serialize> {
    /// The name of the timestep.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "report", schemars(with = "NonfiniteName"))]
    timestep: Option<&'t str>,
    /// Row, column (both from 0) and what the number there was.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "report", schemars(with = "Vec<(usize, usize, NonfiniteName)>"))]
    rows: Option<N>,
}

/// A cell as it is written.
#[cfg(feature = "report")]
struct WrittenCell;

#[cfg(feature = "report")]
impl schemars::JsonSchema for WrittenCell {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "cell".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"type": ["number", "boolean", "string", "null"]})
    }
}

/// A list that is generated while it is written.
struct Sequence<F>(F);

impl<I: Iterator<Item: Serialize>, F: Fn() -> I> Serialize for Sequence<F> {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.collect_seq((self.0)())
    }
}

fn cells_of<'t>(row: &'t [Cell], types: &'t [CellType]) -> impl Serialize {
    Sequence(move || row.iter().zip(types).map(|(cell, cell_type)| TypedCell(cell, *cell_type)))
}

struct TypedCell<'t>(&'t Cell, CellType);

impl Serialize for TypedCell<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        match self {
            TypedCell(Cell::Number(x), CellType::Text) => out.serialize_str(&number_in_table(*x)),
            TypedCell(Cell::Bool(b), CellType::Text) => out.collect_str(b),
            TypedCell(Cell::Number(x), _) => out.serialize_f64(*x),
            TypedCell(Cell::Text(text), _) => out.serialize_str(text),
            TypedCell(Cell::Bool(b), _) => out.serialize_bool(*b),
            TypedCell(Cell::Nothing, _) => out.serialize_none(),
        }
    }
}

/// Row, column and name of every number that JSON cannot represent, in columns of numbers.
fn nonfinite_cells<'t>(
    rows: &'t [Vec<Cell>],
    types: &'t [CellType],
) -> impl Iterator<Item = (usize, usize, &'static str)> {
    rows.iter().enumerate().flat_map(move |(row, cells)| {
        cells.iter().zip(types).enumerate().filter_map(move |(column, (cell, cell_type))| match cell {
            Cell::Number(x) if *cell_type == CellType::Number => Some((row, column, nonfinite(*x)?)),
            _ => None,
        })
    })
}

fn as_object<S: Serializer>(pairs: &[(&str, usize)], out: S) -> Result<S::Ok, S::Error> {
    out.collect_map(pairs.iter().copied())
}

/// Formats JSON with control characters of terminals written as escapes.
struct Printable;

impl Formatter for Printable {
    fn write_string_fragment<W: Write + ?Sized>(&mut self, out: &mut W, text: &str) -> io::Result<()> {
        out.write_all(printable_json(text).as_bytes())
    }
}

impl Table {
    /// Writes the report `run`, in the layout of the reference runner: columns, rows, warnings, errors, and breakdowns.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let types = types(self);
        let timestep = nonfinite(self.timestep);
        let cells = || nonfinite_cells(&self.rows, &types);
        let cells = cells().next().is_some().then_some(Sequence(cells));
        let breakdowns: Vec<BreakdownRow<'_>> = (self.breakdowns.iter())
            .map(|b| BreakdownRow { code: b.rule.code, what: &b.what, why: b.why, help: b.help() })
            .collect();
        let report = TableReport {
            schema_version: SCHEMA_VERSION,
            report: "run",
            version: concat!("labspec ", env!("CARGO_PKG_VERSION")),
            timestep: self.timestep,
            columns: &self.columns,
            types: &types,
            rows: Sequence(|| self.rows.iter().map(|row| cells_of(row, &types))),
            warnings: &self.warnings,
            errors: &self.errors,
            breakdown: breakdowns.first(),
            breakdowns: &breakdowns,
            nonfinite: (timestep.is_some() || cells.is_some())
                .then_some(NonfiniteCells { timestep, rows: cells }),
        };
        Ok(report.serialize(&mut serde_json::Serializer::with_formatter(out, Printable))?)
    }

    /// Writes comma-separated values with a header. Nonfinite numbers are `NaN`, `Infinity` and `-Infinity`; an empty cell
    /// is an empty field.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write_csv_line(&self.columns, out, |name, out| write_csv_text(name, out))?;
        self.rows.iter().try_for_each(|row| {
            write_csv_line(row, out, |cell, out| match cell {
                Cell::Number(x) => out.write_all(number_in_table(*x).as_bytes()),
                Cell::Text(t) => write_csv_text(t, out),
                Cell::Bool(b) => write!(out, "{b}"),
                Cell::Nothing => Ok(()),
            })
        })
    }
}

fn write_csv_line<T>(
    items: &[T],
    out: &mut dyn Write,
    write: impl Fn(&T, &mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            out.write_all(b",")?;
        }
        write(item, out)?;
    }
    out.write_all(b"\n")
}

fn write_csv_text(text: &str, out: &mut dyn Write) -> io::Result<()> {
    if text.contains(|c: char| matches!(c, ',' | '"') || c.is_control()) {
        write!(out, "\"{}\"", text.replace('"', "\"\""))
    } else {
        out.write_all(text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{Breakdown, ShorterTimestep};
    use serde_json::json;

    fn table(names: &[&str], rows: Vec<Vec<Cell>>) -> Table {
        let mut table = Table::new(0.002, names.iter().map(|n| (*n).to_string()));
        table.rows = rows;
        table
    }

    fn written(write: impl Fn(&mut dyn Write) -> io::Result<()>) -> String {
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    fn json_of(table: &Table) -> serde_json::Value {
        let text = written(|out| table.write_json(out));
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        // The output equals that of a JSON writer.
        assert_eq!(value.to_string(), text);
        value
    }

    #[test]
    fn a_table_has_all_its_entries() {
        let mut table = table(&["plot/0/a, \"b\"", "readout/é"], vec![]);
        let empty = json!({
            "schemaVersion": 1, "report": "run", "version": concat!("labspec ", env!("CARGO_PKG_VERSION")),
            "timestep": 0.002, "columns": ["time", "plot/0/a, \"b\"", "readout/é"],
            "types": ["number", "number", "number"], "rows": [], "warnings": {}, "errors": [], "breakdown": null,
            "breakdowns": [],
        });
        assert_eq!(json_of(&table).to_string(), empty.to_string());
        table.warnings = vec![("badqacc", 1), ("inertia", 20)];
        table.errors = vec!["x: y".into(), "data\t".into()];
        table.breakdowns = vec![Breakdown {
            rule: crate::rules::SIMULATION_DIVERGES,
            what: "a".into(),
            why: "b",
            cause: None,
            shorter: ShorterTimestep::No,
            instead: "c".into(),
        }];
        table.timestep = f64::INFINITY;
        let value = json_of(&table);
        assert_eq!(value["warnings"], json!({"badqacc": 1, "inertia": 20}));
        assert_eq!(value["errors"], json!(["x: y", "data\t"]));
        let breakdown = json!({"code": "simulation-diverges", "what": "a", "why": "b", "help": "c"});
        assert_eq!((&value["breakdown"], &value["breakdowns"]), (&breakdown, &json!([breakdown])));
        assert_eq!(
            (&value["timestep"], &value["nonfinite"]),
            (&json!(null), &json!({"timestep": "Infinity"}))
        );
        table.rows = vec![vec![Cell::Number(f64::NAN)]];
        assert_eq!(json_of(&table)["nonfinite"], json!({"timestep": "Infinity", "rows": [[0, 0, "NaN"]]}));
    }

    #[test]
    fn a_column_holds_values_of_one_type() {
        let text = |t: &str| Cell::Text(t.into());
        let rows = vec![
            vec![
                Cell::Number(0.0),
                Cell::Number(1e-7),
                text("a\n\"b\""),
                Cell::Bool(true),
                Cell::Bool(false),
            ],
            vec![
                Cell::Number(1e300),
                Cell::Number(f64::NAN),
                Cell::Bool(true),
                Cell::Nothing,
                Cell::Number(-0.0),
            ],
            vec![
                Cell::Number(-0.1),
                Cell::Number(f64::NEG_INFINITY),
                Cell::Nothing,
                Cell::Bool(false),
                Cell::Number(f64::NAN),
            ],
        ];
        let table = table(&["n", "t", "b", "mixed"], rows);
        let value = json_of(&table);
        assert_eq!(value["types"], json!(["number", "number", "text", "boolean", "text"]));
        let rows = json!([
            [0.0, 1e-7, "a\n\"b\"", true, "false"],
            [1e300, null, "true", null, "-0"],
            [-0.1, null, null, false, "NaN"],
        ]);
        assert_eq!(value["rows"], rows);
        assert_eq!(value["nonfinite"], json!({"rows": [[1, 1, "NaN"], [2, 1, "-Infinity"]]}));
        let lines = "time,n,t,b,mixed\n0,1e-7,\"a\n\"\"b\"\"\",true,false\n1e+300,NaN,true,,-0\n-0.1,-Infinity,,false,NaN\n";
        assert_eq!(written(|out| table.write_csv(out)), lines);
    }

    /// Bit patterns from a simple generator (splitmix64), including many NaN.
    #[test]
    fn every_bit_of_a_number_survives() {
        let mut state = 1u64;
        let mut bits = move || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let x = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            x ^ (x >> 31)
        };
        let edges =
            [0.0, -0.0, f64::MIN_POSITIVE, f64::MAX, f64::MIN, 5e-324, 0.1 + 0.2, 2f64.powi(53), 1e21, 1e-7];
        let no = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        // A third are small numbers as in lessons, and a few have the exponent of NaN and infinity.
        let random = (0..10_000).map(|i| match i % 9 {
            0..=2 => (bits() >> 11) as f64 / 2f64.powi(53) * 100.0 - 50.0,
            3 => f64::from_bits(bits() | 0x7ff0_0000_0000_0000),
            _ => f64::from_bits(bits()),
        });
        let all: Vec<f64> = edges.into_iter().chain(no).chain(random).collect();
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        let table = table(&["x"], all.iter().map(|&x| vec![Cell::Number(1.0), Cell::Number(x)]).collect());

        let csv = written(|out| table.write_csv(out));
        for (line, &x) in csv.lines().skip(1).zip(&all) {
            let read: f64 = line.split_once(',').unwrap().1.parse().unwrap();
            assert!(same(read, x), "{line} is not {x:?}");
        }
        let value = json_of(&table);
        let rows = value["rows"].as_array().unwrap();
        let mut read: Vec<Option<f64>> = rows.iter().map(|row| row[1].as_f64()).collect();
        for lost in value["nonfinite"]["rows"].as_array().unwrap() {
            let place = &mut read[lost[0].as_u64().unwrap() as usize];
            assert_eq!((&lost[1], *place), (&json!(1), None), "{lost}");
            *place = lost[2].as_str().unwrap().parse().ok();
        }
        assert_eq!((read.len(), csv.lines().count()), (all.len(), all.len() + 1));
        for (read, x) in read.into_iter().zip(all) {
            assert!(read.is_some_and(|read| same(read, x)), "{read:?} is not {x:?}");
        }
    }
}
