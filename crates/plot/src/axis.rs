//! Axes: their range, round ticks and tick labels, linear and logarithmic.
//!
//! Ticks of a linear axis are integers times a power of ten, so that labels are written by moving a decimal point: exact, and
//! as short as the step allows. Steps are 1, 2 or 5 times a power of ten. What all labels share (a power of ten, or a value
//! around which a curve varies by little) is removed from the labels and written once next to the axis.

use super::canvas::Label;
use super::number::{decade, drawable, log10, minus, pow10};

/// One axis.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    scale: Scale,
    /// The ends, as values or as decimal logarithms.
    low: f64,
    high: f64,
    /// The labelled positions.
    pub(super) ticks: Vec<Tick>,
    /// Further positions with grid lines, as fractions of the axis.
    pub(super) minor: Vec<f64>,
    /// The part that all labels share.
    pub(super) note: Option<Label>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    Linear,
    Log,
}

/// A labelled position on an axis.
#[derive(Clone, Debug)]
pub(super) struct Tick {
    /// 0 at the low end, 1 at the high end.
    pub(super) fraction: f64,
    /// The label.
    pub(super) label: Label,
}

/// The ends of a linear axis before rounding, and whether each end may move outwards to a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisRange {
    /// The low end.
    pub(super) low: f64,
    /// The high end.
    pub(super) high: f64,
    /// Whether the low end may move.
    pub(super) free_low: bool,
    /// Whether the high end may move.
    pub(super) free_high: bool,
}

impl Axis {
    /// The position of a value: 0 at the low end, 1 at the high end, outside this range for values outside. `None` if the axis
    /// has no position for it: the value is not finite, or not positive on a logarithmic scale.
    pub(super) fn fraction(&self, value: f64) -> Option<f64> {
        let coordinate = match self.scale {
            Scale::Linear => value,
            Scale::Log => log10(value),
        };
        let fraction = (coordinate - self.low) / (self.high - self.low);
        (drawable(coordinate) && fraction.is_finite()).then_some(fraction)
    }

    /// The smallest distance between two neighbouring ticks, as a fraction of the axis.
    pub(super) fn spacing(&self) -> f64 {
        self.ticks.windows(2).fold(1.0, |least, pair| match pair {
            [a, b] => (b.fraction - a.fraction).min(least),
            _ => least,
        })
    }

    /// The width of the widest label of a tick, in pixels.
    pub(super) fn widest(&self, size: f64) -> f64 {
        self.ticks.iter().map(|t| t.label.width(size)).fold(0.0, f64::max)
    }
}

/// The range of an axis for data with these extremes (if there are any), between the requested ends.
pub(super) fn range(data: Option<(f64, f64)>, low: Option<f64>, high: Option<f64>) -> AxisRange {
    let (low, high) = (low.filter(|v| drawable(*v)), high.filter(|v| drawable(*v)));
    let (low, high) = match (low, high) {
        (Some(a), Some(b)) if a > b => (Some(b), Some(a)),
        both => both,
    };
    let (data_low, data_high) = data.unwrap_or(match (low, high) {
        (Some(a), None) => (a, a + a.abs().max(1.0)),
        (None, Some(b)) => (b - b.abs().max(1.0), b),
        _ => (0.0, 1.0),
    });
    let (free_low, free_high) = (low.is_none(), high.is_none());
    let (mut a, mut b) = (low.unwrap_or(data_low), high.unwrap_or(data_high));
    if b < a {
        // All data are outside the one end that was requested.
        if free_high { b = a } else { a = b }
    }
    let magnitude = a.abs().max(b.abs());
    if magnitude < 1e-290 {
        (a, b) = if free_low { (-1.0, 1.0) } else { (0.0, 1.0) };
    } else if a == b {
        let margin = 0.1 * magnitude;
        (a, b) = if free_low || !free_high { (a - margin, b + margin) } else { (a, b + 2.0 * margin) };
    } else if b - a < 1e-13 * magnitude {
        // Too close to be distinguished as doubles in a picture.
        (a, b) = (a - 1e-13 * magnitude, b + 1e-13 * magnitude);
    }
    AxisRange { low: a, high: b, free_low, free_high }
}

