use super::Check;
use super::claims;
use crate::json::read;
use crate::source::Text;
use crate::spec::{LabAddress, Lesson, UsedObject, VerifyLab};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A `verify` object refers to a lab that the lesson does not have.
pub const UNKNOWN_LAB: &Rule = &Rule {
    code: "unknown-lab",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a `verify` object refers to a lab that the lesson does not have",
    why: "nothing can be run, so nothing is checked",
    bad: Example::Quiz(
        r##"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 3.924, "verify": {"lab": "⟦#1⟧", "runs": {"run": {"until": 0.4}}, "value": "final(-data.qvel[2])"}}]}"##,
    ),
    good: Example::Lesson(
        "```lab simlab\n{\"model\": \"ball\"}\n```\n\n```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"numeric\", \"q\": \"How fast?\", \"answer\": 3.924, \"verify\": {\"lab\": \"#1\", \"runs\": {\"run\": {\"until\": 0.4}}, \"value\": \"final(-data.qvel[2])\"}}]}\n```\n",
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let named = claims::all(lesson).flat_map(|claim| claim.verify.labs());
    for claim in claims::all(lesson) {
        let Some((text, used)) = &claim.verify.uses else { continue };
        let message = match lesson.used_object(used) {
            None => match used {
                UsedObject::Owner(_) => format!("{} has no `verify`", read::named(text.as_str())),
                UsedObject::Defined(_) => format!("nothing defines {}", read::named(text.as_str())),
            },
            Some(used) if used.span == claim.verify.span => "this `verify` uses itself".to_string(),
            // The referenced object could not be resolved.
            Some(_) if std::ptr::eq(lesson.whole(claim.verify), claim.verify) => {
                "the `verify` objects that the lesson reuses are larger than 8 MB in total".to_string()
            }
            Some(_) => continue,
        };
        findings.push(
            Finding::new(UNKNOWN_LAB, text.span(), message)
                .help("name a lab (#1) or a question (#quiz-id.2) with a `verify`, or a comment `<!-- labspec define NAME {…} -->`"),
        );
    }
    for lab in named {
        let VerifyLab::Reference(text, address) = lab else { continue };
        // A lab that exists but could not be parsed is already reported.
        let broken = matches!(address, LabAddress::Lab(n) if *n <= lesson.labs.len());
        if broken || lesson.lab(address).is_some() {
            continue;
        }
        let all: Vec<String> = lesson.addressed().iter().take(12).map(|(a, _)| a.to_string()).collect();
        let message = format!("the lesson has no lab {}", read::named(text.as_str()));
        let found = Finding::new(UNKNOWN_LAB, text.span(), message);
        findings.push(if all.is_empty() {
            found.help("write a lab object here, or add a lab to the lesson")
        } else {
            found.help(format!("use one of: {}", all.join(", ")))
        });
    }
}

/// Reports a text that is not an address, where an address is required.
pub(crate) fn not_an_address(span: Range<usize>, text: &str) -> Finding {
    let found =
        Finding::new(UNKNOWN_LAB, span.clone(), format!("{} is not the address of a lab", read::named(text)));
    // A number alone, or with other words, probably counts the labs.
    let digits = text.trim_start_matches(|c: char| !c.is_ascii_digit());
    if let Ok(number @ 1..) = digits.trim_end().parse::<usize>() {
        let address = format!("#{number}");
        return found.help(format!("write \"{address}\"")).guess(span, address);
    }
    found.help("write \"#2\" for the second lab of the lesson, \"#quiz-id.1\" for the sim of a quiz's first question, or a lab object")
}

/// Reports a lab of another lesson that cannot be used. `other`: the reason, if that lesson was read.
pub(crate) fn lab_of_other_lesson(text: &Text, other: Option<Option<&str>>) -> Finding {
    let name = read::named(text.as_str());
    let message = match other {
        Some(None) => format!("{name} cannot run, because its model or its code has errors"),
        Some(Some(why)) => format!("{name} does not exist: {why}"),
        None => format!("{name} does not exist: only this lesson was given, or it names too many others"),
    };
    Finding::error(UNKNOWN_LAB, text.span(), message)
        .why("claims about it cannot be checked")
        .help("check that lesson; name a lab of another lesson by its path from this one: other.md#2")
}
