//! Search for the largest value without a fault: raises it by a factor until a fault occurs, then bisects.

/// The largest multiple that is tried; its inverse is the smallest one if the current value already fails.
const MOST: f64 = 1_048_576.0;
/// The relative accuracy of the limit.
const RELATIVE_ACCURACY: f64 = 0.01;

/// The result of a search, as multiples of the current value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SearchLimit {
    /// The largest multiple without a fault; `None` if even the smallest one fails.
    pub(super) fine: Option<f64>,
    /// The smallest multiple above it with a fault; `None` if there is none.
    pub(super) broken: Option<f64>,
}

/// Searches from 1 up to `most` in steps of a factor, because a lab that fails may work again beyond. `fine` states whether a
/// multiple works, or returns `None` if the work limit is reached, which ends the search without a result.
pub(super) fn largest(
    most: f64,
    factor: f64,
    mut fine: impl FnMut(f64) -> Option<bool>,
) -> Option<SearchLimit> {
    let (mut good, mut bad) = (None, None);
    let mut multiple = 1.0;
    if fine(multiple)? {
        good = Some(multiple);
        while bad.is_none() && multiple < most.min(MOST) {
            multiple = (factor * multiple).min(most).min(MOST);
            if fine(multiple)? {
                good = Some(multiple);
            } else {
                bad = Some(multiple);
            }
        }
    } else {
        bad = Some(multiple);
        while good.is_none() && multiple > 1.0 / MOST {
            multiple /= factor;
            if fine(multiple)? {
                good = Some(multiple);
            } else {
                bad = Some(multiple);
            }
        }
    }
    while let (Some(low), Some(high)) = (good, bad)
        && high > low * (1.0 + RELATIVE_ACCURACY)
    {
        // The geometric mean, because both ends may differ by orders of magnitude.
        let middle = (low * high).sqrt();
        if fine(middle)? {
            good = Some(middle);
        } else {
            bad = Some(middle);
        }
    }
    Some(SearchLimit { fine: good, broken: bad })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_found_to_a_hundredth() {
        for limit in [1.0, 1.3, 2.0, 77.7, 3e5, 0.9, 0.013, 2e-6] {
            let mut asked = 0;
            let found = largest(f64::INFINITY, 2.0, |x| {
                asked += 1;
                Some(x <= limit)
            });
            let found = found.unwrap();
            let (low, high) = (found.fine.unwrap(), found.broken.unwrap());
            assert!(low <= limit && limit < high && high <= 1.01 * low && asked < 32, "{limit}: {found:?}");
        }
    }

    #[test]
    fn never_and_always_failing_parameters_are_distinguished() {
        assert_eq!(
            largest(1e9, 2.0, |_| Some(true)),
            Some(SearchLimit { fine: Some(2f64.powi(20)), broken: None })
        );
        assert_eq!(largest(10.0, 2.0, |_| Some(true)), Some(SearchLimit { fine: Some(10.0), broken: None }));
        assert_eq!(
            largest(1e9, 2.0, |_| Some(false)),
            Some(SearchLimit { fine: None, broken: Some(0.5f64.powi(20)) })
        );
        assert_eq!(largest(1e9, 2.0, |x| (x < 4.0).then_some(true)), None);
    }
}
