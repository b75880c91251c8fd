//! The kinds of files that the program writes, and how an existing file of a kind is recognized. Only files of
//! the same kind are replaced.

use labspec::report::number_in_table;
use std::fs::{self, File};
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// The kind of an output.
#[derive(Clone, Copy, Debug)]
pub(super) enum OutputKind<'t> {
    /// A baseline of known findings.
    Baseline,
    /// A record of the basis of every verdict.
    Record,
    /// A request to the reference simulator.
    JudgeRequest,
    /// An HTML page with the evidence.
    Page,
    /// A run as JSON.
    Run,
    /// A run as a table.
    Table,
    /// A table of settings and their errors.
    Settings,
    /// A plot as SVG.
    Plot,
    /// A plot as PNG.
    Picture,
    /// The stored output of the labs of a lesson.
    Snapshot,
    /// A reference page or a schema.
    Reference,
    /// A file that does not exist yet.
    New,
    /// A changed lesson, with its text as it was read. A file that has changed since is not replaced.
    Lesson(&'t str),
}

/// Extensions of files that labspec reads. An output never replaces such a file, even if labspec wrote it.
const INPUT_EXTENSIONS: [&str; 14] = [
    "md", "markdown", "mdx", "qmd", "rmd", "xml", "mjcf", "urdf", "stl", "obj", "msh", "png", "toml", "snap",
];
/// The maximum size of a JSON output that is read completely to recognize it.
const MAX_JSON_OUTPUT: u64 = 64 << 20;
/// The number of bytes by which other outputs are recognized.
const RECOGNIZED_BYTES: u64 = 4 << 10;
/// The first columns of a table of settings.
const SETTINGS: [&str; 4] = ["integrator", "solver", "timestep", "own"];

impl OutputKind<'_> {
    /// The option that requests this output.
    pub(super) fn option(self) -> &'static str {
        match self {
            OutputKind::Baseline => "--update-baseline",
            OutputKind::Record => "--record",
            OutputKind::JudgeRequest => "--judge-request",
            OutputKind::Page => "--html",
            OutputKind::Run => "--json",
            OutputKind::Table | OutputKind::Settings => "--csv",
            OutputKind::Plot => "--svg",
            OutputKind::Picture => "--png",
            OutputKind::Snapshot => "snapshot",
            OutputKind::Reference => "reference",
            OutputKind::New => "init",
            OutputKind::Lesson(_) => "the change",
        }
    }

    /// Whether a file has the extension of a file that labspec reads, and was not drawn by labspec.
    pub(super) fn is_input(self, place: &Path) -> bool {
        let ending = place.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match self {
            OutputKind::Snapshot | OutputKind::Reference | OutputKind::New | OutputKind::Lesson(_) => false,
            _ => ending.is_some_and(|e| INPUT_EXTENSIONS.contains(&e.as_str())) && !is_own_picture(place),
        }
    }

    /// Why this output may not replace an existing file, or `None` if it may.
    pub(super) fn refusal(self, place: &Path, old: &fs::Metadata) -> Option<&'static str> {
        match self {
            OutputKind::New => Some("a file already exists there"),
            OutputKind::Lesson(text) => {
                let same = old.len() == text.len() as u64
                    && fs::read(place).is_ok_and(|current| current == text.as_bytes());
                (!same).then_some("the file has changed since it was read, or is not UTF-8")
            }
            _ if self.is_input(place) => Some("it is a lesson, a model or a part of one"),
            _ => {
                let is_own = old.len() == 0 || self.looks_like_output(place, old.len());
                (!is_own).then_some("it is a file of another kind")
            }
        }
    }

    /// Whether a file looks like an output of this kind.
    fn looks_like_output(self, place: &Path, size: u64) -> bool {
        let head = head(place);
        let text = head.trim_start_matches('\u{feff}').trim_start();
        let value = || {
            let whole = if size <= MAX_JSON_OUTPUT { fs::read_to_string(place).ok() } else { None };
            whole.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok())
        };
        let says = |key: &str, word: &str| value().is_some_and(|value| value[key] == word);
        match self {
            OutputKind::Baseline => says("report", "baseline"),
            OutputKind::Record => says("report", "reproduction"),
            OutputKind::JudgeRequest => says("request", "judge"),
            OutputKind::Run => {
                let start: String = text.chars().take(80).collect();
                start.starts_with("{\"schemaVersion\":")
                    && start.contains(",\"report\":\"run\",\"version\":\"labspec ")
            }
            OutputKind::Page => {
                text.starts_with("<!DOCTYPE html>")
                    && last_bytes(place, size).contains("<footer><p><bdi>labspec ")
            }
            OutputKind::Table | OutputKind::Settings => is_table(place),
            OutputKind::Plot => {
                text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"")
                    && fs::read_to_string(place).is_ok_and(|text| text.contains("'DejaVu Sans'"))
            }
            OutputKind::Picture => is_own_picture(place),
            OutputKind::Snapshot => {
                let is_header =
                    |line: &str| line.trim_start_matches(['#', ' ']).starts_with("labspec snapshot");
                text.lines().take(8).any(is_header)
            }
            OutputKind::Reference => {
                text.starts_with("<!-- Written from the tables: ")
                    || text.starts_with("{\n  \"$schema\": ")
                        && value().is_some_and(|v| {
                            let of_report =
                                v["title"].as_str().is_some_and(|title| title.starts_with("labspec "));
                            of_report || !v["$defs"].is_null()
                        })
            }
            OutputKind::New | OutputKind::Lesson(_) => false,
        }
    }
}

