//! The findings about a program that omits constants or coupled parameters.

use super::advice::SetConstAdvice;
use super::bench::SetConstBench;
use super::compare::ProgramEffects;
use super::{ProgramSite, SuspectProgram};
use crate::bind::coupled::{CoupledPair, PairSet};
use crate::finding::{Applicability, Finding, Fix, Severity};
use crate::rules::{self, Rule};

const CONSTANTS: &str =
    "the constants that follow from it (subtree masses, inverse weights of contacts) keep their old values";

impl SetConstBench<'_> {
    /// The findings, unless there is no visible difference.
    pub(super) fn judge(&mut self, s: &SuspectProgram<'_>) -> Vec<Finding> {
        match self.compare(s) {
            Ok(compared) => {
                let constants = missing(s, &compared);
                let fix =
                    replacement(s, &compared).filter(|_| constants.as_ref().is_none_or(|f| f.fix.is_none()));
                let partners = self.has_uncoupled_change(s, &compared, fix);
                constants.into_iter().chain(partners).collect()
            }
            Err(reason) => untested(s, &reason).into_iter().collect(),
        }
    }

    /// A finding for each violated rule.
    fn has_uncoupled_change(
        &self,
        s: &SuspectProgram<'_>,
        compared: &ProgramEffects,
        mut fix: Option<Fix>,
    ) -> Vec<Finding> {
        let (evidence, pairs, severity) = match (&compared.partners, &compared.untested) {
            (Some((evidence, pairs)), _) => (evidence.clone(), *pairs, Severity::Warning),
            (None, Some(reason)) => {
                let why = format!("the effect could not be tested: {reason}");
                (why, s.pairs, Severity::Note)
            }
            (None, None) => return Vec::new(),
        };
        let who = match s.place {
            ProgramSite::Setup => "the setup".to_string(),
            ProgramSite::Controller => "the controller".to_string(),
            ProgramSite::Control(i) => {
                format!("\"{}\"", self.programs().controls.get(i).map_or("", |(l, _)| l))
            }
            ProgramSite::Run(run) => {
                format!("the setup of the run {}", crate::json::read::named(&run.name.value))
            }
        };
        let mut all = Vec::new();
        for (rule, pairs) in by_rule(pairs) {
            let mut finding = left(rule, s.bound.text.span(), &who, &pairs, severity).why(evidence.clone());
            let with: Vec<&str> = pairs.iter().map(|p| p.corrected).collect();
            finding = match (&compared.repaired, severity) {
                (Some(text), Severity::Warning) => finding.help(format!(
                    "{}; in a test run, the lab then uses {}",
                    instead(s, text),
                    with.join(" and ")
                )),
                _ => finding,
            };
            finding.fix = fix.take().filter(|_| severity == Severity::Warning);
            all.push(finding);
        }
        all
    }
}

/// The pairs of a set by the rule that they violate.
pub(in crate::check) fn by_rule(pairs: PairSet) -> Vec<(&'static Rule, Vec<&'static CoupledPair>)> {
    let mut all: Vec<(&'static Rule, Vec<&'static CoupledPair>)> = Vec::new();
    for (_, pair) in pairs.pairs() {
        match all.iter_mut().find(|(rule, _)| rule.code == pair.rule.code) {
            Some((_, list)) => list.push(pair),
            None => all.push((pair.rule, vec![pair])),
        }
    }
    all
}

/// The finding that a parameter changes and its coupled parameters do not.
pub(in crate::check) fn left(
    rule: &'static Rule,
    span: std::ops::Range<usize>,
    who: &str,
    pairs: &[&CoupledPair],
    severity: Severity,
) -> Finding {
    let (mut parameters, mut partners, mut help) = (Vec::new(), Vec::new(), Vec::new());
    for pair in pairs {
        for (list, text) in [
            (&mut parameters, format!("`model.{}`", pair.parameter.info().name)),
            (&mut partners, pair.left.to_string()),
            (&mut help, pair.help.to_string()),
        ] {
            if !list.contains(&text) {
                list.push(text);
            }
        }
    }
    let [parameters, partners] = [parameters, partners].map(|list| list.join(" and "));
    let message = format!("{who} changes {parameters} but not {partners}");
    Finding::plain(rule, span, message).severity(severity).help(help.join("; "))
}

