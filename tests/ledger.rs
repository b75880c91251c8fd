//! The law of the ledger: whatever is damaged in a lesson, nothing is called verified or clean that was not computed, and no
//! true claim is lost.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use labspec::check;
use labspec::ledger::{Entry, Ledger, Outcome, State, Subject};
use proptest::prelude::*;
use serde_json::{Value as Json, json};

/// A part of a lesson that can be damaged, and the claims that must then no longer be true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Damage {
    /// The model of the first lab is gone.
    ModelRemoved,
    /// A trace of the first lab means nothing.
    TraceBroken,
    /// The condition of the keyed option is a constant.
    ConditionConstant,
    /// The other condition is a constant.
    OtherConstant,
    /// The key is another option.
    KeyMoved,
    /// The number in the prose is another one.
    ProseChanged,
    /// The quote is about a text that stands nowhere.
    QuoteMoved,
    /// The expression of a quote throws.
    QuoteThrows,
    /// The closed form is slightly wrong.
    FormWrong,
    /// The closed form is for no trace.
    FormLost,
    /// The run of the question breaks.
    RunBroken,
    /// The measure is never a number.
    MeasureNever,
    /// The question says nothing of how it is checked.
    VerifyRemoved,
}

const ALL: [Damage; 13] = [
    Damage::ModelRemoved,
    Damage::TraceBroken,
    Damage::ConditionConstant,
    Damage::OtherConstant,
    Damage::KeyMoved,
    Damage::ProseChanged,
    Damage::QuoteMoved,
    Damage::QuoteThrows,
    Damage::FormWrong,
    Damage::FormLost,
    Damage::RunBroken,
    Damage::MeasureNever,
    Damage::VerifyRemoved,
];

const MODEL: &str =
    "<mujoco><worldbody><body pos='0 0 HEIGHT'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>";

/// A lesson about a fall from a height, of so many steps of 4 ms, in which everything is true but for the damage.
fn lesson(height: f64, steps: u32, damage: &[Damage]) -> String {
    let has = |d: Damage| damage.contains(&d);
    let time = f64::from(steps) * 0.004;
    let formula = format!("{height} - 0.5 * 9.81 * data.time * data.time");
    let mut lab = json!({
        "title": "A fall", "xml": MODEL.replace("HEIGHT", &height.to_string()), "stopAt": time,
        "setup": "model.opt.timestep = 0.004",
        "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}],
        "verify": {"exact": {"height": formula}},
    });
    // Semi-implicit Euler: after n steps of h the fall is g h² n (n + 1) / 2.
    let fallen = 9.81 * 0.004 * 0.004 * f64::from(steps) * f64::from(steps + 1) / 2.0;
    let quote = format!("{fallen:.3} m");
    let mut verify = json!({
        "lab": "#1", "runs": {"fall": {"until": time}}, "measure": {"fallen": format!("{height} - final(data.qpos[2])")},
        "options": [format!("fallen < {}", fallen - 0.01), format!("fallen >= {}", fallen - 0.01)],
        "says": [[quote.clone(), "fallen"]],
    });
    let mut prose = quote.clone();
    let mut answer = 1;
    if has(Damage::ModelRemoved) {
        lab["xml"] = Json::Null;
        lab["model"] = json!("nowhere");
        lab.as_object_mut().unwrap().remove("xml");
    }
    if has(Damage::TraceBroken) {
        lab["plots"][0]["traces"][0]["expr"] = json!("data.qpso[2]");
    }
    if has(Damage::FormWrong) {
        lab["verify"]["exact"]["height"] = json!(formula.replace("9.81", "9.82"));
    }
    if has(Damage::FormLost) {
        lab["verify"]["exact"] = json!({"hieght": formula});
    }
    if has(Damage::ConditionConstant) {
        verify["options"][1] = json!("true");
    }
    if has(Damage::OtherConstant) {
        verify["options"][0] = json!("false");
    }
    if has(Damage::KeyMoved) {
        answer = 0;
    }
    if has(Damage::ProseChanged) {
        prose = format!("{:.3} m", fallen + 0.5);
    }
    if has(Damage::QuoteMoved) {
        verify["says"][0][0] = json!(format!("{:.4} m", fallen));
    }
    if has(Damage::QuoteThrows) {
        verify["says"][0][1] = json!("fallen.toFixed(101)");
    }
    if has(Damage::RunBroken) {
        verify["runs"]["fall"]["setup"] = json!("data.qvel[0] = 1e11");
    }
    if has(Damage::MeasureNever) {
        verify["measure"]["fallen"] = json!("first(data.qpos[2] > 99)");
    }
    let mut question = json!({
        "kind": "mcq", "q": "How far does it fall?", "options": ["Less", "That far, or further"], "answer": answer, "verify": verify,
    });
    if has(Damage::VerifyRemoved) {
        question.as_object_mut().unwrap().remove("verify");
    }
    let quiz = json!({"id": "fall", "questions": [question]});
    format!("# A fall\n\nIt falls {prose}.\n\n```lab simlab\n{lab:#}\n```\n\n```quiz\n{quiz:#}\n```\n")
}

