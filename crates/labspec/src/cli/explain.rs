//! `labspec explain`.

use super::{Failure, Outcome, print};
use crate::{json, lint, rules};

/// Arguments of `explain`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// A code such as `unknown-key`
    code: Option<String>,
}

pub(super) fn explain(a: &Arguments) -> Result<Outcome, Failure> {
    let Some(code) = &a.code else {
        let width = rules::all().map(|(code, _)| code.len()).max().unwrap_or(0);
        let lines: Vec<String> =
            rules::all().map(|(code, summary)| format!("{code:<width$}  {summary}\n")).collect();
        print(&lines.concat())?;
        return Ok(Outcome::Clean);
    };
    let text = lint::explain(code).or_else(|| rules::explain(code));
    match text {
        Some(text) => print(&text).map(|()| Outcome::Clean),
        None => {
            let near = json::nearest(code, rules::all().map(|(c, _)| c));
            let near = near.map_or(String::new(), |c| format!("; did you mean `{c}`?"));
            let code = crate::report::printable(code);
            Err(format!("there is no code `{code}`{near}\n`labspec explain` lists all codes"))
        }
    }
}
