//! Which findings are reported, and with which severity, according to the command line and the nearest `labspec.toml`.

use super::common::Failure;
use super::conventions;
use super::listings::ListingSettings;
use super::routes::Routes;
use super::widgets::{self, PageWidget};
use ignore::gitignore::{Gitignore, GitignoreBuilder};
use labspec::finding::{Finding, Severity};
use labspec::report::{printable, printable_path};
use labspec::rules;
use labspec::source::read_text;
use labspec::spec::Conventions;
use labspec_finding::{Layer, nearest};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of the settings file.
pub(super) const FILE: &str = "labspec.toml";
/// The maximum size of a settings file in bytes.
const MAX_SETTINGS: u64 = 1 << 20;

/// The options of the command line for findings.
#[derive(clap::Args, Debug, Clone, Default)]
pub(super) struct PolicyOptions {
    /// Report only these findings: codes of rules, layers (source, json, structure, model, program, run, claim), errors,
    /// warnings, notes, or all [default: `select` in labspec.toml, else all]
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    select: Vec<String>,
    /// Skip these findings, in addition to those that labspec.toml ignores
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    ignore: Vec<String>,
    /// Report these findings as errors: `warnings`, `notes`, codes of rules, or layers
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    deny: Vec<String>,
    /// Use only the settings of this file [default: the nearest labspec.toml around each lesson]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

impl PolicyOptions {
    /// The settings file that was named.
    pub(super) fn config(&self) -> Option<&Path> {
        self.config.as_deref()
    }
}

/// A set of rules.
#[derive(Clone, Debug, Default)]
struct RuleSet {
    codes: Vec<&'static str>,
    layers: Vec<Layer>,
    severities: Vec<Severity>,
    all: bool,
}

/// The words for all findings of a severity.
const SEVERITIES: [(&str, Severity); 3] =
    [("errors", Severity::Error), ("warnings", Severity::Warning), ("notes", Severity::Note)];

impl RuleSet {
    /// Adds the rules that a word denotes.
    fn add(&mut self, word: &str) -> Result<(), String> {
        let word = word.trim();
        let words = || {
            let fixed = SEVERITIES.iter().map(|(word, _)| *word).chain(["all"]);
            fixed.chain(Layer::ALL.map(Layer::as_str)).chain(rules::all().map(|r| r.code))
        };
        if word == "all" {
            self.all = true;
        } else if let Some((_, severity)) = SEVERITIES.iter().find(|(keyword, _)| *keyword == word) {
            self.severities.push(*severity);
        } else if let Some(layer) = Layer::ALL.into_iter().find(|layer| layer.as_str() == word) {
            self.layers.push(layer);
        } else if let Some(rule) = rules::find(word) {
            self.codes.push(rule.code);
        } else {
            let near =
                nearest(word, words()).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(format!("`{}` is not a rule or a group of rules{near}", printable(word)));
        }
        Ok(())
    }

    fn parse<'w>(words: impl IntoIterator<Item = &'w String>) -> Result<RuleSet, String> {
        let mut set = RuleSet::default();
        words.into_iter().try_for_each(|word| set.add(word)).map(|()| set)
    }

    fn is_empty(&self) -> bool {
        !self.all && self.codes.is_empty() && self.layers.is_empty() && self.severities.is_empty()
    }

    fn holds(&self, f: &Finding) -> bool {
        self.all
            || self.codes.contains(&f.code)
            || self.severities.contains(&f.severity)
            || (!self.layers.is_empty()
                && rules::find(f.code).is_some_and(|rule| self.layers.contains(&rule.layer)))
    }
}

/// The treatment of the findings of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Policy {
    select: RuleSet,
    ignore: RuleSet,
    deny: RuleSet,
    /// Additional widgets that the page provides.
    pub(super) widgets: Vec<PageWidget>,
    /// The files of the pages of a single-page site.
    pub(super) routes: Routes,
    /// How the texts of the lesson are read.
    pub(super) conventions: Conventions,
    /// How listings are run.
    pub(super) listings: ListingSettings,
}

