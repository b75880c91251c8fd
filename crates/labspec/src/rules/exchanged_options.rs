use super::Check;
use crate::json::Scalar;
use crate::json::read::named;
use crate::spec::{Choice, Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The texts of the options of a select state the values of each other.
pub const EXCHANGED_OPTIONS: &Rule = &Rule {
    code: "exchanged-options",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the texts of two or more options are swapped: each states the value of another one",
    why: "a student chooses one value, and the lab uses another one. The rule reports a select in which the text of every option has one number, and these numbers are the values of the options in another order",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "place", "set": "model.opt.gravity[2]", "options": [["Moon (1.62 m/s²)", ⟦-9.81⟧], ["Earth (9.81 m/s²)", -1.62]], "value": -9.81}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "place", "set": "model.opt.gravity[2]", "options": [["Moon (1.62 m/s²)", -1.62], ["Earth (9.81 m/s²)", -9.81]], "value": -9.81}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

/// The maximum number of options that are compared.
const MAX_OPTIONS: usize = 200;

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Select { options, .. } = &control.kind else { return };
    let options = options.get(..MAX_OPTIONS).unwrap_or(options);
    let Some(numbers) = options.iter().map(numbers_of).collect::<Option<Vec<[f64; 2]>>>() else { return };
    let sorted = |i: usize| {
        let mut list: Vec<f64> = numbers.iter().map(|pair| pair[i]).collect();
        list.sort_by(f64::total_cmp);
        list
    };
    let Some(wrong) = numbers.iter().position(|[stated, value]| stated != value) else { return };
    if sorted(0) != sorted(1) {
        return;
    }
    let Some([option, owner]) = numbers.get(wrong).and_then(|[_, value]| {
        let owner = numbers.iter().position(|[stated, _]| stated == value)?;
        Some([options.get(wrong)?, options.get(owner)?])
    }) else {
        return;
    };
    findings.push(
        Finding::new(
            EXCHANGED_OPTIONS,
            option.value.span(),
            format!(
                "{} has the value that {} states",
                named(option.text.as_str()),
                named(owner.text.as_str())
            ),
        )
        .related(owner.value.span(), "the value of the other option")
        .help("exchange the values, or correct the texts"),
    );
}

/// The only number in the text of an option, and the magnitude of its value.
fn numbers_of(option: &Choice) -> Option<[f64; 2]> {
    let Scalar::Number(value) = &option.value else { return None };
    Some([only_number(option.text.as_str())?, value.value.abs()])
}

/// The number of a text that has one; `m/s²` and `x2` have none.
fn only_number(text: &str) -> Option<f64> {
    let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    let mut found = None;
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let before = rest[..start].chars().next_back();
        let digits = &rest[start..];
        let end = digits.find(|c| !is_part(c)).unwrap_or(digits.len());
        if !before.is_some_and(char::is_alphanumeric) {
            let number = digits[..end].trim_end_matches(['.', ',']).replace(',', ".").parse().ok()?;
            if found.replace(number).is_some() {
                return None;
            }
        }
        rest = &digits[end..];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::only_number;

    #[test]
    fn a_text_has_one_number_or_none() {
        for (text, number) in [
            ("Moon (1.62 m/s²)", Some(1.62)),
            ("Mond (1,62 m/s²)", Some(1.62)),
            ("5 kg.", Some(5.0)),
            ("m2: 3 kg", Some(3.0)),
            ("RK4", None),
            ("Earth", None),
            ("2 to 3 kg", None),
            ("2 × 10^3 Pa", None),
            ("1.2.3", None),
        ] {
            assert_eq!(only_number(text), number, "{text}");
        }
    }
}
