//! The dimension of a number: a product of powers of base units, and a factor by which the number is
//! larger than in these units.
//!
//! The host defines the base units. The language knows only one of them, the angle, because functions of
//! `Math` take and return angles.

/// The maximum number of base units.
pub const BASES: usize = 6;

/// The index of the angle among the base units.
pub const ANGLE: usize = 0;

/// Powers are stored in sixths, so that square roots and cube roots of units can be represented.
const SIXTHS: i16 = 6;

/// Largest power, in sixths. No physical quantity has a larger one.
const MAX_POWER: i16 = 24 * SIXTHS;

/// A product of powers of base units. A number of millimetres has the dimension of metres with the factor 1000.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension {
    /// The power of each base unit, in sixths.
    powers: [i16; BASES],
    /// The number is `factor` times larger than in base units. NaN if the factor is unknown, or may have a unit itself.
    pub factor: f64,
}

/// What is known about the dimension of a value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Measure {
    /// A literal number, which may be a quantity of any dimension.
    Anything,
    /// This dimension.
    Dimension(Dimension),
    /// No information.
    #[default]
    Unknown,
}

impl Dimension {
    /// The dimension of a number without a unit.
    pub const NUMBER: Dimension = Dimension { powers: [0; BASES], factor: 1.0 };

    /// An angle in radians.
    pub const RADIAN: Dimension = Dimension::base(ANGLE);

    /// The dimension of a base unit.
    pub const fn base(unit: usize) -> Dimension {
        let mut powers = [0; BASES];
        powers[unit] = SIXTHS;
        Dimension { powers, factor: 1.0 }
    }

    /// The same dimension, for numbers that are larger by a factor.
    pub fn times(self, factor: f64) -> Dimension {
        Dimension { factor: self.factor * factor, ..self }
    }

    /// The dimension of a product, or `None` if a power is out of range.
    pub fn product(self, other: Dimension) -> Option<Dimension> {
        let mut powers = self.powers;
        for (p, q) in powers.iter_mut().zip(other.powers) {
            *p += q;
        }
        let small = powers.iter().all(|p| p.abs() <= MAX_POWER);
        small.then_some(Dimension { powers, factor: self.factor * other.factor })
    }

    /// The dimension of a power, or `None` if a resulting power of a unit is not a multiple of 1/6 or is out of range.
    pub fn power(self, exponent: f64) -> Option<Dimension> {
        let mut powers = self.powers;
        for p in &mut powers {
            let power = f64::from(*p) * exponent;
            if power.fract() != 0.0 || power.abs() > f64::from(MAX_POWER) {
                return None;
            }
            *p = power as i16;
        }
        Some(Dimension { powers, factor: self.factor.powf(exponent) })
    }

    /// The power of a base unit, if it is an integer.
    pub fn whole_power(&self, base: usize) -> Option<i16> {
        self.powers.get(base).filter(|p| *p % SIXTHS == 0).map(|p| p / SIXTHS)
    }

    /// Whether the powers of all units except the angle are equal. The angle is ignored, because an arc is
    /// a radius times an angle.
    pub fn agrees(&self, other: &Dimension) -> bool {
        let rest = |d: &Dimension| {
            let mut powers = d.powers;
            powers[ANGLE] = 0;
            powers
        };
        rest(self) == rest(other)
    }

    /// Whether the number is in base units, up to its sign.
    pub fn is_exact(&self) -> bool {
        (self.factor.abs() - 1.0).abs() < 1e-9
    }

    /// The power of a base unit.
    pub fn power_of(&self, base: usize) -> f64 {
        self.powers.get(base).map_or(0.0, |p| f64::from(*p) / f64::from(SIXTHS))
    }

    /// The power of the angle.
    pub fn angle(&self) -> f64 {
        f64::from(self.powers[ANGLE]) / f64::from(SIXTHS)
    }

    /// Whether the dimension includes an angle.
    pub fn has_angle(&self) -> bool {
        self.powers[ANGLE] != 0
    }

    /// Whether the number has no unit.
    pub fn is_number(&self) -> bool {
        self.powers.iter().all(|p| *p == 0)
    }
}

impl Measure {
    /// A dimensionless number with an unknown factor, from which nothing can be concluded: a sine may be a
    /// factor of an implied 1 m.
    pub(crate) const UNCERTAIN_FACTOR: Measure =
        Measure::Dimension(Dimension { powers: [0; BASES], factor: f64::NAN });

    /// A number without a unit.
    pub(crate) const NUMBER: Measure = Measure::Dimension(Dimension::NUMBER);