/// A linear axis with at most about `count` steps. A free end moves to the next tick if that extends the range by at most
/// `slack` times the range.
pub(super) fn linear(range: AxisRange, count: usize, slack: f64) -> Axis {
    let AxisRange { mut low, mut high, free_low, free_high } = range;
    let step = TickStep::over((high - low) / count.max(1) as f64);
    let allowance = slack * (high - low);
    let (below, above) = ((low / step.size() + 1e-9).floor(), (high / step.size() - 1e-9).ceil());
    if free_low && low - step.value(below) <= allowance {
        low = step.value(below);
    }
    if free_high && step.value(above) - high <= allowance {
        high = step.value(above);
    }
    let first = (low / step.size() - 1e-9).ceil() as i64;
    let last = (high / step.size() + 1e-9).floor() as i64;
    let integers: Vec<i64> =
        (first..=last.min(first.saturating_add(100))).map(|i| i * step.mantissa).collect();
    let (labels, note) = write(&integers, step.exponent);
    let ticks = integers.iter().zip(labels).map(|(integer, text)| {
        let fraction = (decimal(*integer, step.exponent) - low) / (high - low);
        Tick { fraction: fraction.clamp(0.0, 1.0), label: Label::plain(text) }
    });
    Axis { scale: Scale::Linear, low, high, ticks: ticks.collect(), minor: Vec::new(), note }
}

/// The distance between ticks: 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy)]
struct TickStep {
    mantissa: i64,
    exponent: i32,
}

impl TickStep {
    /// The smallest step that is not smaller than `least`.
    fn over(least: f64) -> TickStep {
        let (mantissa, exponent) = decade(least);
        // If the range is an integer number of steps, rounding in the last bit must not cause a larger step.
        match mantissa - 1e-9 {
            m if m <= 1.0 => TickStep { mantissa: 1, exponent },
            m if m <= 2.0 => TickStep { mantissa: 2, exponent },
            m if m <= 5.0 => TickStep { mantissa: 5, exponent },
            _ => TickStep { mantissa: 1, exponent: exponent.saturating_add(1) },
        }
    }

    fn size(self) -> f64 {
        decimal(self.mantissa, self.exponent)
    }

    fn value(self, index: f64) -> f64 {
        decimal(index as i64 * self.mantissa, self.exponent)
    }
}

/// `integer` times 10 to the power `exponent`, rounded only once if both factors are exact.
fn decimal(integer: i64, exponent: i32) -> f64 {
    let integer = integer as f64;
    if exponent < 0 { integer / pow10(-exponent) } else { integer * pow10(exponent) }
}

/// The labels of ticks at integers times 10 to the power `exponent`, and the part that they share.
fn write(integers: &[i64], exponent: i32) -> (Vec<String>, Option<Label>) {
    let offset = shared(integers);
    let left: Vec<i64> = integers.iter().map(|i| i - offset).collect();
    let most = left.iter().map(|i| i.unsigned_abs()).max().unwrap_or(0);
    let top = exponent + digits(most) - 1;
    let power = if most > 0 && (top >= 5 || top <= -4) { top } else { 0 };
    let labels = left.iter().map(|i| shift(*i, exponent - power)).collect();
    let around = if offset == 0 { String::new() } else { scientific(offset, exponent) };
    let note = match (power, offset) {
        (0, 0) => None,
        (0, _) => Some(Label::plain(if offset > 0 { format!("+ {around}") } else { around })),
        _ => {
            let (sign, size) =
                if offset < 0 { ("−", around.trim_start_matches('−')) } else { ("+", &*around) };
            let rest = if offset == 0 { String::new() } else { format!("{sign} {size}") };
            Some(Label { text: String::from("×10"), power: minus(&power.to_string()), rest })
        }
    };
    (labels, note)
}

