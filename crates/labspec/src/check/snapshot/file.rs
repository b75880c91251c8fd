//! The text of a snapshot, and what it says: for people who read it in a review, and for the comparison.
//!
//! Whoever reads takes nothing for granted: what is not exactly as it is written has a place and a sentence.

use super::digits;
use super::runs::Taken;
use crate::printable::{printable, printable_json};
use crate::run::Cell;
use crate::source::SourceFile;
use std::collections::BTreeSet;
use std::fmt::Write;

/// What stands in the first line.
const HEAD: &str = "labspec snapshot 1";
/// What stands below a run that shows what the first one shows.
const SAME: &str = "the same as the first run";
/// Letters of a column, at least: a digit more or less moves no other line.
const WIDE: usize = 8;
/// Longest text of a cell that is written out.
const LONG: usize = 40;
/// A number of which no digit can be told.
pub(super) const OPEN: &str = "~";
/// Nothing: an expression that threw, or a run that had ended.
const NOTHING: &str = "-";

/// A lab as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredLab {
    /// Its address, as people write it: `#1`.
    pub(super) address: String,
    pub(super) runs: Vec<StoredRun>,
    /// Its lines.
    pub(super) text: String,
}

/// A run as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredRun {
    pub(super) name: String,
    pub(super) about: Vec<String>,
    pub(super) times: Vec<f64>,
    pub(super) rows: Vec<StoredRow>,
}

/// The values of a trace or a readout, as they stand there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredRow {
    pub(super) name: String,
    pub(super) cells: Vec<String>,
    /// Its line in the file.
    pub(super) line: usize,
}

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// From 1.
    pub(super) line: usize,
    /// From 1, in characters.
    pub(super) column: usize,
    /// What is wrong there.
    pub(super) message: String,
}

/// The text of a file. `name` is that of the lesson, without its folder.
pub(super) fn whole<'t>(name: &str, labs: impl Iterator<Item = &'t str>) -> String {
    let mut text = format!(
        "{HEAD}\n\
         # What the labs of {} show at 11 times: as they stand, with each slider at its ends, each select at\n\
         # its other options, after each button. A number has the digits that neither half the timestep nor a start moved\n\
         # by 1e-14 changes, at most five ({OPEN}: none; {NOTHING}: nothing is shown), and is as stored while it rounds to them.\n\
         # Written by `labspec snapshot`; look at changes with `labspec snapshot --review`.\n",
        printable(name)
    );
    let mut count = 0;
    for lab in labs {
        text.push('\n');
        text.push_str(lab);
        count += 1;
    }
    let _ = writeln!(text, "\nend of {count} labs");
    text
}

/// The lines of a lab. Each run has its values, and the same under the numerics that digits must survive.
pub(super) fn lab(address: &str, title: &str, runs: &[(Taken, Vec<Taken>)]) -> String {
    let mut text = format!("lab {} {}\n", quoted(address), quoted(title));
    let mut first = String::new();
    for (run, others) in runs {
        let mut rows = vec![times(run)];
        for (i, (name, cells)) in run.rows.iter().enumerate() {
            let others: Vec<&Vec<Cell>> = others.iter().filter_map(|o| Some(&o.rows.get(i)?.1)).collect();
            rows.push((quoted(name), row(cells, &others)));
        }
        let _ = writeln!(text, "run {}\n  {}", printable(&run.name), run.about.join(", "));
        let mut shown = String::new();
        table(&rows, &mut shown);
        if shown == first {
            shown = format!("  {SAME}\n");
        } else if first.is_empty() {
            first.clone_from(&shown);
        }
        text.push_str(&shown);
    }
    text
}

fn times(run: &Taken) -> (String, Vec<String>) {
    ("time".into(), run.times.iter().map(|t| crate::verify::significant(*t)).collect())
}

