//! The origin of a number.

/// The origin of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// The lesson already claims it, so a check computes it.
    Claimed,
    /// This measure has its digits.
    From(MeasureMatch),
    /// This measure has its digits, but other digits if the start is perturbed slightly, so that no reader can reproduce them.
    Unsteady(MeasureMatch),
    /// The text uses the number as a setting, so it is not the result of a run.
    Setting(String),
    /// No candidate has its digits, but the output of a listing contains it: the line of the output.
    Listed(usize),
    /// A measure has its digits, but chance explains the match.
    Chance(MeasureMatch),
    /// No candidate has its digits.
    Unknown,
}

/// A measure that has the digits of a number.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureMatch {
    /// The indexes of the lab and the run; `None` for an evaluated formula.
    pub place: Option<(usize, usize)>,
    /// The measure or the formula.
    pub measure: String,
    /// The factor from its value to the number in the text: `1000 * `, `-`, or nothing.
    pub factor: String,
    /// The value in the unit of the text.
    pub value: f64,
    /// The probability that something as simple as this has these digits by chance.
    pub chance: f64,
    /// Whether half the timestep gives other digits.
    pub fragile: bool,
}

impl MeasureMatch {
    /// The expression for the number in the text: `1000 * (a - b)`.
    pub fn description(&self) -> String {
        let MeasureMatch { factor, measure, .. } = self;
        let mut deep = 0;
        let sum = measure.char_indices().any(|(i, c)| {
            deep += i32::from(c == '(') - i32::from(c == ')');
            deep == 0
                && measure.get(i..).is_some_and(|rest| rest.starts_with(" - ") || rest.starts_with(" + "))
        });
        if sum && !factor.is_empty() { format!("{factor}({measure})") } else { format!("{factor}{measure}") }
    }
}