impl Policy {
    /// Removes the ignored findings and returns them; the others get the severity of the policy.
    pub(super) fn apply(&self, findings: &mut Vec<Finding>) -> Vec<Finding> {
        self.routes.resolve(findings);
        let mut ignored = Vec::new();
        findings.retain(|f| {
            let reported = (self.select.is_empty() || self.select.holds(f)) && !self.ignore.holds(f);
            if !reported {
                ignored.push(f.clone());
            }
            reported
        });
        for f in findings.iter_mut().filter(|f| self.deny.holds(f)) {
            f.severity = Severity::Error;
        }
        ignored
    }
}

/// The content of one settings file.
#[derive(Debug, Default)]
struct PolicyFile {
    path: PathBuf,
    select: Vec<String>,
    ignore: Vec<String>,
    deny: Vec<String>,
    widgets: Vec<PageWidget>,
    routes: Routes,
    conventions: Conventions,
    listings: ListingSettings,
    paths: Vec<PathSettings>,
}

/// Settings for some paths.
#[derive(Debug)]
struct PathSettings {
    patterns: Vec<String>,
    globs: Globs,
    /// The rules that are ignored there.
    ignore: Vec<String>,
    /// The rules that are errors there.
    deny: Vec<String>,
}

/// A setting that holds for a file: its value, and where it comes from.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct EffectiveSetting {
    pub(super) name: &'static str,
    pub(super) value: String,
    pub(super) origin: String,
}

/// Patterns of paths as in `.gitignore`, relative to the folder of the settings.
#[derive(Debug)]
struct Globs(Gitignore);

/// The policies of all files; each settings file is read once.
#[derive(Default)]
pub(super) struct Policies {
    options: PolicyOptions,
    read: BTreeMap<PathBuf, Option<Arc<PolicyFile>>>,
    given: Option<Arc<PolicyFile>>,
}

impl Policies {
    /// # Errors
    /// A word is not a rule, or the settings cannot be read.
    pub(super) fn new(options: &PolicyOptions) -> Result<Policies, Failure> {
        for (name, words) in
            [("--select", &options.select), ("--ignore", &options.ignore), ("--deny", &options.deny)]
        {
            RuleSet::parse(words).map_err(|e| format!("{name}: {e}"))?;
        }
        let given = options.config.as_ref().map(|path| read(path)).transpose()?.map(Arc::new);
        Ok(Policies { options: options.clone(), read: BTreeMap::new(), given })
    }

    /// Returns the policy of a file.
    ///
    /// # Errors
    /// The settings that apply to it cannot be read.
    pub(super) fn policy_for(&mut self, path: &Path) -> Result<Policy, Failure> {
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let settings = match &self.given {
            Some(given) => Some(given.clone()),
            None => self.nearest_settings(whole.parent())?,
        };
        let none = PolicyFile::default();
        let near = settings.as_deref().unwrap_or(&none);
        let options = &self.options;
        let select = if options.select.is_empty() { &near.select } else { &options.select };
        let here = || near.paths.iter().filter(|paths| paths.globs.hold(&whole));
        let ignore = near.ignore.iter().chain(here().flat_map(|paths| &paths.ignore)).chain(&options.ignore);
        let deny = near.deny.iter().chain(here().flat_map(|paths| &paths.deny)).chain(&options.deny);
        let widgets = near.widgets.clone();
        Ok(Policy {
            select: RuleSet::parse(select)?,
            ignore: RuleSet::parse(ignore)?,
            deny: RuleSet::parse(deny)?,
            widgets,
            routes: near.routes.clone(),
            conventions: near.conventions.clone(),
            listings: near.listings.clone(),
        })
    }