/// The first bytes of a file as text.
fn head(place: &Path) -> String {
    let mut bytes = Vec::new();
    let read = File::open(place).and_then(|file| file.take(RECOGNIZED_BYTES).read_to_end(&mut bytes));
    read.map_or(String::new(), |_| String::from_utf8_lossy(&bytes).into_owned())
}

/// The last bytes of a file as text.
fn last_bytes(place: &Path, size: u64) -> String {
    let mut bytes = Vec::new();
    let read = File::open(place).and_then(|mut file| {
        file.seek(SeekFrom::Start(size.saturating_sub(RECOGNIZED_BYTES)))?;
        file.take(RECOGNIZED_BYTES).read_to_end(&mut bytes)
    });
    read.map_or(String::new(), |_| String::from_utf8_lossy(&bytes).into_owned())
}

/// Whether this program drew a picture. Other pictures may be height fields of a model.
#[cfg(feature = "png")]
fn is_own_picture(place: &Path) -> bool {
    let mut start = Vec::new();
    let read = File::open(place).and_then(|file| file.take(512).read_to_end(&mut start));
    read.is_ok() && labspec_plot::is_own_png(&start)
}

#[cfg(not(feature = "png"))]
fn is_own_picture(_: &Path) -> bool {
    false
}

/// Whether a file is a table of labspec, which is read to its end: the columns have the names that labspec uses, and
/// every row has as many cells, the first of which is a time or an integrator in labspec's format. A user's own
/// measurements are not such a table.
fn is_table(place: &Path) -> bool {
    let Ok(file) = File::open(place) else { return false };
    let mut rows = CsvRows { bytes: BufReader::new(file).bytes(), most: MAX_ROW };
    let Some(Some(columns)) = rows.next_row() else { return false };
    let timed = columns.first().is_some_and(|name| name == "time")
        && columns.iter().skip(1).all(|name| is_column(name));
    let plain = |name: &String| name.strip_suffix(" (s)").unwrap_or(name).to_string();
    let settings = columns.iter().take(SETTINGS.len()).map(plain).eq(SETTINGS);
    if !timed && !settings {
        return false;
    }
    loop {
        match rows.next_row() {
            None => return true,
            Some(None) => return false,
            Some(Some(cells)) => {
                let first = cells.first().map_or("", String::as_str);
                let is_row_name = if timed { is_time(first) } else { is_name(first) };
                if cells.len() != columns.len() || !is_row_name {
                    return false;
                }
            }
        }
    }
}

