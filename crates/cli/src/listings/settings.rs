//! The table `[listings]` of `labspec.toml`.

use labspec::report::printable;
use labspec_finding::nearest;
use std::path::{Component, Path, PathBuf};

/// The keys of the table.
pub(crate) const KEYS: [&str; 7] =
    ["python", "requirements", "project", "files", "seconds", "memory", "network"];
/// The range of the time limit, in seconds.
const SECONDS: [i64; 2] = [1, 3600];
/// The range of the memory limit, in MiB.
const MEMORY: [i64; 2] = [16, 1 << 20];

/// How listings are run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ListingSettings {
    /// The folder of the settings.
    pub(super) folder: PathBuf,
    /// The interpreter, or the folder of an environment, relative to that folder.
    pub(super) python: Option<String>,
    /// The packages of an environment that labspec makes.
    pub(super) requirements: Vec<String>,
    /// The folder of a project of uv, relative to that folder.
    pub(super) project: Option<String>,
    /// Files and folders that listings share, relative to that folder.
    pub(super) files: Vec<String>,
    pub(super) seconds: u64,
    /// In MiB; 0 for no limit.
    pub(super) memory: u64,
    pub(super) network: bool,
}

impl Default for ListingSettings {
    fn default() -> ListingSettings {
        ListingSettings {
            folder: PathBuf::new(),
            python: None,
            requirements: Vec::new(),
            project: None,
            files: Vec::new(),
            seconds: 60,
            memory: 2048,
            network: false,
        }
    }
}

impl ListingSettings {
    /// Reads the table.
    ///
    /// # Errors
    /// A key is unknown, or a value has another type or is out of its range.
    pub(crate) fn read(folder: &Path, value: Option<&toml::Value>) -> Result<ListingSettings, String> {
        let default = ListingSettings { folder: folder.to_path_buf(), ..ListingSettings::default() };
        let Some(value) = value else { return Ok(default) };
        let table = value.as_table().ok_or("`listings` must be a table: [listings]")?;
        if let Some(key) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let help = match nearest(key, KEYS.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("use one of {}", KEYS.join(", ")),
            };
            return Err(format!("listings: unknown setting `{}`; {help}", printable(key)));
        }
        let settings = ListingSettings {
            python: text(table, "python")?,
            requirements: texts(table, "requirements")?,
            project: text(table, "project")?,
            files: texts(table, "files")?,
            seconds: number(table, "seconds", SECONDS, default.seconds)?,
            memory: match table.get("memory").and_then(toml::Value::as_integer) {
                Some(0) => 0,
                _ => number(table, "memory", MEMORY, default.memory)?,
            },
            network: flag(table, "network")?,
            ..default
        };
        let given = [
            ("python", settings.python.is_some()),
            ("requirements", !settings.requirements.is_empty()),
            ("project", settings.project.is_some()),
        ];
        let given: Vec<&str> =
            given.into_iter().filter_map(|(name, is_given)| is_given.then_some(name)).collect();
        if let [first, second, ..] = given.as_slice() {
            return Err(format!("listings: `{first}` and `{second}` exclude each other; delete one of them"));
        }
        settings.requirements.iter().try_for_each(|requirement| check_requirement(requirement))?;
        check_files(&settings.files)?;
        Ok(settings)
    }

    /// The settings in words: the name of each, and its value.
    pub(crate) fn lines(&self) -> Vec<(&'static str, String)> {
        let default = ListingSettings::default();
        let mut all: Vec<(&'static str, String)> = Vec::new();
        all.extend(self.python.iter().map(|python| ("listings.python", python.clone())));
        all.extend(self.requirements.iter().map(|name| ("listings.requirements", name.clone())));
        all.extend(self.project.iter().map(|project| ("listings.project", project.clone())));
        all.extend(self.files.iter().map(|file| ("listings.files", file.clone())));
        if self.seconds != default.seconds {
            all.push(("listings.seconds", self.seconds.to_string()));
        }
        if self.memory != default.memory {
            all.push(("listings.memory", self.memory.to_string()));
        }
        if self.network {
            all.push(("listings.network", "true".into()));
        }
        all
    }
}

fn text(table: &toml::Table, name: &str) -> Result<Option<String>, String> {
    let Some(value) = table.get(name) else { return Ok(None) };
    let text = value.as_str().filter(|text| !text.is_empty());
    text.map(|text| Some(text.to_string())).ok_or_else(|| format!("listings: `{name}` must be a text"))
}

fn texts(table: &toml::Table, name: &str) -> Result<Vec<String>, String> {
    let Some(value) = table.get(name) else { return Ok(Vec::new()) };
    let list = value.as_array().and_then(|list| list.iter().map(|v| v.as_str().map(String::from)).collect());
    list.ok_or_else(|| format!("listings: `{name}` must be a list of texts"))
}

