//! Imagined runs between two others. Random runs rarely hit a narrow interval, as that of `abs(t - 0.5) > 0.04`. Where two
//! imagined runs are given, every value in between is possible too: the search follows a comparison of the claim from one
//! run to the other, to the place where it flips. Relations between the measures of a run are preserved.

use super::bound::BoundVerify;
use super::compiled_claim::{ClaimInputs, CompiledClaim};
use super::evidence::{ClaimValue, find_changing_value};
use super::imagined::DrawnSet;
use labspec_expr::Comparison;

/// Number of comparisons of a claim, and of sets of imagined runs for each of them: those nearest to where it flips.
const COMPARISONS: usize = 8;
const NEAREST: usize = 6;
/// Fractions between two sets at which the search begins, denser near each of them.
const FRACTIONS: [f64; 9] = [0.0, 0.015_625, 0.0625, 0.25, 0.5, 0.75, 0.9375, 0.984_375, 1.0];
/// Maximum number of evaluations at samples of one search.
const MAX_EVALUATIONS: usize = 60_000;

/// The value of a claim over a set of imagined runs, with its inputs.
type EvaluateSet<'s> = dyn FnMut(DrawnSet) -> Option<(ClaimValue, ClaimInputs)> + 's;

impl BoundVerify<'_> {
    /// Whether runs between two sets of imagined runs give a claim an outcome other than `current`.
    pub(super) fn differs_between(
        &self,
        claim: &CompiledClaim,
        decided: &[(DrawnSet, ClaimInputs)],
        current: ClaimValue,
        says: &mut EvaluateSet<'_>,
    ) -> bool {
        let compared = |inputs: &ClaimInputs| Some(claim.evaluate(self, inputs, None)?.ok()?.comparisons);
        let sets: Vec<(DrawnSet, Vec<Comparison>)> =
            decided.iter().filter_map(|(drawn, inputs)| Some((*drawn, compared(inputs)?))).collect();
        let mut left = MAX_EVALUATIONS;
        let mut differs = |a: DrawnSet, b: DrawnSet| {
            let mut at = |fraction: f64| {
                left = left.checked_sub(a.samples)?;
                let (then, inputs) = says(DrawnSet { toward: Some((b.set, fraction)), ..a })?;
                Some((then, compared(&inputs)?))
            };
            let tried = FRACTIONS.into_iter().filter_map(|f| Some((f, at(f)?.1))).collect::<Vec<_>>();
            find_changing_value(&tried, current, &mut at)
        };
        (0..COMPARISONS).any(|k| nearest_pairs(&sets, k).into_iter().any(|(a, b)| differs(a, b)))
    }
}

/// Pairs of sets with the same number of samples: the set nearest to where a comparison flips, with each of the next ones.
fn nearest_pairs(sets: &[(DrawnSet, Vec<Comparison>)], k: usize) -> Vec<(DrawnSet, DrawnSet)> {
    let mut near: Vec<(f64, DrawnSet)> = sets
        .iter()
        .filter_map(|(drawn, list)| Some((list.get(k).map(|c| (c.left - c.right).abs())?, *drawn)))
        .filter(|(distance, _)| distance.is_finite())
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut counts: Vec<usize> = near.iter().map(|(_, drawn)| drawn.samples).collect();
    counts.sort_unstable();
    counts.dedup();
    let of_count = |count: usize| {
        let mut same = near.iter().map(|(_, drawn)| *drawn).filter(move |drawn| drawn.samples == count);
        let first = same.next();
        first
            .into_iter()
            .flat_map(move |a| same.clone().take(NEAREST).map(move |b| (a, b)).collect::<Vec<_>>())
    };
    counts.into_iter().flat_map(of_count).collect()
}

#[cfg(test)]
mod tests {
    use crate::Checker;

    /// The codes of the findings about a question with these options about a ball that falls from 1 m.
    fn codes(measure: &str, options: [&str; 2], answer: usize) -> Vec<&'static str> {
        let lab = serde_json::json!({"stopAt": 1, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"});
        let verify = serde_json::json!({"lab": lab, "measure": {"x": measure}, "options": options});
        let question = serde_json::json!({"q": "Is it so?", "options": ["no", "yes"], "answer": answer, "verify": verify});
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        report.findings.iter().map(|finding| finding.code).collect()
    }

    #[test]
    fn narrow_intervals_are_hit() {
        let (time, speed) = ("crossing(data.qpos[2])", "final(-data.qvel[2])");
        assert_eq!(codes(time, ["abs(x - 0.5) > 0.04", "abs(x - 0.5) <= 0.04"], 0), [""; 0]);
        assert_eq!(codes(speed, ["abs(x - 5) > 0.01", "abs(x - 5) <= 0.01"], 0), [""; 0]);
        assert_eq!(codes(speed, ["x < 4.999 || x > 5.001", "x >= 4.999 && x <= 5.001"], 0), [""; 0]);
        assert_eq!(codes(speed, ["x !== 5", "x === 5"], 0), [""; 0]);
    }

    #[test]
    fn relations_between_measures_of_a_run_remain() {
        for (measure, condition, other) in [
            ("max(data.qpos[2]) - min(data.qpos[2])", "x >= -0.001", "x < -0.001"),
            ("final(0 * data.qpos[2] + 7)", "abs(x - 5) > 0.01", "abs(x - 5) <= 0.01"),
            ("final(data.qpos[2] * data.qpos[2])", "abs(x + 5) > 0.01", "abs(x + 5) <= 0.01"),
        ] {
            assert!(codes(measure, [condition, other], 0).contains(&"constant-claim"), "{measure}");
        }
    }
}
