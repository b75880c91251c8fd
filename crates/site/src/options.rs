//! What a site says of itself, and what its files are.

use std::path::PathBuf;

/// The title of a course without one.
const TITLE: &str = "Lessons";

/// What a site says of itself.
#[derive(Clone, Debug, Default)]
pub struct SiteOptions {
    /// The title of the course.
    pub title: Option<String>,
    /// The language of the pages.
    pub lang: String,
    /// The address where the site will be, ending in `/`; with it, the site has a map for search engines.
    pub base: Option<String>,
    /// Whether there are content packages for learning systems, and what they say of grades.
    pub scorm: Option<ScormOptions>,
}

impl SiteOptions {
    /// The title of the course.
    pub(crate) fn title(&self) -> &str {
        self.title.as_deref().unwrap_or(TITLE)
    }
}

/// A file of a site.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SiteFile {
    /// A text.
    Text(String),
    /// A copy of a file.
    Copy(PathBuf),
    /// A picture or an archive.
    Bytes(Vec<u8>),
}

/// What packages say of grades.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScormOptions {
    /// The share of right answers that passes, from 0 to 1. Without it, a lesson is neither passed nor failed.
    pub passing: Option<f64>,
}
