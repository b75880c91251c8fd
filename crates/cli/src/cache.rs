//! The cache of check results, identified by the content of a lesson, of its models and of this program.
//!
//! Each lesson has one file with its last result. The result is valid only if the same program computed it, from the same bytes
//! and at the same check level; otherwise the lesson is checked again. If the cache cannot be written, nothing is stored.

use super::digest;
use super::output::clear_abandoned;
use labspec::bind::parts::ModelFile;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, LabOutcome};
use labspec::source::Text;
use labspec::spec::{Lab, Lesson, ModelSource};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The storage of results.
#[derive(Debug)]
pub(super) struct Cache {
    /// A folder with a file for each lesson.
    folder: Option<PathBuf>,
    /// The memory of this process, used while it waits for changes.
    memory: Option<Mutex<BTreeMap<String, String>>>,
    /// The version and the digest of this program.
    program: String,
}

impl Cache {
    /// Opens the user's cache, unless `off`. With `memory`, results are stored in this process as well.
    pub(super) fn open(off: bool, memory: bool) -> Cache {
        let folder = if off { None } else { folder() };
        if let Some(folder) = &folder {
            clear_abandoned(folder, is_unfinished);
        }
        let program = folder.as_deref().map(program);
        // A program without a digest stores nothing on disk, because its results could not be attributed to it.
        let has_digest = program.as_ref().is_some_and(Option::is_some);
        Cache {
            folder: folder.filter(|_| has_digest),
            memory: memory.then(Mutex::default),
            program: program.flatten().unwrap_or_default(),
        }
    }

    fn is_off(&self) -> bool {
        self.folder.is_none() && self.memory.is_none()
    }

    /// Returns the findings of a lesson: from the cache, or computed and stored, unless `cancelled` states that
    /// the check was incomplete.
    pub(super) fn check_cached(
        &self,
        path: &Path,
        lesson: &Lesson,
        models: &Models,
        level: CheckLevel,
        cancelled: impl Fn() -> bool,
    ) -> LabOutcome {
        if self.is_off() {
            return check::run_checks(lesson, models, level);
        }
        let (slot, key) = (slot(path, level), self.key(lesson, models, level));
        if let Some(found) = self.load(&slot).and_then(|text| read_entry(&text, &key, lesson, models)) {
            return found;
        }
        let found = check::run_checks(lesson, models, level);
        if !cancelled()
            && let Some(text) = entry(&key, lesson, models, &found)
        {
            self.save(&slot, text);
        }
        found
    }

    /// Everything on which a result depends, except the models.
    fn key(&self, lesson: &Lesson, models: &Models, level: CheckLevel) -> String {
        let flags =
            [level.programs, level.labs, level.claims, models.folder().names().is_some()].map(u8::from);
        let file = &lesson.file;
        let (stored, snapshot) = match &lesson.snapshot {
            None => (0, ""),
            Some(Ok(snapshot)) => (1, snapshot.text()),
            Some(Err(why)) => (2, why.as_str()),
        };
        let texts = [file.path().as_bytes(), file.text().as_bytes(), snapshot.as_bytes()];
        let [path, text, snapshot] = texts;
        let conventions = format!("{:?}", lesson.conventions);
        let inputs =
            [self.program.as_bytes(), &flags, path, text, &[stored], snapshot, conventions.as_bytes()];
        let others = lesson.others.iter().flat_map(|other| {
            let why = other.lab.as_ref().err().map_or("", String::as_str);
            [other.path.as_bytes(), other.text.as_bytes(), why.as_bytes()]
        });
        let data = lesson.data.iter().flat_map(|file| {
            let text = file.text.as_deref().unwrap_or_else(|why| why);
            [file.path.as_os_str().as_encoded_bytes(), text.as_bytes()]
        });
        digest::hex_of(&inputs.into_iter().chain(others).chain(data).collect::<Vec<_>>())
    }

    /// A text that was stored, if it is complete.
    pub(super) fn load_text(&self, slot: &str) -> Option<String> {
        self.load(slot).as_deref().and_then(whole).map(str::to_string)
    }

    /// Stores a text, unless the cache is off.
    pub(super) fn save_text(&self, slot: &str, text: &str) {
        self.save(slot, with_digest(text));
    }

