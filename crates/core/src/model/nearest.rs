//! Which name a misspelt one was meant to be.

/// The candidate that is closest to a misspelt name, when one is close enough to be meant.
pub(crate) fn closest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    const LONGEST: usize = 40;
    const MOST: usize = 500;
    if name.is_empty() || name.len() > LONGEST {
        return None;
    }
    let limit = (name.chars().count() / 3).clamp(1, 3);
    candidates
        .into_iter()
        .take(MOST)
        .filter(|c| !c.is_empty() && c.len() <= LONGEST)
        .map(|c| (distance(&name.to_lowercase(), &c.to_lowercase()), c))
        .filter(|&(d, _)| d <= limit)
        .min_by_key(|&(d, _)| d)
        .map(|(_, c)| c)
}

/// Edit distance with swaps of neighbours counted once (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let width = b.len() + 1;
    let mut d = vec![0; (a.len() + 1) * width];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            let at = i * width + j;
            if i == 0 || j == 0 {
                d[at] = i + j;
                continue;
            }
            let change = usize::from(a[i - 1] != b[j - 1]);
            d[at] = (d[at - width] + 1).min(d[at - 1] + 1).min(d[at - width - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                d[at] = d[at].min(d[at - 2 * width - 2] + 1);
            }
        }
    }
    d[a.len() * width + b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_close_and_swaps_count_once() {
        assert_eq!(closest("frcition", ["friction", "frictionloss"]), Some("friction"));
        assert_eq!(closest("Size", ["size", "pos"]), Some("size"));
        assert_eq!(closest("banana", ["size", "pos"]), None);
        assert_eq!(distance("", "abc"), 3);
    }
}
