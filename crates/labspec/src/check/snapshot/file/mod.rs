//! The text of a snapshot and its content: for people who review it, and for the comparison.
//!
//! The reader accepts only the exact form that the writer produces. Every deviation is an error with a position.

mod read;
mod write;

pub(super) use read::read;
pub(super) use write::{lab, plain, whole};

/// The first line.
const FIRST_LINE: &str = "labspec snapshot 1";
/// The line of a run that equals the first run.
const SAME_AS_FIRST_RUN: &str = "the same as the first run";
/// Minimum number of characters of a column: a change of one digit does not move other lines.
const MIN_COLUMN_WIDTH: usize = 8;
/// Maximum length of a text that is written completely.
const MAX_TEXT: usize = 40;
/// A number without a certain digit.
pub(super) const NO_CERTAIN_DIGIT: &str = "~";
/// No value: the expression threw, or the run had ended.
const NO_VALUE: &str = "-";

/// A stored lab.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredLab {
    /// Its address: `#1`.
    pub(super) address: String,
    pub(super) runs: Vec<StoredRun>,
    /// Its lines.
    pub(super) text: String,
}

/// A stored run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredRun {
    pub(super) name: String,
    pub(super) about: Vec<String>,
    pub(super) times: Vec<f64>,
    pub(super) rows: Vec<StoredRow>,
}

/// The values of a trace or a readout as they are written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StoredRow {
    pub(super) name: String,
    pub(super) cells: Vec<String>,
    /// Its line in the file.
    pub(super) line: usize,
}

/// An error in a file, and its position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SnapshotFault {
    /// From 1.
    pub(super) line: usize,
    /// From 1, in characters.
    pub(super) column: usize,
    /// The error.
    pub(super) message: String,
}

#[cfg(test)]
mod tests {
    use super::super::runs::SnapshotRun;
    use super::*;
    use crate::run::Cell;
    use crate::source::SourceFile;

    fn snapshot_run(name: &str, z: &[f64]) -> SnapshotRun {
        SnapshotRun {
            name: name.into(),
            about: vec!["0.2 s".into(), "timestep 0.1 s".into()],
            times: vec![0.0, 0.1, 0.2],
            rows: vec![
                ("plot/0/z \"up\"".into(), z.iter().map(|x| Cell::Number(*x)).collect()),
                ("readout/on".into(), vec![Cell::Bool(true), Cell::Nothing, Cell::Text("a b".into())]),
            ],
            is_cut: false,
        }
    }

    fn text() -> String {
        let nominal = snapshot_run("as it stands", &[1.0, 0.5, -0.26]);
        let runs = [
            (nominal, vec![snapshot_run("", &[1.0, 0.5004, 0.3])]),
            (snapshot_run("with \"k\" at 2", &[0.0; 3]), vec![]),
        ];
        whole("fall.md", [lab("#1", "A\nfall", &runs).as_str()].into_iter())
    }

    #[test]
    fn written_snapshots_are_read_back() {
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

    /// A truncated or changed file gives a list of labs, or an error with a position in the file.
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