    /// The settings that hold for a file, each with its origin, and the settings file.
    ///
    /// # Errors
    /// The settings that apply to it cannot be read.
    pub(super) fn effective(
        &mut self,
        path: &Path,
    ) -> Result<(Option<PathBuf>, Vec<EffectiveSetting>), Failure> {
        // A wrong setting is an error here, too.
        self.policy_for(path)?;
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let folder = if whole.is_dir() { Some(whole.as_path()) } else { whole.parent() };
        let settings = match &self.given {
            Some(given) => Some(given.clone()),
            None => self.nearest_settings(folder)?,
        };
        let none = PolicyFile::default();
        let near = settings.as_deref().unwrap_or(&none);
        let file = near.path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let mut all = Vec::new();
        let mut add = |name: &'static str, values: &[String], origin: &str| {
            let one =
                |value: &String| EffectiveSetting { name, value: value.clone(), origin: origin.to_string() };
            all.extend(values.iter().map(one));
        };
        let command = "command line";
        match self.options.select.is_empty() {
            true => add("select", &near.select, &file),
            false => add("select", &self.options.select, command),
        }
        let here: Vec<(&PathSettings, String)> = (near.paths.iter().filter(|paths| paths.globs.hold(&whole)))
            .map(|paths| (paths, format!("{file}, [[paths]] {}", paths.patterns.join(" "))))
            .collect();
        add("ignore", &near.ignore, &file);
        here.iter().for_each(|(paths, origin)| add("ignore", &paths.ignore, origin));
        add("ignore", &self.options.ignore, command);
        add("deny", &near.deny, &file);
        here.iter().for_each(|(paths, origin)| add("deny", &paths.deny, origin));
        add("deny", &self.options.deny, command);
        add("widgets", &near.widgets.iter().map(PageWidget::line).collect::<Vec<_>>(), &file);
        add("routes", &near.routes.lines().collect::<Vec<_>>(), &file);
        let conventions = conventions::lines(&near.conventions).into_iter();
        conventions.chain(near.listings.lines()).for_each(|(name, value)| add(name, &[value], &file));
        Ok((settings.as_ref().map(|settings| settings.path.clone()), all))
    }

    /// The settings of a folder: those in the folder, otherwise those of the nearest enclosing folder.
    fn nearest_settings(&mut self, folder: Option<&Path>) -> Result<Option<Arc<PolicyFile>>, Failure> {
        let Some(folder) = folder else { return Ok(None) };
        if let Some(cached) = self.read.get(folder) {
            return Ok(cached.clone());
        }
        let file = folder.join(FILE);
        // A folder with this name, or a link that leads nowhere, is an error when it is read.
        let found = if file.symlink_metadata().is_ok() {
            Some(Arc::new(read(&file)?))
        } else {
            self.nearest_settings(folder.parent())?
        };
        self.read.insert(folder.to_path_buf(), found.clone());
        Ok(found)
    }
}

/// How the texts of a lesson are read, according to the nearest settings.
///
/// # Errors
/// The settings cannot be read.
pub(super) fn conventions_of(path: &Path) -> Result<Conventions, Failure> {
    Ok(Policies::new(&PolicyOptions::default())?.policy_for(path)?.conventions)
}

impl Globs {
    fn new(folder: &Path, patterns: &[String]) -> Result<Globs, String> {
        let mut all = GitignoreBuilder::new(folder);
        for (n, pattern) in patterns.iter().enumerate() {
            // As in `.gitignore`: `#` begins a comment, and `!` takes back what an earlier pattern matches.
            if pattern.trim().is_empty() || pattern.starts_with('#') || (n == 0 && pattern.starts_with('!')) {
                return Err(format!(
                    "the pattern `{}` matches nothing; write one such as \"drafts/**\"",
                    printable(pattern)
                ));
            }
            all.add_line(None, pattern).map_err(|e| format!("`{}`: {e}", printable(pattern)))?;
        }
        all.build().map(Globs).map_err(|e| e.to_string())
    }

    fn hold(&self, path: &Path) -> bool {
        path.starts_with(self.0.path()) && self.0.matched_path_or_any_parents(path, false).is_ignore()
    }
}

/// The keys of settings, and of settings for some paths.
const KEYS: [&str; 10] = [
    "select",
    "ignore",
    "deny",
    "widgets",
    "routes",
    "languages",
    "macros",
    "front-matter",
    "listings",
    "paths",
];
const OF_PATHS: [&str; 3] = ["match", "ignore", "deny"];

