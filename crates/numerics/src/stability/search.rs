//! The largest value at which something is still fine: raised by a factor until it breaks, then bisection.

/// How many times as much is tried at most, and how little where it is broken from the start.
const MOST: f64 = 1_048_576.0;
/// How closely the limit is found, as a part of itself.
const CLOSE: f64 = 0.01;

/// What a search came to, as multiples of what there is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SearchLimit {
    /// The largest that was fine; `None` where even the smallest is broken.
    pub(super) fine: Option<f64>,
    /// The smallest above it that was broken; `None` where nothing was.
    pub(super) broken: Option<f64>,
}

/// Searches from 1 up to `most`, by steps of a factor, as what breaks may hold again beyond. `fine` says whether a multiple is
/// fine; `None` when nothing more can be tried, which ends the search without a result.
pub(super) fn largest(
    most: f64,
    factor: f64,
    mut fine: impl FnMut(f64) -> Option<bool>,
) -> Option<SearchLimit> {
    let (mut good, mut bad) = (None, None);
    let mut at = 1.0;
    if fine(at)? {
        good = Some(at);
        while bad.is_none() && at < most.min(MOST) {
            at = (factor * at).min(most).min(MOST);
            if fine(at)? {
                good = Some(at);
            } else {
                bad = Some(at);
            }
        }
    } else {
        bad = Some(at);
        while good.is_none() && at > 1.0 / MOST {
            at /= factor;
            if fine(at)? {
                good = Some(at);
            } else {
                bad = Some(at);
            }
        }
    }
    while let (Some(low), Some(high)) = (good, bad)
        && high > low * (1.0 + CLOSE)
    {
        // In the middle of their logarithms: both ends may be far apart.
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
#[allow(clippy::unwrap_used)]
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
    fn what_never_breaks_and_what_always_does_is_told_apart() {
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
