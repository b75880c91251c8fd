//! Mutation tests: mistakes of authors are planted one by one into real labs and quizzes, to measure how many are found.
//!
//! A mutant counts if it changes what a student sees (`mutants/student_view.rs`). It is found if it gives a finding with
//! the severity of a warning or higher that the original does not have. The table is in `docs/measured/mutants.md`.

#![allow(clippy::unwrap_used, clippy::panic)]

mod claims;
mod edit;
mod labs;
pub(crate) mod material;
mod quizzes;
mod reasons;
mod student_view;

use crate::needs::needs;
use crate::population::{sample, takes_all};
use crate::support::{for_each, workspace};
use claims::{Case, Needs};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::Severity;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use material::{Piece, PieceKind};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A kind of mistake: its name, its description, and a function that makes a copy for every place.
pub(crate) struct Kind {
    name: &'static str,
    words: &'static str,
    plant: fn(&Value) -> Vec<Value>,
    /// The correct version of a mutant, if it is not the original: displayed values are compared with it.
    right: Option<fn(&Value) -> Value>,
}

/// The maximum number of mutants of one kind per piece, selected by the seed.
const PLACES: usize = 2;
const SEED: u64 = 16;
/// One of this many mutants is in a sample.
const STEP: usize = 16;
/// The maximum number of survivors of each kind that the table lists.
const NAMED: usize = 50;

/// A planted mistake.
struct Mutant {
    kind: usize,
    piece: usize,
    json: Value,
}

/// The result for a mutant.
#[derive(Clone, Copy, PartialEq)]
enum Detection {
    Unseen,
    Found,
    Survived,
}

/// The information that is needed to recognize a mistake.
#[derive(Clone, Copy, PartialEq)]
enum RequiredKnowledge {
    /// Only the lab or the quiz.
    Itself,
    /// A claim, which the lesson contains.
    Claimed,
    /// A claim, which the lesson does not contain.
    Unclaimed,
}

fn kinds() -> Vec<(PieceKind, &'static Kind)> {
    let labs = labs::TEXTS.iter().chain(&labs::VIEWS).chain(&labs::CONTROLS).chain(&labs::SCENES);
    let labs = labs.map(|k| (PieceKind::Lab, k));
    let quizzes = quizzes::QUIZZES.iter().map(|k| (PieceKind::Quiz, k));
    labs.chain(quizzes).chain(labs::LABELS.iter().map(|k| (PieceKind::Lab, k))).collect()
}

/// A pseudo-random number that depends on others, for selections.
fn mixed(numbers: [u64; 3]) -> u64 {
    let mut x = SEED;
    for n in numbers {
        x = (x ^ n).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x ^= x >> 29;
    }
    x
}

/// All mutants.
fn planted(pieces: &[Piece]) -> Vec<Mutant> {
    let mut all = Vec::new();
    for (k, (what, kind)) in kinds().into_iter().enumerate() {
        for (p, piece) in pieces.iter().enumerate().filter(|(_, p)| p.what == what) {
            let mut made = (kind.plant)(&piece.json);
            for n in 0..PLACES.min(made.len()) {
                let i = mixed([k as u64, p as u64, n as u64]) as usize % made.len();
                all.push(Mutant { kind: k, piece: p, json: made.swap_remove(i) });
            }
        }
    }
    all
}

/// The number of findings of each code in a piece, with the severity of a warning or higher.
fn codes(piece: &Piece, json: &Value, models: &Models) -> BTreeMap<&'static str, usize> {
    let (name, text) = piece.file(json);
    // A quiz has answers, a lab has runs.
    counted(
        name,
        text,
        models,
        if piece.what == PieceKind::Quiz { CheckLevel::CLAIMS } else { CheckLevel::FULL },
    )
}

/// The same for the lesson of a lab with claims: the findings of the claims.
fn claim_findings(piece: &Piece, json: &Value, models: &Models) -> BTreeMap<&'static str, usize> {
    piece.lesson(json).map_or(BTreeMap::new(), |text| counted("lesson.md", text, models, CheckLevel::CLAIMS))
}

fn counted(
    name: &'static str,
    text: String,
    models: &Models,
    depth: CheckLevel,
) -> BTreeMap<&'static str, usize> {
    let lesson = load_lesson(SourceFile::new(name, text), models.folder());
    let mut count = BTreeMap::new();
    for f in check::check_lesson(lesson, models, depth).findings {
        if matches!(f.severity, Severity::Error | Severity::Warning) {
            *count.entry(f.code).or_insert(0) += 1;
        }
    }
    count
}