fn read(path: &Path) -> Result<PolicyFile, Failure> {
    let name = printable_path(path);
    let cannot = |e: String| format!("{name}: {e}");
    let text = read_text(path, MAX_SETTINGS, "settings")?;
    let table: toml::Table = toml::from_str(&text).map_err(|e| {
        let place = e.span().map_or(String::new(), |span| {
            let line = text.get(..span.start).unwrap_or_default().matches('\n').count() + 1;
            format!(" (line {line})")
        });
        cannot(format!("invalid TOML: {}{place}", e.message()))
    })?;
    reject_unknown_keys(&table, &KEYS).map_err(cannot)?;
    let list = |name: &str| string_list(&table, name, true).map_err(cannot);
    let (select, ignore, deny) = (list("select")?, list("ignore")?, list("deny")?);
    let folder = path.canonicalize().ok().and_then(|p| p.parent().map(Path::to_path_buf)).unwrap_or_default();
    let widgets = widgets::read(&folder, table.get("widgets")).map_err(cannot)?;
    let routes = Routes::read(&folder, table.get("routes")).map_err(cannot)?;
    let conventions = conventions::read(|name| string_list(&table, name, false)).map_err(cannot)?;
    let listings = ListingSettings::read(&folder, table.get("listings")).map_err(cannot)?;
    let mut paths = Vec::new();
    for entry in of_paths(&table).map_err(cannot)? {
        reject_unknown_keys(entry, &OF_PATHS).map_err(cannot)?;
        let patterns = string_list(entry, "match", false).map_err(cannot)?;
        if patterns.is_empty() {
            return Err(cannot("[[paths]] needs `match`, a list of patterns such as \"drafts/**\"".into()));
        }
        let globs = Globs::new(&folder, &patterns).map_err(cannot)?;
        let list = |name: &str| string_list(entry, name, true).map_err(cannot);
        paths.push(PathSettings { patterns, globs, ignore: list("ignore")?, deny: list("deny")? });
    }
    let path = path.to_path_buf();
    Ok(PolicyFile { path, select, ignore, deny, widgets, routes, conventions, listings, paths })
}

/// The tables of `[[paths]]`; empty if there are none.
fn of_paths(table: &toml::Table) -> Result<Vec<&toml::Table>, String> {
    let Some(value) = table.get("paths") else { return Ok(Vec::new()) };
    let tables = value.as_array().and_then(|list| list.iter().map(toml::Value::as_table).collect());
    tables.ok_or_else(|| "`paths` must be a list of tables: [[paths]]".to_string())
}

/// Refuses unknown keys.
fn reject_unknown_keys(table: &toml::Table, keys: &[&str]) -> Result<(), String> {
    let Some(key) = table.keys().find(|key| !keys.contains(&key.as_str())) else { return Ok(()) };
    let near = match nearest(key, keys.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("use one of {}", keys.join(", ")),
    };
    Err(format!("unknown setting `{}`; {near}", printable(key)))
}

