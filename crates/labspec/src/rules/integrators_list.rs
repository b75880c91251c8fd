use super::Check;
use crate::json::{nearest, read::named};
use crate::spec::Lab;
use crate::spec::format::{INTEGRATOR_NAMES, texts};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The list `integrators` is empty, names something else, or names an integrator twice.
pub const INTEGRATORS_LIST: &Rule = &Rule {
    code: "integrators-list",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`integrators` is empty, names an unknown integrator, or names one twice",
    why: "the page has no curve for this integrator",
    bad: Example::Lesson(
        "```lab integrators\n{\"model\": \"ball\", \"integrators\": [\"Euler\", \"⟦rk4⟧\"]}\n```\n",
    ),
    good: Example::Lesson(
        "```lab integrators\n{\"model\": \"ball\", \"integrators\": [\"Euler\", \"RK4\"]}\n```\n",
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    let Some(comparison) = &lab.comparison else { return };
    let Some(listed) = &comparison.listed else { return };
    if listed.is_empty() {
        let message = "`integrators` names no integrator";
        findings.push(
            Finding::new(INTEGRATORS_LIST, comparison.span.clone(), message)
                .help("delete the key to compare all integrators"),
        );
    }
    for (i, name) in listed.iter().enumerate() {
        let is_declared = texts(&INTEGRATOR_NAMES).any(|text| text == name.as_str());
        let repeated = listed.iter().take(i).any(|earlier| earlier.value == name.value);
        if is_declared && repeated {
            let message = format!("{} is listed twice", named(name.as_str()));
            findings.push(Finding::new(INTEGRATORS_LIST, name.span(), message).help("delete one of them"));
        } else if !is_declared {
            findings.push(unknown(name.as_str(), name.span()));
        }
    }
}

fn unknown(name: &str, span: std::ops::Range<usize>) -> Finding {
    let found = Finding::new(INTEGRATORS_LIST, span.clone(), format!("{} is not an integrator", named(name)));
    let same = texts(&INTEGRATOR_NAMES).find(|text| text.eq_ignore_ascii_case(name));
    match same.or_else(|| nearest(name, texts(&INTEGRATOR_NAMES))) {
        Some(right) => found.help(format!("did you mean `{right}`?")).guess(span, right),
        None => {
            found.help(format!("use one of: {}", texts(&INTEGRATOR_NAMES).collect::<Vec<_>>().join(", ")))
        }
    }
}
