//! `labspec explain`.

use super::common::{CommandOutcome, Failure};
use super::stdio::print;
use labspec::json;
use labspec::rules;

/// Arguments of `explain`.
#[derive(clap::Args, Debug)]
pub(super) struct ExplainArguments {
    /// A code such as `unknown-key`
    code: Option<String>,
}

pub(super) fn explain(a: &ExplainArguments) -> Result<CommandOutcome, Failure> {
    let Some(code) = &a.code else {
        let width = rules::all().map(|rule| rule.code.len()).max().unwrap_or(0);
        let lines: Vec<String> =
            rules::all().map(|rule| format!("{:<width$}  {}\n", rule.code, rule.summary)).collect();
        print(&lines.concat())?;
        return Ok(CommandOutcome::Clean);
    };
    let text = rules::explain(code);
    match text {
        Some(text) => print(&text).map(|()| CommandOutcome::Clean),
        None => {
            let near = json::nearest(code, rules::all().map(|rule| rule.code));
            let near = near.map_or(String::new(), |c| format!("; did you mean `{c}`?"));
            let code = labspec::report::printable(code);
            Err(format!("the code `{code}` does not exist{near}\n`labspec explain` lists all codes"))
        }
    }
}
