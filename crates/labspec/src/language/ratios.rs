/// Words with which a text states the ratio of two values.
#[derive(Debug, PartialEq)]
pub struct Ratios {
    /// Words for factors, with their values: `twice`.
    pub factors: &'static [(&'static str, f64)],
    /// Words for quantities, with units of each: `long`.
    pub quantities: &'static [(&'static str, &'static [&'static str])],
    /// First words of a clause that states a setting: `with twice the gravity`, `if the stiffness is doubled`.
    pub settings: &'static [&'static str],
}
