//! Courses as pages: `labspec build` writes a static site, `labspec preview` serves the same pages while they are written.
//!
//! | module | contents |
//! |---|---|
//! | `names`, `text` | names of pages in addresses; texts of lessons as text of a page, and JSON inside it |
//! | `html` | the harmless part of the HTML in lessons |
//! | `masked` | the text of a lesson with its fences replaced, so that a page has the fences that a check has |
//! | `links` | links and images: pages of the course, files that are copied, addresses that are refused |
//! | `models` | models of labs: inside a page, or as files beside it |
//! | `twin`, `moments` | a lab or a quiz without JavaScript and on paper, with pictures of its run |
//! | `verified` | which claims a check has found true |
//! | `marks` | claimed and unclaimed numbers in the text |
//! | `prose`, `fence` | Markdown without its fences, and the fences, as HTML |
//! | `lesson`, `lesson_main` | a lesson as blocks of HTML, in the order of its text, and the main part of its page |
//! | `page`, `overview`, `search`, `offline` | pages around lessons, the indexes, and the files of the site |
//! | `archive`, `scorm` | content packages for learning systems |
//! | `assets` | scripts and styles that every page needs |
//! | `options`, `site` | what is built, and a course to files; [`build_site`] is the entry point |
//! | `preview` | the server |
//!
//! Texts of lessons are untrusted. They reach a page through `text` and `html` only, and every page has a policy that allows no
//! script but those of the site.

mod archive;
mod assets;
mod fence;
mod html;
mod lesson;
mod lesson_main;
mod links;
mod marks;
mod masked;
mod models;
mod moments;
mod names;
mod offline;
mod options;
mod overview;
mod page;
pub mod preview;
mod prose;
mod scorm;
mod search;
mod site;
#[cfg(test)]
mod tests;
mod text;
mod twin;
mod verified;

pub use assets::PageFiles;
pub use options::{ScormOptions, SiteFile, SiteOptions};
pub use site::{Course, MANIFEST, Site, build_site};
pub use twin::chart;