/// The values of a row with the digits that all its numerics share.
fn row(cells: &[Cell], others: &[&Vec<Cell>]) -> Vec<String> {
    let numbers: Vec<f64> = cells.iter().filter_map(number).collect();
    let (finest, coarsest) = digits::units(&numbers);
    let one = |(i, cell): (usize, &Cell)| match number(cell).filter(|x| x.is_finite()) {
        None => {
            let text = plain(cell);
            let same = others.iter().all(|o| o.get(i).map(plain).as_ref() == Some(&text));
            if same { text } else { OPEN.into() }
        }
        Some(x) => {
            let at = |unit: i32| {
                let text = digits::written(x, unit);
                let same = |o: &&Vec<Cell>| {
                    o.get(i)
                        .and_then(number)
                        .is_some_and(|y| y.is_finite() && digits::written(y, unit) == text)
                };
                others.iter().all(same).then_some(text)
            };
            (finest..=coarsest).find_map(at).unwrap_or_else(|| OPEN.into())
        }
    };
    cells.iter().enumerate().map(one).collect()
}

fn number(cell: &Cell) -> Option<f64> {
    match cell {
        Cell::Number(x) => Some(*x),
        _ => None,
    }
}

/// What is no number: a text, a truth value, nothing.
pub(super) fn plain(cell: &Cell) -> String {
    match cell {
        Cell::Number(x) => crate::run::shown(*x, 6),
        Cell::Bool(b) => b.to_string(),
        Cell::Nothing => NOTHING.into(),
        Cell::Text(text) if text.chars().count() <= LONG => quoted(text),
        Cell::Text(text) => {
            let start: String = text.chars().take(LONG).collect();
            let mark = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |mark, byte| {
                (mark ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
            });
            quoted(&format!("{start}… ({} bytes, {mark:016x})", text.len()))
        }
    }
}

fn quoted(text: &str) -> String {
    printable_json(&serde_json::Value::from(text).to_string()).into_owned()
}

/// Names to the left, numbers to the right, in columns.
fn table(rows: &[(String, Vec<String>)], text: &mut String) {
    let width = |of: &str| of.chars().count();
    let names = rows.iter().map(|(name, _)| width(name)).max().unwrap_or(0);
    let columns = rows.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
    let widest = |k: usize| rows.iter().filter_map(|(_, cells)| cells.get(k)).map(|c| width(c)).max();
    let widths: Vec<usize> = (0..columns).map(|k| widest(k).unwrap_or(0).max(WIDE)).collect();
    for (name, cells) in rows {
        let _ = write!(text, "  {name:names$}");
        for (cell, width) in cells.iter().zip(&widths) {
            let _ = write!(text, "  {cell:>width$}");
        }
        text.push('\n');
    }
}

/// Reads what was written.
///
/// # Errors
/// The first thing that is not as it is written.
pub(super) fn read(file: &SourceFile) -> Result<Vec<StoredLab>, Fault> {
    let mut reader = Reader { lines: file.text().lines().collect(), at: 0 };
    reader.head()?;
    let mut labs: Vec<StoredLab> = Vec::new();
    let mut known = BTreeSet::new();
    loop {
        let Some(line) = reader.next() else {
            return Err(
                reader.fault(0, "the file ends here, without the line `end of … labs`: it is not whole")
            );
        };
        if let Some(rest) = line.strip_prefix("lab ") {
            let start = reader.at - 1;
            let [address, _] = reader.names(rest, 4)?;
            if !known.insert(address.clone()) {
                return Err(reader.fault(4, &format!("the lab {address} stands here a second time")));
            }
            let runs = reader.runs()?;
            let lines = reader.lines.get(start..reader.at).unwrap_or_default();
            let text = lines.iter().filter(|l| !is_empty(l)).map(|l| format!("{l}\n")).collect();
            labs.push(StoredLab { address, runs, text });
        } else if let Some(rest) = line.strip_prefix("end of ") {
            if rest != format!("{} labs", labs.len()) {
                return Err(
                    reader.fault(7, &format!("there are {} labs above, and this says `{rest}`", labs.len()))
                );
            }
            return match reader.next() {
                None => Ok(labs),
                Some(_) => Err(reader.fault(0, "nothing stands behind the end")),
            };
        } else {
            return Err(reader.fault(0, "here a lab begins (`lab \"#1\" \"title\"`), or the end stands"));
        }
    }
}

fn is_empty(line: &str) -> bool {
    line.trim().is_empty() || line.starts_with('#')
}

struct Reader<'t> {
    lines: Vec<&'t str>,
    /// The line that comes next.
    at: usize,
}

impl<'t> Reader<'t> {
    /// A mistake in the line that was read last, behind so many characters.
    fn fault(&self, before: usize, message: &str) -> Fault {
        Fault { line: self.at.max(1), column: before + 1, message: message.to_string() }
    }

