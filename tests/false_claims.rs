//! A generator of false claims. For random labs, true claims are made by simulation and then made false or empty. None of the
//! false claims may be verified, and each true one is verified, or reported with the reason.
//!
//! `LABSPEC_FALSE_CLAIMS=100000` makes this number of claims, `LABSPEC_SEED` selects others;
//! `docs/measured/false-claims.md` lists the results.

#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod conditions;
mod lesson;
mod quotes;
mod random;
mod scenes;
mod snapshots;
mod spaces;
mod values;

use crate::population::takes_all;
use crate::support::for_each;
use crate::support::random::Random;
use conditions::MeasuredNumber;
use lesson::{Claim, Outcome, Truth};
use scenes::Scene;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The default number of lessons, the number of them that a sample has, and their seed.
const LESSONS: usize = 60;
const SAMPLE: usize = 12;
const SEED: u64 = 32;
/// The number of draws of claims of each kind in a lesson.
const DRAWS: usize = 6;
/// One of this many lessons has snapshots.
const SNAPSHOTS: usize = 10;

/// The results of the claims of one kind and variant.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    made: usize,
    verified: usize,
    computed: usize,
    refuted: usize,
    open: usize,
}

#[derive(Debug, Default)]
struct Tally {
    lessons: usize,
    counts: BTreeMap<(bool, String, String), Count>,
    /// The wrong results: a few words, and the claim.
    wrong: Vec<String>,
}

impl Tally {
    fn count(&mut self, kind: &str, truth: Truth, variant: &str, outcome: Outcome) {
        let count = self.counts.entry((truth != Truth::True, kind.into(), variant.into())).or_default();
        count.made += 1;
        match outcome {
            Outcome::Verified => count.verified += 1,
            Outcome::Computed => count.computed += 1,
            Outcome::Refuted => count.refuted += 1,
            Outcome::Open => count.open += 1,
        }
    }

    fn add(&mut self, other: Tally) {
        self.lessons += other.lessons;
        self.wrong.extend(other.wrong);
        for (key, c) in other.counts {
            let count = self.counts.entry(key).or_default();
            count.made += c.made;
            count.verified += c.verified;
            count.computed += c.computed;
            count.refuted += c.refuted;
            count.open += c.open;
        }
    }

    fn false_claims(&self) -> usize {
        self.counts.iter().filter(|((made, ..), _)| *made).map(|(_, c)| c.made).sum()
    }
}

/// The measures of a lab that are numbers that can be claimed.
fn measured(scene: &Scene) -> Vec<MeasuredNumber> {
    let measured = lesson::measured(scene);
    let mut all = Vec::new();
    for (name, x) in measured {
        let of = name.split('.').next_back().unwrap();
        let measure = scene.measures.iter().find(|m| m.name == of);
        if let Some(m) = measure.filter(|_| x.is_finite()) {
            all.push(MeasuredNumber { name, x, unit: m.unit, positive: m.positive });
        }
    }
    all
}

fn claims(random: &mut Random, scene: &Scene) -> Vec<Claim> {
    let measured = measured(scene);
    assert!(!measured.is_empty(), "nothing is measured in {}", scene.family);
    let mut all = Vec::new();
    for _ in 0..DRAWS {
        all.extend(conditions::right(random, &measured));
        all.extend(values::right(random, &measured));
        all.extend(quotes::right(random, &measured));
    }
    for _ in 0..DRAWS {
        all.extend(conditions::wrong(random, &measured));
        all.extend(conditions::empty(random, &measured));
        all.extend(values::wrong(random, &measured));
        all.extend(values::empty(random, &measured));
        all.extend(quotes::wrong(random, &measured));
        all.extend(quotes::empty(random, &measured));
        all.extend(conditions::texts(random, &measured));
    }
    match random.below(5) {
        0 => all.extend(spaces::over(scene)),
        1 => all.extend(spaces::find(random, scene)),
        2 => all.extend(spaces::fit(scene)),
        3 => all.extend(spaces::columns(random, scene)),
        _ => all.extend(spaces::exact(random, scene)),
    }
    all.extend(spaces::stop());
    // Findings are in the order of the text; true claims come first.
    all.sort_by_key(|c| c.truth != Truth::True);
    all
}

