//! Findings that are known: `--baseline FILE` tells only those that are not in it, `--update-baseline` writes it anew.
//!
//! A finding is known by its file, its code, its words and the line that it stands in, not by the number of that line: text that
//! moves stays known. A finding about a claim is known by the claim, too, and by what was claimed and what came out: a key that moved, or
//! another value, is new. Of several alike so many are known as there were.

use super::common::Failure;
use super::output::write_file;
use super::output_kind::OutputKind;
use labspec::finding::Finding;
use labspec::report::{self, printable_path};
use labspec::source::{SourceFile, read_text};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Its bytes, at most.
const MOST: u64 = 64 << 20;

/// What a finding is known by.
type Mark = [String; 6];

/// How often each is known.
#[derive(Debug, Default)]
pub(super) struct Baseline {
    folder: PathBuf,
    baselined: BTreeMap<Mark, usize>,
}

impl Baseline {
    /// Nothing is known; files are named from the folder of a file.
    pub(super) fn new(path: &Path) -> Baseline {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
        Baseline { folder, baselined: BTreeMap::new() }
    }

    /// # Errors
    /// It cannot be read, or is no baseline.
    pub(super) fn read(path: &Path) -> Result<Baseline, Failure> {
        let no = |why: &str| {
            format!(
                "{} is not a baseline: {why}; name another file, or use --update-baseline to write one",
                printable_path(path)
            )
        };
        let text = read_text(path, MOST, "a baseline")?;
        let value: Value = serde_json::from_str(&text).map_err(|e| no(&e.to_string()))?;
        if value["report"] != "baseline" || value["schemaVersion"] != report::SCHEMA_VERSION {
            return Err(no("its version is missing or unsupported"));
        }
        let mut all = Baseline::new(path);
        for entry in value["findings"].as_array().ok_or_else(|| no("it has no findings"))? {
            let text = |key: &str| entry[key].as_str().map(String::from);
            let mark = [text("file"), text("code"), text("message"), text("line")];
            let [Some(file), Some(code), Some(message), Some(line)] = mark else {
                return Err(no("one of its findings is incomplete"));
            };
            let count = entry["count"].as_u64().unwrap_or(1) as usize;
            // Findings about something else carry no claim.
            let [claim, result] = [text("claim"), text("result")].map(Option::unwrap_or_default);
            *all.baselined.entry([file, code, message, line, claim, result]).or_default() += count;
        }
        Ok(all)
    }

    /// Takes out what is known.
    pub(super) fn apply(&self, findings: &mut Vec<Finding>, files: &[&SourceFile]) -> Vec<Finding> {
        let mut met: BTreeMap<Mark, usize> = BTreeMap::new();
        let mut baselined = Vec::new();
        findings.retain(|f| {
            let mark = self.mark(f, files);
            let Some(&most) = self.baselined.get(&mark) else { return true };
            let count = met.entry(mark).or_default();
            *count += 1;
            if *count <= most {
                baselined.push(f.clone());
            }
            *count > most
        });
        baselined
    }

    /// Makes findings known, and writes them.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn write(
        mut self,
        path: &Path,
        findings: &[Finding],
        files: &[&SourceFile],
    ) -> Result<(), Failure> {
        for f in findings {
            *self.baselined.entry(self.mark(f, files)).or_default() += 1;
        }
        let one = |([file, code, message, line, claim, result], count): (&Mark, &usize)| {
            let mut entry =
                json!({"file": file, "code": code, "message": message, "line": line, "count": count});
            if !claim.is_empty() {
                entry["claim"] = json!(claim);
                entry["result"] = json!(result);
            }
            entry
        };
        let list: Vec<Value> = self.baselined.iter().map(one).collect();
        let value = report::report("baseline", json!({"findings": list}));
        let text = serde_json::to_string_pretty(&value).map_err(|e| e.to_string())?;
        write_file(path, OutputKind::Baseline, &(text + "\n"))
    }

    fn mark(&self, f: &Finding, files: &[&SourceFile]) -> Mark {
        let path = Path::new(&*f.path);
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let name = whole.strip_prefix(&self.folder).unwrap_or(&whole);
        let name: Vec<String> =
            name.components().map(|c| c.as_os_str().to_string_lossy().into_owned()).collect();
        let file = files.iter().find(|file| *file.path() == f.path);
        let line = file.map_or("", |file| line(file.text(), f.span.start));
        let (claim, result) = match &f.claim {
            Some(claim) if claim.part.is_empty() => (claim.owner.clone(), claim.result.clone()),
            Some(claim) => (format!("{}, {}", claim.owner, claim.part), claim.result.clone()),
            None => Default::default(),
        };
        [name.join("/"), f.code.to_string(), f.message.clone(), line.to_string(), claim, result]
    }
}

/// The line that holds a place, without the space around it.
fn line(text: &str, at: usize) -> &str {
    let (before, after) = text.split_at_checked(at).unwrap_or((text, ""));
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    let end = at + after.find('\n').unwrap_or(after.len());
    text.get(start..end).unwrap_or_default().trim()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use labspec::finding::InFile;
    use labspec::rules;

    #[test]
    fn what_has_moved_is_known_and_what_is_new_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("baseline.json");
        let file = |text: &str| SourceFile::new(folder.path().join("a.md").to_str().unwrap(), text);
        let found = |file: &SourceFile, word: &str| -> Vec<Finding> {
            let places = file.text().match_indices(word);
            places.map(|(at, _)| Finding::new(rules::UNKNOWN_KEY, at..at + 1, "odd").at(file)).collect()
        };
        let old = file("one\n  odd here\nodd there\n");
        Baseline::new(&path).write(&path, &found(&old, "odd"), &[&old]).unwrap();
        let new = file("one\n\n\nodd there\nodd here\n odd here\n");
        let mut findings = found(&new, "odd");
        let baselined = Baseline::read(&path).unwrap().apply(&mut findings, &[&new]);
        assert_eq!((baselined.len(), findings.len()), (2, 1));
        std::fs::write(&path, "{}").unwrap();
        assert!(Baseline::read(&path).unwrap_err().contains("--update-baseline"));
    }
}