    fn load(&self, slot: &str) -> Option<String> {
        if let Some(memory) = &self.memory
            && let Some(text) = memory.lock().unwrap_or_else(PoisonError::into_inner).get(slot)
        {
            return Some(text.clone());
        }
        std::fs::read_to_string(self.folder.as_ref()?.join(slot)).ok()
    }

    fn save(&self, slot: &str, text: String) {
        if let Some(folder) = &self.folder {
            write(folder, slot, &text);
        }
        if let Some(memory) = &self.memory {
            memory.lock().unwrap_or_else(PoisonError::into_inner).insert(slot.to_string(), text);
        }
    }
}

/// The folder of the cache on this machine. No results are stored if `LABSPEC_CACHE` is empty or `off`.
pub(super) fn folder() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let full = |path: &PathBuf| path.is_absolute();
    if let Some(folder) = set("LABSPEC_CACHE") {
        return Some(folder).filter(|folder| !folder.as_os_str().is_empty() && folder.as_os_str() != "off");
    }
    let caches = if cfg!(windows) {
        set("LOCALAPPDATA").filter(full)
    } else {
        set("XDG_CACHE_HOME").filter(full).or_else(|| Some(set("HOME").filter(full)?.join(".cache")))
    };
    Some(caches?.join("labspec"))
}

/// The name of the lesson's file in the cache.
fn slot(path: &Path, level: CheckLevel) -> String {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let flags = [level.programs, level.labs, level.claims].map(u8::from);
    digest::hex_of(&[real.as_os_str().as_encoded_bytes(), &flags])
}

/// The names of the models of a lesson's labs, without duplicates.
fn named_models(lesson: &Lesson) -> BTreeSet<&str> {
    let named = |lab: &'_ Lab| matches!(lab.scene(), Some(ModelSource::Model(_)));
    let others = lesson.others.iter().filter_map(|other| other.lab.as_ref().ok());
    let labs = lesson.all_labs().into_iter().chain(others).filter(|lab| named(lab));
    labs.filter_map(|lab| lab.model.as_ref().map(Text::as_str)).collect()
}

/// A result with its dependencies.
#[derive(Serialize, Deserialize)]
struct CacheEntry<O> {
    key: String,
    models: Vec<UsedModel>,
    found: O,
}

/// A model that a lab of the lesson uses.
#[derive(Serialize, Deserialize)]
struct UsedModel {
    name: String,
    has_diagnostics: bool,
    /// `None` if the folder has no such model.
    files: Option<Vec<ModelFile>>,
}

/// The result as text, or `None` if it would not be equal after reading it back.
fn entry(key: &str, lesson: &Lesson, models: &Models, found: &LabOutcome) -> Option<String> {
    let used = named_models(lesson).into_iter().map(|name| {
        let (files, has_diagnostics) = models.parts(name).unzip();
        UsedModel { name: name.into(), has_diagnostics: has_diagnostics.unwrap_or_default(), files }
    });
    let entry = CacheEntry { key: key.to_string(), models: used.collect(), found };
    let body = serde_json::to_string(&entry).ok()?;
    let again: CacheEntry<LabOutcome> = serde_json::from_str(&body).ok()?;
    (serde_json::to_string(&again).ok()? == body).then(|| with_digest(&body))
}

/// The result in a text, if it is complete and belongs to these models. Models with diagnostics are compiled, so
/// that these are reported.
fn read_entry(text: &str, key: &str, lesson: &Lesson, models: &Models) -> Option<LabOutcome> {
    let entry: CacheEntry<LabOutcome> = serde_json::from_str(whole(text)?).ok()?;
    let is_same = |used: &UsedModel| match &used.files {
        None => models.folder().path(&used.name).is_none(),
        Some(files) => models.is_made_of(&used.name, files),
    };
    let is_about_these = entry.models.iter().map(|used| used.name.as_str()).eq(named_models(lesson));
    if entry.key != key || !is_about_these || !entry.models.iter().all(is_same) {
        return None;
    }
    for used in entry.models.iter().filter(|used| used.has_diagnostics) {
        models.load(&used.name);
    }
    Some(entry.found)
}

/// A text after its digest.
fn with_digest(body: &str) -> String {
    format!("{}\n{body}", digest::hex(body.as_bytes()))
}

