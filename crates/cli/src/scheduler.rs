//! The check of all files of a course, in this order:
//!
//! 1. [`select_files`] finds the files of the paths that the user named.
//! 2. [`plan_jobs`] determines the task and the policy of each file.
//! 3. [`check_files`] checks the files on several threads, and prints the findings of lessons in the order of the files.
//! 4. [`collect_outcomes`] joins the outcomes of all files in the order of the files.
//! 5. [`add_course_findings`] adds the findings about models and about several lessons together.
//! 6. [`apply_policies`] removes the suppressed findings from those.
//! 7. [`build_ledger`] builds the ledger of all claims.
//!
//! The results do not depend on the thread that checked a file.

use super::cache::Cache;
use super::collect::{Collected, ListedFile, UnreadFile, collect, orphaned_snapshots};
use super::common::Failure;
use super::course::{CheckRequest, CourseResults};
use super::course_ledger::{FileOutcomes, build_ledger, group_by_path};
use super::digest;
use super::file_check::{FileOutcome, FileTask, check_file, plan_tasks};
use super::parallel::{OrderedPrinter, map_in_parallel};
use super::policy::{Policies, Policy};
use super::stdio::{clear_progress, show_progress};
use super::widgets;
use labspec::bind::parts::Hash;
use labspec::bind::scene::Models;
use labspec::finding::{self, Finding};
use labspec::lint;
use labspec::report::{human, printable_path};
use labspec::rules;
use labspec::source::SourceFile;
use labspec::spec::{FileKind, kind_of};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file with everything that its check needs.
struct CheckJob {
    file: ListedFile,
    task: FileTask,
    policy: Policy,
}

/// Checks every file. A file that cannot be read gives a finding, and does not affect the others.
pub(super) fn check_lessons(request: &CheckRequest<'_>, cache: &Cache) -> Result<CourseResults, Failure> {
    check_with_hash(request, cache, digest::hex_of)
}

/// As [`check_lessons`], with another hash for the files of models.
fn check_with_hash(request: &CheckRequest<'_>, cache: &Cache, hash: Hash) -> Result<CourseResults, Failure> {
    let Collected { files, problems, skipped } = select_files(request)?;
    let mut policies = Policies::default();
    let (jobs, mut models) = plan_jobs(request, files, hash, &mut policies)?;
    let outcomes = check_files(request, cache, &jobs, &models)?;
    let (mut results, mut files) = collect_outcomes(request, &jobs, outcomes, problems)?;
    files.skipped.extend(skipped);
    add_course_findings(request, &jobs, &mut models, &mut results);
    apply_policies(request, &mut policies, &mut results)?;
    results.ledger = build_ledger(&results, &files, &mut policies, request.baseline)?;
    Ok(results)
}

/// Returns the files below the named paths, and the one from standard input.
///
/// # Errors
/// There are no files.
fn select_files(request: &CheckRequest<'_>) -> Result<Collected, Failure> {
    let mut collected = collect(request.paths);
    collected.print_skipped();
    if let Some((name, _)) = request.stdin {
        // The text from standard input replaces the file with its name.
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        collected.files.retain(|(path, _)| real(path) != real(name));
        collected.files.push((name.clone(), true));
    }
    if request.skip_others {
        collected.files.retain(|(path, _)| kind_of(path) != FileKind::Unknown);
        collected.files.iter_mut().for_each(|(_, named)| *named = false);
    }
    match collected.files.is_empty() && !request.skip_others {
        true => Err(nothing_to_check(request.paths, &collected.problems)),
        false => Ok(collected),
    }
}

/// Returns the task and the policy of each file, and the models that lessons share.
///
/// # Errors
/// A folder of models or a settings file cannot be read, or an option names an unknown rule.
fn plan_jobs(
    request: &CheckRequest<'_>,
    files: Vec<ListedFile>,
    hash: Hash,
    policies: &mut Policies,
) -> Result<(Vec<CheckJob>, Vec<Models>), Failure> {
    let (tasks, models) = plan_tasks(request, &files, hash)?;
    *policies = Policies::new(request.policy)?;
    let jobs = files.into_iter().zip(tasks).map(|(file, task)| {
        let policy = policies.policy_for(&file.0)?;
        Ok(CheckJob { file, task, policy })
    });
    Ok((jobs.collect::<Result<_, Failure>>()?, models))
}