/// Whether a column has a name like `readout/height (m)` or `plot/0/height`.
fn is_column(name: &str) -> bool {
    let plot = || name.strip_prefix("plot/")?.split_once('/');
    let is_plot = plot().is_some_and(|(n, _)| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()));
    name.starts_with("readout/") || is_plot
}

/// Whether a cell is a number in the format of a table. Times may decrease where a run was reset.
fn is_time(cell: &str) -> bool {
    cell.parse::<f64>().is_ok_and(|time| number_in_table(time) == cell)
}

fn is_name(cell: &str) -> bool {
    !cell.is_empty() && cell.bytes().all(|b| b.is_ascii_alphanumeric())
}

/// The maximum size of a row in bytes.
const MAX_ROW: usize = 64 << 20;

/// Iterates over the rows of comma-separated values.
struct CsvRows<I> {
    bytes: I,
    most: usize,
}

impl<I: Iterator<Item = std::io::Result<u8>>> CsvRows<I> {
    /// Returns the cells of the next row, `None` at the end, or `Some(None)` if the text is not comma-separated values.
    fn next_row(&mut self) -> Option<Option<Vec<String>>> {
        let (mut cells, mut cell) = (Vec::new(), Vec::new());
        let (mut quoted, mut any, mut size) = (false, false, 0);
        loop {
            let byte = match self.bytes.next() {
                Some(Ok(byte)) => byte,
                Some(Err(_)) => return Some(None),
                None if quoted => return Some(None),
                None if !any => return None,
                None => b'\n',
            };
            any = true;
            size += 1;
            if size > self.most {
                return Some(None);
            }
            match byte {
                // Two quotes inside quotes close and reopen them, which makes no difference for counting cells.
                b'"' => quoted = !quoted,
                b',' | b'\n' if !quoted => {
                    let Ok(text) = String::from_utf8(std::mem::take(&mut cell)) else { return Some(None) };
                    cells.push(text);
                    if byte == b'\n' {
                        return Some(Some(cells));
                    }
                }
                byte => cell.push(byte),
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn own_tables_are_distinguished_from_measurements() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        let is_labspec_table = |text: &str| {
            fs::write(&path, text).unwrap();
            is_table(&path)
        };
        for table in [
            "time\n0\n0.002\n",
            "time,readout/height (m)\n0,1\n0.002,0.99\n0.002,\n",
            "time,\"plot/0/light, say\",readout/a\n0,1,\"two\nlines, \"\"quoted\"\"\"\n",
            "integrator,solver,timestep,own,label\nEuler,,0.002,true,\"a, b\"\n",
            "integrator,solver,timestep (s),own,label,unit\nEuler,,0.002,true,\"a, b\",\"m\"\n",
        ] {
            assert!(is_labspec_table(table), "{table}");
        }
        for other in [
            "",
            "time,height\n0,1\n0.1,0.95\n",
            "time,height\n0.0,1.0\n",
            "time\n0.10\n0.20\n",
            "time,readout/height (m)\n0,1\n0.002\n",
            "time,readout/height (m)\nnoon,1\n",
            "time,plot/x/height\n0,1\n",
            "time,readout/a\n0,\"never closed\n",
            "integrator,solver,order\nEuler,,1\n",
            "# A lesson\n\ntime, and what it is\n",
        ] {
            assert!(!is_labspec_table(other), "{other}");
        }
    }

    #[test]
    fn an_output_replaces_only_files_of_its_kind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.md");
        fs::write(&path, "as read").unwrap();
        let refused = |kind: OutputKind<'_>| kind.refusal(&path, &fs::metadata(&path).unwrap()).is_some();
        assert!(!refused(OutputKind::Lesson("as read")));
        assert!(refused(OutputKind::Lesson("as  read")) && refused(OutputKind::Lesson("AS READ")));
        assert!(refused(OutputKind::New) && refused(OutputKind::Snapshot) && refused(OutputKind::Reference));
        // An empty file with the extension of a lesson is still a lesson.
        fs::write(&path, "").unwrap();
        assert!(refused(OutputKind::Table) && refused(OutputKind::Page) && refused(OutputKind::New));
    }
}
