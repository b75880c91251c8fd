//! The law of the ledger: for any damage of a lesson, nothing is called verified or clean that was not computed,
//! and no true claim is lost.

#![allow(clippy::unwrap_used)]

use crate::program::{CLEAN, Done, FALL, folder, run_in, run_with_input};
use crate::support::check_text;
use labspec::Checker;
use labspec::check;
use labspec::ledger::{Entry, Ledger, Outcome, State, Subject};
use labspec::lint::ModelFolder;
use proptest::prelude::*;
use serde_json::{Value as Json, json};

/// A kind of damage to a lesson. The claims that depend on the damaged part must no longer be true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Damage {
    /// The model of the first lab does not exist.
    ModelRemoved,
    /// A trace of the first lab is invalid.
    TraceBroken,
    /// The condition of the keyed option is a constant.
    ConditionConstant,
    /// The other condition is a constant.
    OtherConstant,
    /// The key is moved to another option.
    KeyMoved,
    /// The number in the prose is changed.
    ProseChanged,
    /// The quoted text does not occur in the lesson.
    QuoteMoved,
    /// The expression of a quote fails at run time.
    QuoteThrows,
    /// The closed form is slightly wrong.
    FormWrong,
    /// The closed form belongs to no trace.
    FormLost,
    /// The run of the question fails.
    RunBroken,
    /// The measure is always NaN.
    MeasureNever,
    /// The question has no `verify` object.
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

/// A lesson about a fall from a height, with this number of steps of 4 ms, in which everything except the damage is true.
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

/// The subjects of the claims that a damage affects.
fn takes(damage: Damage) -> &'static [Subject] {
    use Subject::{Answer, ClosedForm, File, Lab, Quote};
    match damage {
        Damage::ModelRemoved => &[Lab, Answer, Quote, ClosedForm, File],
        Damage::TraceBroken => &[Lab, ClosedForm, File],
        Damage::ConditionConstant | Damage::OtherConstant | Damage::KeyMoved => &[Answer, File],
        Damage::ProseChanged | Damage::QuoteMoved | Damage::QuoteThrows => &[Quote, File],
        Damage::FormWrong | Damage::FormLost => &[ClosedForm, File],
        Damage::RunBroken | Damage::MeasureNever => &[Answer, Quote, File],
        // A question without a check is not wrong, only unverified.
        Damage::VerifyRemoved => &[Answer],
    }
}

fn ledger(text: &str) -> Ledger {
    let checked = check_text("lesson.md", text);
    check::ledger(std::slice::from_ref(&checked), &checked.findings)
}

fn entries_of(ledger: &Ledger, subject: Subject) -> Vec<&Entry> {
    ledger.entries().iter().filter(|e| e.subject == subject).collect()
}

