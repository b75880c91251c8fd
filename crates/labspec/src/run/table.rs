//! The samples of a run, and their written forms.

use super::{Breakdown, End, Session};
use crate::report::printable_json;
use labspec_core::Warning;
use labspec_expr::Value;
use serde_json::json;
use std::io::{self, Write};

/// One sampled value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number, possibly not finite.
    Number(f64),
    /// A text.
    Text(String),
    /// A truth value.
    Bool(bool),
    /// `undefined`, `null`, or an expression that threw.
    Nothing,
}

impl From<Value> for Cell {
    fn from(value: Value) -> Cell {
        match value {
            Value::Number(x) => Cell::Number(x),
            Value::Boolean(b) => Cell::Bool(b),
            Value::String(s) => Cell::Text(s.to_string()),
            // Lists and records are refused where a readout is compiled.
            _ => Cell::Nothing,
        }
    }
}

impl Cell {
    /// The number to draw; NaN for what is none.
    pub fn number(&self) -> f64 {
        match self {
            Cell::Number(x) => *x,
            Cell::Bool(b) => f64::from(u8::from(*b)),
            _ => f64::NAN,
        }
    }

    fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Cell::Number(x) if x.is_finite() => Ok(serde_json::to_writer(out, x)?),
            Cell::Number(x) => write_json_text(&Value::Number(*x).to_string(), out),
            Cell::Text(t) => write_json_text(t, out),
            Cell::Bool(b) => write!(out, "{b}"),
            Cell::Nothing => out.write_all(b"null"),
        }
    }

    fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Cell::Number(x) => write!(out, "{}", Value::Number(*x)),
            Cell::Text(t) => write_csv_text(t, out),
            Cell::Bool(b) => write!(out, "{b}"),
            Cell::Nothing => Ok(()),
        }
    }

    /// As the page prints it with so many decimals.
    pub fn shown(&self, digits: u32) -> String {
        match self {
            Cell::Number(x) => shown(*x, digits),
            Cell::Text(t) => t.clone(),
            Cell::Bool(b) => b.to_string(),
            Cell::Nothing => "nan".into(),
        }
    }
}

/// A number as the page prints it: fixed decimals, exponential when small or large.
pub fn shown(x: f64, digits: u32) -> String {
    if x.is_nan() {
        return "nan".into();
    }
    if x.is_infinite() {
        return if x > 0.0 { "inf" } else { "-inf" }.into();
    }
    let magnitude = x.abs();
    if magnitude != 0.0 && !(1e-3..1e5).contains(&magnitude) {
        let text = format!("{x:.2e}");
        // JavaScript writes the sign of the exponent.
        return if text.contains("e-") { text } else { text.replace('e', "e+") };
    }
    labspec_expr::to_fixed(x, digits as usize)
}

fn write_json_text(text: &str, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(printable_json(&serde_json::to_string(text)?).as_bytes())
}