#[test]
fn planted_mistakes_are_found() {
    if !needs("../shared/corpus") {
        return;
    }
    let (pieces, models) = (material::pieces(), material::models());
    let originals = for_each(pieces.len(), |i| {
        let piece = &pieces[i];
        let models = &models[piece.models];
        (
            student_view::visible_text(piece, &piece.json, models),
            codes(piece, &piece.json, models),
            claim_findings(piece, &piece.json, models),
        )
    });
    let kinds = kinds();
    let mutants = planted(&pieces);
    assert!((1000..=2200).contains(&mutants.len()), "{}", mutants.len());
    let mutants = sample(mutants, STEP);
    let detections = for_each(mutants.len(), |i| {
        let Mutant { kind, piece, json } = &mutants[i];
        let (seen, before, claimed) = &originals[*piece];
        let piece = &pieces[*piece];
        let models = &models[piece.models];
        let kind = kinds[*kind].1;
        let displayed = student_view::visible_text(piece, json, models);
        let right = kind.right.map(|right| student_view::visible_text(piece, &right(json), models));
        let case = Case { piece, json, models };
        let ground = match (claims::is_measurable(kind.name, &case), claims::claimed(&case)) {
            (true, _) => RequiredKnowledge::Itself,
            (false, true) => RequiredKnowledge::Claimed,
            (false, false) => RequiredKnowledge::Unclaimed,
        };
        if displayed == *seen || right.is_some_and(|right| right == displayed) {
            return (Detection::Unseen, ground);
        }
        let more = |now: &BTreeMap<_, usize>, before: &BTreeMap<_, usize>| {
            now.iter().any(|(code, n)| before.get(code).is_none_or(|b| b < n))
        };
        let new = more(&codes(piece, json, models), before)
            || ground == RequiredKnowledge::Claimed && more(&claim_findings(piece, json, models), claimed);
        (if new { Detection::Found } else { Detection::Survived }, ground)
    });
    drop(kinds);
    if let Some(path) = std::env::var_os("LABSPEC_SURVIVORS") {
        std::fs::write(path, survivors(&pieces, &mutants, &detections)).unwrap();
    }
    let [_, seen, found] = count(&mutants, &detections, |_, ground| ground == RequiredKnowledge::Itself);
    assert!(100 * found >= 95 * seen, "without a claim: {found} of {seen}");
    let [_, seen, found] = count(&mutants, &detections, |_, ground| ground == RequiredKnowledge::Claimed);
    assert!(found == seen && seen > 0, "with a claim: {found} of {seen}");
    // The page is that of all mutants.
    if takes_all() {
        hold(&table(&pieces, &mutants, &detections));
    }
}

/// All mutants that are visible and not found: their kind, their piece, and the change.
fn survivors(pieces: &[Piece], mutants: &[Mutant], detections: &[(Detection, RequiredKnowledge)]) -> String {
    let (kinds, mut page) = (kinds(), String::new());
    for (m, (_, ground)) in mutants.iter().zip(detections).filter(|(_, f)| f.0 == Detection::Survived) {
        let piece = &pieces[m.piece];
        let needs = match ground {
            RequiredKnowledge::Itself => "known",
            RequiredKnowledge::Claimed => "claimed",
            RequiredKnowledge::Unclaimed => "unclaimed",
        };
        writeln!(page, "{needs} {} {}", kinds[m.kind].1.name, piece.name).unwrap();
        edit::differences("", &piece.json, &m.json, &mut page);
    }
    page
}

/// The numbers of visible and of found mutants, of those that a predicate selects.
fn count(
    mutants: &[Mutant],
    detections: &[(Detection, RequiredKnowledge)],
    which: impl Fn(&Mutant, RequiredKnowledge) -> bool,
) -> [usize; 3] {
    let selected = || mutants.iter().zip(detections).filter(|(m, (_, ground))| which(m, *ground));
    let seen = selected().filter(|(_, f)| f.0 != Detection::Unseen).count();
    [selected().count(), seen, selected().filter(|(_, f)| f.0 == Detection::Found).count()]
}

fn share([_, seen, found]: [usize; 3]) -> String {
    (100 * found + seen / 2).checked_div(seen).map_or("–".into(), |percent| format!("{percent} %"))
}

