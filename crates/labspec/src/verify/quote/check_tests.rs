//! Outcomes and messages of quotes, with values of perturbed runs.

use super::read::read_quote;
use super::*;
use crate::finding::{Finding, Severity};
use crate::lint::ModelFolder;
use crate::lint::load_lesson;
use crate::source::SourceFile;

/// Checks a quote in a lesson whose prose contains it.
fn checked(quote: &str, computed: f64, half: &[f64], starts: &[f64]) -> (QuoteOutcome, Vec<Finding>) {
    let lab = serde_json::json!({"xml": "<mujoco/>", "verify": {"says": [[quote, "x"]]}});
    let text = format!("It is {quote} here, and {quote} there.\n\n```lab simlab\n{lab}\n```\n");
    let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown());
    let says = &lesson.labs[0].lab.as_ref().unwrap().verify.as_ref().unwrap().says[0];
    let other = |how| move |&value: &f64| OtherValue { how, value };
    let half: Vec<_> = half.iter().map(other("at half the timestep")).collect();
    let starts: Vec<_> = starts.iter().map(other("with a start moved by 1e-14")).collect();
    let mut findings = Vec::new();
    let rendered = RenderedText::of_lesson(&lesson);
    let value = QuoteValue { computed, timestep: &half, start: &starts, unit: &|| None, counts_turns: false };
    let claim = QuoteClaim { quote: &says.quote, part: says.quote.as_str(), expr: &says.exprs[0] };
    let places = places_of_quote(&says.quote, None, &rendered);
    let outcome = check_quote(&claim, &read_quote(quote), places, &value, &rendered, &mut findings);
    (outcome, findings)
}

/// The rule and all texts of the only finding.
fn first_finding(findings: &[Finding]) -> (&'static str, String) {
    assert_eq!(findings.len(), 1, "{findings:#?}");
    let f = &findings[0];
    let words = [Some(f.message.clone()), f.why.clone(), f.help.clone()];
    (f.code, words.into_iter().flatten().collect::<Vec<_>>().join(" | "))
}

/// Issue 12, line 8: the energy error of a double pendulum after 20 s.
#[test]
fn digits_that_no_reader_can_reproduce_are_never_to_be_written() {
    let (outcome, findings) = checked("-10.05 %", -10.05, &[-8.2], &[-20.75, -13.58]);
    let (code, words) = first_finding(&findings);
    assert_eq!(
        (outcome.state, code, findings[0].severity),
        (QuoteState::Unclear, "quote-chaotic", Severity::Warning)
    );
    assert!(
        words.contains("-10.05 as the lesson stands, -20.75 with a start moved by 1e-14, -13.58"),
        "{words}"
    );
    assert!(
        words.contains("quote a shorter run") && !words.contains("write") && !words.contains("fewer digits"),
        "{words}"
    );
    assert_eq!(outcome.moved.len(), 2);
    // The same where the nominal run gives another number.
    let (outcome, findings) = checked("-10.05 %", -20.75, &[], &[-13.58]);
    assert_eq!((outcome.state, first_finding(&findings).0), (QuoteState::Unclear, "quote-chaotic"));
    assert!(!first_finding(&findings).1.contains("write"));
}

#[test]
fn a_number_far_from_everything_that_comes_out_is_wrong() {
    let (outcome, findings) = checked("-60 %", -20.75, &[], &[-13.58]);
    assert_eq!((outcome.state, first_finding(&findings).0), (QuoteState::Wrong, "quote-wrong"));
    let (outcome, _) = checked("-60 %", -20.75, &[], &[f64::NAN]);
    assert_eq!(outcome.state, QuoteState::Unclear, "nobody knows what comes out");
}

