//! How a lab is handled on the command line: `--set LABEL=VALUE`, `--press LABEL@TIME`.

use super::Failure;
use crate::run::settings;
use crate::spec::Lab;
use labspec_expr::Value;

/// `LABEL=VALUE`. Both may hold equals signs: it is split where the label of a control ends, else at the last sign.
pub(super) fn assignment(lab: &Lab, text: &str) -> Result<(String, Value), Failure> {
    let (label, value) = split(lab, text, '=').ok_or_else(|| format!("--set {text}: write LABEL=VALUE"))?;
    Ok((label.to_string(), settings::written(lab, label, value.trim())))
}

/// `LABEL@TIME`, or a label alone for the start.
pub(super) fn press(lab: &Lab, text: &str) -> Result<(String, f64), Failure> {
    match split(lab, text, '@').filter(|_| lab.control(text).is_none()) {
        None => Ok((text.to_string(), 0.0)),
        Some((label, time)) => match time.trim().parse::<f64>() {
            Ok(t) if t >= 0.0 && t.is_finite() => Ok((label.to_string(), t)),
            _ => Err(format!("--press {text}: `{time}` is not a time in seconds; write LABEL@TIME")),
        },
    }
}

/// The label of a control and what stands behind the mark after it.
fn split<'t>(lab: &Lab, text: &'t str, mark: char) -> Option<(&'t str, &'t str)> {
    let places = text.match_indices(mark).map(|(i, m)| (&text[..i], &text[i + m.len()..]));
    let known = places.into_iter().find(|(label, _)| lab.control(label).is_some());
    known.or_else(|| text.rsplit_once(mark))
}
