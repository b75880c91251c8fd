//! The suggested statements: appended to a program, or in place of it. Each suggestion is tested before it is given.

use super::SuspectProgram;
use crate::bind::coupled::Repair;

/// The call that recomputes constants.
const SET_CONST: &str = "mj.mj_setConst(model, data)";

/// How constants are recomputed after a program.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SetConstAdvice {
    /// mj_setConst alone: for a lab whose qpos is that of the model at this time, or that is reset immediately.
    Plain,
    /// mj_setConst with qpos preserved.
    Keep,
}

impl SetConstAdvice {
    fn statements(self, text: &str) -> String {
        let name =
            ["q", "kept", "qpos_kept"].into_iter().find(|n| !text.contains(n)).unwrap_or("qpos_as_it_was");
        match self {
            SetConstAdvice::Plain => SET_CONST.into(),
            SetConstAdvice::Keep => {
                format!("const {name} = data.qpos.slice(); {SET_CONST}; data.qpos.set({name})")
            }
        }
    }

    /// The text to append to `text`.
    pub(super) fn tail(self, text: &str) -> String {
        format!("{}{}", between(text), self.statements(text))
    }
}

/// The separator between a text and statements after it.
fn between(text: &str) -> &'static str {
    let last_line = text.lines().last().unwrap_or("");
    match text.trim_end() {
        "" => "",
        _ if last_line.contains("//") => "\n",
        t if t.ends_with([';', '}']) => " ",
        _ => "; ",
    }
}

/// The statements of a program, unchanged.
pub(super) fn source(s: &SuspectProgram<'_>) -> String {
    let text = &s.bound.text.value;
    if s.target { format!("{text} = value") } else { text.clone() }
}

/// The statements of a program with its coupled parameters corrected, and with constants recomputed where necessary.
pub(super) fn repaired(s: &SuspectProgram<'_>, repair: &Repair, advice: SetConstAdvice) -> String {
    let source = source(s);
    let last = source.trim_end().trim_end_matches(';').trim_end();
    // A call of mj_setConst at the end of the program stays at the end.
    let before_call = last.strip_suffix(SET_CONST).filter(|_| s.inertial.is_none() && repair.constants);
    let mut text: String = repair.before.iter().map(|s| format!("{s}; ")).collect();
    text += before_call.map_or(source.as_str(), str::trim_end);
    for statement in &repair.after {
        text = format!("{text}{}{statement}", between(&text));
    }
    match before_call {
        Some(_) => text + "; " + &advice.statements(&source),
        None if repair.constants || s.inertial.is_some() => {
            let tail = advice.tail(&text);
            text + &tail
        }
        None => text,
    }
}