/// A list of strings, which must be names of rules if `of_rules`.
fn string_list(table: &toml::Table, name: &str, of_rules: bool) -> Result<Vec<String>, String> {
    let Some(value) = table.get(name) else { return Ok(Vec::new()) };
    let list = value.as_array().map(|list| list.iter().map(|v| v.as_str().map(String::from)).collect());
    let words: Option<Vec<String>> = list.unwrap_or(None);
    let words = words.ok_or_else(|| format!("`{name}` must be a list of texts"))?;
    if of_rules {
        RuleSet::parse(&words).map_err(|e| format!("{name}: {e}"))?;
    }
    Ok(words)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    fn reported_rules(policy: &Policy) -> Vec<(&'static str, Severity)> {
        let finding = |code: &str| Finding::new(rules::find(code).unwrap(), 0..0, "");
        let mut all: Vec<Finding> =
            ["duplicate-readout", "unknown-key", "energy-grows"].map(finding).to_vec();
        policy.apply(&mut all);
        all.iter().map(|f| (f.code, f.severity)).collect()
    }

    #[test]
    fn the_nearest_settings_count_and_the_command_line_adds_to_them() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, text).unwrap();
            path
        };
        write(
            "labspec.toml",
            "ignore = [\"duplicate-readout\"]\n[[paths]]\nmatch = [\"drafts/**\"]\nignore = [\"run\"]\n",
        );
        write("inner/labspec.toml", "deny = [\"warnings\"]\n");
        let lesson = write("a.md", "");
        let draft = write("drafts/b.md", "");
        let inner = write("inner/deep/c.md", "");
        let mut all = Policies::new(&PolicyOptions::default()).unwrap();
        let key = ("unknown-key", Severity::Error);
        let grows = rules::find("energy-grows").unwrap().severity;
        assert_eq!(reported_rules(&all.policy_for(&lesson).unwrap()), [key, ("energy-grows", grows)]);
        assert_eq!(reported_rules(&all.policy_for(&draft).unwrap()), [key]);
        let denied = [("duplicate-readout", Severity::Error), key, ("energy-grows", Severity::Error)];
        assert_eq!(reported_rules(&all.policy_for(&inner).unwrap()), denied);
        let options = PolicyOptions { ignore: vec!["structure".into()], ..PolicyOptions::default() };
        let mut all = Policies::new(&options).unwrap();
        assert_eq!(reported_rules(&all.policy_for(&lesson).unwrap()), [("energy-grows", grows)]);
    }

    #[test]
    fn the_schema_knows_every_setting() {
        let text = include_str!("../../../docs/schema/labspec-toml.json");
        let schema: serde_json::Value = serde_json::from_str(text).unwrap();
        let keys = |value: &serde_json::Value| -> Vec<String> {
            let mut keys: Vec<String> = value["properties"].as_object().unwrap().keys().cloned().collect();
            keys.sort();
            keys
        };
        let sorted = |keys: &[&str]| {
            let mut keys: Vec<String> = keys.iter().map(|k| (*k).to_string()).collect();
            keys.sort();
            keys
        };
        assert_eq!(keys(&schema), sorted(&KEYS));
        assert_eq!(keys(&schema["properties"]["paths"]["items"]), sorted(&OF_PATHS));
        let codes: Vec<&str> = labspec::language::LANGUAGES.iter().map(|language| language.code).collect();
        assert_eq!(schema["properties"]["languages"]["items"]["enum"], serde_json::json!(codes));
        let words = schema["$defs"]["rules"]["description"].as_str().unwrap();
        for word in Layer::ALL.map(Layer::as_str).iter().chain(SEVERITIES.map(|(word, _)| word).iter()) {
            assert!(words.contains(word), "{word}");
        }
    }

    #[test]
    fn errors_in_settings_are_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("labspec.toml");
        let error = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read(&path).unwrap_err()
        };
        assert!(error("ignor = []").contains("did you mean `ignore`"));
        assert!(error("ignore = [\"duplicate-readouts\"]").contains("did you mean `duplicate-readout`"));
        assert!(error("ignore = 3").contains("a list of texts"));
        assert!(error("\nignore = ").contains("line 2"));
        assert!(error("[[paths]]\nignore = []").contains("needs `match`"));
        for pattern in ["", " ", "#1.md", "!drafts"] {
            assert!(
                error(&format!("[[paths]]\nmatch = [{pattern:?}]\n")).contains("matches nothing"),
                "{pattern}"
            );
        }
        assert!(error("paths = 1").contains("[[paths]]"));
        assert!(error("paths = [1]").contains("[[paths]]"));
        assert!(error("widgets = \"playground\"").contains("a list of texts"));
        assert!(error("languages = [\"dee\"]").contains("did you mean `de`"));
        assert!(error("languages = [\"xxxx\"]").contains("use one of en, de"));
        assert!(error("macros = [\"{%\"]").contains("a closing delimiter"));
        assert!(error("[listings]\nfile = []").contains("did you mean `files`"));
        assert!(error("front_matter = []").contains("did you mean `front-matter`"));
    }
}