/// The text after a digest, if the digest matches.
fn whole(text: &str) -> Option<&str> {
    let (hash, body) = text.split_once('\n')?;
    (digest::hex(body.as_bytes()) == hash).then_some(body)
}

/// The version and the digest of this program's file. Reading the whole file takes longer than many checks, so its digest is
/// cached as well, under the metadata of the file.
fn program(folder: &Path) -> Option<String> {
    let path = std::env::current_exe().ok()?;
    let slot = format!("program-{}", digest::hex_of(&[identity(&path)?.as_bytes()]));
    let cached = std::fs::read_to_string(folder.join(&slot)).ok();
    let digest = match cached.as_deref().and_then(whole) {
        Some(digest) => digest.to_string(),
        None => {
            let digest = digest::hex(&std::fs::read(&path).ok()?);
            write(folder, &slot, &with_digest(&digest));
            digest
        }
    };
    Some(format!("results 2 of labspec {} {digest}", env!("CARGO_PKG_VERSION")))
}

/// The metadata that identify a file.
fn identity(path: &Path) -> Option<String> {
    let meta = std::fs::metadata(path).ok()?;
    let mut text = format!("{} {} {:?}", path.display(), meta.len(), meta.modified().ok()?);
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        text.push_str(&format!(" {} {} {} {}", meta.dev(), meta.ino(), meta.ctime(), meta.ctime_nsec()));
    }
    Some(text)
}

/// Whether this is the name of a temporary file of the cache: `12-0.new`.
fn is_unfinished(name: &str) -> bool {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let inside = name.strip_suffix(".new").and_then(|rest| rest.split_once('-'));
    inside.is_some_and(|(a, b)| number(a) && number(b))
}