    fn head(&mut self) -> Result<(), Fault> {
        self.at = 1;
        match self.lines.first() {
            Some(line) if *line == HEAD => Ok(()),
            Some(line) if line.starts_with("labspec snapshot ") => {
                Err(self.fault(17, "this is of another version: labspec snapshot --accept writes it anew"))
            }
            _ => Err(self.fault(0, &format!("this is no snapshot: one begins with `{HEAD}`"))),
        }
    }

    /// The next line in which something stands.
    fn next(&mut self) -> Option<&'t str> {
        while let Some(line) = self.lines.get(self.at) {
            self.at += 1;
            if !is_empty(line) {
                return Some(line);
            }
        }
        self.at = self.lines.len();
        None
    }

    /// The next line, if it begins like this.
    fn next_with(&mut self, start: &str) -> Option<&'t str> {
        let before = self.at;
        let rest = self.next().and_then(|line| line.strip_prefix(start));
        if rest.is_none() {
            self.at = before;
        }
        rest
    }

    /// Two texts between quotes.
    fn names(&self, rest: &str, before: usize) -> Result<[String; 2], Fault> {
        let words = self.words(rest, before)?;
        let text = |i: usize| words.get(i).and_then(|(_, w)| serde_json::from_str::<String>(w).ok());
        match (text(0), text(1), words.len()) {
            (Some(a), Some(b), 2) => Ok([a, b]),
            _ => {
                Err(self.fault(before, "here the address of a lab and its title stand, both between quotes"))
            }
        }
    }

    /// The words of a line, each with the characters before it: what is between quotes is one.
    fn words(&self, line: &'_ str, before: usize) -> Result<Vec<(usize, String)>, Fault> {
        let mut words: Vec<(usize, String)> = Vec::new();
        let mut letters = line.chars().enumerate().peekable();
        while let Some((i, c)) = letters.next() {
            if c.is_whitespace() {
                continue;
            }
            let mut word = String::from(c);
            if c == '"' {
                let mut escaped = false;
                let mut closed = false;
                for (_, c) in letters.by_ref() {
                    word.push(c);
                    if c == '"' && !escaped {
                        closed = true;
                        break;
                    }
                    escaped = c == '\\' && !escaped;
                }
                if !closed || serde_json::from_str::<String>(&word).is_err() {
                    return Err(self.fault(before + i, "this text between quotes is not whole"));
                }
            } else {
                while let Some((_, c)) = letters.next_if(|(_, c)| !c.is_whitespace()) {
                    word.push(c);
                }
            }
            words.push((before + i, word));
        }
        Ok(words)
    }

    fn runs(&mut self) -> Result<Vec<StoredRun>, Fault> {
        let mut runs: Vec<StoredRun> = Vec::new();
        while let Some(name) = self.next_with("run ") {
            if runs.iter().any(|run| run.name == name) {
                return Err(self.fault(4, "this run stands here a second time"));
            }
            let about = self.next_with("  ");
            let about = about
                .ok_or_else(|| self.fault(0, "below the name of a run stand its length and its timestep"))?;
            let about = about.split(", ").map(str::to_string).collect();
            if let (Some(first), Some(_)) = (runs.first(), self.next_with(&format!("  {SAME}"))) {
                let run = StoredRun { name: name.to_string(), about, ..first.clone() };
                runs.push(run);
                continue;
            }
            let times = self.next_with("  ").map(|line| self.words(line, 2)).transpose()?.unwrap_or_default();
            if times.first().is_none_or(|(_, word)| word != "time") || times.len() < 2 {
                return Err(self.fault(0, "here the times of a run stand, behind the word `time`"));
            }
            let time = |(at, word): &(usize, String)| {
                let t = word.parse::<f64>().ok().filter(|t| t.is_finite());
                t.ok_or_else(|| self.fault(*at, &format!("`{}` is no time", shortened(word))))
            };
            let times: Vec<f64> = times.iter().skip(1).map(time).collect::<Result<_, _>>()?;
            let mut rows = Vec::new();
            while let Some(line) = self.next_with("  ") {
                rows.push(self.row(line, times.len())?);
            }
            runs.push(StoredRun { name: name.to_string(), about, times, rows });
        }
        Ok(runs)
    }

    fn row(&self, line: &str, columns: usize) -> Result<StoredRow, Fault> {
        let mut words = self.words(line, 2)?.into_iter();
        let name = words.next().and_then(|(_, w)| serde_json::from_str(&w).ok());
        let Some(name) = name else {
            return Err(self.fault(2, "here the name of a trace or a readout stands, between quotes"));
        };
        let words: Vec<(usize, String)> = words.collect();
        if words.len() != columns {
            let end = line.chars().count() + 2;
            return Err(self.fault(end, &format!("here are {} values, for {columns} times", words.len())));
        }
        for (at, word) in &words {
            let fixed = [OPEN, NOTHING, "true", "false", "nan", "inf", "-inf"];
            if !fixed.contains(&word.as_str()) && !word.starts_with('"') && digits::read(word).is_none() {
                return Err(self.fault(*at, &format!("`{}` is no value", shortened(word))));
            }
        }
        Ok(StoredRow { name, cells: words.into_iter().map(|(_, w)| w).collect(), line: self.at })
    }
}

