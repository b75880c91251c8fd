//! Tables of samples as JSON and as comma-separated values, row by row: a table of millions of rows is never held as a whole
//! a second time.
//!
//! Every number is written so that reading it gives the same bits. A column of JSON holds values of one type; where a number
//! is none, it holds `null`, and the list `nonfinite` says what was there.

use super::{SCHEMA_VERSION, nonfinite};
use crate::printable::printable_json;
use crate::run::{Breakdown, Cell, Table};
use labspec_expr::Value;
use serde_json::json;
use std::io::{self, Write};

/// What the cells of a column are, besides those with nothing in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    Number,
    Boolean,
    /// Texts, or values of several types, which are then written as texts.
    Text,
}

impl Type {
    /// The type of a cell; `None` when there is nothing in it.
    fn of_cell(cell: &Cell) -> Option<Type> {
        match cell {
            Cell::Number(_) => Some(Type::Number),
            Cell::Bool(_) => Some(Type::Boolean),
            Cell::Text(_) => Some(Type::Text),
            Cell::Nothing => None,
        }
    }

    fn as_str(self) -> &'static str {
        match self {
            Type::Number => "number",
            Type::Boolean => "boolean",
            Type::Text => "text",
        }
    }
}

/// The types of all columns. One in which there is nothing is a column of numbers that are missing.
fn types(table: &Table) -> Vec<Type> {
    let mut types: Vec<Option<Type>> = vec![None; table.columns.len()];
    for row in &table.rows {
        for (column_type, cell) in types.iter_mut().zip(row) {
            *column_type = match (*column_type, Type::of_cell(cell)) {
                (Some(a), Some(b)) if a != b => Some(Type::Text),
                (a, b) => a.or(b),
            };
        }
    }
    types.into_iter().map(|t| t.unwrap_or(Type::Number)).collect()
}

/// A number in words: those of JavaScript, and `-0`, which it writes as `0`.
pub fn number_in_table(x: f64) -> String {
    if x == 0.0 && x.is_sign_negative() { "-0".into() } else { Value::Number(x).to_string() }
}

fn write_cell(cell: &Cell, of: Type, out: &mut dyn Write) -> io::Result<()> {
    match cell {
        Cell::Number(x) if of == Type::Text => write_text(&number_in_table(*x), out),
        Cell::Bool(b) if of == Type::Text => write_text(&b.to_string(), out),
        Cell::Number(x) if x.is_finite() => Ok(serde_json::to_writer(out, x)?),
        Cell::Text(t) => write_text(t, out),
        Cell::Bool(b) => write!(out, "{b}"),
        Cell::Number(_) | Cell::Nothing => out.write_all(b"null"),
    }
}

fn write_text(text: &str, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(printable_json(&serde_json::to_string(text)?).as_bytes())
}

/// Items with commas between them.
fn separated<T>(
    items: impl IntoIterator<Item = T>,
    out: &mut dyn Write,
    mut write: impl FnMut(T, &mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    for (i, item) in items.into_iter().enumerate() {
        if i > 0 {
            out.write_all(b",")?;
        }
        write(item, out)?;
    }
    Ok(())
}

/// Row, column and name of every number that JSON has not, where a column holds numbers.
fn lost<'t>(table: &'t Table, types: &'t [Type]) -> impl Iterator<Item = (usize, usize, &'static str)> + 't {
    table.rows.iter().enumerate().flat_map(move |(row, cells)| {
        cells.iter().zip(types).enumerate().filter_map(move |(column, (cell, of))| match cell {
            Cell::Number(x) if *of == Type::Number => nonfinite(*x).map(|name| (row, column, name)),
            _ => None,
        })
    })
}

impl Table {
    /// The report `run`, in the layout of the reference runner: columns, rows, warnings, errors, and what broke.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let types = types(self);
        let version = json!(concat!("labspec ", env!("CARGO_PKG_VERSION")));
        write!(out, "{{\"schemaVersion\":{SCHEMA_VERSION},\"report\":\"run\",\"version\":{version},")?;
        write!(out, "\"timestep\":{},\"columns\":[", json!(self.timestep))?;
        separated(&self.columns, out, |name, out| write_text(name, out))?;
        out.write_all(b"],\"types\":[")?;
        separated(&types, out, |of, out| write!(out, "\"{}\"", of.as_str()))?;
        out.write_all(b"],\"rows\":[")?;
        separated(&self.rows, out, |row, out| {
            out.write_all(b"[")?;
            separated(row.iter().zip(&types), out, |(cell, of), out| write_cell(cell, *of, out))?;
            out.write_all(b"]")
        })?;
        out.write_all(b"],\"warnings\":{")?;
        separated(&self.warnings, out, |(name, n), out| write!(out, "{}:{n}", json!(name)))?;
        out.write_all(b"},\"errors\":[")?;
        separated(&self.errors, out, |error, out| write_text(error, out))?;
        out.write_all(b"],\"breakdown\":")?;
        let breakdown_value =
            |b: &Breakdown| json!({"code": b.rule.code, "what": b.what, "why": b.why, "help": b.help()});
        let list: Vec<serde_json::Value> = self.breakdowns.iter().map(breakdown_value).collect();
        out.write_all(printable_json(&json!(list.first()).to_string()).as_bytes())?;
        out.write_all(b",\"breakdowns\":")?;
        out.write_all(printable_json(&json!(list).to_string()).as_bytes())?;
        self.write_lost(&types, out)?;
        out.write_all(b"}")
    }

    /// The object `nonfinite`, where a number is none.
    fn write_lost(&self, types: &[Type], out: &mut dyn Write) -> io::Result<()> {
        let timestep = nonfinite(self.timestep).map(|name| format!("\"timestep\":\"{name}\""));
        let rows = lost(self, types).next().is_some();
        if timestep.is_none() && !rows {
            return Ok(());
        }
        write!(out, ",\"nonfinite\":{{{}", timestep.as_deref().unwrap_or(""))?;
        if rows {
            out.write_all(if timestep.is_some() { b",\"rows\":[" } else { b"\"rows\":[" })?;
            separated(lost(self, types), out, |(row, column, name), out| {
                write!(out, "[{row},{column},\"{name}\"]")
            })?;
            out.write_all(b"]")?;
        }
        out.write_all(b"}")
    }

    /// Comma-separated values with a header. Numbers that are none are `NaN`, `Infinity` and `-Infinity`; where there is
    /// nothing, there is nothing between the commas.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        separated(&self.columns, out, |name, out| write_csv_text(name, out))?;
        out.write_all(b"\n")?;
        for row in &self.rows {
            separated(row, out, |cell, out| match cell {
                Cell::Number(x) => out.write_all(number_in_table(*x).as_bytes()),
                Cell::Text(t) => write_csv_text(t, out),
                Cell::Bool(b) => write!(out, "{b}"),
                Cell::Nothing => Ok(()),
            })?;
            out.write_all(b"\n")?;
        }
        Ok(())
    }
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
    use crate::run::Shorter;

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
        // One value, with nothing in it that a writer of JSON would write otherwise.
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
            shorter: Shorter::No,
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

    /// Patterns of bits from a plain generator (splitmix64), among them many that are no numbers.
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
        // A third of them small numbers as lessons have them, and a few with the exponent of NaN and the infinities.
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