/// The offset to subtract from integers that have many digits in common: the roundest number among them, or 0.
fn shared(integers: &[i64]) -> i64 {
    let (Some(&low), Some(&high)) = (integers.iter().min(), integers.iter().max()) else { return 0 };
    let most = digits(low.unsigned_abs().max(high.unsigned_abs()));
    if low == high || most <= 6 || most - digits((high - low).unsigned_abs()) < 2 {
        return 0;
    }
    (0..=18)
        .rev()
        .map(|p| 10i64.pow(p))
        .find_map(|unit| {
            let multiple = high.div_euclid(unit) * unit;
            (multiple >= low && multiple != 0).then_some(multiple)
        })
        .unwrap_or(0)
}

fn digits(integer: u64) -> i32 {
    integer.checked_ilog10().map_or(1, |d| d as i32 + 1)
}

/// `integer` times 10 to the power `exponent`, written out. The exponent is small, because a larger common
/// factor was removed before.
fn shift(integer: i64, exponent: i32) -> String {
    if integer == 0 {
        return String::from("0");
    }
    let sign = if integer < 0 { "−" } else { "" };
    let text = integer.unsigned_abs().to_string();
    let Ok(zeros) = usize::try_from(exponent) else {
        let decimals = exponent.unsigned_abs() as usize;
        let text = format!("{text:0>width$}", width = decimals + 1);
        let (whole, part) = text.split_at_checked(text.len() - decimals).unwrap_or((&text, ""));
        return format!("{sign}{whole}.{part}");
    };
    format!("{sign}{text}{}", "0".repeat(zeros))
}

/// A common offset of labels: without trailing zeros, and with an exponent if it is long.
fn scientific(integer: i64, exponent: i32) -> String {
    let (mut integer, mut exponent) = (integer, exponent);
    while integer != 0 && integer % 10 == 0 {
        (integer, exponent) = (integer / 10, exponent + 1);
    }
    let top = exponent + digits(integer.unsigned_abs()) - 1;
    if (-4..7).contains(&top) {
        return shift(integer, exponent);
    }
    let text = shift(integer, exponent - top);
    format!("{text}e{}", minus(&top.to_string()))
}