/// Everything that is true has the state true, and nothing else has.
fn holds(height: f64, steps: u32, damage: &[Damage]) -> Result<(), TestCaseError> {
    let text = lesson(height, steps, damage);
    let ledger = ledger(&text);
    for subject in [Subject::File, Subject::Lab, Subject::Answer, Subject::Quote, Subject::ClosedForm] {
        let affected = damage.iter().any(|&d| takes(d).contains(&subject));
        let gone = subject == Subject::Quote && damage.contains(&Damage::VerifyRemoved);
        let entries = entries_of(&ledger, subject);
        prop_assert_eq!(entries.len(), usize::from(!gone), "{:?} {:?}", subject, entries);
        for entry in entries {
            let is_true = matches!(entry.state, State::True(_));
            prop_assert_eq!(is_true, !affected, "{:?}: {:?}\n{}", damage, entry, text);
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
        // Without its `verify` object, the question has nothing else that could be damaged.
        if damage.contains(&Damage::VerifyRemoved) {
            damage.retain(|d| !takes(*d).contains(&Subject::Quote) || *d == Damage::ModelRemoved);
            damage.retain(|d| !takes(*d).contains(&Subject::Answer) || matches!(d, Damage::ModelRemoved | Damage::VerifyRemoved));
        }
        // With a moved quote, the changed prose makes no difference, so only one of the two is applied.
        if damage.contains(&Damage::QuoteMoved) {
            damage.retain(|d| *d != Damage::ProseChanged);
        }
        holds(height, steps, &damage)?;
    }
}

/// A lab that other lessons use, and a lesson with a right and a wrong claim about it.
pub(crate) const LABS: &str = r#"# Labs

```lab simlab
{"title": "A fall", "model": "free_fall", "setup": "data.qpos[2] = 1", "stopAt": 0.4,
 "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}
```
"#;
pub(crate) const READER: &str = r##"# Reader

See [the labs](labs.md#labs) and [what is not there](labs.md#elsewhere).

<!-- labspec verify {"lab": "labs.md#1", "runs": {"fall": {"until": 0.3}}, "measure": {"low": "final(data.qpos[2])"}, "says": [["0.56 m", "low"], ["0.77 m", "low"]]} -->
The ball is at 0.56 m after 0.3 s, and now at 0.77 m.

```lab simlab
{"title": "Twice", "model": "free_fall", "stopAt": 0.1, "readouts": [{"label": "a", "expr": "data.qpos[2]"}, {"label": "a", "expr": "data.qvel[2]"}]}
```
"##;

pub(crate) fn with_neighbours() -> tempfile::TempDir {
    let folder = folder();
    for (name, text) in [("labs.md", LABS), ("reader.md", READER)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The rule and the line of every finding about a lesson.
pub(crate) fn found(report: &Json) -> Vec<(String, u64)> {
    let one = |f: &Json| (f["code"].as_str().unwrap().to_string(), f["line"].as_u64().unwrap());
    let mut all: Vec<(String, u64)> = report["findings"].as_array().unwrap().iter().map(one).collect();
    all.sort();
    all
}

fn parsed(done: &Done) -> Json {
    serde_json::from_str(&done.stdout).unwrap()
}

fn last_line(done: &Done) -> &str {
    done.stdout.trim_end().lines().last().unwrap_or_default()
}

/// There is only one loader: a lesson that uses another one gives the same result in a folder, alone, from a
/// pipe, repaired and in memory.
#[test]
fn a_lesson_with_neighbours_is_the_same_everywhere() {
    let folder = with_neighbours();
    let named = parsed(&run_in(folder.path(), &["check", "reader.md", "--format", "json"]));
    let all = found(&named);
    let codes: Vec<&str> = all.iter().map(|(code, _)| code.as_str()).collect();
    assert_eq!(codes, ["dead-link", "duplicate-readout", "quote-wrong"], "{named:#}");
    let piped = run_with_input(
        folder.path(),
        &["check", "-", "--stdin-name", "reader.md", "--format", "json"],
        READER,
    );
    assert_eq!(found(&parsed(&piped)), all);
    // Also in a subfolder.
    std::fs::create_dir(folder.path().join("week")).unwrap();
    std::fs::write(folder.path().join("week/labs.md"), LABS).unwrap();
    let arguments = ["check", "-", "--stdin-name", "week/reader.md", "--format", "json"];
    assert_eq!(found(&parsed(&run_with_input(folder.path(), &arguments, READER))), all);
    let models = ModelFolder::open(&folder.path().join("models")).unwrap();
    let report = Checker::new(models.clone()).neighbours([("labs.md", LABS)]).check("reader.md", READER);
    let mut in_memory: Vec<(String, u64)> = Vec::new();
    for f in &report.findings {
        in_memory.push((f.code.to_string(), f.position.unwrap().line as u64));
    }
    in_memory.sort();
    assert_eq!(in_memory, all);
    let below =
        Checker::new(models.clone()).neighbours([("week/labs.md", LABS)]).check("week/./reader.md", READER);
    assert_eq!(below.findings.len(), all.len());
    // Without the other lesson, the findings state only what was checked.
    let alone = Checker::new(models.clone()).check("reader.md", READER);
    let unknown = alone.findings.iter().find(|f| f.code == "unknown-lab").unwrap();
    assert!(unknown.message.contains("only this lesson was given"), "{}", unknown.message);
    let missing = Checker::new(models.clone()).neighbours([("others.md", LABS)]).check("reader.md", READER);
    assert!(missing.findings.iter().any(|f| f.message.contains("that lesson was not given")));
    // A page plays a lab of it; claims about labs of other lessons do not matter there.
    let player = labspec::Player::of_lesson("reader.md", READER, "#1", models.clone()).unwrap();
    let codes: Vec<&str> = player.findings().iter().map(|f| f.code).collect();
    assert_eq!(codes, ["duplicate-readout"]);
    // Commands that read one lab, format code, and apply fixes.
    assert_eq!(run_in(folder.path(), &["run", "reader.md#1", "--steps", "2"]).code, 0);
    assert_eq!(run_in(folder.path(), &["fmt", "reader.md"]).code, 0);
    assert_eq!(run_in(folder.path(), &["check", "reader.md", "--fix", "--diff"]).code, 0);
}

/// A fix in a lesson that uses others is verified together with them.
#[test]
fn a_repair_keeps_the_neighbours_in_sight() {
    let folder = with_neighbours();
    let text = READER
        .replace("\"title\": \"Twice\"", "\"titel\": \"Twice\"")
        .replace("[\"0.77 m\", \"low\"]", "[\"0.56 m\", \"low\"]");
    std::fs::write(folder.path().join("reader.md"), &text).unwrap();
    let done = run_in(folder.path(), &["check", "reader.md", "--fix", "--unsafe-fixes"]);
    assert!(done.stderr.contains("fixed 1 finding in 1 file"), "{}{}", done.stdout, done.stderr);
    let after = std::fs::read_to_string(folder.path().join("reader.md")).unwrap();
    assert_eq!(after, text.replace("titel", "title"));
    assert!(!done.stdout.contains("unknown-lab"), "{}", done.stdout);
}

/// There is no limit on the number of other labs that are searched.
#[test]
fn the_thirty_third_lab_of_another_lesson_is_found() {
    let folder = with_neighbours();
    let claim = |i: usize| {
        format!(
            "<!-- labspec verify {{\"lab\": \"labs.md#1\", \"runs\": {{\"fall\": {{\"until\": 0.3}}}}, \"measure\": {{\"low\": \"final(data.qpos[2])\"}}, \"says\": [[\"0.56 m\", \"low\"]]}} -->\nPart {i}: the ball is at 0.56 m.\n\n"
        )
    };
    let text: String = std::iter::once("# Many\n\n".to_string()).chain((0..40).map(claim)).collect();
    std::fs::write(folder.path().join("many.md"), text).unwrap();
    let done = run_in(folder.path(), &["check", "many.md"]);
    assert_eq!(done.code, 0, "{}", done.stdout);
    assert!(last_line(&done).contains("40 quoted numbers verified"), "{}", done.stdout);
}

/// The baseline identifies claims: a moved key makes another claim, and a new refutation is reported.
#[test]
fn a_baseline_hides_no_claim_that_changed() {
    let folder = folder();
    let write = |text: &str| std::fs::write(folder.path().join("a.md"), text).unwrap();
    let check = |more: &[&str]| {
        run_in(folder.path(), &[&["check", "a.md", "--baseline", "known.json"], more].concat())
    };
    write(&CLEAN.replace("\"answer\": 2", "\"answer\": 0"));
    assert_eq!(check(&["--update-baseline"]).code, 0);
    let baselined = check(&[]);
    assert_eq!(baselined.code, 0, "{}", baselined.stdout);
    assert!(
        last_line(&baselined).contains("2 already in the baseline: no problems outside the baseline"),
        "{}",
        baselined.stdout
    );
    // Another key, which is refuted as well.
    write(&CLEAN.replace("\"answer\": 2", "\"answer\": 1"));
    let moved = check(&[]);
    assert_eq!(moved.code, 1, "{}", moved.stdout);
    assert!(moved.stdout.contains("error[answer-refuted]"), "{}", moved.stdout);
    assert!(last_line(&moved).contains("1 claim is false"), "{}", moved.stdout);
    // The same key, with another text of the option.
    write(&CLEAN.replace("\"answer\": 2", "\"answer\": 0").replace("the heavy one", "the iron one"));
    assert_eq!(check(&[]).code, 1);
    // The same key, with another condition.
    write(&CLEAN.replace("\"answer\": 2", "\"answer\": 0").replace("heavy < light", "heavy < light - 1"));
    assert_eq!(check(&[]).code, 1);
    // In the original state, the finding is in the baseline; after the correction, there is none.
    write(&format!("A line before it.\n\n{}", CLEAN.replace("\"answer\": 2", "\"answer\": 0")));
    assert_eq!(check(&[]).code, 0);
    write(CLEAN);
    let clean = check(&[]);
    assert!(clean.code == 0 && last_line(&clean).contains("no problems found"), "{}", clean.stdout);
}

/// The last line states the number of false claims and findings, and what the lessons suppress.
#[test]
fn the_last_line_states_the_outcome() {
    let folder = folder();
    let done = run_in(folder.path(), &["check", "wrong.md"]);
    let (claims, findings) = last_line(&done).rsplit_once(": ").unwrap().1.split_once(" false, ").unwrap();
    let report = parsed(&run_in(folder.path(), &["check", "wrong.md", "--format", "json"]));
    let count = |state: &str| {
        let all = report["ledger"].as_array().unwrap().iter();
        all.filter(|e| e["state"] == state && e["subject"] != "file").count()
    };
    let wrong = count("false");
    let verb = if wrong == 1 { "1 claim is".to_string() } else { format!("{wrong} claims are") };
    assert_eq!(claims, verb);
    let summary = &report["summary"];
    let errors = summary["errors"].as_u64().unwrap();
    assert!(wrong > 0 && errors > 0, "{summary}");
    assert!(findings.contains(&format!("{errors} error")), "{findings}");
    // Only a wrong answer.
    std::fs::write(folder.path().join("b.md"), CLEAN.replace("\"answer\": 2", "\"answer\": 0")).unwrap();
    let one = run_in(folder.path(), &["check", "b.md"]);
    assert!(
        last_line(&one).contains("1 answer wrong, 1 quoted number verified: 1 claim is false, 1 error"),
        "{}",
        one.stdout
    );
    // Findings that the lesson suppresses are counted, and change nothing.
    let twice = FALL.replace("\"stopAt\"", "\"readouts\": [{\"label\": \"a\", \"expr\": \"data.qpos[2]\"}, {\"label\": \"a\", \"expr\": \"data.qvel[2]\"}],\n \"lint\": {\"allow\": [\"duplicate-readout\"], \"why\": \"both are read aloud\"},\n \"stopAt\"");
    std::fs::write(folder.path().join("allowed.json"), twice).unwrap();
    let allowed = run_in(folder.path(), &["check", "allowed.json"]);
    assert_eq!(allowed.code, 0, "{}", allowed.stdout);
    let end = "no problems found (1 finding suppressed by the lessons)";
    assert!(last_line(&allowed).ends_with(end), "{}", allowed.stdout);
}

/// A fence with almost the right word is reported, also next to a correct lab.
#[test]
fn a_misspelt_fence_is_reported_although_the_lesson_has_a_lab() {
    let folder = folder();
    let lab = FALL.replace("\n", " ");
    for near in ["lab-simlab", "labs", "simlab", "Lab simlab", "lab simlabs", "lab_simlab"] {
        let text = format!("# Fall\n\n```lab simlab\n{lab}\n```\n\nAgain:\n\n```{near}\n{lab}\n```\n");
        std::fs::write(folder.path().join("near.md"), text).unwrap();
        let done = run_in(folder.path(), &["check", "near.md", "--format", "concise"]);
        assert!(done.stdout.lines().any(|l| l.starts_with("near.md:9:")), "{near}: {}", done.stdout);
        assert!(matches!(done.code, 1 | 3), "{near}: {}", done.code);
    }
}