/// The beginning of a word that somebody else wrote.
fn shortened(word: &str) -> String {
    let short: String = word.chars().take(24).collect();
    let more = if short.len() < word.len() { "…" } else { "" };
    format!("{}{more}", printable(&short))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(name: &str, z: &[f64]) -> Taken {
        Taken {
            name: name.into(),
            about: vec!["0.2 s".into(), "timestep 0.1 s".into()],
            times: vec![0.0, 0.1, 0.2],
            rows: vec![
                ("plot/0/z \"up\"".into(), z.iter().map(|x| Cell::Number(*x)).collect()),
                ("readout/on".into(), vec![Cell::Bool(true), Cell::Nothing, Cell::Text("a b".into())]),
            ],
        }
    }

    fn text() -> String {
        let nominal = taken("as it stands", &[1.0, 0.5, -0.26]);
        let runs =
            [(nominal, vec![taken("", &[1.0, 0.5004, 0.3])]), (taken("with \"k\" at 2", &[0.0; 3]), vec![])];
        whole("fall.md", [lab("#1", "A\nfall", &runs).as_str()].into_iter())
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = text();
        insta::assert_snapshot!(text);
        let labs = read(&SourceFile::new("a.snap", text.as_str())).unwrap();
        assert_eq!(labs.len(), 1);
        assert_eq!(labs[0].runs[0].rows[0].cells, ["1.0000", "0.500", "~"]);
        assert_eq!(labs[0].runs[1].name, "with \"k\" at 2");
        assert_eq!(whole("fall.md", labs.iter().map(|l| l.text.as_str())), text);
        let other = text.replace('\n', "\r\n");
        assert_eq!(read(&SourceFile::new("a.snap", other)).unwrap(), labs);
    }

    /// Whatever is cut off or changed: a list of labs, or a fault with a place in the file.
    #[test]
    fn a_damaged_file_has_a_place() {
        let text = text();
        let lines = text.lines().count();
        for end in 0..text.len() {
            let Some(cut) = text.get(..end) else { continue };
            let read = read(&SourceFile::new("a.snap", cut));
            // Only the last line break may be missing.
            assert_eq!(read.is_ok(), end + 1 == text.len(), "{end}: {read:?}");
            if let Err(fault) = read {
                assert!((1..=lines).contains(&fault.line) && fault.column > 0, "{end} {fault:?}");
            }
        }
        for (from, to, line, column) in [
            ("snapshot 1", "snapshot 2", 1, 18),
            ("labspec", "labsepc", 1, 1),
            ("\"#1\"", "\"#1", 7, 5),
            ("lab \"#1\"", "lba \"#1\"", 7, 1),
            ("0.500", "0.5.0", 11, 35),
            ("0.500", "0.500 7", 11, 52),
            ("end of 1", "end of 2", 19, 8),
        ] {
            let fault = read(&SourceFile::new("a.snap", text.replacen(from, to, 1))).unwrap_err();
            assert_eq!((fault.line, fault.column), (line, column), "{to}: {fault:?}");
        }
        let twice = text.replace("\nend of", "lab \"#1\" \"\"\n\nend of");
        assert!(read(&SourceFile::new("a.snap", twice)).unwrap_err().message.contains("a second time"));
    }
}
