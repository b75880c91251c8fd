//! The findings in the runs of a lab that compares integrators: each once, with the integrators that have it.

use super::Trial;
use crate::finding::Finding;
use crate::spec::Lab;
use labspec_expr::Value;

/// A finding in the runs of several integrators.
struct SharedFinding {
    finding: Finding,
    /// The words of its message that name the run.
    done: String,
    integrators: Vec<String>,
}

/// The findings of the runs so far.
#[derive(Default)]
pub(super) struct ComparedFindings(Vec<SharedFinding>);

impl ComparedFindings {
    /// Adds the findings of a run. Those of a run that compares nothing are returned.
    pub(super) fn add(&mut self, trial: &Trial<'_>, lab: &Lab, findings: Vec<Finding>) -> Vec<Finding> {
        let Some(integrator) = compared_integrator(trial, lab) else { return findings };
        for finding in findings {
            let same =
                |s: &&mut SharedFinding| s.finding.code == finding.code && s.finding.span == finding.span;
            match self.0.iter_mut().find(same) {
                Some(shared) if shared.integrators.contains(&integrator) => {}
                Some(shared) => shared.integrators.push(integrator.clone()),
                None => self.0.push(SharedFinding {
                    finding,
                    done: trial.done.clone(),
                    integrators: vec![integrator.clone()],
                }),
            }
        }
        Vec::new()
    }

    /// The findings with the names of all integrators that have them.
    pub(super) fn take(&mut self) -> Vec<Finding> {
        std::mem::take(&mut self.0).into_iter().map(SharedFinding::finish).collect()
    }
}

impl SharedFinding {
    fn finish(self) -> Finding {
        let SharedFinding { mut finding, done, integrators } = self;
        if let [first @ .., last] = integrators.as_slice()
            && !first.is_empty()
        {
            let names = format!("with the integrators {} and {last}", first.join(", "));
            let message = finding.message.replacen(&done, &names, 1);
            // The time and the number are those of one run.
            finding.message = match integrators.first().filter(|_| message != finding.message) {
                Some(first) => format!("{message} (with {first})"),
                None => format!("{message}, {names}"),
            };
        }
        finding
    }
}

/// The integrator of a run that differs from the lab only in it.
fn compared_integrator(trial: &Trial<'_>, lab: &Lab) -> Option<String> {
    let comparison = lab.comparison.as_ref()?;
    match &trial.moved {
        None if trial.control.is_none() => comparison.integrators.first().map(|name| name.to_string()),
        Some((index, Some(Value::String(name)))) if *index == comparison.control => Some(name.to_string()),
        _ => None,
    }
}
