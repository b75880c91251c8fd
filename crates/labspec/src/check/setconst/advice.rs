//! What to write instead: statements behind a program, or in place of it, each tried before it is given.

use super::Suspect;
use crate::bind::coupled::Repair;

/// The call that computes constants anew.
const SET_CONST: &str = "mj.mj_setConst(model, data)";

/// How constants are computed anew behind a program.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SetConstAdvice {
    /// mj_setConst alone: for a lab whose qpos is the model's own then, or that is reset at once.
    Plain,
    /// mj_setConst with qpos kept.
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

    /// What is written behind a text.
    pub(super) fn tail(self, text: &str) -> String {
        format!("{}{}", between(text), self.statements(text))
    }
}

/// What separates a text from statements behind it.
fn between(text: &str) -> &'static str {
    let last_line = text.lines().last().unwrap_or("");
    match text.trim_end() {
        "" => "",
        _ if last_line.contains("//") => "\n",
        t if t.ends_with([';', '}']) => " ",
        _ => "; ",
    }
}

/// The statements of a program as they are.
pub(super) fn source(s: &Suspect<'_>) -> String {
    let text = &s.bound.text.value;
    if s.target { format!("{text} = value") } else { text.clone() }
}

/// The statements of a program with its partners corrected, and with constants computed anew where they have to be.
pub(super) fn repaired(s: &Suspect<'_>, repair: &Repair, advice: SetConstAdvice) -> String {
    let source = source(s);
    let last = source.trim_end().trim_end_matches(';').trim_end();
    // A call that the program ends with stays behind everything.
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