fn number(table: &toml::Table, name: &str, [least, most]: [i64; 2], default: u64) -> Result<u64, String> {
    let Some(value) = table.get(name) else { return Ok(default) };
    let number = value.as_integer().filter(|n| (least..=most).contains(n));
    let number = number.and_then(|n| u64::try_from(n).ok());
    number.ok_or_else(|| format!("listings: `{name}` must be a whole number from {least} to {most}"))
}

fn flag(table: &toml::Table, name: &str) -> Result<bool, String> {
    let Some(value) = table.get(name) else { return Ok(false) };
    value.as_bool().ok_or_else(|| format!("listings: `{name}` must be true or false"))
}

/// Refuses options of an installer, paths and addresses: packages come from the index of the installer.
fn check_requirement(requirement: &str) -> Result<(), String> {
    let is_name = requirement.starts_with(|c: char| c.is_ascii_alphanumeric());
    let allowed = |c: char| c.is_ascii_alphanumeric() || "._-+[],=<>!~*; ".contains(c);
    match is_name && requirement.chars().all(allowed) {
        true => Ok(()),
        false => Err(format!(
            "listings: `{}` in `requirements` is not a package, such as \"numpy\" or \"mujoco==3.14.0\"",
            printable(requirement)
        )),
    }
}

/// Refuses files without a name, and two with the same name, because they are copied into one folder.
fn check_files(files: &[String]) -> Result<(), String> {
    let mut names = std::collections::BTreeSet::new();
    for file in files {
        let name = match Path::new(file).components().next_back() {
            Some(Component::Normal(name)) => name,
            _ => {
                return Err(format!(
                    "listings: `{}` in `files` does not name a file or a folder",
                    printable(file)
                ));
            }
        };
        if !names.insert(name) {
            return Err(format!(
                "listings: two of `files` have the name `{}`",
                printable(&name.to_string_lossy())
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ListingSettings, String> {
        let table: toml::Table = toml::from_str(text).unwrap();
        ListingSettings::read(Path::new("/course"), table.get("listings"))
    }

    #[test]
    fn settings_are_read() {
        let all = read(
            "[listings]\npython = \"../p\"\nfiles = [\"a/b.py\", \"models\"]\nseconds = 5\nmemory = 100\nnetwork = true",
        )
        .unwrap();
        assert_eq!(
            (all.python.as_deref(), all.seconds, all.memory, all.network),
            (Some("../p"), 5, 100, true)
        );
        assert_eq!(all.lines().len(), 6);
        assert_eq!(read("").unwrap().lines(), []);
        assert_eq!(read("[listings]\nmemory = 0").unwrap().memory, 0);
        let packages =
            read("[listings]\nrequirements = [\"mujoco==3.14.0\", \"numpy\"]").unwrap().requirements;
        assert_eq!(packages, ["mujoco==3.14.0", "numpy"]);
        let project = read("[listings]\nproject = \"course\"").unwrap();
        assert_eq!(project.lines(), [("listings.project", "course".to_string())]);
    }

    #[test]
    fn wrong_settings_are_reported() {
        let error = |text: &str| read(text).unwrap_err();
        assert!(error("listings = 1").contains("[listings]"));
        assert!(error("[listings]\nsecond = 5").contains("did you mean `seconds`"));
        assert!(error("[listings]\nseconds = 0").contains("from 1 to 3600"));
        assert!(error("[listings]\nseconds = \"5\"").contains("a whole number"));
        assert!(error("[listings]\nmemory = -1").contains("from 16"));
        assert!(error("[listings]\nnetwork = 1").contains("true or false"));
        assert!(error("[listings]\npython = 3").contains("a text"));
        assert!(error("[listings]\nfiles = \"a\"").contains("a list of texts"));
        assert!(error("[listings]\nfiles = [\"a/x\", \"b/x\"]").contains("the name `x`"));
        assert!(error("[listings]\nfiles = [\"..\"]").contains("does not name"));
        assert!(
            error("[listings]\npython = \"p\"\nrequirements = [\"numpy\"]").contains("exclude each other")
        );
        assert!(
            error("[listings]\nproject = \"p\"\nrequirements = [\"numpy\"]")
                .contains("`requirements` and `project`")
        );
        assert!(error("[listings]\nproject = []").contains("a text"));
        for wrong in ["-r file", "--index-url=x", "a @ https://x", "./local", "/local", ""] {
            assert!(
                error(&format!("[listings]\nrequirements = [\"{wrong}\"]")).contains("is not a package"),
                "{wrong}"
            );
        }
    }

    #[test]
    fn the_schema_knows_every_key() {
        let text = include_str!("../../../../docs/schema/labspec-toml.json");
        let schema: serde_json::Value = serde_json::from_str(text).unwrap();
        let keys = schema["properties"]["listings"]["properties"].as_object().unwrap();
        assert!(KEYS.iter().all(|key| keys.contains_key(*key)) && keys.len() == KEYS.len());
    }
}
