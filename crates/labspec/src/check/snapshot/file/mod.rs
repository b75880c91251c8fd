//! The text of a snapshot, and what it says: for people who read it in a review, and for the comparison.
//!
//! Whoever reads takes nothing for granted: what is not exactly as it is written has a place and a sentence.

mod read;
mod write;

pub(super) use read::read;
pub(super) use write::{lab, plain, whole};

/// What stands in the first line.
const HEAD: &str = "labspec snapshot 1";
/// What stands below a run that shows what the first one shows.
const SAME: &str = "the same as the first run";
/// Letters of a column, at least: a digit more or less moves no other line.
const WIDE: usize = 8;
/// Longest text of a cell that is written out.
const LONG: usize = 40;
/// A number of which no digit is certain.
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
pub(super) struct SnapshotFault {
    /// From 1.
    pub(super) line: usize,
    /// From 1, in characters.
    pub(super) column: usize,
    /// What is wrong there.
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
