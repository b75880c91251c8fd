//! `labspec lsp`.

use super::common::{CommandOutcome, Failure, ModelOptions};
use super::policy::{Policies, Policy, PolicyOptions};
use super::stdio::print_error;
use super::target::model_folder;
use labspec::finding::Finding;
use labspec::lint::ModelFolder;
use labspec::spec::Conventions;
use labspec_lsp::{CourseConfig, serve};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Arguments of `lsp`.
#[derive(clap::Args, Debug)]
pub(super) struct LspArguments {
    #[command(flatten)]
    models: ModelOptions,
    #[command(flatten)]
    policy: PolicyOptions,
    /// Use standard input and output (the only transport; many editors pass this option)
    #[arg(long)]
    stdio: bool,
}

pub(super) fn lsp(a: &LspArguments) -> Result<CommandOutcome, Failure> {
    Policies::new(&a.policy)?;
    // Each problem is reported once on standard error, which editors write to their log.
    let reported = RefCell::new(BTreeSet::new());
    let say = |why: Failure| {
        if reported.borrow_mut().insert(why.clone()) {
            print_error(&format!("labspec: {why}\n"));
        }
    };
    let models = |path: &Path| {
        model_folder(&a.models, path).unwrap_or_else(|why| {
            say(why);
            ModelFolder::unknown()
        })
    };
    // Settings may change while the editor is open, so they are read again when files may have changed.
    let policies: RefCell<BTreeMap<PathBuf, Policy>> = RefCell::default();
    let mut policy = |path: &Path, findings: &mut Vec<Finding>| {
        if let Some(policy) = policies.borrow().get(path) {
            return drop(policy.apply(findings));
        }
        match Policies::new(&a.policy).and_then(|mut all| all.policy_for(path)) {
            Ok(policy) => {
                drop(policy.apply(findings));
                policies.borrow_mut().insert(path.to_path_buf(), policy);
            }
            Err(why) => say(why),
        }
    };
    // A problem of the settings is reported with the findings.
    let conventions = |path: &Path| {
        if let Some(policy) = policies.borrow().get(path) {
            return policy.conventions.clone();
        }
        let near = Policies::new(&a.policy).and_then(|mut all| all.policy_for(path));
        near.map_or(Conventions::default(), |policy| policy.conventions)
    };
    let refresh = || policies.borrow_mut().clear();
    let course =
        CourseConfig { models: &models, policy: &mut policy, conventions: &conventions, refresh: &refresh };
    let input = BufReader::new(std::io::stdin());
    match serve(course, input, &mut std::io::stdout().lock()) {
        Ok(true) => Ok(CommandOutcome::Clean),
        Ok(false) => Ok(CommandOutcome::Findings),
        Err(e) => Err(format!("cannot talk to the editor: {e}")),
    }
}
