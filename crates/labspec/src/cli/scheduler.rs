//! The files of a course, each read and checked, on as many threads as there are.
//!
//! What came of a file does not depend on the thread that checked it, and is put together in the order of the files.

use super::baseline::Baseline;
use super::cache::Cache;
use super::collect::{Collected, collect, lost_snapshots};
use super::digest;
use super::policy::{Policies, Policy, PolicyOptions};
use super::stdio::{complain, print};
use super::target::{model_folder_within, root};
use super::{Failure, ModelOptions, interrupted};
use crate::bind::parts::Hash;
use crate::bind::scene::{Models, check_model_file};
use crate::check::{self, Allowed, Basis, CheckLevel, Checked, CrossCheck, Drawn, LabOutcome, Recording};
use crate::finding::{self, Finding, Severity};
use crate::ledger::{Entry, Evidence, Ledger, State, Subject};
use crate::lint::{self, ModelFolder, load_lesson_at, load_lesson_file};
use crate::report::{Summary, human, printable_path};
use crate::rules;
use crate::source::{SourceFile, Sources};
use crate::spec::{FileKind, Lesson, kind_of};
use crate::threads;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What is checked, and how.
pub(super) struct Plan<'a> {
    pub(super) paths: &'a [PathBuf],
    /// A lesson from standard input: under which name, and its text.
    pub(super) stdin: Option<&'a (PathBuf, String)>,
    pub(super) models: &'a ModelOptions,
    pub(super) depth: CheckLevel,
    /// What is told of what is found.
    pub(super) policy: &'a PolicyOptions,
    /// What is known and not told again.
    pub(super) baseline: Option<&'a Baseline>,
    /// What every verdict rests on is asked for.
    pub(super) basis: bool,
    /// A second judge is asked, or heard.
    pub(super) judge: Judge<'a>,
    /// What the labs show in the runs of the claims is asked for.
    pub(super) curves: bool,
    /// Most threads.
    pub(super) jobs: usize,
    /// Names of files are shown while they are checked.
    pub(super) progress: bool,
    /// Findings of a lesson are printed as soon as it and those before it are checked; in colour, if so.
    pub(super) reported: Option<bool>,
}

/// A second judge.
#[derive(Clone, Copy, Default)]
pub(super) struct Judge<'a> {
    /// Its runs are asked for.
    pub(super) ask: bool,
    /// What it has recorded.
    pub(super) recording: Option<&'a Recording>,
}

/// Everything that was checked, and what it came to.
#[derive(Default)]
pub(super) struct Course {
    pub(super) checked: Vec<Checked>,
    /// What the check of each lesson rests on, where that is asked for.
    pub(super) bases: Vec<Basis>,
    /// What a second judge is asked about each lesson, and what it says.
    pub(super) hearings: Vec<CrossCheck>,
    /// The engine of that judge.
    pub(super) judged_by: Option<String>,
    /// What the labs of each lesson show in the runs of its claims, where that is asked for.
    pub(super) curves: Vec<Vec<Drawn>>,
    pub(super) findings: Vec<Finding>,
    /// Those of the findings that are known only when all lessons are checked: of models, and of lessons together.
    pub(super) last: Vec<Finding>,
    pub(super) ledger: Ledger,
    /// What was found and is not told.
    pub(super) suppressed: Aside,
    /// Files that are shown with findings, besides the lessons.
    pub(super) sources: Vec<SourceFile>,
    /// Every file that it depends on, and the folders of models.
    pub(super) read: BTreeSet<PathBuf>,
}

/// What was found and is not told: by the reader's wish, by the author's, or as it is in the baseline.
#[derive(Default)]
pub(super) struct Aside {
    pub(super) ignored: Vec<Finding>,
    pub(super) allowed: Vec<Allowed>,
    pub(super) baselined: Vec<Finding>,
    /// The check of the lesson was ended by a mistake of the program.
    failed: bool,
}