/// The lesson of a seed.
fn lesson_of(seed: u64, tally: &mut Tally) {
    let mut random = Random(seed);
    let scene = scenes::scene(&mut random);
    let claims = claims(&mut random, &scene);
    let checked = lesson::check(&scene, &claims);
    tally.lessons += 1;
    for (claim, (outcome, found)) in claims.iter().zip(lesson::outcomes(&checked, &claims)) {
        tally.count(claim.kind, claim.truth, &claim.variant, outcome);
        let wrong = match (claim.truth, outcome) {
            (Truth::True, Outcome::Verified) | (Truth::Worked, Outcome::Computed) => None,
            (Truth::True, Outcome::Refuted) => Some("a true claim is refuted"),
            (Truth::True, _) if found.is_empty() => Some("a true claim is open without a reason"),
            (Truth::True, Outcome::Computed) => Some("a true claim is only computed"),
            (Truth::True, Outcome::Open) => None,
            (_, Outcome::Verified) => Some("verified"),
            (_, Outcome::Computed) => Some("computed"),
            (_, Outcome::Refuted | Outcome::Open) => None,
        };
        if let Some(wrong) = wrong {
            tally.wrong.push(format!(
                "{wrong}: {} / {} ({:?}, {outcome:?}, {}, seed {seed}): {found}\n    {:?}",
                claim.kind, claim.variant, claim.truth, scene.family, claim.body
            ));
        }
    }
}

/// Snapshots of some labs, and changes of these labs.
fn snapshots_of(seed: u64, tally: &mut Tally) {
    let mut random = Random(seed);
    let scenes: Vec<Scene> = (0..3).map(|_| scenes::scene(&mut random)).collect();
    let stored = snapshots::stored(&scenes);
    tally.lessons += 1;
    let mut hold = |truth: Truth, variants: &[&str], text: &str| {
        for ((variant, unchanged), scene) in
            variants.iter().zip(snapshots::unchanged(&scenes, text)).zip(&scenes)
        {
            tally.count(
                "snapshot",
                truth,
                variant,
                if unchanged { Outcome::Verified } else { Outcome::Refuted },
            );
            if unchanged != (truth == Truth::True) {
                tally.wrong.push(format!(
                    "snapshot / {variant} ({}, seed {seed}): as stored: {unchanged}\n{text}",
                    scene.family
                ));
            }
        }
    };
    hold(Truth::True, &["", "", ""], &stored);
    for _ in 0..3 {
        let (text, variants) = snapshots::changed(&mut random, &stored);
        hold(Truth::False, &variants, &text);
    }
}

/// This number of lessons, from a seed on.
fn tally(seed: u64, from: usize, count: usize) -> Tally {
    let one = |i: usize| {
        let mut tally = Tally::default();
        let case_seed = seed.wrapping_mul(1_000_003).wrapping_add((from + i) as u64);
        if (from + i) % SNAPSHOTS == SNAPSHOTS - 1 {
            snapshots_of(case_seed, &mut tally);
        } else {
            lesson_of(case_seed, &mut tally);
        }
        tally
    };
    let mut all = Tally::default();
    for_each(count, one).into_iter().for_each(|t| all.add(t));
    all
}

/// The wrong results, each kind and variant once.
fn format_tally(tally: &Tally) -> String {
    let mut measured = BTreeMap::new();
    for wrong in &tally.wrong {
        let what = wrong.split(" (").next().unwrap_or("").to_string();
        measured.entry(what).or_insert_with(Vec::new).push(wrong.clone());
    }
    let mut text = String::new();
    for (what, all) in measured {
        let _ = writeln!(text, "{what}: {} times, as", all.len());
        for wrong in all.iter().take(if std::env::var_os("LABSPEC_ALL").is_some() { 60 } else { 4 }) {
            let _ = writeln!(text, "  {wrong}");
        }
    }
    text
}

fn table(tally: &Tally) -> String {
    let mut text = String::from(
        "| claim | made | verified | computed | refuted | reported |\n|---|---:|---:|---:|---:|---:|\n",
    );
    for ((changed, kind, variant), c) in &tally.counts {
        let what = if *changed { format!("{kind}: {variant}") } else { format!("{kind}, true") };
        let Count { made, verified, computed, refuted, open } = c;
        let _ = writeln!(text, "| {what} | {made} | {verified} | {computed} | {refuted} | {open} |");
    }
    text
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|s| s.parse().ok())
}

#[test]
fn false_claims_are_never_verified() {
    let seed = variable("LABSPEC_SEED");
    let requested = variable("LABSPEC_FALSE_CLAIMS");
    let begin = std::time::Instant::now();
    let mut all = Tally::default();
    let usual = if takes_all() { LESSONS } else { SAMPLE };
    let lessons = variable("LABSPEC_LESSONS").map_or(usual, |n| n as usize);
    let mut from = 0;
    loop {
        all.add(tally(seed.unwrap_or(SEED), from, lessons));
        from += lessons;
        if all.false_claims() as u64 >= requested.unwrap_or(0) {
            break;
        }
    }
    if requested.is_some() || seed.is_some() {
        println!(
            "seed {seed:?}: {} lessons, {} false or empty claims, {:?}",
            all.lessons,
            all.false_claims(),
            begin.elapsed()
        );
        println!("{}", table(&all));
    }
    assert!(all.wrong.is_empty(), "{} are wrong:\n{}", all.wrong.len(), format_tally(&all));
}
