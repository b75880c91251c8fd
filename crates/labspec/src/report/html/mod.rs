//! A course as one page of HTML: every claim with what it rests on, to be read without a server, a network or a script.
//!
//! The page is HTML that is also XML, so that a test can hold its nesting. Text from lessons enters it through `text` and `formula` alone, and
//! pictures are drawn by `labspec_plot`, which escapes what it is given. The policy in its head forbids everything but its style.
//!
//! | piece | module |
//! |---|---|
//! | what it all comes to, and how much is claimed | `overview`, `coverage` |
//! | a lesson with its findings and labs | `lesson` |
//! | a question with its options | `question` |
//! | runs, measures, quoted numbers, closed forms | `evidence` |
//! | how a run is made, and with which settings | `settings` |
//! | pictures of the runs | `plots` |
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