/// The page.
fn table(pieces: &[Piece], mutants: &[Mutant], detections: &[(Detection, RequiredKnowledge)]) -> String {
    let mut page = String::new();
    let labs = pieces.iter().filter(|p| p.what == PieceKind::Lab).count();
    let kinds = kinds();
    write!(
        page,
        "# Planted mistakes\n\n\
         This page lists how many planted mistakes `labspec check` finds. Every kind of mistake was planted into each of {labs} labs and {} quizzes \
         written by people (`tests/mutants.rs`), at {PLACES} places at most. A mistake is *seen* if it changes what a student sees: the text, or \
         what the lab shows in short runs as it stands, with every control moved and after a reset. It is *found* if `labspec check` gives a warning \
         or an error that the original does not have.\n\nSome mistakes are recognizable in the lab or the quiz itself, because no author could have \
         intended the result. Others produce a valid lab that somebody could have written on purpose (another sign, another start, no gravity); only \
         a claim of the author reveals them. `tests/mutants/claims.rs` declares this for each kind. For a kind that has both, it is computed from \
         the lesson, never from the result of the check.\n\n\
         | requirement | planted | seen | found | share |\n|---|---:|---:|---:|---:|\n",
        pieces.len() - labs
    )
    .unwrap();
    for (words, ground) in [
        ("recognizable without a claim", RequiredKnowledge::Itself),
        ("needs a claim, and the lesson has a `verify` object for it", RequiredKnowledge::Claimed),
        ("needs a claim, and the lesson has none", RequiredKnowledge::Unclaimed),
    ] {
        let [all, seen, found] = count(mutants, detections, |_, g| g == ground);
        writeln!(page, "| {words} | {all} | {seen} | {found} | {} |", share([all, seen, found])).unwrap();
    }
    let [all, seen, found] = count(mutants, detections, |_, _| true);
    writeln!(
        page,
        "| **all** {} kinds | {all} | {seen} | {found} | {} |",
        kinds.len(),
        share([all, seen, found])
    )
    .unwrap();
    page.push_str(
        "\nIn the table, *itself* are the mistakes that are recognizable without a claim, *claimed* and *unclaimed* the others, as found / seen.\n\n\
         | kind | mistake | planted | seen | found | share | itself | claimed | unclaimed |\n|---|---|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for (i, (_, kind)) in kinds.iter().enumerate() {
        let [all, seen, found] = count(mutants, detections, |m, _| m.kind == i);
        let parts = [RequiredKnowledge::Itself, RequiredKnowledge::Claimed, RequiredKnowledge::Unclaimed]
            .map(|ground| {
                let [_, seen, found] = count(mutants, detections, |m, g| m.kind == i && g == ground);
                if seen == 0 { "–".to_string() } else { format!("{found} / {seen}") }
            });
        let share = share([all, seen, found]);
        let parts = parts.join(" | ");
        writeln!(page, "| {} | {} | {all} | {seen} | {found} | {share} | {parts} |", kind.name, kind.words)
            .unwrap();
    }
    page.push_str("\n## Mistakes that need a claim\n\n");
    for (_, kind) in &kinds {
        if let Needs::Claim(why) | Needs::Some(_, why) = claims::needs(kind.name) {
            let how = if matches!(claims::needs(kind.name), Needs::Claim(_)) { "all" } else { "some" };
            writeln!(page, "* **{}** ({how}): {why}.", kind.name).unwrap();
        }
    }
    page.push_str("\n## Mistakes that are not found\n\nRecognizable without a claim, but not found:\n\n");
    undetected(&mut page, pieces, mutants, detections, RequiredKnowledge::Itself);
    page.push_str("\nRecognizable only through a claim, in lessons without one:\n\n");
    undetected(&mut page, pieces, mutants, detections, RequiredKnowledge::Unclaimed);
    page
}

/// The kinds of mistakes that are not found, with the first of the pieces.
fn undetected(
    page: &mut String,
    pieces: &[Piece],
    mutants: &[Mutant],
    detections: &[(Detection, RequiredKnowledge)],
    ground: RequiredKnowledge,
) {
    for (i, (_, kind)) in kinds().iter().enumerate() {
        let survived = mutants
            .iter()
            .zip(detections)
            .filter(|(m, f)| m.kind == i && **f == (Detection::Survived, ground));
        let mut names: Vec<&str> = survived.map(|(m, _)| pieces[m.piece].name.as_str()).collect();
        let count = names.len();
        names.dedup();
        if count > 0 {
            let named = names.iter().take(NAMED).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
            let more = if names.len() > NAMED { ", …" } else { "" };
            let why = match ground {
                RequiredKnowledge::Itself => {
                    let why = reasons::reason(kind.name)
                        .unwrap_or_else(|| panic!("why is {} not found?", kind.name));
                    format!("{why}. ")
                }
                _ => String::new(),
            };
            writeln!(page, "* **{}** ({count}): {why}{named}{more}", kind.name).unwrap();
        }
    }
}

/// Compares the page with the stored one, or replaces it.
fn hold(page: &str) {
    let path = workspace().join("docs/measured/mutants.md");
    if std::env::var_os("LABSPEC_BLESS").is_some() {
        std::fs::write(&path, page).unwrap();
        return;
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        stored == page,
        "docs/measured/mutants.md is not what was found; LABSPEC_BLESS=1 writes:\n{page}"
    );
}
