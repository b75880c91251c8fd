//! The lab of a command, and the interactions with it: `--set LABEL=VALUE`, `--press LABEL@TIME`.

use super::common::{Failure, ModelOptions};
use super::output::{PlannedOutput, check_outputs_writable};
use super::target::{self, LabTarget};
use labspec::run::settings;
use labspec::spec::Lab;
use labspec_expr::Value;

/// The common arguments of all commands that run a lab.
#[derive(clap::Args, Debug)]
pub(super) struct LabArguments {
    /// LAB.json, LESSON.md#2 (its second lab), LESSON.md#quiz-id.1 (a question's sim), or MODEL.xml
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// Set a control before every run
    #[arg(long, value_name = "LABEL=VALUE")]
    set: Vec<String>,
    /// Press a button in every run, at a time in seconds
    #[arg(long, value_name = "LABEL@TIME")]
    press: Vec<String>,
}

impl LabArguments {
    pub(super) fn open(&self) -> Result<LabTarget, Failure> {
        target::open(&self.lab, &self.models)
    }

    /// Checks that these files can be written and would not overwrite an input.
    pub(super) fn check_outputs_writable(
        &self,
        target: &LabTarget,
        outputs: &[PlannedOutput],
    ) -> Result<(), Failure> {
        check_outputs_writable(&target::read_for(&self.lab, &self.models, &target.lab), outputs)
    }

    pub(super) fn set(&self, lab: &Lab) -> Result<Vec<(String, Value)>, Failure> {
        self.set.iter().map(|text| assignment(lab, text)).collect()
    }

    pub(super) fn press(&self, lab: &Lab) -> Result<Vec<(String, f64)>, Failure> {
        self.press.iter().map(|text| press(lab, text)).collect()
    }
}

/// Parses `LABEL=VALUE`. Both parts may contain `=`: the text is split after the label of a control, otherwise at the last `=`.
fn assignment(lab: &Lab, text: &str) -> Result<(String, Value), Failure> {
    let (label, value) = split(lab, text, '=').ok_or_else(|| format!("--set {text}: write LABEL=VALUE"))?;
    Ok((label.to_string(), settings::written(lab, label, value.trim())))
}

/// Parses `LABEL@TIME`, or only a label for a press at the start.
fn press(lab: &Lab, text: &str) -> Result<(String, f64), Failure> {
    match split(lab, text, '@').filter(|_| lab.control(text).is_none()) {
        None => Ok((text.to_string(), 0.0)),
        Some((label, time)) => match time.trim().parse::<f64>() {
            Ok(t) if t >= 0.0 && t.is_finite() => Ok((label.to_string(), t)),
            _ => Err(format!("--press {text}: `{time}` is not a time in seconds; write LABEL@TIME")),
        },
    }
}

/// Splits a text at `mark` into the label of a control and the rest.
fn split<'t>(lab: &Lab, text: &'t str, mark: char) -> Option<(&'t str, &'t str)> {
    let places = text.match_indices(mark).map(|(i, m)| (&text[..i], &text[i + m.len()..]));
    let at_label = places.into_iter().find(|(label, _)| lab.control(label).is_some());
    at_label.or_else(|| text.rsplit_once(mark))
}
