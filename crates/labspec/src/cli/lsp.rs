//! `labspec lsp`.

use super::policy::{Policies, PolicyOptions};
use super::stdio::complain;
use super::target::model_folder;
use super::{Failure, ModelOptions, Outcome};
use crate::finding::Finding;
use crate::lint::ModelFolder;
use crate::lsp::{Course, serve};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io::BufReader;
use std::path::Path;

/// Arguments of `lsp`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    policy: PolicyOptions,
    /// Speak over standard input and output, which is the only way there is: many editors say so
    #[arg(long)]
    stdio: bool,
}

pub(super) fn lsp(a: &Arguments) -> Result<Outcome, Failure> {
    Policies::new(&a.policy)?;
    // What cannot be read is said once, on standard error: editors keep it in their log.
    let said = RefCell::new(BTreeSet::new());
    let say = |why: Failure| {
        if said.borrow_mut().insert(why.clone()) {
            complain(&format!("labspec: {why}\n"));
        }
    };
    let models = |path: &Path| {
        model_folder(&a.models, path).unwrap_or_else(|why| {
            say(why);
            ModelFolder::unknown()
        })
    };
    // Settings are read anew each time: they may change while the editor is open.
    let mut policy = |path: &Path, findings: &mut Vec<Finding>| match Policies::new(&a.policy)
        .and_then(|mut all| all.of(path))
    {
        Ok(policy) => drop(policy.apply(findings)),
        Err(why) => say(why),
    };
    let course = Course { models: &models, policy: &mut policy };
    let input = BufReader::new(std::io::stdin());
    match serve(course, input, &mut std::io::stdout().lock()) {
        Ok(true) => Ok(Outcome::Clean),
        Ok(false) => Ok(Outcome::Findings),
        Err(e) => Err(format!("cannot talk to the editor: {e}")),
    }
}