/// Writes a file of the cache atomically.
fn write(folder: &Path, slot: &str, text: &str) {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let new = folder.join(format!("{}-{}.new", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    let done = std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&new, text))
        .and_then(|()| std::fs::rename(&new, folder.join(slot)));
    if done.is_err() {
        let _ = std::fs::remove_file(&new);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::ModelFolder;
    use labspec::lint::load_lesson;
    use labspec::source::SourceFile;
    use std::cell::Cell;

    const FULL_CHECK: CheckLevel = CheckLevel::FULL;
    const LESSON: &str = r#"{"model": "drop", "title": "Drop", "stopAt": 0.1,
        "controls": [{"label": "v", "set": "data.qvel[2]", "min": 0, "max": 1, "value": 0}],
        "readouts": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "n", "expr": "data.qops"}],
        "verify": {"runs": {"r": {"until": 0.1}}, "measure": {"z": "final(data.qpos[2])", "none": "before(data.time > 9, 1)"},
            "says": [["1.0 m", "z"]]}}"#;

    /// A folder with a model that includes another file.
    fn course() -> tempfile::TempDir {
        let top = tempfile::tempdir().unwrap();
        std::fs::create_dir(top.path().join("models")).unwrap();
        let model = "<mujoco><include file='ball.xml'/></mujoco>";
        std::fs::write(top.path().join("models/drop.xml"), model).unwrap();
        write_ball(top.path(), "<geom size='0.05'/>");
        top
    }

    fn write_ball(top: &Path, inside: &str) {
        let ball =
            format!("<mujoco><worldbody><body pos='0 0 1'><freejoint/>{inside}</body></worldbody></mujoco>");
        std::fs::write(top.join("models/ball.xml"), ball).unwrap();
    }

    fn models(top: &Path) -> Models {
        Models::with_hash(ModelFolder::open(&top.join("models")).unwrap(), digest::hex_of)
    }

    fn lesson(models: &Models, text: &str) -> Lesson {
        load_lesson(SourceFile::new("drop.json", text), models.folder())
    }

    #[test]
    fn written_results_are_read_back() {
        let top = course();
        let models = models(top.path());
        let lesson = lesson(&models, LESSON);
        let found = check::run_checks(&lesson, &models, FULL_CHECK);
        assert!(
            !found.findings.is_empty() && found.labs[0].runs == 5 && found.claims.len() == 1,
            "{found:?}"
        );
        let text = entry("key", &lesson, &models, &found).unwrap();
        let again = read_entry(&text, "key", &lesson, &models).unwrap();
        assert_eq!(format!("{found:?}"), format!("{again:?}"));
        assert!(read_entry(&text, "other", &lesson, &models).is_none());
    }

    /// A changed byte or a truncated file gives no result.
    #[test]
    fn a_damaged_result_is_not_read() {
        let top = course();
        let models = models(top.path());
        let lesson = lesson(&models, LESSON);
        let found = check::run_checks(&lesson, &models, FULL_CHECK);
        let text = entry("key", &lesson, &models, &found).unwrap();
        for i in 0..text.len() {
            for bit in [0x01, 0x20, 0x80] {
                let mut bytes = text.clone().into_bytes();
                bytes[i] ^= bit;
                let Ok(damaged) = String::from_utf8(bytes) else { continue };
                assert!(read_entry(&damaged, "key", &lesson, &models).is_none(), "byte {i}");
            }
            assert!(read_entry(&text[..i], "key", &lesson, &models).is_none(), "{i} bytes");
        }
        // A complete entry with another structure gives no result, and no panic.
        for body in [
            "",
            "[]",
            "[1,2,3]",
            "{}",
            "[\"key\",[],[[],[],[],[]]]",
            "{\"key\":\"key\",\"models\":[{\"name\":\"drop\",\"has_diagnostics\":false,\"files\":[]}],\"found\":[[],[],[],[]]}",
        ] {
            let foreign = format!("{}\n{body}", digest::hex(body.as_bytes()));
            assert!(read_entry(&foreign, "key", &lesson, &models).is_none(), "{body}");
        }
    }

    /// A lesson is checked again exactly when something changes on which the result depends.
    #[test]
    fn a_result_is_about_the_same_bytes() {
        let top = course();
        let cache = Cache { folder: Some(top.path().join("cache")), memory: None, program: "one".into() };
        let fresh = |cache: &Cache, text: &str, level: CheckLevel| {
            let models = models(top.path());
            let asked = Cell::new(false);
            let cancelled = || {
                asked.set(true);
                false
            };
            let lesson = lesson(&models, text);
            cache.check_cached(&top.path().join("drop.json"), &lesson, &models, level, cancelled);
            asked.get()
        };
        let newer = LESSON.replace("Drop", "Fall");
        assert!(fresh(&cache, LESSON, FULL_CHECK));
        assert!(!fresh(&cache, LESSON, FULL_CHECK));
        assert!(fresh(&cache, &newer, FULL_CHECK), "the lesson");
        assert!(!fresh(&cache, &newer, FULL_CHECK));
        assert!(fresh(&cache, &newer, CheckLevel::CLAIMS), "the depth");
        write_ball(top.path(), "<geom size='0.06'/>");
        assert!(fresh(&cache, &newer, FULL_CHECK), "a file that the model includes");
        assert!(!fresh(&cache, &newer, FULL_CHECK));
        std::fs::write(top.path().join("models/drop.xml"), "<mujoco> <include file='ball.xml'/></mujoco>")
            .unwrap();
        assert!(fresh(&cache, &newer, FULL_CHECK), "the model");
        std::fs::remove_file(top.path().join("models/drop.xml")).unwrap();
        assert!(fresh(&cache, &newer, FULL_CHECK), "the model is gone");
        assert!(!fresh(&cache, &newer, FULL_CHECK));
        let other = Cache { program: "two".into(), ..cache };
        assert!(fresh(&other, &newer, FULL_CHECK), "the program");
        // A damaged file on disk: the lesson is checked again, and the file is replaced.
        for file in std::fs::read_dir(top.path().join("cache")).unwrap() {
            std::fs::write(file.unwrap().path(), [0xff, 0, 0x80]).unwrap();
        }
        assert!(fresh(&other, &newer, FULL_CHECK), "damage");
        assert!(!fresh(&other, &newer, FULL_CHECK));
    }

    /// A model reports its diagnostics even if the result of its lab is cached.
    #[test]
    fn cached_models_report_their_diagnostics_again() {
        let top = course();
        write_ball(top.path(), "text <geom size='0.05'/>");
        let mut first = models(top.path());
        let read = lesson(&first, LESSON);
        let found = check::run_checks(&read, &first, FULL_CHECK);
        let text = entry("key", &read, &first, &found).unwrap();
        let mut second = models(top.path());
        assert!(read_entry(&text, "key", &read, &second).is_some());
        let findings = first.take_findings();
        assert!(!findings.is_empty());
        assert_eq!(findings, second.take_findings());
    }
}
