//! The baseline of known findings: `--baseline FILE` reports only findings that are not in it, `--update-baseline` replaces it.
//!
//! A finding is identified by its file, its code, its message and the text of its line, not by the line number, so that it is
//! still recognized when text moves. A finding about a claim is also identified by the claim, by the claimed value and by the
//! computed value: if the key or a value changes, the finding is new. The baseline stores how many equal findings there were.
//!
//! It also stores the claims that could not be checked because of a finding elsewhere, such as those of a lab that cannot run,
//! with the reason. A claim that can be checked later is checked like any other.

use super::common::Failure;
use super::digest;
use super::output_kind::OutputKind;
use super::report_json::{StoredReport, read_report, write_report};
use labspec::finding::Finding;
use labspec::ledger::{Entry, State, Subject};
use labspec::markdown::Block;
use labspec::source::SourceFile;
use labspec::spec::{FileKind, Lesson, kind_of};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

const STORED: StoredReport = StoredReport {
    name: "baseline",
    what: "a baseline",
    next_step: "name another file, or use --update-baseline to write one",
    output: OutputKind::Baseline,
};

/// The identification of a finding.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct BaselineKey {
    file: String,
    code: String,
    message: String,
    line: String,
}

/// The claim to which a finding belongs: its owner, and the claimed and the computed value.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct ClaimKey {
    claim: String,
    result: String,
}

#[derive(Serialize, Deserialize)]
struct BaselineEntry {
    #[serde(flatten)]
    key: BaselineKey,
    #[serde(default = "once")]
    count: usize,
    #[serde(flatten)]
    claim: Option<ClaimKey>,
}

fn once() -> usize {
    1
}

/// The identification of a claim that could not be checked.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct UncheckedKey {
    file: String,
    /// Its kind: `answer`.
    kind: String,
    /// The claim among several of its owner.
    part: String,
    reason: String,
    /// The digest of its block: whatever changes there makes other claims of them.
    block: String,
}

#[derive(Serialize, Deserialize)]
struct UncheckedEntry {
    #[serde(flatten)]
    key: UncheckedKey,
    #[serde(default = "once")]
    count: usize,
}

#[derive(Serialize, Deserialize)]
struct BaselineFile {
    findings: Vec<BaselineEntry>,
    #[serde(default)]
    unchecked: Vec<UncheckedEntry>,
}

/// The number of occurrences of each finding in the baseline.
#[derive(Debug, Default)]
pub(super) struct Baseline {
    folder: PathBuf,
    baselined: BTreeMap<(BaselineKey, Option<ClaimKey>), usize>,
    unchecked: BTreeMap<UncheckedKey, usize>,
}

impl Baseline {
    /// An empty baseline; the paths of files are relative to the folder of `path`.
    pub(super) fn new(path: &Path) -> Baseline {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
        Baseline { folder, ..Baseline::default() }
    }

    /// # Errors
    /// The file cannot be read, or is not a baseline.
    pub(super) fn read(path: &Path) -> Result<Baseline, Failure> {
        let mut all = Baseline::new(path);
        let BaselineFile { findings, unchecked } = read_report(path, &STORED)?;
        for BaselineEntry { key, count, claim } in findings {
            let baselined = all.baselined.entry((key, claim)).or_default();
            *baselined = baselined.saturating_add(count);
        }
        for UncheckedEntry { key, count } in unchecked {
            let baselined = all.unchecked.entry(key).or_default();
            *baselined = baselined.saturating_add(count);
        }
        Ok(all)
    }

    /// What the baseline has about files other than these, which a check of these files does not find again.
    pub(super) fn of_other_files(mut self, files: &[&SourceFile]) -> Baseline {
        let checked: BTreeSet<String> = files.iter().map(|file| self.relative(file.path())).collect();
        let is_there = |folder: &Path, file: &str| folder.join(file).exists();
        let folder = self.folder.clone();
        self.baselined.retain(|(key, _), _| !checked.contains(&key.file) && is_there(&folder, &key.file));
        self.unchecked.retain(|key, _| !checked.contains(&key.file) && is_there(&folder, &key.file));
        self
    }

    /// Removes the findings that are in the baseline, and returns them.
    pub(super) fn apply(&self, findings: &mut Vec<Finding>, files: &[&SourceFile]) -> Vec<Finding> {
        let mut met: BTreeMap<_, usize> = BTreeMap::new();
        let mut baselined = Vec::new();
        findings.retain(|f| {
            let key = self.key(f, files);
            let Some(&most) = self.baselined.get(&key) else { return true };
            let count = met.entry(key).or_default();
            *count += 1;
            if *count <= most {
                baselined.push(f.clone());
            }
            *count > most
        });
        baselined
    }

    /// The claims that could not be checked before, for the same reason, as indexes of the entries.
    pub(super) fn unchecked(&self, entries: &[Entry], lessons: &[&Lesson]) -> BTreeSet<usize> {
        let mut met: BTreeMap<_, usize> = BTreeMap::new();
        let open = entries.iter().enumerate().filter(|(_, entry)| is_unchecked_claim(entry));
        let recorded = open.filter(|(_, entry)| {
            let key = self.unchecked_key(entry, lessons);
            let most = self.unchecked.get(&key).copied().unwrap_or(0);
            let count = met.entry(key).or_default();
            *count += 1;
            *count <= most
        });
        recorded.map(|(i, _)| i).collect()
    }

