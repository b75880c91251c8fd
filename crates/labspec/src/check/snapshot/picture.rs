//! Draws two curves with characters: the stored and the current one.

use crate::verify::significant;

/// Number of lines of the picture.
const LINES: usize = 9;
/// Number of characters for each time.
const TIME_WIDTH: usize = 5;

/// `o` is stored, `x` is now, `*` is both. Empty if there are no numbers, or if all are equal.
pub(super) fn picture(times: &[f64], stored: &[f64], current: &[f64]) -> Vec<String> {
    let numbers = || stored.iter().chain(current).copied().filter(|x| x.is_finite());
    let (low, high) = numbers().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) || times.len() < 2 {
        return Vec::new();
    }
    let line_of = |x: f64| ((high - x) / span * (LINES - 1) as f64).round() as usize;
    let mut grid = vec![vec![' '; (times.len() - 1) * TIME_WIDTH + 1]; LINES];
    for (curve, letter) in [(stored, 'o'), (current, 'x')] {
        for (k, x) in curve.iter().enumerate().filter(|(_, x)| x.is_finite()) {
            if let Some(place) = grid.get_mut(line_of(*x)).and_then(|line| line.get_mut(k * TIME_WIDTH)) {
                *place = if *place == ' ' { letter } else { '*' };
            }
        }
    }
    let labels = [(0, significant(high)), (LINES - 1, significant(low))];
    let width = labels.iter().map(|(_, label)| label.len()).max().unwrap_or(0);
    let mut picture = Vec::new();
    for (i, line) in grid.iter().enumerate() {
        let label = labels.iter().find(|(index, _)| *index == i).map_or("", |(_, label)| label);
        let line: String = line.iter().collect();
        picture.push(format!("{label:>width$} | {line}").trim_end().to_string());
    }
    let [first, last] = [times.first(), times.last()].map(|t| significant(t.copied().unwrap_or(0.0)));
    let space = ((times.len() - 1) * TIME_WIDTH + 1).saturating_sub(first.len());
    picture.push(format!("{:width$}   {first}{last:>space$} s    o stored, x now, * both", ""));
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_curves_share_one_picture() {
        let times = [0.0, 0.1, 0.2, 0.3, 0.4];
        let drawn = picture(&times, &[1.0, 0.95, 0.8, 0.55, f64::NAN], &[1.0, 0.95, 0.75, 0.6, 0.2]);
        insta::assert_snapshot!(drawn.join("\n"));
        assert!(picture(&times, &[1.0; 5], &[1.0; 5]).is_empty());
        assert!(picture(&times, &[f64::NAN; 5], &[f64::INFINITY; 5]).is_empty());
    }
}
