//! `labspec build`: a course as a static site.

use super::cache::Cache;
use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::course::{CheckRequest, CourseResults, CrossCheckRequest};
use super::output::{remove_site_file, write_site_file};
use super::overview::format_summary;
use super::policy::PolicyOptions;
use super::scheduler::check_lessons;
use super::stdio::print;
use super::target::model_folder_within;
use labspec::check::CheckLevel;
use labspec::ledger::Outcome;
use labspec::lint::ModelFolder;
use labspec::report::{counted, human, printable, printable_path};
use labspec::source::SourceFile;
use labspec_site::{Course, MANIFEST, PageFiles, ScormOptions, Site, SiteFile, SiteOptions, build_site};
use std::fs;
use std::io::IsTerminal;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// BuildArguments of `build`.
#[derive(clap::Args, Debug)]
pub(super) struct BuildArguments {
    /// A folder of lessons, or several folders and lessons below one folder
    #[arg(value_name = "FOLDER", required = true)]
    paths: Vec<PathBuf>,
    /// The folder of the site. It is created, or it holds an earlier site, which is replaced
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The lesson that is the first page [default: a list of the lessons]
    #[arg(long, value_name = "LESSON")]
    index: Option<PathBuf>,
    /// The address of the repository, or of the folder that holds labspec.toml, on the web: links to files that the site does not
    /// copy lead there
    #[arg(long, value_name = "URL", value_parser = base_address)]
    sources: Option<String>,
    /// The address where the site will be, for sitemap.xml and canonical links
    #[arg(long, value_name = "URL", value_parser = base_address)]
    base_url: Option<String>,
    /// Write a content package of SCORM 2004 for each lesson into the folder `scorm` of the site
    #[arg(long)]
    scorm: bool,
    /// The share of correct answers needed to pass a package, from 0 to 1. Without it, lessons are neither passed nor failed
    #[arg(long, value_name = "SHARE", requires = "scorm", value_parser = share)]
    pass: Option<f64>,
    #[command(flatten)]
    page: PageOptions,
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    policy: PolicyOptions,
}

/// What the pages say, and where their scripts are.
#[derive(clap::Args, Debug, Clone)]
pub(super) struct PageOptions {
    /// The title of the course [default: Lessons]
    #[arg(long, value_name = "TEXT")]
    pub(super) title: Option<String>,
    /// The language of the lessons
    #[arg(long, value_name = "CODE", default_value = "en", value_parser = language)]
    pub(super) lang: String,
    /// The folder with the scripts and styles of pages [default: LABSPEC_PAGE, else `page` beside the program]
    #[arg(long, value_name = "DIR")]
    pub(super) page: Option<PathBuf>,
}

impl PageOptions {
    /// Finds the scripts and styles of pages.
    pub(super) fn files(&self) -> Result<PageFiles, Failure> {
        let environment =
            std::env::var_os("LABSPEC_PAGE").filter(|value| !value.is_empty()).map(PathBuf::from);
        let program = std::env::current_exe().and_then(|path| path.canonicalize()).ok();
        PageFiles::find(self.page.as_deref(), environment, program.as_deref())
    }

    /// What a site says of itself.
    pub(super) fn site(&self, base: Option<String>) -> SiteOptions {
        SiteOptions { title: self.title.clone(), lang: self.lang.clone(), base, scorm: None }
    }
}

/// The code of a language: letters, digits and hyphens.
fn language(text: &str) -> Result<String, String> {
    let is_code =
        !text.is_empty() && text.len() < 36 && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-');
    if is_code { Ok(text.into()) } else { Err("write a code such as `en` or `de-AT`".into()) }
}

/// An address of the web, which then ends in `/`.
fn base_address(text: &str) -> Result<String, String> {
    let is_web = text.starts_with("https://") || text.starts_with("http://");
    let is_plain = !text.contains(|c: char| c.is_whitespace() || c.is_control() || "<>\"'?#".contains(c));
    match is_web && is_plain {
        true => Ok(format!("{}/", text.trim_end_matches('/'))),
        false => Err("write an address such as https://example.org/course/".into()),
    }
}

/// A share from 0 to 1.
fn share(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or_else(|| "write a number from 0 to 1, such as 0.6".into())
}

/// Checks the course and writes its site.
pub(super) fn build(a: &BuildArguments) -> Result<CommandOutcome, Failure> {
    let folder = course_folder(&a.paths)?;
    let page_files = a.page.files()?;
    let old = earlier_site(&a.paths, &a.out)?;
    let results = check_course(a)?;
    if interrupted() {
        return Ok(CommandOutcome::Clean);
    }
    let models = |path: &Path| {
        model_folder_within(&a.models, path, &a.paths).unwrap_or_else(|_| ModelFolder::unknown())
    };
    let course = Course {
        folder: &folder,
        index: a.index.as_deref(),
        sources: a.sources.as_deref(),
        lessons: &results.checked,
        ledger: &results.ledger,
        models: &models,
    };
    let scorm = a.scorm.then_some(ScormOptions { passing: a.pass });
    let options = SiteOptions { scorm, ..a.page.site(a.base_url.clone()) };
    let site = build_site(&course, &options, &page_files)?;
    write_site(&a.out, &site, &old)?;
    report(a, &results, &site)
}