/// The claims that a damage takes away, by subject.
fn takes(damage: Damage) -> &'static [Subject] {
    use Subject::{Answer, ClosedForm, File, Lab, Quote};
    match damage {
        Damage::ModelRemoved => &[Lab, Answer, Quote, ClosedForm, File],
        Damage::TraceBroken => &[Lab, ClosedForm, File],
        Damage::ConditionConstant | Damage::OtherConstant | Damage::KeyMoved => &[Answer, File],
        Damage::ProseChanged | Damage::QuoteMoved | Damage::QuoteThrows => &[Quote, File],
        Damage::FormWrong | Damage::FormLost => &[ClosedForm, File],
        Damage::RunBroken | Damage::MeasureNever => &[Answer, Quote, File],
        // Nothing is wrong with a question that nobody checks; it is only not verified.
        Damage::VerifyRemoved => &[Answer],
    }
}

fn ledger(text: &str) -> Ledger {
    let checked = check_text("lesson.md", text);
    check::ledger(std::slice::from_ref(&checked), &checked.findings)
}

fn of(ledger: &Ledger, subject: Subject) -> Vec<&Entry> {
    ledger.entries().iter().filter(|e| e.subject == subject).collect()
}

/// Everything that is true stands there as true, and nothing else does.
fn holds(height: f64, steps: u32, damage: &[Damage]) -> Result<(), TestCaseError> {
    let text = lesson(height, steps, damage);
    let ledger = ledger(&text);
    for subject in [Subject::File, Subject::Lab, Subject::Answer, Subject::Quote, Subject::ClosedForm] {
        let taken = damage.iter().any(|&d| takes(d).contains(&subject));
        let gone = subject == Subject::Quote && damage.contains(&Damage::VerifyRemoved);
        let entries = of(&ledger, subject);
        prop_assert_eq!(entries.len(), usize::from(!gone), "{:?} {:?}", subject, entries);
        for entry in entries {
            let is_true = matches!(entry.state, State::True(_));
            prop_assert_eq!(is_true, !taken, "{:?}: {:?}\n{}", damage, entry, text);
        }
    }
    let harmless = damage.iter().all(|&d| d == Damage::VerifyRemoved);
    let expected = if harmless { Outcome::Clean } else { Outcome::Findings };
    prop_assert_eq!(ledger.outcome(), expected, "{:?}\n{}", damage, text);
    Ok(())
}

#[test]
fn every_single_damage_takes_exactly_its_claims() {
    holds(2.0, 125, &[]).unwrap();
    for damage in ALL {
        holds(2.0, 125, &[damage]).unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// Random lessons with random damage.
    #[test]
    fn nothing_damaged_is_verified_and_nothing_true_is_lost(
        height in (150u32..400).prop_map(|h| f64::from(h) / 100.0),
        steps in 60u32..130,
        damage in prop::collection::btree_set(prop::sample::select(ALL.to_vec()), 0..4),
    ) {
        let mut damage: Vec<Damage> = damage.into_iter().collect();
        // Without its `verify` there is nothing in the question that could be damaged.
        if damage.contains(&Damage::VerifyRemoved) {
            damage.retain(|d| !takes(*d).contains(&Subject::Quote) || *d == Damage::ModelRemoved);
            damage.retain(|d| !takes(*d).contains(&Subject::Answer) || matches!(d, Damage::ModelRemoved | Damage::VerifyRemoved));
        }
        // A text of other digits says what the prose says, or not: one of the two is enough.
        if damage.contains(&Damage::QuoteMoved) {
            damage.retain(|d| *d != Damage::ProseChanged);
        }
        holds(height, steps, &damage)?;
    }
}