/// Checks the files on several threads, and prints the findings of lessons as soon as all files before them are checked.
///
/// # Errors
/// Findings cannot be printed.
fn check_files(
    request: &CheckRequest<'_>,
    cache: &Cache,
    jobs: &[CheckJob],
    models: &[Models],
) -> Result<Vec<FileOutcome>, Failure> {
    let printer = OrderedPrinter::new(request.progress);
    let outcomes = map_in_parallel(jobs, request.jobs, |i, job| {
        if request.progress {
            show_progress(&format!("checking {} of {}: {}", i + 1, jobs.len(), printable_path(&job.file.0)));
        }
        let mut outcome = check_file(request, cache, &job.task, &job.policy, &job.file, models);
        suppress_findings(request, &job.policy, &mut outcome);
        if let Some(color) = request.findings_in_color {
            printer.add(i, findings_text(&outcome, color));
        }
        outcome
    });
    if request.progress {
        clear_progress();
    }
    printer.finish()?;
    Ok(outcomes)
}

/// Moves the suppressed findings of a lesson.
fn suppress_findings(request: &CheckRequest<'_>, policy: &Policy, outcome: &mut FileOutcome) {
    if let FileOutcome::Lesson(lesson) = outcome {
        let (c, suppressed) = (&mut lesson.checked, &mut lesson.suppressed);
        widgets::check(&c.lesson, &policy.widgets, &mut c.findings);
        finding::sort(&mut c.findings);
        suppressed.suppress(policy, request.baseline, &mut c.findings, &[&c.lesson.file]);
        suppressed.allowed = std::mem::take(&mut c.allowed);
    }
}

/// The findings of a lesson for people.
fn findings_text(outcome: &FileOutcome, color: bool) -> String {
    match outcome {
        FileOutcome::Lesson(l) => human(&l.checked.findings, &[&l.checked.lesson.file], color),
        _ => String::new(),
    }
}

/// Joins the outcomes of all files.
///
/// # Errors
/// No file could be read.
fn collect_outcomes(
    request: &CheckRequest<'_>,
    jobs: &[CheckJob],
    outcomes: Vec<FileOutcome>,
    problems: Vec<UnreadFile>,
) -> Result<(CourseResults, FileOutcomes), Failure> {
    let reference_engine = request.cross_check.recording.map(|r| r.engine.clone());
    let mut results = CourseResults { reference_engine, ..CourseResults::default() };
    let mut files = FileOutcomes::default();
    let mut refused: Vec<UnreadFile> = problems;
    let (mut readable, mut interrupted) = (0, 0);
    for (CheckJob { file: (path, _), .. }, outcome) in jobs.iter().zip(outcomes) {
        results.dependencies.insert(path.clone());
        readable += usize::from(!matches!(outcome, FileOutcome::Refused(_) | FileOutcome::Interrupted));
        match outcome {
            FileOutcome::Lesson(lesson) => {
                if lesson.cancelled {
                    files.cancelled.insert(lesson.checked.lesson.file.path().clone());
                }
                results.cross_checks.push(lesson.cross_check);
                results.bases.push(lesson.basis);
                results.curves.push(lesson.curves);
                results.checked.push(lesson.checked);
                results.suppressed.append(lesson.suppressed);
            }
            FileOutcome::Other => {}
            FileOutcome::Model { loads, findings, sources } => {
                files.models.push((path.clone(), loads));
                results.course_findings.extend(findings);
                results.sources.extend(sources);
            }
            FileOutcome::Refused(why) => refused.push((path.clone(), why)),
            FileOutcome::Interrupted => {
                interrupted += 1;
                files.skipped.push((path.clone(), "interrupted before it was checked".into()));
            }
        }
    }
    if interrupted > 0 {
        results.checked_before_interrupt = Some((jobs.len() - interrupted, jobs.len()));
    }
    if readable == 0 && interrupted > 0 {
        return Err(format!("interrupted: 0 of {} files checked", jobs.len()));
    }
    if readable == 0 && !(request.skip_others && refused.is_empty()) {
        return Err(nothing_to_check(request.paths, &refused));
    }
    results.course_findings.extend(refused.into_iter().map(|(path, why)| unreadable_finding(&path, why)));
    Ok((results, files))
}

/// Adds the findings about lost snapshots, about several lessons together and about models, with the
/// files on which they depend.
fn add_course_findings(
    request: &CheckRequest<'_>,
    jobs: &[CheckJob],
    models: &mut [Models],
    results: &mut CourseResults,
) {
    results.dependencies.extend(jobs.iter().map(|job| lint::snapshot_path(&job.file.0)));
    let others = results.checked.iter().flat_map(|c| &c.lesson.others);
    results.dependencies.extend(others.map(|other| PathBuf::from(&other.path)));
    let data = results.checked.iter().flat_map(|c| &c.lesson.data);
    results.dependencies.extend(data.map(|file| file.path.clone()));
    results.dependencies.extend(request.listings.iter().flat_map(|listings| listings.dependencies()));
    let findings = &mut results.course_findings;
    findings.extend(orphaned_snapshots(request.paths).iter().map(|path| orphaned_snapshot_finding(path)));
    let lessons: Vec<_> = results.checked.iter().map(|c| &c.lesson).collect();
    findings.extend(lint::check_course(&lessons));
    for models in models {
        findings.extend(models.take_findings());
        results.sources.extend(models.files().iter().cloned());
        results.dependencies.extend(models.read());
    }
}

