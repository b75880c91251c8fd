//! A lesson with many claims about one lab, which is checked once, and the outcome of each claim.

use super::scenes::{NEVER, Scene};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked};
use labspec::ledger::State;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::verify::{Judgement, QuoteState, Verdict};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What is known about a claim by its construction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Truth {
    True,
    False,
    /// The result does not depend on the simulation, or the claim states nothing.
    Empty,
    /// The claim is true and evaluated without a run: the outcome may be *computed*, but not *verified*.
    Worked,
}

#[derive(Clone, Debug)]
pub(super) enum Body {
    Question(Value),
    /// A comment, and the block to which it applies.
    Text(Value, String),
}

#[derive(Clone, Debug)]
pub(super) struct Claim {
    pub(super) kind: &'static str,
    /// How a true claim was altered; empty if it was not.
    pub(super) variant: String,
    pub(super) truth: Truth,
    pub(super) body: Body,
}

/// The outcome of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Verified,
    Computed,
    Refuted,
    /// The claim could not be checked, or depends on the numerics.
    Open,
}

/// Measures with the same values, or the same relations between them, in every run.
const DEPENDENT_MEASURES: [(&str, &str); 10] = [
    ("seven", "final(0 * data.qpos[0] + 7)"),
    ("nothing", "final(data.qpos[0] - data.qpos[0])"),
    ("always", "holds(data.qpos[0] <= max(data.qpos[0]))"),
    ("high", "max(data.qpos[0])"),
    ("top", "max(data.qpos[0])"),
    ("low", "min(data.qpos[0])"),
    ("spread", "max(data.qpos[0]) - min(data.qpos[0])"),
    ("size", "rms(data.qpos[0])"),
    ("middle", "mean(data.qpos[0])"),
    ("late", "first(data.time > 0.03)"),
];

/// The `verify` object of the lab, with the runs and measures that all other claims use.
fn shared(scene: &Scene) -> Value {
    let named = scene.measures.iter().chain(&NEVER).map(|m| (m.name.to_string(), json!(m.expr)));
    let mut measures: Map<String, Value> = named.collect();
    measures.insert("half".into(), json!("0.5"));
    measures.insert("text".into(), json!("'0.5'"));
    measures.insert("rooted".into(), json!("max(Math.sqrt(0.2 - data.time))"));
    measures.insert("hopeless".into(), json!("holds(!(NaN < -1))"));
    measures.insert("hidden".into(), json!("holds(!(Math.sqrt(-1 - data.time) > 0))"));
    measures.insert("counted".into(), json!("count(!(Math.sqrt(0.2 - data.time) > 100))"));
    for (name, text) in DEPENDENT_MEASURES {
        measures.insert(name.into(), json!(text));
    }
    json!({"runs": scene.runs, "measure": measures, "says": [["runs", "1 < 2"]]})
}

/// The lesson, with questions before comments.
pub(super) fn text(scene: &Scene, claims: &[Claim]) -> String {
    let mut lab = scene.lab.clone();
    lab["verify"] = shared(scene);
    let mut text = format!("# A lab\n\nIt runs.\n\n```lab simlab\n{lab}\n```\n\n");
    let questions: Vec<&Value> = claims
        .iter()
        .filter_map(|c| match &c.body {
            Body::Question(q) => Some(q),
            Body::Text(..) => None,
        })
        .collect();
    if !questions.is_empty() {
        let _ = writeln!(text, "```quiz\n{}\n```\n", json!({"id": "q", "questions": questions}));
    }
    for claim in claims {
        if let Body::Text(verify, block) = &claim.body {
            let _ = writeln!(text, "<!-- labspec verify {verify} -->\n{block}\n");
        }
    }
    text
}

pub(super) fn check(scene: &Scene, claims: &[Claim]) -> Checked {
    let models = Models::new(ModelFolder::unknown());
    let lesson = load_lesson(SourceFile::new("claims.md", text(scene, claims)), models.folder());
    check::check_lesson(lesson, &models, CheckLevel::CLAIMS)
}

/// The measures of both runs, by name.
pub(super) fn measured(scene: &Scene) -> Vec<(String, f64)> {
    let checked = check(scene, &[]);
    let judgement = &checked.claims[0].judgement;
    judgement.measures.iter().map(|m| (m.name.clone(), m.value)).collect()
}

/// The outcome of each claim, and its first finding.
pub(super) fn outcomes(checked: &Checked, claims: &[Claim]) -> Vec<(Outcome, String)> {
    let is_question = |c: &Claim| matches!(c.body, Body::Question(_));
    let count = claims.iter().filter(|c| is_question(c)).count();
    // The claim of the lab comes first, then all questions, then all comments.
    assert_eq!(
        checked.claims.len(),
        1 + claims.len(),
        "{:?}",
        &checked.findings[..checked.findings.len().min(5)]
    );
    let (mut question, mut comment) = (1, 1 + count);
    let mut all = Vec::new();
    for claim in claims {
        let at = if is_question(claim) { &mut question } else { &mut comment };
        let judged = &checked.claims[*at];
        let before = checked.claims[*at - 1].span.end;
        *at += 1;
        let inside = |start: usize| start >= before.min(judged.span.start) && start <= judged.span.end;
        let found = checked.findings.iter().find(|f| inside(f.span.start));
        let found = found.map_or(String::new(), |f| format!("{}: {}", f.code, f.message));
        let reasons: Vec<&str> = judged.judgement.quotes.iter().map(|q| q.reason.as_str()).collect();
        let found = if found.is_empty() { reasons.join("; ") } else { found };
        all.push((outcome(&judged.judgement), found));
    }
    all
}

fn outcome(judgement: &Judgement) -> Outcome {
    let answer = judgement.answer.iter().map(|a| match a.verdict {
        Verdict::Verified => Outcome::Verified,
        Verdict::Computed => Outcome::Computed,
        Verdict::Refuted | Verdict::Ambiguous => Outcome::Refuted,
        Verdict::Fragile | Verdict::Failed | Verdict::Unverified => Outcome::Open,
    });
    let quotes = judgement.quotes.iter().map(|q| match q.state {
        QuoteState::Right if q.verdict() == "verified" => Outcome::Verified,
        QuoteState::Right => Outcome::Computed,
        QuoteState::Wrong => Outcome::Refuted,
        QuoteState::Unclear => Outcome::Open,
    });
    let exact = judgement.exact.iter().map(|e| match e.state {
        State::True(_) => Outcome::Verified,
        State::False => Outcome::Refuted,
        _ => Outcome::Open,
    });
    let rank = |f: &Outcome| match f {
        Outcome::Verified => 0,
        Outcome::Computed => 1,
        Outcome::Open => 2,
        Outcome::Refuted => 3,
    };
    answer.chain(quotes).chain(exact).max_by_key(rank).unwrap_or(Outcome::Open)
}