fn write_csv_text(text: &str, out: &mut dyn Write) -> io::Result<()> {
    if text.contains(|c: char| matches!(c, ',' | '"') || c.is_control()) {
        write!(out, "\"{}\"", text.replace('"', "\"\""))
    } else {
        out.write_all(text.as_bytes())
    }
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

/// Rows of samples: time, then every trace, then every readout.
#[derive(Clone, Debug)]
pub struct Table {
    /// Length of a step, s.
    pub timestep: f64,
    /// Names of the columns; the first is `time`.
    pub columns: Vec<String>,
    /// The samples.
    pub rows: Vec<Vec<Cell>>,
    /// Warnings of the engine since the last reset: name and number.
    pub warnings: Vec<(&'static str, usize)>,
    /// What they mean for the lesson, or energy that the run gained from nothing.
    pub breakdown: Option<Breakdown>,
    /// What threw.
    pub errors: Vec<String>,
}

impl Table {
    pub(super) fn new(timestep: f64, probes: impl Iterator<Item = String>) -> Table {
        let columns = std::iter::once("time".to_string()).chain(probes).collect();
        Table {
            timestep,
            columns,
            rows: Vec::new(),
            warnings: Vec::new(),
            breakdown: None,
            errors: Vec::new(),
        }
    }

    pub(super) fn finish(&mut self, session: &Session<'_>) {
        let raised =
            Warning::ALL.iter().zip(&session.world.data.fields().warning).filter(|(_, s)| s.number > 0);
        self.warnings = raised.map(|(w, s)| (w.name(), s.number)).collect();
        self.breakdown = Breakdown::of(session);
        self.errors = session.troubles.iter().map(|t| format!("{}: {}", t.text.value, t.message)).collect();
        match session.ended() {
            Some(End::Budget { time }) => self.errors.push(format!(
                "the run was stopped at t = {time} s: it does more work than a run may; simplify the scene or its programs"
            )),
            Some(End::Interrupted) => {
                let time = super::time(session.world.data.time());
                self.errors.push(format!("stopped by Ctrl-C at t = {time} s, before its end"));
            }
            Some(End::Threw) | None => {}
        }
    }

    /// The points of a column over time.
    pub fn series(&self, column: usize) -> Vec<(f64, f64)> {
        let at = |row: &[Cell], i: usize| row.get(i).map_or(f64::NAN, Cell::number);
        self.rows.iter().map(|row| (at(row, 0), at(row, column))).collect()
    }

    /// JSON in the layout of the reference runner: columns, rows, warnings, errors; and what broke, where something
    /// did. Written row by row: a table of millions of rows is never held as a whole a second time.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let version = json!(concat!("labspec ", env!("CARGO_PKG_VERSION")));
        write!(out, "{{\"version\":{version},\"timestep\":{},\"columns\":[", json!(self.timestep))?;
        separated(&self.columns, out, |name, out| write_json_text(name, out))?;
        out.write_all(b"],\"rows\":[")?;
        separated(&self.rows, out, |row, out| {
            out.write_all(b"[")?;
            separated(row, out, Cell::write_json)?;
            out.write_all(b"]")
        })?;
        out.write_all(b"],\"warnings\":{")?;
        separated(&self.warnings, out, |(name, n), out| write!(out, "{}:{n}", json!(name)))?;
        out.write_all(b"},\"errors\":[")?;
        separated(&self.errors, out, |error, out| write_json_text(error, out))?;
        out.write_all(b"]")?;
        if let Some(b) = &self.breakdown {
            let b = json!({"code": b.rule.code, "what": b.what, "why": b.why, "help": b.help});
            write!(out, ",\"breakdown\":{}", printable_json(&b.to_string()))?;
        }
        out.write_all(b"}")
    }

    /// Comma-separated values with a header, row by row.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        separated(&self.columns, out, |name, out| write_csv_text(name, out))?;
        out.write_all(b"\n")?;
        for row in &self.rows {
            separated(row, out, Cell::write_csv)?;
            out.write_all(b"\n")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// The table as one JSON value, which is what the rows are streamed as.
    fn whole(table: &Table) -> serde_json::Value {
        let cell = |cell: &Cell| match cell {
            Cell::Number(x) if x.is_finite() => json!(x),
            Cell::Number(x) => json!(Value::Number(*x).to_string()),
            Cell::Text(t) => json!(t),
            Cell::Bool(b) => json!(b),
            Cell::Nothing => serde_json::Value::Null,
        };
        let rows: Vec<Vec<_>> = table.rows.iter().map(|row| row.iter().map(cell).collect()).collect();
        let warnings: serde_json::Map<String, serde_json::Value> =
            table.warnings.iter().map(|(name, n)| (name.to_string(), json!(n))).collect();
        let mut whole = json!({
            "version": concat!("labspec ", env!("CARGO_PKG_VERSION")),
            "timestep": table.timestep, "columns": table.columns, "rows": rows, "warnings": warnings,
            "errors": table.errors,
        });
        if let Some(b) = &table.breakdown {
            whole["breakdown"] = json!({"code": b.rule.code, "what": b.what, "why": b.why, "help": b.help});
        }
        whole
    }

    #[test]
    fn rows_are_streamed_as_the_bytes_of_one_value() {
        let mut table =
            Table::new(0.002, ["plot/0/a, \"b\"".to_string(), "readout/é".to_string()].into_iter());
        assert_eq!(streamed(&table), whole(&table).to_string());
        table.rows = vec![
            vec![Cell::Number(0.0), Cell::Number(1e-7), Cell::Text("a\n\"b\"".into())],
            vec![Cell::Number(1e300), Cell::Number(f64::NAN), Cell::Bool(true)],
            vec![Cell::Number(-0.1), Cell::Number(f64::NEG_INFINITY), Cell::Nothing],
        ];
        table.warnings = vec![("badqacc", 1), ("inertia", 20)];
        table.errors = vec!["x: y".into(), "data\t".into()];
        table.breakdown = Some(Breakdown {
            rule: crate::rules::SIMULATION_DIVERGES,
            what: "a".into(),
            why: "b",
            help: "c".into(),
        });
        assert_eq!(streamed(&table), whole(&table).to_string());
        let mut csv = Vec::new();
        table.write_csv(&mut csv).unwrap();
        let lines = "time,\"plot/0/a, \"\"b\"\"\",readout/é\n0,1e-7,\"a\n\"\"b\"\"\"\n1e+300,NaN,true\n-0.1,-Infinity,\n";
        assert_eq!(String::from_utf8(csv).unwrap(), lines);
    }

    fn streamed(table: &Table) -> String {
        let mut bytes = Vec::new();
        table.write_json(&mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn numbers_print_as_the_page_prints_them() {
        let cases = [
            (0.0, 3, "0.000"),
            (0.36718, 2, "0.37"),
            (0.0005, 3, "5.00e-4"),
            (123456.0, 1, "1.23e+5"),
            (99999.0, 0, "99999"),
            (-0.001, 3, "-0.001"),
            (f64::NAN, 3, "nan"),
            (f64::NEG_INFINITY, 3, "-inf"),
        ];
        for (x, digits, text) in cases {
            assert_eq!(shown(x, digits), text);
        }
    }
}