    /// Adds findings and unchecked claims to the baseline, and writes it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn write(
        mut self,
        path: &Path,
        findings: &[Finding],
        files: &[&SourceFile],
        (entries, lessons): (&[Entry], &[&Lesson]),
    ) -> Result<(), Failure> {
        for entry in entries.iter().filter(|entry| is_unchecked_claim(entry)) {
            *self.unchecked.entry(self.unchecked_key(entry, lessons)).or_default() += 1;
        }
        for f in findings {
            *self.baselined.entry(self.key(f, files)).or_default() += 1;
        }
        let entries = self.baselined.into_iter();
        let findings = entries.map(|((key, claim), count)| BaselineEntry { key, count, claim }).collect();
        let unchecked =
            self.unchecked.into_iter().map(|(key, count)| UncheckedEntry { key, count }).collect();
        write_report(path, &STORED, &BaselineFile { findings, unchecked })
    }

    fn key(&self, f: &Finding, files: &[&SourceFile]) -> (BaselineKey, Option<ClaimKey>) {
        let file = files.iter().find(|file| *file.path() == f.path);
        let line = file.map_or("", |file| line(file.text(), f.span.start)).to_string();
        let claim = f.claim.as_ref().map(|c| ClaimKey {
            claim: if c.part.is_empty() { c.owner.clone() } else { format!("{}, {}", c.owner, c.part) },
            result: c.result.clone(),
        });
        let (file, code, message) = (self.relative(&f.path), f.code.to_string(), f.message.clone());
        (BaselineKey { file, code, message, line }, claim)
    }

    fn unchecked_key(&self, entry: &Entry, lessons: &[&Lesson]) -> UncheckedKey {
        let lesson = lessons.iter().find(|lesson| *lesson.file.path() == entry.path);
        let text = lesson.map_or("", |lesson| {
            let holds =
                |block: &&Block| block.span.start <= entry.span.start && entry.span.end <= block.span.end;
            let block = lesson.scan.blocks.iter().find(holds).map(|block| block.span.clone());
            let is_json = kind_of(Path::new(&*entry.path)) == FileKind::Json;
            let whole = || if is_json { 0..lesson.file.text().len() } else { entry.span.clone() };
            lesson.file.slice(block.unwrap_or_else(whole))
        });
        let [kind, part, reason] = [entry.subject.as_str(), &entry.what, &entry.remark].map(str::to_string);
        let block = digest::hex_of(&[text.as_bytes()]);
        UncheckedKey { file: self.relative(&entry.path), kind, part, reason, block }
    }

    /// The path of a file from the folder of the baseline.
    fn relative(&self, path: &str) -> String {
        let whole = Path::new(path).canonicalize().unwrap_or_else(|_| PathBuf::from(path));
        let name = whole.strip_prefix(&self.folder).unwrap_or(&whole);
        let parts: Vec<String> =
            name.components().map(|c| c.as_os_str().to_string_lossy().into_owned()).collect();
        parts.join("/")
    }
}

/// Whether an entry is a claim that could not be checked.
fn is_unchecked_claim(entry: &Entry) -> bool {
    entry.state == State::Unchecked && Subject::CLAIMS.contains(&entry.subject)
}

/// The line that contains a position, without surrounding space.
fn line(text: &str, offset: usize) -> &str {
    let (before, after) = text.split_at_checked(offset).unwrap_or((text, ""));
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    let end = offset + after.find('\n').unwrap_or(after.len());
    text.get(start..end).unwrap_or_default().trim()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use labspec::finding::InFile;
    use labspec::rules;

    #[test]
    fn moved_findings_are_baselined_and_new_ones_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("baseline.json");
        let file = |text: &str| SourceFile::new(folder.path().join("a.md").to_str().unwrap(), text);
        let found = |file: &SourceFile, word: &str| -> Vec<Finding> {
            let places = file.text().match_indices(word);
            places
                .map(|(offset, _)| Finding::new(rules::UNKNOWN_KEY, offset..offset + 1, "odd").at(file))
                .collect()
        };
        let old = file("one\n  odd here\nodd there\n");
        Baseline::new(&path).write(&path, &found(&old, "odd"), &[&old], (&[], &[])).unwrap();
        let new = file("one\n\n\nodd there\nodd here\n odd here\n");
        let mut findings = found(&new, "odd");
        let baselined = Baseline::read(&path).unwrap().apply(&mut findings, &[&new]);
        assert_eq!((baselined.len(), findings.len()), (2, 1));
        std::fs::write(&path, "{}").unwrap();
        assert!(Baseline::read(&path).unwrap_err().contains("--update-baseline"));
    }

    /// A wrong type, a missing key or a too large number gives an error with the file and the next step, and no panic.
    #[test]
    fn a_damaged_baseline_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("baseline.json");
        let finding = |count: &str| {
            format!(
                r#"{{"file":"a.md","code":"c","message":"m","line":"l","count":{count},"claim":"q","result":"r"}}"#
            )
        };
        let read = |findings: &str| {
            let text = format!(r#"{{"schemaVersion":1,"report":"baseline","findings":{findings}}}"#);
            std::fs::write(&path, text).unwrap();
            Baseline::read(&path)
        };
        let most = finding("18446744073709551615");
        let whole = read(&format!("[{most},{most}]")).unwrap();
        assert_eq!(whole.baselined.values().collect::<Vec<_>>(), [&usize::MAX]);
        let long = format!("[\"{}\"]", "\u{202e}".repeat(1000));
        for findings in ["7", "[7]", "[{}]", &long, &finding("1"), &format!("[{}]", finding("1e400"))] {
            let error = read(findings).unwrap_err();
            assert!(
                error.contains("baseline.json is not a baseline: ") && error.contains("--update-baseline")
            );
            assert!(error.len() < 2000 && !error.contains('\u{202e}'), "{error}");
        }
        for count in ["-1", "1.5", "\"1\"", "null"] {
            assert!(read(&format!("[{}]", finding(count))).is_err(), "{count}");
        }
    }
}
