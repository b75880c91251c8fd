//! Origins that follow from other numbers of the lesson: numbers of a paragraph share a run or a measure, a sentence contrasts two
//! runs, a repeated number has one origin.

use super::formula::Binding;
use super::lab::TracedLab;
use super::origin::{MeasureMatch, Origin};
use super::rank::{NumberContext, Siblings, close, compare_values, origin};
use super::units::si;
use labspec::verify::Stated;

/// Words between two values of the same measure: "it leaves at 0.67 m/s instead of 1.00 m/s".
const CONTRASTS: [&str; 6] =
    ["instead of", "rather than", "compared with", "compared to", "as opposed to", "in place of"];

/// Whether the words between two numbers contrast them.
fn are_contrasted(a: &Stated, b: &Stated) -> bool {
    let (first, second) = if a.offset < b.offset { (a, b) } else { (b, a) };
    let between = first.paragraph.get(first.offset..second.offset).unwrap_or("");
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '−' | ' ');
    let words = between.trim_start_matches(number);
    let words =
        words.strip_prefix(first.unit.as_str()).unwrap_or(words).trim_matches(|c: char| !c.is_alphanumeric());
    CONTRASTS.contains(&words.to_lowercase().as_str())
}

/// The cheapest measure that gives two numbers in two runs.
fn measure_of_both(pair: [&Stated; 2], numbers: &[Stated], labs: &[TracedLab<'_>]) -> Option<String> {
    let matches =
        pair.map(|s| compare_values(s, &NumberContext::new(s, numbers), labs, &Siblings::default()).1);
    let [first, second] = &matches;
    let both = first.iter().flat_map(|a| second.iter().map(move |b| (a, b))).filter(|(a, b)| {
        (&a.hit.measure, &a.hit.factor) == (&b.hit.measure, &b.hit.factor) && a.hit.place != b.hit.place
    });
    let cheapest = both.min_by(|a, b| (a.0.cost + a.1.cost).total_cmp(&(b.0.cost + b.1.cost)));
    cheapest.map(|(a, _)| a.hit.measure.clone())
}

/// Determines the origins of numbers again that a sentence contrasts: both are one measure in two runs.
pub(super) fn compare_contrasts(
    numbers: &[Stated],
    origins: &mut [Origin],
    labs: &[TracedLab<'_>],
    bindings: &[Binding],
) {
    for (i, a) in numbers.iter().enumerate() {
        let contrasted = |(_, b): &(usize, &Stated)| {
            b.paragraph == a.paragraph && b.dimension.agrees(&a.dimension) && are_contrasted(a, b)
        };
        let Some((j, b)) = numbers.iter().enumerate().skip(i + 1).find(contrasted) else { continue };
        let open = |index: usize| {
            matches!(origins.get(index), Some(Origin::From(_) | Origin::Chance(_) | Origin::Unknown))
        };
        if !open(i) || !open(j) {
            continue;
        }
        let Some(measure) = measure_of_both([a, b], numbers, labs) else { continue };
        let siblings = Siblings { all: Vec::new(), contrasted: Some(&measure) };
        for (index, s) in [(i, a), (j, b)] {
            if let Some(found) = origins.get_mut(index) {
                *found = origin(s, numbers, labs, bindings, &siblings);
            }
        }
    }
}

/// Determines origins again beside the more certain ones of the same paragraph: numbers of a paragraph are about the same run, or
/// compare the same measure in two runs.
pub(super) fn compare_siblings(
    numbers: &[Stated],
    origins: &mut [Origin],
    labs: &[TracedLab<'_>],
    bindings: &[Binding],
) {
    let hits: Vec<Option<MeasureMatch>> = origins
        .iter()
        .map(|origin| match origin {
            Origin::From(hit) if hit.place.is_some() => Some(hit.clone()),
            _ => None,
        })
        .collect();
    for ((s, hit), found) in numbers.iter().zip(&hits).zip(origins) {
        let Some(hit) = hit else { continue };
        let others =
            numbers.iter().zip(&hits).filter(|(n, _)| n.paragraph == s.paragraph && n.span != s.span);
        let all: Vec<&MeasureMatch> = others
            .filter_map(|(_, other)| other.as_ref())
            .filter(|other| other.chance < hit.chance)
            .collect();
        if !all.is_empty() {
            let siblings = Siblings { all, contrasted: None };
            *found = origin(s, numbers, labs, bindings, &siblings);
        }
    }
}

/// Of two different numbers of a paragraph with the same origin, the one with fewer digits is another quantity: "1.78 rad/s, close
/// to the 1.8 rad/s of the formula".
pub(super) fn doubt_coarse(numbers: &[Stated], origins: &mut [Origin]) {
    let hits: Vec<(usize, MeasureMatch)> = origins
        .iter()
        .enumerate()
        .filter_map(|(i, o)| if let Origin::From(hit) = o { Some((i, hit.clone())) } else { None })
        .collect();
    for (i, hit) in &hits {
        let Some(s) = numbers.get(*i) else { continue };
        let is_finer = |(j, other): &&(usize, MeasureMatch)| {
            let Some(n) = numbers.get(*j) else { return false };
            (other.place, &other.measure, &other.factor) == (hit.place, &hit.measure, &hit.factor)
                && n.paragraph == s.paragraph
                && n.read.half_unit < s.read.half_unit
                && n.read.value != s.read.value
                && hit.place.is_some()
        };
        if let (true, Some(origin)) = (hits.iter().any(|other| is_finer(&other)), origins.get_mut(*i)) {
            *origin = Origin::Chance(hit.clone());
        }
    }
}

/// A repeated number whose more certain origin has exactly its value has this origin: "the pull is 40 N", where another measure gives
/// 39.9 N.
pub(super) fn share_exact(numbers: &[Stated], origins: &mut [Origin]) {
    let exact = |s: &Stated, hit: &MeasureMatch| close(hit.value, s.read.value);
    let hits: Vec<(&Stated, MeasureMatch)> = numbers
        .iter()
        .zip(origins.iter())
        .filter_map(|(s, o)| if let Origin::From(hit) = o { Some((s, hit.clone())) } else { None })
        .collect();
    for (s, origin) in numbers.iter().zip(origins) {
        let Origin::From(hit) = &*origin else { continue };
        if exact(s, hit) {
            continue;
        }
        let same = |(other, found): &&(&Stated, MeasureMatch)| {
            other.quote == s.quote && exact(other, found) && found.chance < hit.chance
        };
        if let Some((_, found)) = hits.iter().find(same) {
            *origin = Origin::From(found.clone());
        }
    }
}

/// The number of digits from which a repeated number is recognized.
const KNOWN: f64 = 3.0;

/// A repeated number has the same origin, and a time at which something was measured is a setting.
pub(super) fn share(numbers: &[Stated], origins: &mut [Origin]) {
    let open = |o: &Origin| matches!(o, Origin::Unknown | Origin::Chance(_) | Origin::Listed(_));
    let traced: Vec<(usize, Origin)> =
        origins.iter().cloned().enumerate().filter(|(_, o)| !open(o)).collect();
    for (s, origin) in numbers.iter().zip(origins.iter_mut()).filter(|(s, o)| open(o) && !s.bound) {
        let digits = (s.read.value / (2.0 * s.read.half_unit)).abs().log10();
        let again = traced.iter().find(|(i, o)| {
            matches!(o, Origin::From(_)) && numbers.get(*i).is_some_and(|n| n.quote == s.quote)
        });
        // A measure that explains the number there and is the best candidate here needs fewer digits.
        let same = |from: &Origin| match (from, &*origin) {
            (Origin::From(a), Origin::Chance(b)) => (a.place, &a.measure) == (b.place, &b.measure),
            _ => false,
        };
        let again = again.filter(|(_, from)| digits >= KNOWN || same(from));
        let marked = format!("at(data.time >= {} - ", si(s));
        let read_then = |o: &Origin| matches!(o, Origin::From(hit) if hit.measure.contains(&marked));
        if let Some((_, from)) = again {
            *origin = from.clone();
        } else if s.unit.ends_with('s') && traced.iter().any(|(_, o)| read_then(o)) {
            *origin = Origin::Setting("the time at which other numbers are read".into());
        }
    }
}