#[test]
fn fewer_digits_are_advised_where_all_runs_agree_on_them() {
    let (_, findings) = checked("1.4237 s", 1.4237, &[], &[1.4241, 1.4239]);
    assert!(
        first_finding(&findings).1.contains("print fewer digits, 1.424, which all of these runs give"),
        "{findings:#?}"
    );
    let (_, findings) = checked("0.012 m", 0.012, &[], &[0.034]);
    assert!(!first_finding(&findings).1.contains("fewer digits"), "a zero that is none");
    // A change below the printed digits does not count.
    let (outcome, findings) = checked("1.42 s", 1.4237, &[1.4238], &[1.4241]);
    assert_eq!((outcome.state, findings.len()), (QuoteState::Right, 0));
}

#[test]
fn digits_of_a_timestep_are_noted_or_explained() {
    let (outcome, findings) = checked("0.442 s", 0.442, &[0.4405], &[0.442]);
    let (code, words) = first_finding(&findings);
    assert_eq!(
        (outcome.state, code, findings[0].severity),
        (QuoteState::Right, "quote-of-timestep", Severity::Note)
    );
    assert!(
        words.contains("0.442 as the lesson stands") && words.contains("at half the timestep"),
        "{words}"
    );
    assert!(words.contains("state it with its timestep") && !words.contains("| write"), "{words}");
    assert_eq!(outcome.moved.len(), 1);
    let (outcome, findings) = checked("0.438 s", 0.442, &[0.4405], &[]);
    let (code, words) = first_finding(&findings);
    assert_eq!((outcome.state, code), (QuoteState::Wrong, "quote-wrong"));
    assert!(
        words.contains("write 0.442 in the text and in the quote, and state the timestep beside it"),
        "{words}"
    );
    assert_eq!(outcome.moved.len(), 1);
}

#[test]
fn every_place_is_reported_with_the_number_read() {
    let (outcome, findings) = checked("$L^2 = 2.4 \\times 10^{-4}$", 3e-4, &[], &[]);
    let (code, words) = first_finding(&findings);
    assert_eq!((outcome.state, code, outcome.places.len()), (QuoteState::Wrong, "quote-wrong", 2));
    assert!(words.contains("(read as 2.4×10^-4), but the simulation gives 3.0×10^-4"), "{words}");
    assert_eq!(findings[0].related[0].span, outcome.places[1]);
    assert_eq!(outcome.read.unwrap().to_string(), "2.4×10^-4");
    assert!(outcome.reason.contains("the simulation gives 3.0×10^-4"), "{}", outcome.reason);
}

#[test]
fn the_finding_of_a_percentage_names_the_number_read() {
    assert_eq!(checked("50 %", 50.2, &[], &[]).0.read.unwrap().to_string(), "50");
    assert_eq!(checked("50 %", 0.502, &[], &[]).0.read.unwrap().to_string(), "0.50");
}

#[test]
fn nan_is_never_advised() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for quote in ["0.442 s", "3.0e-7", "1.5×10³", "0.4 to 0.5"] {
            let (outcome, findings) = checked(quote, value, &[value], &[value]);
            let (code, words) = first_finding(&findings);
            assert_eq!((outcome.state, code), (QuoteState::Unclear, "quote-without-value"), "{quote}");
            assert!(!words.contains("NaN") && !words.contains("0.0e") && !words.contains("write"), "{words}");
        }
    }
    // A missing value in a perturbed run is a change.
    let (outcome, findings) = checked("0.442 s", 0.442, &[f64::NAN], &[]);
    assert_eq!(outcome.moved, [("at half the timestep", "no value".to_string())]);
    assert!(first_finding(&findings).1.contains("no value at half the timestep"));
}

#[test]
fn another_unit_is_no_wrong_number() {
    let (outcome, findings) = checked("0.83 mm", 0.000831, &[], &[]);
    let (code, words) = first_finding(&findings);
    assert_eq!((outcome.state, code), (QuoteState::Unclear, "quote-unit"));
    assert!(
        words
            .contains("the numbers differ by exactly a power of ten: the text is in mm, the expression in m"),
        "{words}"
    );
    assert!(words.contains("multiply the expression by 1000: write `1000 * ("), "{words}");
}
