//! A course as one HTML page: every claim with its evidence, readable without a server, a network or scripts.
//!
//! The page is HTML that is also well-formed XML, so that a test can check its nesting. Text of lessons enters it only
//! through `text` and `formula`, and plots are drawn by `labspec_plot`, which escapes its input. The content security
//! policy in the head forbids everything except the style.
//!
//! | part | module |
//! |---|---|
//! | the summary, and how much is claimed | `overview`, `coverage` |
//! | a lesson with its findings and labs | `lesson` |
//! | a question with its options | `question` |
//! | runs, measures, quoted numbers, closed forms | `evidence` |
//! | the events and the settings of a run | `settings` |
//! | plots of the runs | `plots` |
//! | texts of lessons, and formulas in them | `text`, `formula` |

mod context;
mod coverage;
mod evidence;
mod formula;
mod lesson;
mod material;
mod overview;
mod page;
mod plots;
mod question;
mod settings;
mod text;
mod verdict;

pub use material::Material;
pub use page::page;
pub use text::escape;