/// A logarithmic axis for positive values between `low` and `high`. Its ends are 1, 2 or 5 times powers of ten outside the
/// data. `extent` returns the part of the axis that a label occupies, between 0 and 1.
pub(super) fn logarithmic(low: f64, high: f64, extent: impl Fn(&Label) -> f64) -> Axis {
    // Marks on the frame would be hard to see, so there is some margin, and a larger one on an axis of many decades.
    let space = 1.05 + 0.1 * (log10(high) - log10(low));
    let (mut low, mut high) = (round(low / space, -1), round(high * space, 1));
    // A single value, or values close to each other, are in the middle of at least one decade.
    if log10(high.1) - log10(low.1) < 0.999 {
        (low, high) = (round(low.1 * 0.6, -1), round(high.1 * 1.7, 1));
    }
    let (a, b) = (log10(low.1), log10(high.1));
    let plain = low.0 >= -3 && high.0 <= 3;
    let tick = |m: u8, e: i32| {
        let fraction = (log10(f64::from(m)) + f64::from(e) - a) / (b - a);
        let inside = (-1e-9..=1.0 + 1e-9).contains(&fraction);
        inside.then(|| Tick { fraction: fraction.clamp(0.0, 1.0), label: power(m, e, plain) })
    };
    let decades = low.0..=high.0.saturating_add(1);
    let whole: Vec<(i32, Tick)> = decades.clone().filter_map(|e| Some((e, tick(1, e)?))).collect();

    // Every decade has a label, or every second, fifth, tenth, …, so that the labels fit.
    let most = whole.iter().map(|(_, t)| extent(&t.label)).fold(0.0, f64::max) * (b - a);
    let every = [1, 2, 5, 10, 20, 50, 100].into_iter().find(|n| f64::from(*n) >= most).unwrap_or(200);
    // If the decades of the axis contain no multiple, one in the middle gets the label.
    let multiple = whole.iter().any(|(e, _)| e.rem_euclid(every) == 0);
    let phase = if multiple { 0 } else { whole.get(whole.len() / 2).map_or(0, |(e, _)| e.rem_euclid(every)) };
    let (labelled, others): (Vec<_>, Vec<_>) =
        whole.into_iter().partition(|(e, _)| e.rem_euclid(every) == phase);
    let mut ticks: Vec<Tick> = labelled.into_iter().map(|(_, t)| t).collect();
    let mut minor: Vec<f64> = others.into_iter().map(|(_, t)| t.fraction).collect();
    let between = decades.flat_map(|e| [2, 5, 3, 4, 6, 7, 8, 9].map(|m| (m, e))).filter(|_| b - a <= 6.0);
    let few = ticks.len() <= 2;
    for (m, e) in between {
        let Some(tick) = tick(m, e) else { continue };
        let free = |other: &Tick| {
            (other.fraction - tick.fraction).abs() > (extent(&other.label) + extent(&tick.label)) / 2.0
        };
        if few && matches!(m, 2 | 5) && ticks.iter().all(free) {
            ticks.push(tick);
        } else {
            minor.push(tick.fraction);
        }
    }
    ticks.sort_by(|a, b| a.fraction.total_cmp(&b.fraction));
    Axis { scale: Scale::Log, low: a, high: b, ticks, minor, note: None }
}

/// The next 1, 2 or 5 times a power of ten in a direction, at or beyond a positive value: its exponent and value.
fn round(value: f64, direction: i32) -> (i32, f64) {
    let (m, e) = decade(value);
    let (m, e) = match (direction > 0, m) {
        (true, m) if m <= 1.0 => (1, e),
        (true, m) if m <= 2.0 => (2, e),
        (true, m) if m <= 5.0 => (5, e),
        (true, _) => (1, e.saturating_add(1)),
        (false, m) if m >= 5.0 => (5, e),
        (false, m) if m >= 2.0 => (2, e),
        (false, _) => (1, e),
    };
    (e, decimal(m, e))
}