/// The folder of the course: the named one, or the innermost folder around all named paths.
fn course_folder(paths: &[PathBuf]) -> Result<PathBuf, Failure> {
    if let [folder] = paths {
        return match folder.is_dir() {
            true => Ok(folder.clone()),
            false => Err(format!("{} is not a folder of lessons", printable_path(folder))),
        };
    }
    let mut folders = Vec::new();
    for path in paths {
        let real = path.canonicalize().map_err(|e| format!("cannot read {}: {e}", printable_path(path)))?;
        let folder = if real.is_dir() { Some(real.as_path()) } else { real.parent() };
        folders.extend(folder.map(Path::to_path_buf));
    }
    let holds_all = |folder: &&Path| folders.iter().all(|other| other.starts_with(folder));
    let common = folders.first().and_then(|first| first.ancestors().find(holds_all));
    // A folder without a parent holds everything on the machine.
    common.filter(|folder| folder.parent().is_some()).map(Path::to_path_buf).ok_or_else(|| {
        "the lessons are in no common folder; name lessons and folders below one folder".to_string()
    })
}

/// Checks every lesson anew: a mark on a page states what this run has found.
fn check_course(a: &BuildArguments) -> Result<CourseResults, Failure> {
    let request = CheckRequest {
        paths: &a.paths,
        skip_others: false,
        stdin: None,
        models: &a.models,
        level: CheckLevel::FULL,
        policy: &a.policy,
        baseline: None,
        listings: None,
        with_bases: false,
        cross_check: CrossCheckRequest::default(),
        with_curves: false,
        jobs: std::thread::available_parallelism().map_or(1, NonZeroUsize::get),
        progress: std::io::stderr().is_terminal(),
        findings_in_color: None,
    };
    check_lessons(&request, &Cache::open(true, false))
}

/// Prints the findings and what was written. The site is complete in any case; the outcome is that of the check.
fn report(a: &BuildArguments, results: &CourseResults, site: &Site) -> Result<CommandOutcome, Failure> {
    let mut sources: Vec<&SourceFile> = results.checked.iter().map(|c| &c.lesson.file).collect();
    sources.extend(&results.sources);
    let mut text = human(&results.findings, &sources, false);
    for problem in &site.problems {
        text.push_str(&format!("{}\n", printable(problem)));
    }
    text.push_str(&format!(
        "{}\nwrote {} ({}) to {}; {} carry the mark \"verified\"{}\n",
        format_summary(results),
        counted(site.lessons, "lesson"),
        counted(site.files.len(), "file"),
        printable_path(&a.out),
        match site.verified {
            1 => "1 lab or question".into(),
            n => format!("{n} labs and questions"),
        },
        match site.packages {
            0 => String::new(),
            n => format!("; {} in scorm/", counted(n, "content package")),
        }
    ));
    print(&text)?;
    Ok(match results.ledger.outcome() {
        Outcome::Findings => CommandOutcome::Findings,
        Outcome::Partial => CommandOutcome::Partial,
        _ if !site.problems.is_empty() => CommandOutcome::Findings,
        _ => CommandOutcome::Clean,
    })
}

/// The files of the site that the folder holds. A folder with other content is refused, so that nothing is lost.
fn earlier_site(course: &[PathBuf], out: &Path) -> Result<Vec<String>, Failure> {
    let displayed = printable_path(out);
    let holds =
        |out: &Path| course.iter().any(|path| path.canonicalize().is_ok_and(|path| path.starts_with(out)));
    if out.canonicalize().is_ok_and(|out| holds(&out)) {
        return Err(format!("{displayed} holds the course itself; name another folder with --out"));
    }
    let is_empty = match fs::read_dir(out) {
        Ok(mut entries) => entries.next().is_none(),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => true,
        Err(e) => return Err(format!("cannot read {displayed}: {e}")),
    };
    if is_empty {
        return Ok(Vec::new());
    }
    let refuse = || {
        format!("{displayed} holds files that `labspec build` did not write; name an empty folder with --out")
    };
    let manifest = fs::read_to_string(out.join(MANIFEST)).map_err(|_| refuse())?;
    let manifest: serde_json::Value = serde_json::from_str(&manifest).map_err(|_| refuse())?;
    if manifest["site"] != "labspec" {
        return Err(refuse());
    }
    let files = manifest["files"].as_array().ok_or_else(refuse)?;
    Ok(files
        .iter()
        .filter_map(|name| name.as_str())
        .filter(|name| is_inside(name))
        .map(String::from)
        .collect())
}

/// Whether a name of a file stays in its folder.
fn is_inside(name: &str) -> bool {
    Path::new(name).components().all(|c| matches!(c, std::path::Component::Normal(_)))
}

/// Writes the files of a site, and removes those of the earlier one that it does not have.
fn write_site(out: &Path, site: &Site, old: &[String]) -> Result<(), Failure> {
    for name in old.iter().filter(|name| !site.files.contains_key(*name)) {
        remove_site_file(&out.join(name));
    }
    for (name, file) in &site.files {
        if !is_inside(name) {
            return Err(format!("a file of the site has the name {}, which is not a path", printable(name)));
        }
        let path = out.join(name);
        match file {
            SiteFile::Text(text) => write_site_file(&path, text.as_bytes())?,
            SiteFile::Bytes(bytes) => write_site_file(&path, bytes)?,
            SiteFile::Copy(from) => {
                let bytes =
                    fs::read(from).map_err(|e| format!("cannot read {}: {e}", printable_path(from)))?;
                write_site_file(&path, &bytes)?;
            }
        }
    }
    Ok(())
}