    /// The measure of a value that has one of two measures.
    pub fn or(self, other: Measure) -> Measure {
        match (self, other) {
            (Measure::Anything, one) | (one, Measure::Anything) => one,
            (Measure::Dimension(a), Measure::Dimension(b)) if a.agrees(&b) => {
                Measure::Dimension(joined(a, b))
            }
            _ => Measure::Unknown,
        }
    }

    /// The measure of a sum, a difference or a remainder. A literal factor may have a unit, so that its product proves nothing.
    pub(crate) fn sum(self, other: Measure) -> Measure {
        match (self, other) {
            (Measure::Dimension(a), Measure::Dimension(b)) if !a.agrees(&b) => {
                match (a.is_exact(), b.is_exact()) {
                    (true, false) => self,
                    (false, true) => other,
                    _ => Measure::Unknown,
                }
            }
            _ => self.or(other),
        }
    }

    /// Whether a sum of both is certainly wrong.
    pub(crate) fn clashes(self, other: Measure) -> bool {
        match (self, other) {
            (Measure::Dimension(a), Measure::Dimension(b)) => a.is_exact() && b.is_exact() && !a.agrees(&b),
            _ => false,
        }
    }

    /// The measure of a product; `number` is the value of a literal factor, if there is one.
    pub(crate) fn product(self, other: Measure, number: Option<f64>) -> Measure {
        match (self, other) {
            (Measure::Anything, Measure::Anything) => Measure::Anything,
            (Measure::Anything, Measure::Dimension(d)) | (Measure::Dimension(d), Measure::Anything) => {
                let factor = number.filter(|x| *x != 0.0 && x.is_finite()).unwrap_or(f64::NAN);
                Measure::Dimension(d.times(factor))
            }
            (Measure::Dimension(a), Measure::Dimension(b)) => {
                a.product(b).map_or(Measure::Unknown, Measure::Dimension)
            }
            _ => Measure::Unknown,
        }
    }

    /// Whether both measures are identical.
    pub(crate) fn is(self, other: Measure) -> bool {
        match (self, other) {
            (Measure::Dimension(a), Measure::Dimension(b)) => {
                a.powers == b.powers && (a.factor == b.factor || a.factor.is_nan() && b.factor.is_nan())
            }
            _ => self == other,
        }
    }

    /// The measure of a power with a known exponent.
    pub(crate) fn power(self, exponent: f64) -> Measure {
        match self {
            Measure::Dimension(d) => d.power(exponent).map_or(Measure::Unknown, Measure::Dimension),
            other => other,
        }
    }
}

/// Joins two dimensions that agree: the factor is kept if both have it, and the angle if either has it.
fn joined(a: Dimension, b: Dimension) -> Dimension {
    let larger = if a.powers[ANGLE].abs() >= b.powers[ANGLE].abs() { a } else { b };
    let same = (a.factor - b.factor).abs() <= 1e-9 * a.factor.abs();
    Dimension { factor: if same { a.factor } else { f64::NAN }, ..larger }
}

#[cfg(test)]
mod tests {
    use super::*;

    const M: Dimension = Dimension::base(1);
    const S: Dimension = Dimension::base(2);

    fn certain(d: Dimension) -> Measure {
        Measure::Dimension(d)
    }

    #[test]
    fn powers_have_roots() {
        let area = M.product(M).unwrap();
        assert_eq!(area.power(0.5), Some(M));
        assert_eq!(M.power(0.5).unwrap().power(2.0), Some(M));
        assert_eq!(M.power(1.0 / 3.0).unwrap().whole_power(1), None);
        assert_eq!(M.power(0.3), None);
        assert_eq!(M.power(1e6), None);
    }

    #[test]
    fn a_number_of_the_text_may_have_a_unit() {
        let speed = certain(M.product(S.power(-1.0).unwrap()).unwrap());
        let fallen = certain(S).product(Measure::Anything, Some(9.81));
        assert!(!speed.clashes(fallen) && speed.clashes(certain(S)) && !speed.clashes(Measure::Anything));
        assert_eq!(speed.sum(fallen), speed);
        assert_eq!(speed.sum(certain(S)), Measure::Unknown);
        assert_eq!(certain(M).product(Measure::Anything, Some(1000.0)), certain(M.times(1000.0)));
        // A value in either metres or millimetres has no known factor.
        let Measure::Dimension(mixed) = certain(M).or(certain(M.times(1000.0))) else { panic!() };
        assert!(mixed.factor.is_nan());
    }

    #[test]
    fn angles_may_vanish() {
        let arc = M.product(Dimension::RADIAN).unwrap();
        assert!(arc.agrees(&M) && !arc.agrees(&Dimension::RADIAN));
        assert_eq!(certain(M).or(certain(arc)), certain(arc));
    }
}