/// The label of a tick of a logarithmic axis.
fn power(mantissa: u8, exponent: i32, plain: bool) -> Label {
    if plain {
        return Label::plain(shift(i64::from(mantissa), exponent));
    }
    let text = if mantissa == 1 { String::from("10") } else { format!("{mantissa}×10") };
    Label { text, power: minus(&exponent.to_string()), rest: String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(low: f64, high: f64, count: usize) -> String {
        let axis = linear(range(Some((low, high)), None, None), count, 1.0);
        let ticks: Vec<String> = axis.ticks.iter().map(|t| t.label.text.clone()).collect();
        let note = axis.note.map_or(String::new(), |n| format!(" | {}^{} {}", n.text, n.power, n.rest));
        ticks.join(" ") + note.trim_end()
    }

    fn powers(low: f64, high: f64, count: u8) -> String {
        let axis = logarithmic(low, high, |_| 1.0 / f64::from(count));
        let ticks = axis.ticks.iter().map(|t| format!("{}^{}", t.label.text, t.label.power));
        ticks.collect::<Vec<_>>().join(" ").replace("^ ", " ").trim_end_matches('^').to_owned()
    }

    #[test]
    fn linear_ticks_are_round_and_short() {
        assert_eq!(labels(0.0, 1.0, 5), "0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(labels(-0.3, 2.9, 6), "−1 0 1 2 3");
        assert_eq!(labels(0.0, 0.3, 3), "0 0.1 0.2 0.3");
        assert_eq!(labels(0.0, 0.000_83, 5), "0 0.0002 0.0004 0.0006 0.0008 0.0010");
        assert_eq!(labels(0.0, 8.3e-5, 5), "0 0.2 0.4 0.6 0.8 1.0 | ×10^−4");
        assert_eq!(labels(0.0, 250_000.0, 5), "0 0.5 1.0 1.5 2.0 2.5 | ×10^5");
        assert_eq!(labels(1200.0, 48_000.0, 5), "0 10000 20000 30000 40000 50000");
    }

    #[test]
    fn constant_and_nearly_constant_data() {
        assert_eq!(labels(5.0, 5.0, 5), "4.4 4.6 4.8 5.0 5.2 5.4 5.6");
        assert_eq!(labels(0.0, 0.0, 4), "−1.0 −0.5 0 0.5 1.0");
        assert_eq!(labels(0.981 - 3e-10, 0.981 + 1e-10, 4), "−4 −2 0 2 | ×10^−10 + 0.981");
        assert_eq!(labels(-0.981, -0.981 + 1e-10, 2), "0 1 | ×10^−10 − 0.981");
    }

    #[test]
    fn logarithmic_ticks() {
        assert_eq!(powers(3e-9, 4e-3, 8), "10^−9 10^−8 10^−7 10^−6 10^−5 10^−4 10^−3 10^−2");
        assert_eq!(powers(12.0, 700.0, 6), "10 100 1000");
        assert_eq!(powers(3.0, 3.0, 6), "1 2 5 10");
        assert_eq!(powers(1e-300, 1e300, 7), "10^−300 10^−200 10^−100 10^0 10^100 10^200 10^300");
    }

    #[test]
    fn requested_ends_are_used() {
        let both = range(Some((0.0, 9.0)), Some(2.0), Some(1.0));
        assert_eq!((both.low, both.high, both.free_low, both.free_high), (1.0, 2.0, false, false));
        let beyond = range(Some((0.0, 1.0)), Some(10.0), None);
        assert!(beyond.low == 10.0 && beyond.high > 10.0);
        let broken = range(None, Some(f64::NAN), Some(f64::INFINITY));
        assert_eq!((broken.low, broken.high), (0.0, 1.0));
    }

    proptest! {
        #[test]
        fn any_range_has_ticks(a in any::<f64>(), b in any::<f64>(), low in any::<Option<f64>>(), count in 1usize..12) {
            prop_assume!(drawable(a) && drawable(b));
            let axis = linear(range(Some((a.min(b), a.max(b))), low, None), count, 1.0);
            prop_assert!(axis.low < axis.high && axis.ticks.len() <= count + 3);
            prop_assert!(axis.ticks.windows(2).all(|t| t[0].fraction < t[1].fraction));
            prop_assert!(axis.ticks.iter().all(|t| t.label.text.chars().count() < 14));
        }

        #[test]
        fn a_free_axis_holds_its_data(a in -1e9..1e9f64, b in -1e9..1e9f64, count in 2usize..12) {
            let axis = linear(range(Some((a.min(b), a.max(b))), None, None), count, 1.0);
            for value in [a, b] {
                let fraction = axis.fraction(value).unwrap();
                prop_assert!((-1e-6..=1.0 + 1e-6).contains(&fraction), "{fraction}");
            }
            prop_assert!(axis.ticks.len() >= 2);
        }

        #[test]
        fn a_logarithmic_axis_holds_its_data(a in -290.0..290.0f64, b in -290.0..290.0f64, count in 2u8..12) {
            let (low, high) = (10f64.powf(a.min(b)), 10f64.powf(a.max(b)));
            let axis = logarithmic(low, high, |_| 1.0 / f64::from(count));
            for value in [low, high] {
                let fraction = axis.fraction(value).unwrap();
                prop_assert!((-1e-9..=1.0 + 1e-9).contains(&fraction), "{fraction}");
            }
            prop_assert!(!axis.ticks.is_empty() && axis.ticks.len() <= 12);
        }
    }
}
