//! Which known word a misspelt one was meant to be.

/// The candidate that a misspelt word most likely means, if one is near enough.
///
/// Distance is the number of letters to change, insert, delete or swap with a neighbour (optimal string
/// alignment), ignoring case; a third of the letters may differ. A word that begins another one of at least
/// three letters counts as near too (`expression` for `expr`).
pub fn nearest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let lower = |s: &str| s.chars().flat_map(char::to_lowercase).take(65).collect::<Vec<char>>();
    let wanted = lower(word);
    if wanted.is_empty() || wanted.len() > 64 {
        return None;
    }
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let other = lower(candidate);
        let allowed = (wanted.len().max(other.len()) / 3).max(1);
        let distance = if wanted == other {
            0
        } else if other.len().min(wanted.len()) < 2 {
            continue;
        } else if wanted.len().min(other.len()) >= 3
            && (wanted.starts_with(&other) || other.starts_with(&wanted))
        {
            1
        } else {
            distance(&wanted, &other)
        };
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Optimal string alignment distance, row by row.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let same = usize::from(a[i] != b[j]);
            let mut least = (last[j] + same).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let keys = ["label", "expr", "digits", "stopAt", "setup"];
        assert_eq!(nearest("lable", keys), Some("label"));
        assert_eq!(nearest("stopat", keys), Some("stopAt"));
        assert_eq!(nearest("expression", keys), Some("expr"));
        assert_eq!(nearest("colour", keys), None);
        assert_eq!(nearest("", keys), None);
        assert_eq!(nearest(&"x".repeat(1000), keys), None);
    }
}