/// Removes the suppressed findings of the course, and joins all findings.
///
/// # Errors
/// The settings that apply to a file cannot be read.
fn apply_policies(
    request: &CheckRequest<'_>,
    policies: &mut Policies,
    results: &mut CourseResults,
) -> Result<(), Failure> {
    let CourseResults { course_findings, suppressed, sources, checked, .. } = results;
    // Findings about several lessons together are in lessons.
    let lessons = checked.iter().map(|c| &c.lesson.file);
    let sources: Vec<&SourceFile> = sources.iter().chain(lessons).collect();
    for (path, mut findings) in group_by_path(std::mem::take(course_findings)) {
        let policy = policies.policy_for(Path::new(&*path))?;
        suppressed.suppress(&policy, request.baseline, &mut findings, &sources);
        course_findings.extend(findings);
    }
    finding::sort(course_findings);
    let of_lessons = results.checked.iter().flat_map(|c| &c.findings);
    results.findings = of_lessons.chain(&results.course_findings).cloned().collect();
    finding::sort(&mut results.findings);
    Ok(())
}

fn unreadable_finding(path: &Path, why: String) -> Finding {
    let mut f = Finding::error(rules::UNREADABLE_FILE, 0..0, why)
        .why("nothing in it is checked")
        .help("fix the file, or exclude it");
    f.path = Arc::from(path.display().to_string());
    f
}

fn orphaned_snapshot_finding(path: &Path) -> Finding {
    let name = printable_path(path);
    let lesson = name.strip_suffix(lint::SNAPSHOT).unwrap_or(&name);
    let mut f = Finding::new(
        rules::SNAPSHOT_WITHOUT_LESSON,
        0..0,
        format!("this snapshot belongs to {lesson}, which does not exist"),
    )
    .help("rename it like its lesson, or remove it: labspec snapshot --accept, with the folder");
    f.path = Arc::from(path.display().to_string());
    f
}

/// The reason why nothing was checked, and what to do.
fn nothing_to_check(paths: &[PathBuf], problems: &[(PathBuf, String)]) -> Failure {
    let names: Vec<String> = paths.iter().map(|p| printable_path(p)).collect();
    match problems {
        [] => format!("{} has no lessons: name .md or .json files, or a folder of them", names.join(", ")),
        all => all.iter().map(|(_, why)| why.as_str()).collect::<Vec<_>>().join("\nlabspec: "),
    }
}

#[cfg(test)]
#[allow(clippy::panic, clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::common::ModelOptions;
    use crate::course::CrossCheckRequest;
    use crate::policy::PolicyOptions;
    use labspec::check::CheckLevel;
    use labspec::ledger::{Evidence, State, Subject};

    /// A bug that panics ends the check of one lesson and is reported there. The other lessons are checked,
    /// on one thread or several.
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
        let hash: Hash = |parts: &[&[u8]]| {
            let is_odd = parts.iter().any(|part| String::from_utf8_lossy(part).contains("model='odd'"));
            if is_odd { panic!("nobody thought of this model") } else { digest::hex_of(parts) }
        };
        for jobs in [1, 3] {
            let request = CheckRequest {
                paths: &[folder.path().to_path_buf()],
                skip_others: false,
                stdin: None,
                models: &ModelOptions { models: None, root: None },
                level: CheckLevel::FULL,
                policy: &PolicyOptions::default(),
                baseline: None,
                listings: None,
                with_bases: false,
                cross_check: CrossCheckRequest::default(),
                with_curves: false,
                jobs,
                progress: false,
                findings_in_color: None,
            };
            let results = check_with_hash(&request, &Cache::open(true, false), hash).unwrap();
            let errors: Vec<&Finding> = results.findings.iter().filter(|f| f.is_error()).collect();
            let [error] = errors.as_slice() else { panic!("{errors:?}") };
            assert!(error.path.ends_with("b.md") && error.message.contains("nobody thought of"), "{error:?}");
            let labs = results.ledger.entries().iter().filter(|e| e.subject == Subject::Lab);
            let labs: Vec<(bool, State)> = labs.map(|e| (e.path.ends_with("b.md"), e.state)).collect();
            let run = State::True(Evidence::Simulated);
            assert_eq!(labs, [(false, run), (true, State::Unchecked), (false, run)]);
            assert_eq!(results.ledger.outcome(), labspec::ledger::Outcome::Findings);
        }
    }
}