/// The help for a whole program.
fn instead(s: &SuspectProgram<'_>, text: &str) -> String {
    match s.target {
        true => format!("instead of \"set\", write \"apply\": {}", serde_json::Value::from(text)),
        false => format!("write `{}`", text.replace('\n', " ").trim()),
    }
}

/// The help for constants alone.
fn help_for_constants(s: &SuspectProgram<'_>, advice: SetConstAdvice) -> String {
    let text = &s.bound.text.value;
    match s.target {
        true => {
            let source = super::advice::source(s);
            instead(s, &format!("{source}{}", advice.tail(&source)))
        }
        false => format!("add `{}`", advice.tail(text).replace('\n', " ").trim()),
    }
}

/// The repaired program in place of the text. The fix is unsafe, because the author may intend the inertia to stay.
fn replacement(s: &SuspectProgram<'_>, compared: &ProgramEffects) -> Option<Fix> {
    let text = compared.repaired.as_ref().filter(|_| !s.target)?;
    let json = serde_json::Value::from(text.as_str()).to_string();
    let text = json.trim_start_matches('"');
    let text = text.strip_suffix('"').unwrap_or(text).to_string();
    Some(Fix { span: s.bound.text.span(), text, applicability: Applicability::Unsafe })
}

fn about_constants(s: &SuspectProgram<'_>) -> Option<Finding> {
    let (field, late) = s.inertial?;
    let when = if late { "after the last" } else { "without" };
    Some(Finding::warning(
        rules::MISSING_SETCONST,
        s.bound.text.span(),
        format!("`model.{}` changes {when} `mj.mj_setConst(model, data)`", field.info().name),
    ))
}

/// The finding that constants are not recomputed, where the effect is visible.
fn missing(s: &SuspectProgram<'_>, compared: &ProgramEffects) -> Option<Finding> {
    let evidence = compared.constants.as_ref()?;
    let finding = about_constants(s)?.why(format!("{CONSTANTS}: {evidence}"));
    let reason = match compared.advice {
        SetConstAdvice::Plain => "; in a test run, the lab then uses the right constants",
        SetConstAdvice::Keep => {
            "; a test run confirms it. `mj_setConst` alone would also restore qpos from the model, so the code keeps qpos"
        }
    };
    let pairs = compared.partners.as_ref().map_or(PairSet::NONE, |(_, pairs)| *pairs);
    if let Some(text) = &compared.repaired {
        let mut finding = finding.help(format!("{}{reason}", instead(s, text)));
        finding.fix = replacement(s, compared);
        return Some(finding);
    }
    if !pairs.is_empty() {
        let help: Vec<&str> = pairs.pairs().map(|(_, pair)| pair.help).collect();
        let advised = help_for_constants(s, SetConstAdvice::Keep);
        return Some(finding.help(format!(
            "{advised}; this updates only the constants, and the related parameter keeps its old value: {}",
            help.join("; ")
        )));
    }
    let finding = finding.help(format!("{}{reason}", help_for_constants(s, compared.advice)));
    if s.target {
        return Some(finding);
    }
    let text = &s.bound.text;
    let end = text.span().end;
    let tail = serde_json::Value::from(compared.advice.tail(&text.value)).to_string();
    Some(finding.fix(end..end, tail.trim_matches('"')))
}

/// The finding that constants are not recomputed, where the effect could not be tested.
fn untested(s: &SuspectProgram<'_>, reason: &str) -> Option<Finding> {
    Some(
        about_constants(s)?
            .why(format!("{CONSTANTS}: a heavier ball then sinks deeper into the floor than any real one"))
            .help(format!(
                "{}, which keeps qpos; its effect in this lab could not be tested: {reason}",
                help_for_constants(s, SetConstAdvice::Keep)
            )),
    )
}
