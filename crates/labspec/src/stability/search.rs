//! The largest value at which something is still fine: doubling until it breaks, then bisection.

/// Doublings, or halvings where it is broken from the start.
const DOUBLINGS: u32 = 20;
/// How closely the limit is found, as a part of itself.
const CLOSE: f64 = 0.01;

/// What a search came to, as multiples of what there is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    /// The largest that was fine; `None` where even the smallest is broken.
    pub(super) fine: Option<f64>,
    /// The smallest above it that was broken; `None` where nothing was.
    pub(super) broken: Option<f64>,
}

/// Searches from 1 up to `most`. `fine` says whether a multiple is fine; `None` when nothing more can be tried, which ends the
/// search without a result.
pub(super) fn largest(most: f64, mut fine: impl FnMut(f64) -> Option<bool>) -> Option<Limit> {
    let (mut good, mut bad) = (None, None);
    let mut at = 1.0;
    if fine(at)? {
        good = Some(at);
        for _ in 0..DOUBLINGS {
            let next = (2.0 * at).min(most);
            if next <= at {
                break;
            }
            at = next;
            if !fine(at)? {
                bad = Some(at);
                break;
            }
            good = Some(at);
        }
    } else {
        bad = Some(at);
        for _ in 0..DOUBLINGS {
            at *= 0.5;
            if fine(at)? {
                good = Some(at);
                break;
            }
            bad = Some(at);
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
    Some(Limit { fine: good, broken: bad })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_found_to_a_hundredth() {
        for limit in [1.0, 1.3, 2.0, 77.7, 3e5, 0.9, 0.013, 2e-6] {
            let mut asked = 0;
            let found = largest(f64::INFINITY, |x| {
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
        assert_eq!(largest(1e9, |_| Some(true)), Some(Limit { fine: Some(2f64.powi(20)), broken: None }));
        assert_eq!(largest(10.0, |_| Some(true)), Some(Limit { fine: Some(10.0), broken: None }));
        assert_eq!(largest(1e9, |_| Some(false)), Some(Limit { fine: None, broken: Some(0.5f64.powi(20)) }));
        assert_eq!(largest(1e9, |x| (x < 4.0).then_some(true)), None);
    }
}
