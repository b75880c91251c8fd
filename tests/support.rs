//! Shared functions of the test modules: paths, models, and the recorded values of MuJoCo.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used, clippy::panic)]

pub(crate) mod random;
pub(crate) mod report;
pub(crate) mod schema;

use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked};
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use labspec_core::Model;
use labspec_core::xml::{self, Finding, Folder};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// The workspace, two folders above the crate of the tests.
pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The files of a folder in a fixed order; none if there is no such folder.
pub(crate) fn sorted_files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().map(|e| e.unwrap().path()).collect();
    files.sort();
    files
}

/// The processor time of this thread, if known.
pub(crate) fn thread_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse().ok().map(Duration::from_nanos)
}

/// A model of `tests/golden/models`, as text.
pub(crate) fn model_text(name: &str) -> String {
    std::fs::read_to_string(workspace().join(format!("tests/golden/models/{name}.xml"))).unwrap()
}

/// A model of `tests/golden/models`.
pub(crate) fn model(name: &str) -> Model {
    compile(&model_text(name))
}

/// Compiles a model that must be valid.
pub(crate) fn compile(xml: &str) -> Model {
    xml::compile(xml).unwrap_or_else(|list| {
        let text: Vec<String> = list.iter().map(|d| d.to_string()).collect();
        panic!("the model does not compile:\n{}\n{xml}", text.join("\n"))
    })
}

/// Compiles a model file with constraints disabled in its text, as for the recordings of MuJoCo.
pub(crate) fn compile_unconstrained(path: &Path) -> Result<Model, Vec<Finding>> {
    let text = std::fs::read_to_string(path).unwrap();
    let folder = Folder::new(path.parent().unwrap()).unwrap();
    xml::compile_with(&unconstrained(&text), &folder, path.file_name().and_then(|name| name.to_str()))
}

/// The text of a model with constraints disabled.
pub(crate) fn unconstrained(text: &str) -> String {
    let root = text.find("<mujoco").unwrap();
    let end = root + text[root..].find('>').unwrap();
    let (head, tail) = if text[..end].ends_with('/') {
        (format!("{}>", &text[..end - 1]), format!("</mujoco>{}", &text[end + 1..]))
    } else {
        (text[..=end].to_string(), text[end + 1..].to_string())
    };
    format!("{head}<option><flag constraint=\"disable\"/></option>{tail}")
}

/// A file of `tests/golden`, by its name without the extension.
pub(crate) fn recording(name: &str) -> Value {
    read_json(&workspace().join(format!("tests/golden/{name}.json")))
}

pub(crate) fn read_json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap()
}

/// The models (`.xml`) of a folder, by name.
pub(crate) fn models(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.filter_map(|e| e.file_name().into_string().ok());
    let mut names: Vec<String> = files.filter_map(|f| f.strip_suffix(".xml").map(String::from)).collect();
    names.sort();
    names
}

/// The numbers of a recorded array: words separated by spaces, with `0*12` for twelve zeros. Rust parses
/// each to the written bits.
pub(crate) fn numbers(recorded: &Value) -> Vec<f64> {
    let mut all = Vec::new();
    for word in recorded.as_str().unwrap().split_whitespace() {
        let (x, n) = word.split_once('*').unwrap_or((word, "1"));
        all.extend(std::iter::repeat_n(x.parse::<f64>().unwrap(), n.parse().unwrap()));
    }
    all
}

/// Checks a lesson or a lab given as text, with runs and verdicts; models are inline.
pub(crate) fn check_text(name: &str, text: &str) -> Checked {
    let models = Models::new(ModelFolder::unknown());
    let lesson = load_lesson(SourceFile::new(name, text), models.folder());
    check::check_lesson(lesson, &models, CheckLevel::FULL)
}

/// The codes of all findings.
pub(crate) fn codes(checked: &Checked) -> Vec<&'static str> {
    checked.findings.iter().map(|f| f.code).collect()
}

/// Calls `work` for each index on all processors; the results are in order.
pub(crate) fn for_each<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(2, usize::from);
    let mut all: Vec<(usize, T)> = std::thread::scope(|scope| {
        let run = || {
            let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|i| *i < count);
            std::iter::from_fn(take).map(|i| (i, work(i))).collect::<Vec<_>>()
        };
        let handles: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        handles.into_iter().flat_map(|h| h.join().unwrap()).collect()
    });
    all.sort_by_key(|(i, _)| *i);
    all.into_iter().map(|(_, t)| t).collect()
}