/// What is to be done with a file.
enum Task {
    /// Check the lesson, with the models of this number.
    Lesson(usize),
    /// Check the model; what it names lies below this folder.
    Model(PathBuf),
    /// Nothing, for this reason.
    Refuse(String),
}

/// What came of a file.
enum Done {
    Lesson(Box<Checked>, Aside, Basis, Vec<Drawn>, CrossCheck),
    /// JSON that is not ours.
    Other,
    Model(bool, Vec<Finding>, Vec<SourceFile>),
    /// It could not be read.
    Refused(String),
    /// Ctrl-C was pressed before it was checked.
    Interrupted,
}

/// Reads and checks every file. One that cannot be read is a finding and hides nothing of the others.
pub(super) fn check_lessons(plan: &Plan<'_>, cache: &Cache) -> Result<Course, Failure> {
    look_marked(plan, cache, digest::hex_of)
}

/// The same with another way to mark the files of models.
fn look_marked(plan: &Plan<'_>, cache: &Cache, mark: Hash) -> Result<Course, Failure> {
    let collected = collect(plan.paths);
    collected.complain();
    let Collected { mut files, problems, left_out } = collected;
    if let Some((name, _)) = plan.stdin {
        // What is piped stands for the file of its name.
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        files.retain(|(path, _)| real(path) != real(name));
        files.push((name.clone(), true));
    }
    if files.is_empty() {
        return Err(nothing(plan.paths, &problems));
    }
    let (tasks, mut by_folder) = tasks(plan, &files, mark)?;
    let mut policies = Policies::new(plan.policy)?;
    let of_files: Vec<Policy> = files.iter().map(|(path, _)| policies.of(path)).collect::<Result<_, _>>()?;
    let next = AtomicUsize::new(0);
    let told = Mutex::new(Told::default());
    let work = || {
        let mut done = Vec::new();
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let (Some(task), Some((path, named))) = (tasks.get(i), files.get(i)) else { return done };
            let found = threads::apart(|| one(plan, cache, task, path, *named, &by_folder));
            let mut found = found.unwrap_or_else(|why| Done::Refused(failed(&why)));
            if let (Done::Lesson(c, aside, ..), Some(policy)) = (&mut found, of_files.get(i)) {
                let c = &mut **c;
                suppress(plan, policy, &mut c.findings, &[&c.lesson.file], aside);
                aside.allowed = std::mem::take(&mut c.allowed);
            }
            if let Some(colour) = plan.reported {
                let text = match &found {
                    Done::Lesson(c, ..) => human(&c.findings, &[&c.lesson.file], colour),
                    _ => String::new(),
                };
                tell(&told, i, text, plan.progress);
            }
            done.push((i, found));
        }
    };
    let mut done = std::thread::scope(|scope| {
        let others = 1..plan.jobs.min(files.len());
        // Where the system gives no thread, those that there are do all the work.
        let thread = || threads::checking().spawn_scoped(scope, work).ok();
        let threads: Vec<_> = others.map_while(|_| thread()).collect();
        let mut done = work();
        for thread in threads {
            match thread.join() {
                Ok(more) => done.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        done
    });
    if plan.progress {
        complain("\r\x1b[K");
    }
    if let Some(failure) = told.into_inner().unwrap_or_else(PoisonError::into_inner).failure {
        return Err(failure);
    }
    done.sort_by_key(|(i, _)| *i);
    let judged_by = plan.judge.recording.map(|r| r.engine.clone());
    let mut course = Course { judged_by, ..Course::default() };
    let mut refused: Vec<(PathBuf, String)> = problems;
    let mut broken_off = BTreeSet::new();
    let mut read = 0;
    for ((path, _), (_, done)) in files.iter().zip(done) {
        course.read.insert(path.clone());
        read += usize::from(!matches!(done, Done::Refused(_)));
        match done {
            Done::Lesson(checked, aside, basis, curves, hearing) => {
                course.hearings.push(hearing);
                course.bases.push(basis);
                course.curves.push(curves);
                if aside.failed {
                    broken_off.insert(checked.lesson.file.path().clone());
                }
                course.checked.push(*checked);
                course.suppressed.ignored.extend(aside.ignored);
                course.suppressed.allowed.extend(aside.allowed);
                course.suppressed.baselined.extend(aside.baselined);
            }
            Done::Other => {}
            Done::Model(loads, findings, files) => {
                course.ledger.add(model_entry(path, loads));
                course.last.extend(findings);
                course.sources.extend(files);
            }
            Done::Refused(why) => refused.push((path.clone(), why)),
            // What was asked for and not looked at is no silence.
            Done::Interrupted => refused.push((path.clone(), "interrupted before it was checked".into())),
        }
    }
    if read == 0 {
        return Err(nothing(plan.paths, &refused));
    }
    for (path, why) in refused {
        let mut f = Finding::error(rules::UNREADABLE_FILE, 0..0, why)
            .why("nothing in it is checked")
            .help("fix the file, or exclude it");
        f.path = Arc::from(path.display().to_string());
        course.last.push(f);
    }
    course.read.extend(files.iter().map(|(path, _)| lint::snapshot_path(path)));
    let others = course.checked.iter().flat_map(|c| &c.lesson.others);
    course.read.extend(others.map(|other| PathBuf::from(&other.path)));
    course.last.extend(lost_snapshots(plan.paths).iter().map(|path| lost(path)));
    let lessons: Vec<_> = course.checked.iter().map(|c| &c.lesson).collect();
    course.last.extend(lint::check_course(&lessons));
    for models in &mut by_folder {
        course.last.extend(models.take_findings());
        course.sources.extend(models.files().iter().cloned());
        course.read.extend(models.read());
    }
    for (path, mut findings) in by_path(std::mem::take(&mut course.last)) {
        let files: Vec<&SourceFile> = course.sources.iter().collect();
        let policy = policies.of(Path::new(&*path))?;
        suppress(plan, &policy, &mut findings, &files, &mut course.suppressed);
        course.last.extend(findings);
    }
    finding::sort(&mut course.last);
    let own = course.checked.iter().flat_map(|c| &c.findings);
    course.findings = own.chain(&course.last).cloned().collect();
    finding::sort(&mut course.findings);
    for (path, why) in left_out {
        course.ledger.add(left_out_entry(&path, why));
    }
    let models = std::mem::take(&mut course.ledger);
    course.ledger = check::ledger(&course.checked, &course.findings);
    course.ledger.break_off(|path| broken_off.contains(path));
    course.ledger.append(models);
    let mut page: BTreeMap<Arc<str>, Vec<String>> = BTreeMap::new();
    for c in course.checked.iter().filter(|c| !c.lesson.widgets.is_empty()) {
        let path = c.lesson.file.path();
        page.insert(path.clone(), policies.of(Path::new(&**path))?.widgets);
    }
    let known = |path: &Arc<str>, name: &str| page.get(path).is_some_and(|all| all.iter().any(|w| w == name));
    course.ledger.accept_widgets(known);
    settle(&mut course);
    Ok(course)
}

/// Takes what is not to be told out of the findings of a file.
fn suppress(
    plan: &Plan<'_>,
    policy: &Policy,
    findings: &mut Vec<Finding>,
    files: &[&SourceFile],
    aside: &mut Aside,
) {
    aside.ignored.extend(policy.apply(findings));
    if let Some(baseline) = plan.baseline {
        aside.baselined.extend(baseline.apply(findings, files));
    }
}

fn by_path(findings: Vec<Finding>) -> BTreeMap<Arc<str>, Vec<Finding>> {
    let mut by_path: BTreeMap<Arc<str>, Vec<Finding>> = BTreeMap::new();
    for f in findings {
        by_path.entry(f.path.clone()).or_default().push(f);
    }
    by_path
}

/// What is not told is no reason to say that all is well: an error that is ignored is left out of the check, and what the
/// baseline knows is known.
fn settle(course: &mut Course) {
    let known = by_path(
        course.suppressed.baselined.iter().filter(|f| f.severity != Severity::Note).cloned().collect(),
    );
    let told = by_path(course.findings.iter().filter(|f| f.severity != Severity::Note).cloned().collect());
    let meets = |e: &Entry, findings: Option<&Vec<Finding>>| {
        let whole = e.span.is_empty();
        let inside = |f: &Finding| f.span.start <= e.span.end && e.span.start <= f.span.end;
        let claims = [Subject::Answer, Subject::Option, Subject::Quote, Subject::ClosedForm, Subject::Run];
        // A false claim has findings of its own; one that was never judged fails with what holds it.
        let is_claim = claims.contains(&e.subject);
        let about = |f: &Finding| match &f.claim {
            Some(claim) if is_claim => check::is_about(claim, e),
            Some(_) => whole,
            None if is_claim => e.state == State::Unchecked && inside(f),
            None => whole || inside(f),
        };
        findings.is_some_and(|all| all.iter().any(about))
    };
    course.ledger.know(|e| meets(e, known.get(&e.path)) && !meets(e, told.get(&e.path)));
    let ignored = course.suppressed.ignored.iter().filter(|f| f.is_error()).cloned().collect();
    for (path, all) in by_path(ignored) {
        course.ledger.add(left_out_entry(Path::new(&*path), format!("{} ignored", Summary::of(&all))));
    }
}

/// A file that was not checked in full, and why.
fn left_out_entry(path: &Path, remark: String) -> Entry {
    let path: Arc<str> = Arc::from(path.display().to_string());
    Entry {
        subject: Subject::File,
        owner: path.to_string(),
        path,
        span: 0..0,
        state: State::LeftOut,
        word: "left out",
        what: String::new(),
        remark,
    }
}

/// What was printed of the lessons, in their order.
#[derive(Default)]
struct Told {
    /// How many files there is nothing more to be said of.
    count: usize,
    /// What is to be said of later ones.
    waiting: BTreeMap<usize, String>,
    /// Nothing can be printed any more.
    failure: Option<Failure>,
}

/// Prints what is said of a file once all files before it have been told.
fn tell(told: &Mutex<Told>, file: usize, text: String, progress: bool) {
    let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
    told.waiting.insert(file, text);
    let mut ready = String::new();
    loop {
        let count = told.count;
        let Some(text) = told.waiting.remove(&count) else { break };
        ready.push_str(&text);
        told.count += 1;
    }
    if !ready.is_empty() && told.failure.is_none() {
        if progress {
            complain("\r\x1b[K");
        }
        told.failure = print(&ready).err();
    }
}

/// What is to be done with each file, and the models that lessons share, compiled once for each folder.
fn tasks(
    plan: &Plan<'_>,
    files: &[(PathBuf, bool)],
    mark: Hash,
) -> Result<(Vec<Task>, Vec<Models>), Failure> {
    let mut tasks = Vec::new();
    // Lessons of one folder have one folder of models, which is found and listed once.
    let mut near: BTreeMap<PathBuf, String> = BTreeMap::new();
    let mut folders: BTreeMap<String, ModelFolder> = BTreeMap::new();
    let mut of_lessons = Vec::new();
    for (path, _) in files {
        let task = match kind_of(path) {
            FileKind::Lesson | FileKind::Json => {
                let place = lint::lesson_folder(path);
                let name = match near.get(&place) {
                    Some(name) => name.clone(),
                    None => {
                        let folder = model_folder_within(plan.models, path, plan.paths)?;
                        let name = format!("{folder:?}");
                        folders.insert(name.clone(), folder);
                        near.insert(place, name.clone());
                        name
                    }
                };
                of_lessons.push((tasks.len(), name));
                Task::Lesson(0)
            }
            FileKind::Model => Task::Model(root(plan.models, &lint::lesson_folder(path), &[])?),
            FileKind::Unknown => {
                let shown = printable_path(path);
                Task::Refuse(format!(
                    "{shown} is not a lesson: lessons are Markdown (.md, .markdown, .mdx, .qmd, .Rmd) or JSON, models are .xml"
                ))
            }
        };
        tasks.push(task);
    }
    let numbers: BTreeMap<&String, usize> = folders.keys().zip(0..).collect();
    for (i, name) in &of_lessons {
        if let (Some(task), Some(number)) = (tasks.get_mut(*i), numbers.get(name)) {
            *task = Task::Lesson(*number);
        }
    }
    Ok((tasks, folders.into_values().map(|folder| Models::marked(folder, mark)).collect()))
}

/// What is said where a mistake of the program ended the check of a file.
fn failed(why: &str) -> String {
    format!("labspec failed while checking this file: {why}")
}

/// Checks one file.
fn one(plan: &Plan<'_>, cache: &Cache, task: &Task, path: &Path, named: bool, by_folder: &[Models]) -> Done {
    if interrupted() {
        return Done::Interrupted;
    }
    if plan.progress {
        complain(&format!("\r\x1b[Kchecking {}", printable_path(path)));
    }
    let models = match task {
        Task::Refuse(why) => return Done::Refused(why.clone()),
        Task::Model(root) => {
            let (model, findings, files) = check_model_file(path, Some(root));
            return Done::Model(model.is_some(), findings, files);
        }
        Task::Lesson(number) => by_folder.get(*number),
    };
    let Some(models) = models else { return Done::Other };
    let piped = plan.stdin.filter(|(name, _)| name == path);
    let loaded = match piped {
        Some((name, text)) => {
            let file = SourceFile::new(name.display().to_string(), text.as_str());
            Ok(load_lesson_at(file, name, &Sources::Disk, models.folder()))
        }
        None => load_lesson_file(path, models.folder()),
    };
    let lesson = match loaded {
        Ok(lesson) => lesson,
        Err(why) => return Done::Refused(why),
    };
    if !named && is_other_json(&lesson) {
        return Done::Other;
    }
    let examined = threads::apart(|| cache.examine(path, &lesson, models, plan.depth, interrupted));
    let mut found = match examined {
        Ok(found) => found,
        Err(why) => {
            let found = Finding::error(rules::UNREADABLE_FILE, 0..0, failed(&why))
                .why("no lab of this lesson was run to its end, and no claim was checked")
                .help("report it with this lesson; the other lessons were checked");
            let checked = Box::new(check::join(lesson, LabOutcome::from_finding(found), CheckLevel::STATIC));
            let aside = Aside { failed: true, ..Aside::default() };
            return Done::Lesson(checked, aside, Basis::default(), Vec::new(), CrossCheck::default());
        }
    };
    // Runs may have been cut short: half of a check is none.
    if interrupted() {
        Done::Interrupted
    } else {
        let basis = if plan.basis { check::basis(&lesson, models, digest::hex_of) } else { Basis::default() };
        let Judge { ask, recording } = plan.judge;
        let hearing = match ask || recording.is_some() {
            true => check::hear(&lesson, models, digest::hex_of, recording, &mut found.findings),
            false => CrossCheck::default(),
        };
        if interrupted() {
            return Done::Interrupted;
        }
        let curves = if plan.curves { check::curves(&lesson, models) } else { Vec::new() };
        let checked = Box::new(check::join(lesson, found, plan.depth));
        Done::Lesson(checked, Aside::default(), basis, curves, hearing)
    }
}

fn lost(path: &Path) -> Finding {
    let shown = printable_path(path);
    let lesson = shown.strip_suffix(lint::SNAPSHOT).unwrap_or(&shown);
    let mut f = Finding::new(
        rules::SNAPSHOT_WITHOUT_LESSON,
        0..0,
        format!("this snapshot belongs to {lesson}, which does not exist"),
    )
    .help("rename it like its lesson, or remove it: labspec snapshot --accept, with the folder");
    f.path = Arc::from(path.display().to_string());
    f
}

/// The claim of a model that was named itself.
fn model_entry(path: &Path, loads: bool) -> Entry {
    let (state, word) =
        if loads { (State::True(Evidence::Computed), "loads") } else { (State::False, "refused") };
    let path: Arc<str> = Arc::from(path.display().to_string());
    Entry {
        subject: Subject::Model,
        owner: path.to_string(),
        path,
        span: 0..0,
        state,
        word,
        what: String::new(),
        remark: String::new(),
    }
}

/// Why nothing was checked, and what to do.
fn nothing(paths: &[PathBuf], problems: &[(PathBuf, String)]) -> Failure {
    let names: Vec<String> = paths.iter().map(|p| printable_path(p)).collect();
    match problems {
        [] => format!("{} has no lessons: name .md or .json files, or a folder of them", names.join(", ")),
        all => all.iter().map(|(_, why)| why.as_str()).collect::<Vec<_>>().join("\nlabspec: "),
    }
}

/// Other JSON lies in folders of lessons; a file that was named is always ours.
pub(super) fn is_other_json(lesson: &Lesson) -> bool {
    lesson.findings.iter().any(|f| f.code == "unknown-spec")
}

#[cfg(test)]
#[allow(clippy::panic, clippy::unwrap_used)]
mod tests {
    use super::*;

    /// A mistake of the program ends the check of one lesson, and is reported there; the others are checked, on one thread or several.
    #[test]
    fn a_panic_in_one_lesson_is_its_finding_and_no_other_lesson_is_lost() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("models")).unwrap();
        for name in ["ball", "odd"] {
            let model = format!(
                "<mujoco model='{name}'><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
            );
            std::fs::write(folder.path().join(format!("models/{name}.xml")), model).unwrap();
        }
        let lab = |model: &str| {
            format!(
                "```lab simlab\n{{\"model\": \"{model}\", \"stopAt\": 0.01, \"readouts\": [{{\"label\": \"z\", \"expr\": \"data.qpos[2]\"}}]}}\n```\n"
            )
        };
        for (name, model) in [("a.md", "ball"), ("b.md", "odd"), ("c.md", "ball")] {
            std::fs::write(folder.path().join(name), lab(model)).unwrap();
        }
        let mark: Hash = |parts: &[&[u8]]| {
            let is_odd = parts.iter().any(|part| String::from_utf8_lossy(part).contains("model='odd'"));
            if is_odd { panic!("nobody thought of this model") } else { digest::hex_of(parts) }
        };
        for jobs in [1, 3] {
            let plan = Plan {
                paths: &[folder.path().to_path_buf()],
                stdin: None,
                models: &ModelOptions { models: None, root: None },
                depth: CheckLevel::FULL,
                policy: &PolicyOptions::default(),
                baseline: None,
                basis: false,
                judge: Judge::default(),
                curves: false,
                jobs,
                progress: false,
                reported: None,
            };
            let course = look_marked(&plan, &Cache::open(true, false), mark).unwrap();
            let errors: Vec<&Finding> = course.findings.iter().filter(|f| f.is_error()).collect();
            let [error] = errors.as_slice() else { panic!("{errors:?}") };
            assert!(error.path.ends_with("b.md") && error.message.contains("nobody thought of"), "{error:?}");
            let labs = course.ledger.entries().iter().filter(|e| e.subject == Subject::Lab);
            let labs: Vec<(bool, State)> = labs.map(|e| (e.path.ends_with("b.md"), e.state)).collect();
            let run = State::True(Evidence::Simulated);
            assert_eq!(labs, [(false, run), (true, State::Unchecked), (false, run)]);
            assert_eq!(course.ledger.outcome(), crate::ledger::Outcome::Findings);
        }
    }
}
