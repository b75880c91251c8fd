//! "Did you mean": the candidate nearest to a misspelt name. This is the only edit distance in the project.

use crate::order::sort_by;

/// Names longer than this are not compared: they are never intended, and the cost grows with the product of the lengths.
const LONGEST: usize = 64;

/// Maximum number of edits of a similar name.
const MOST_EDITS: usize = 3;

/// Returns the candidate that `written` probably means: the same word in another case, one with few edits (insertion, deletion,
/// replacement, swap of neighbours), one of the same stem (`explanation` for `explain`), one that is a prefix or an extension of the word (`expression` for `expr`), or one that
/// contains the word as a part (`mass` for `body_mass`). Among equal candidates, the first one is returned.
pub fn nearest<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    ranked(written, candidates).map(|(_, candidate)| candidate)
}

/// Returns the same candidate with its distance, to compare the best candidates of several lists.
pub fn ranked<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<(usize, &'a str)> {
    if written.is_empty() || written.len() > LONGEST {
        return None;
    }
    // One edit is allowed for short words, more for longer ones.
    let allowed = written.chars().count().div_ceil(3).min(MOST_EDITS);
    // A single letter is one edit away from every other letter, so only its other case is accepted.
    let most = if written.chars().nth(1).is_none() { 1 } else { 10 * allowed + 1 };
    let mut best: Option<(usize, &str)> = None;
    for c in candidates {
        let nearer = |cost: &usize| *cost <= most && best.is_none_or(|(least, _)| *cost < least);
        if let Some(cost) = cost(written, c).filter(nearer) {
            best = Some((cost, c));
        }
    }
    best
}

/// The distance of a candidate in tenths of an edit, or `None` if it is equal or too long.
#[inline(never)]
fn cost(written: &str, candidate: &str) -> Option<usize> {
    if candidate.len() > LONGEST || candidate == written {
        return None;
    }
    if written.eq_ignore_ascii_case(candidate) {
        return Some(1);
    }
    let parts = |s: &str| {
        s.split(['_', '/', '.']).filter(|p| !p.is_empty()).map(str::to_ascii_lowercase).collect::<Vec<_>>()
    };
    let (a, mut b) = (parts(written), parts(candidate));
    sort_by(&mut b, Ord::cmp);
    let mut sorted = a.clone();
    sort_by(&mut sorted, Ord::cmp);
    if sorted == b {
        return Some(5); // the same parts in another order
    }
    // A difference in case counts little.
    let edits = match written.chars().count().abs_diff(candidate.chars().count()) {
        0..=MOST_EDITS => {
            let same_case = 10 * distance(written, candidate);
            same_case.min(1 + 10 * distance(&written.to_ascii_lowercase(), &candidate.to_ascii_lowercase()))
        }
        // Too many insertions: only the other similarities count.
        far => 10 * far,
    };
    // `mass` for `body_mass`: the distance grows with the number of missing parts.
    let holds = !a.is_empty() && written.len() >= 3 && a.iter().all(|p| b.contains(p));
    let edits = if holds { edits.min(8 + b.len()) } else { edits };
    let (written, candidate) = (written.to_ascii_lowercase(), candidate.to_ascii_lowercase());
    let begins = written.len().min(candidate.len()) >= 3
        && (written.starts_with(&candidate) || candidate.starts_with(&written));
    let edits = if begins { edits.min(10) } else { edits };
    Some(if have_common_stem(&written, &candidate) { edits.min(25) } else { edits })
}

/// Whether two words are of one stem: `explanation` and `explain`.
fn have_common_stem(written: &str, candidate: &str) -> bool {
    let common = written.chars().zip(candidate.chars()).take_while(|(a, b)| a == b).count();
    let shorter = written.chars().count().min(candidate.chars().count());
    let are_words = [written, candidate].iter().all(|word| word.chars().all(char::is_alphabetic));
    are_words && common >= 5 && 3 * common >= 2 * shorter
}

/// Optimal string alignment distance: insertions, deletions, replacements and swaps of neighbours.
pub fn distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().collect();
    let b: Vec<char> = b.chars().collect();
    let mut before: Vec<usize> = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    let mut row = before.clone();
    for i in 0..a.len() {
        row[0] = i + 1;
        for j in 0..b.len() {
            let replace = last[j] + usize::from(a[i] != b[j]);
            row[j + 1] = replace.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                row[j + 1] = row[j + 1].min(before[j - 1] + 1);
            }
        }
        std::mem::swap(&mut before, &mut last);
        std::mem::swap(&mut last, &mut row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_intended_name() {
        let names = ["qpos", "qvel", "qacc", "body_mass", "body_inertia", "xpos", "geom_friction", "time"];
        for (written, meant) in [
            ("qpso", Some("qpos")),
            ("Qpos", Some("qpos")),
            ("qpos2", Some("qpos")),
            ("mass", Some("body_mass")),
            ("mass_body", Some("body_mass")),
            ("geom_frction", Some("geom_friction")),
            ("tiem", Some("time")),
            ("position", None),
            ("times", Some("time")),
            ("tim", Some("time")),
            ("inertia", Some("body_inertia")),
            ("q", None),
            ("banana", None),
            ("", None),
        ] {
            assert_eq!(nearest(written, names), meant, "{written}");
        }
    }

    #[test]
    fn words_of_one_stem_are_near() {
        assert_eq!(nearest("explanation", ["q", "explain", "label"]), Some("explain"));
        assert_eq!(nearest("body_mocap", ["body_mass"]), None);
    }

    #[test]
    fn long_names_cost_nothing() {
        assert_eq!(nearest(&"q".repeat(100_000), ["qpos"]), None);
    }
}
