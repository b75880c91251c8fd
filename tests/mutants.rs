//! Mistakes that authors make, planted one by one into real labs and quizzes: how many of them are found.
//!
//! A mutant counts when it changes what a student sees (`mutants/eyes.rs`), and it is found when a finding of the level of a
//! warning, or above, comes that the original does not have. The table is kept in `docs/measured/mutants.md`.

#![allow(clippy::unwrap_used, clippy::panic)]

mod edit;
mod eyes;
mod labs;
pub(crate) mod material;
mod quizzes;
mod reasons;

use crate::needs::needs;
use crate::support::workspace;
use labspec::bind::scene::Models;
use labspec::check::{self, Depth};
use labspec::finding::Severity;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use material::{Piece, What};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A kind of mistake: what it is called, what it is, and how it is made: a copy for every place.
pub(crate) struct Kind {
    name: &'static str,
    words: &'static str,
    plant: fn(&Value) -> Vec<Value>,
}

/// Most mutants of one kind that a piece gives, chosen by the seed.
const PLACES: usize = 2;
const SEED: u64 = 16;
/// Survivors that are named in the table, of each kind.
const NAMED: usize = 4;

/// A mistake that was planted.
struct Mutant {
    kind: usize,
    piece: usize,
    json: Value,
}

/// What became of it.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Unseen,
    Found,
    Survived,
}

fn kinds() -> Vec<(What, &'static Kind)> {
    let labs = labs::TEXTS.iter().chain(&labs::VIEWS).chain(&labs::CONTROLS).chain(&labs::SCENES);
    let labs = labs.map(|k| (What::Lab, k));
    let quizzes = quizzes::QUIZZES.iter().map(|k| (What::Quiz, k));
    labs.chain(quizzes).chain(labs::LABELS.iter().map(|k| (What::Lab, k))).collect()
}

/// A number that follows from others, for choices.
fn mixed(numbers: [u64; 3]) -> u64 {
    let mut x = SEED;
    for n in numbers {
        x = (x ^ n).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x ^= x >> 29;
    }
    x
}

/// Everything that is planted.
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

/// How often each code is found in a piece, at the level of a warning and above.
fn codes(piece: &Piece, json: &Value, models: &Models) -> BTreeMap<&'static str, usize> {
    let (name, text) = piece.file(json);
    let lesson = load_lesson(SourceFile::new(name, text), models.folder());
    // A quiz has answers, a lab has runs.
    let depth = if piece.what == What::Quiz { Depth::CLAIMS } else { Depth::FULL };
    let mut count = BTreeMap::new();
    for f in check::check(lesson, models, depth).findings {
        if matches!(f.severity, Severity::Error | Severity::Warning) {
            *count.entry(f.code).or_insert(0) += 1;
        }
    }
    count
}

/// Does something for each of so many, on all processors; the results stand in order.
fn for_each<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(2, usize::from);
    let mut all: Vec<(usize, T)> = std::thread::scope(|scope| {
        let run = || {
            let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|i| *i < count);
            std::iter::from_fn(take).map(|i| (i, work(i))).collect::<Vec<_>>()
        };
        let handles: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        handles.into_iter().flat_map(|h| h.join().unwrap()).collect()
    });
    all.sort_by_key(|(i, _)| *i);
    all.into_iter().map(|(_, t)| t).collect()
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
        (eyes::seen(piece, &piece.json, models), codes(piece, &piece.json, models))
    });
    let mutants = planted(&pieces);
    assert!(mutants.len() <= 2200, "{}", mutants.len());
    let fates = for_each(mutants.len(), |i| {
        let Mutant { piece, json, .. } = &mutants[i];
        let (seen, before) = &originals[*piece];
        let piece = &pieces[*piece];
        let models = &models[piece.models];
        if eyes::seen(piece, json, models) == *seen {
            return Fate::Unseen;
        }
        let now = codes(piece, json, models);
        let new = now.iter().any(|(code, n)| before.get(code).is_none_or(|b| b < n));
        if new { Fate::Found } else { Fate::Survived }
    });
    hold(&table(&pieces, &mutants, &fates));
}

/// The page.
fn table(pieces: &[Piece], mutants: &[Mutant], fates: &[Fate]) -> String {
    let of = |kind: Option<usize>, fate: &[Fate]| {
        let all = mutants.iter().zip(fates);
        all.filter(|(m, f)| kind.is_none_or(|k| m.kind == k) && (fate.is_empty() || fate.contains(f))).count()
    };
    let share = |found: usize, changed: usize| match changed {
        0 => "–".to_string(),
        n => format!("{} %", (100 * found + n / 2) / n),
    };
    let mut page = String::new();
    let labs = pieces.iter().filter(|p| p.what == What::Lab).count();
    let row = |kind: Option<usize>| {
        let [all, changed, found] =
            [of(kind, &[]), of(kind, &[Fate::Found, Fate::Survived]), of(kind, &[Fate::Found])];
        format!("{all} | {changed} | {found} | {}", share(found, changed))
    };
    let kinds = kinds();
    write!(
        page,
        "# Planted mistakes\n\n\
         Every kind of mistake below was planted into each of {labs} labs and {} quizzes that people wrote (`tests/mutants.rs`), at \
         {PLACES} places at most. It counts when it changes what a student sees: what is written, or what the lab shows in short runs as it \
         stands, with every control moved and after a reset. It is found when `labspec check` gives a warning or an error that the \
         original does not have.\n\n\
         | kind | what is wrong | planted | seen | found | share |\n|---|---|---:|---:|---:|---:|\n",
        pieces.len() - labs
    )
    .unwrap();
    for (i, (_, kind)) in kinds.iter().enumerate() {
        writeln!(page, "| {} | {} | {} |", kind.name, kind.words, row(Some(i))).unwrap();
    }
    writeln!(page, "| **all** | {} kinds | {} |", kinds.len(), row(None)).unwrap();
    page.push_str("\n## What is not found\n\n");
    for (i, (_, kind)) in kinds.iter().enumerate() {
        let survived = mutants.iter().zip(fates).filter(|(m, f)| m.kind == i && **f == Fate::Survived);
        let mut names: Vec<&str> = survived.map(|(m, _)| pieces[m.piece].name.as_str()).collect();
        let count = names.len();
        names.dedup();
        if count > 0 {
            let named = names.iter().take(NAMED).map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
            let more = if names.len() > NAMED { ", …" } else { "" };
            let why = reasons::reason(kind.name).unwrap_or_else(|| panic!("why is {} not found?", kind.name));
            writeln!(page, "* **{}** ({count}): {why}. {named}{more}", kind.name).unwrap();
        }
    }
    page
}

/// The page is the one that is kept, or becomes it.
fn hold(page: &str) {
    let path = workspace().join("docs/measured/mutants.md");
    if std::env::var_os("LABSPEC_BLESS").is_some() {
        std::fs::write(&path, page).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == page, "docs/measured/mutants.md is not what was found; LABSPEC_BLESS=1 writes:\n{page}");
}
