use super::Check;
use super::wording::numbers;
use crate::finding::Finding;
use crate::spec::Lesson;
use labspec_finding::{Example, Layer, Rule, Severity};
use std::ops::Range;

/// Numbers with units that nothing checks.
pub const NUMBERS_UNCLAIMED: &Rule = &Rule {
    code: "numbers-unclaimed",
    severity: Severity::Note,
    layer: Layer::Structure,
    summary: "the text around the labs states numbers with units that no `says` quotes",
    why: "a number of the text that is quoted is computed with every check; one that is not may be wrong after a change of the model",
    bad: Example::Lesson(
        "It touches the floor after ⟦0.442 s⟧, at 4.43 m/s, and falls 1 m.\n\n```lab simlab\n{\"model\": \"ball\", \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n",
    ),
    good: Example::Lesson(
        "It touches the floor soon.\n\n```lab simlab\n{\"model\": \"ball\", \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n",
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check);

/// Units, the longest first.
const UNITS: [&str; 30] = [
    "kg m²", "kg m^2", "m/s²", "m/s^2", "rad/s", "mm/s", "cm/s", "N m", "N/m", "m/s", "mrad", "rad", "deg",
    "kHz", "Hz", "mm", "cm", "km", "µm", "ms", "µs", "kg", "mN", "kN", "mJ", "°", "%", "m", "s", "N",
];
/// Fewer are not told.
const FEWEST: usize = 3;
/// Paragraphs that are read, and numbers in each.
const MOST: usize = 2000;
const MORE: [&str; 4] = ["kJ", "J", "W", "g"];

fn check(lesson: &Lesson, findings: &mut Vec<Finding>) {
    if lesson.labs.is_empty() || lesson.scan.paragraphs.is_empty() {
        return;
    }
    let said: Vec<String> =
        lesson.verifies().flat_map(|v| &v.says).map(|s| folded(s.quote.as_str())).collect();
    let (mut all, mut first) = (0, None::<Range<usize>>);
    let mut claimed = 0;
    for (range, shown) in with_units(lesson) {
        all += 1;
        let shown = folded(&shown);
        if said.iter().any(|quote| quote.contains(&shown)) {
            claimed += 1;
        } else {
            first.get_or_insert(range);
        }
    }
    // One or two are what the text begins with.
    if let Some(span) = first.filter(|_| all >= claimed + FEWEST) {
        let message = format!(
            "{claimed} of {all} numbers with units in the text are claimed; this is the first that is not"
        );
        findings.push(
            Finding::new(NUMBERS_UNCLAIMED, span, message)
                .help("quote those that come from a run under `says` of a `verify`"),
        );
    }
}

/// Without spaces and the marks of formulas.
fn folded(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_whitespace() && !"$\\{}*".contains(*c))
        .map(|c| if c == '−' { '-' } else { c })
        .collect()
}

/// The numbers with units of the prose, in order, with their bytes.
fn with_units(lesson: &Lesson) -> Vec<(Range<usize>, String)> {
    let text = lesson.file.text();
    let mut all = Vec::new();
    for paragraph in lesson.scan.paragraphs.iter().take(MOST) {
        if lesson.scan.blocks.iter().any(|b| b.span.start < paragraph.end && paragraph.start < b.span.end) {
            continue;
        }
        let from = lesson.scan.inline_code.partition_point(|c| c.end <= paragraph.start);
        let code = lesson.scan.inline_code.get(from..).unwrap_or(&[]);
        let prose = text.get(paragraph.clone()).unwrap_or("");
        for n in numbers(prose).into_iter().take(MOST) {
            let at = paragraph.start + n.at.start..paragraph.start + n.at.end;
            let coded = code.iter().take_while(|c| c.start <= at.start).any(|c| at.end <= c.end);
            let after = prose.get(n.at.end..).unwrap_or("");
            if let Some(length) = unit(after).filter(|_| !coded) {
                let whole = at.start..at.end + length;
                all.push((whole.clone(), text.get(whole).unwrap_or("").to_string()));
            }
        }
    }
    all
}

/// Bytes of the unit that a text begins with.
fn unit(after: &str) -> Option<usize> {
    let trimmed = after.trim_start_matches([' ', '\u{a0}', '\u{202f}', '$', '\\', ',', '~']);
    let space = after.len() - trimmed.len();
    // `5, m` is no metre.
    if after.starts_with(',') || space > 4 {
        return None;
    }
    let own = UNITS.iter().chain(&MORE).find(|unit| {
        let rest = trimmed.strip_prefix(**unit);
        rest.is_some_and(|r| !r.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '-'))
    })?;
    Some(space + own.len())
}
