//! Quoted numbers in prose: each is right, wrong, or reported with a reason, in every form in which it may be written.

#![allow(clippy::unwrap_used)]

use crate::support::check_text;
use crate::verify::{expect, lesson, numeric};
use labspec::check::Checked;
use labspec::verify::{QuoteState, Verdict};

/// The same for a question whose answer is right; the first quote that is not right must have this verdict.
fn expect_quote(name: &str, word: &str, prose: &str, question: &str) {
    expect(name, Verdict::Verified, prose, question);
    let checked = check_text("fall.md", &lesson(prose, question));
    let quotes = &checked.claims[0].judgement.quotes;
    let found = quotes.iter().map(|q| q.verdict()).find(|verdict| *verdict != "verified");
    assert_eq!(found, Some(word), "{quotes:?}");
}

/// The number of quoted numbers that are right.
fn right(checked: &Checked) -> usize {
    checked.claims[0].judgement.quotes.iter().filter(|q| q.state == QuoteState::Right).count()
}

#[test]
fn a_wrong_quote_is_refuted_at_its_place() {
    let question = numeric("0.44", "0.005", "touch", r#"["0.440 s", "touch + 0.01"]"#);
    expect_quote("quote-wrong", "refuted", "Drop it.", &question);
    let question = numeric("0.44", "0.005", "touch", r#"["4.23 m/s", "9.81 * touch"]"#);
    expect_quote("quote-wrong-in-prose", "refuted", "It arrives with 4.23 m/s.", &question);
}

#[test]
fn a_quote_that_no_reader_sees_is_reported() {
    let question = numeric("0.44", "0.005", "touch", r#"["4.32 m/s", "9.81 * touch"]"#);
    expect_quote("quote-not-found", "failed", "It arrives with 24.32 m/s.", &question);
}

#[test]
fn a_quote_without_a_number_is_reported() {
    let question = numeric("0.44", "0.005", "touch", r#"["about half a second", "touch"]"#);
    expect_quote("quote-without-number", "failed", "It takes about half a second.", &question);
}

/// A question whose only claims besides its answer are quotes, in a lesson with this prose: the number of right quotes, and
/// the codes of the findings.
fn quotes(prose: &str, says: &str) -> (usize, Vec<&'static str>) {
    let text = lesson(prose, &numeric("0.44", "0.005", "touch", says));
    let checked = check_text("fall.md", &text);
    let codes = checked.findings.iter().map(|f| f.code).collect();
    (right(&checked), codes)
}

/// Issue 12, line 7: a changed number in the prose remained verified, because invisible text still contained the old one.
#[test]
fn a_changed_number_in_prose_is_not_verified_by_hidden_text() {
    let prose = "It touches after 0.443 s.\n\n```python\nassert touch == \"0.442 s\"\n```\n\n<!-- 0.442 s -->\n\n\
                 <img src=\"a.png\" alt=\"0.442 s\">\n\nNot <span style=\"display: none\">0.442 s</span> here.\n\n\
                 <div hidden>\n\n0.442 s\n\n</div>\n\n```json\n{\"0.442 s\": true}\n```";
    let text = lesson(prose, &numeric("0.44", "0.005", "touch", r#"["0.442 s", "seen"]"#))
        .replace("\"expr\": \"data.qpos[2]\"", "\"expr\": \"'0.442 s' ? data.qpos[2] : 0\"");
    let checked = check_text("fall.md", &text);
    let codes: Vec<_> = checked.findings.iter().map(|f| f.code).collect();
    assert_eq!((right(&checked), codes), (0, vec!["quote-not-found"]));
    assert_ne!(checked.claims[0].judgement.quotes[0].verdict(), "verified");
    // The same lesson with the number where a reader sees it.
    let checked = check_text("fall.md", &text.replace("0.443 s", "0.442 s"));
    assert_eq!(right(&checked), 1);
}

/// Issue 12, line 7: every form of a number is parsed correctly or refused with a reason, never called wrong.
#[test]
fn every_form_of_a_right_number_is_right() {
    for (prose, quote, expr) in [
        ("It is 1,500 N.", "1,500 N", "1500"),
        ("It is 1 500 N.", "1 500 N", "1500"),
        ("It is 1\u{202f}500 N.", "1 500 N", "1500"),
        ("It is 1&nbsp;500 N.", "1 500 N", "1500"),
        ("It is 1.5×10³ N.", "1.5×10³ N", "1500"),
        ("It is 1.5 x 10^3 N.", "1.5 x 10^3 N", "1500"),
        ("It is $3.0\\times10^{-3}$ m.", "$3.0\\\\times10^{-3}$ m", "0.003"),
        ("It is $3.0\\times10^{-3}$ m.", "3.0×10⁻³ m", "0.003"),
        ("It is $2.4 \\times 10^{-4}$.", "$2.4 \\\\times 10^{-4}$", "0.00024"),
        ("It is $2.4 \\cdot 10^{-4}$.", "$2.4 \\\\cdot 10^{-4}$", "0.00024"),
        ("It is 50 % of it.", "50 %", "50"),
        ("It is 50 % of it.", "50 %", "0.5"),
        ("It is ½ of it.", "½", "0.5"),
        ("It is 0,442 s.", "0,442 s", "0.442"),
        ("It is 0.44 ± 0.01 s.", "0.44 ± 0.01 s", "0.449"),
        ("It is 0.4 to 0.5 s.", "0.4 to 0.5 s", "0.42"),
        ("It is 0.4–0.5 s.", "0.4–0.5 s", "0.42"),
        ("It is 0.4–0.5 s.", "0.4-0.5 s", "0.42"),
        ("It is between 0.4 and 0.5.", "between 0.4 and 0.5", "0.42"),
        ("It is \u{2212}0.25 m.", "-0.25 m", "-0.25"),
        ("It is about 29 mm.", "about 29 mm", "29.4"),
        ("It is ≈ 29 mm.", "≈ 29 mm", "29.4"),
        ("Here $I = mL^2 + I_c = 0.2501$.", "$I = mL^2 + I_c = 0.2501$", "0.2501"),
        ("It is **0.25** m.", "0.25 m", "0.25"),
        ("It is <b>0.25</b> m.", "0.25 m", "0.25"),
    ] {
        let found = quotes(prose, &format!(r#"["{quote}", "{expr} + 0"]"#));
        assert_eq!(found, (1, vec![]), "{quote} as {expr} in: {prose}");
    }
}

#[test]
fn a_wrong_number_is_wrong_in_every_form() {
    for (quote, expr) in [
        ("1,500 N", "1600"),
        ("1.5×10³ N", "1600"),
        ("50 %", "0.6"),
        ("½", "0.6"),
        ("0.44 ± 0.01 s", "0.46"),
        ("0.4 to 0.5 s", "0.6"),
        ("-0.25 m", "0.25"),
        ("$I = mL^2 + I_c = 0.2501$", "2"),
    ] {
        let quote = quote.replace('\\', "\\\\");
        let found = quotes(&format!("It is {quote}."), &format!(r#"["{quote}", "{expr} + 0"]"#));
        assert_eq!(found, (0, vec!["quote-wrong"]), "{quote} as {expr}");
    }
}

#[test]
fn unreadable_quotes_are_reported_and_not_called_wrong() {
    for (quote, expr, code) in [
        ("1,500 N", "1.5", "quote-unclear"),
        ("3,5 N", "4", "quote-unclear"),
        ("1/2", "0.5", "quote-unclear"),
        ("3:2", "1.5", "quote-unclear"),
        ("other than 1 mm", "0.83", "quote-unclear"),
        ("0.442 s at 2 ms", "2", "quote-unclear"),
        ("0.83 mm", "0.00083", "quote-unit"),
        ("0.25 m", "0 / 0", "quote-without-value"),
        ("0.25 m", "1 / 0", "quote-without-value"),
        ("the value x_1 of H2O", "1", "quote-without-number"),
    ] {
        let found = quotes(&format!("It is {quote}."), &format!(r#"["{quote}", "{expr} + 0"]"#));
        assert_eq!(found, (0, vec![code]), "{quote} as {expr}");
    }
}

/// The findings for each kind of error in a quote.
#[test]
fn findings_about_quotes_say_what_to_do() {
    let says = r#"["0.25 m", "0.3 + 0"]"#;
    expect_quote(
        "quote-everywhere",
        "refuted",
        "First 0.25 m, then **0.25** m.",
        &numeric("0.44", "0.005", "touch", says),
    );
    let says = r#"["0.83 mm", "0.00083 + 0"]"#;
    expect_quote("quote-unit", "failed", "It sinks by 0.83 mm.", &numeric("0.44", "0.005", "touch", says));
    let says = r#"["0.25 s", "first(contact('ball', 'floor') && data.time > 2)"]"#;
    expect_quote(
        "measure-without-value",
        "failed",
        "After 0.25 s.",
        &numeric("0.44", "0.005", "touch", says),
    );
    let says = r#"["other than 1 mm", "0.83 + 0"]"#;
    expect_quote(
        "quote-unclear",
        "failed",
        "It sinks by other than 1 mm.",
        &numeric("0.44", "0.005", "touch", says),
    );
    let says = r#"["0.25 m", "0.25 + 0"]"#;
    let prose = "After 0.26 m.\n\n```python\nx = '0.25 m'\n```";
    expect_quote("quote-hidden", "failed", prose, &numeric("0.44", "0.005", "touch", says));
}

/// Issue 12, line 8: a number of the time grid is right if its timestep is stated, and is never rewritten.
#[test]
fn digits_that_change_with_the_timestep_are_noted() {
    let question = numeric("0.44", "0.005", "touch", r#"["0.442 s", "seen"]"#);
    expect("quote-of-timestep", Verdict::Verified, "It touches after 0.442 s.", &question);
    let question = numeric("0.44", "0.005", "touch", r#"["0.439 s", "seen"]"#);
    expect_quote("quote-wrong-of-timestep", "refuted", "It touches after 0.439 s.", &question);
    // If the timestep is stated, there is nothing to note.
    let stated = numeric("0.44", "0.005", "touch", r#"["0.442 s", "seen"]"#)
        .replace(r#""drop": {"#, r#""drop": {"set": {"timestep": 0.002}, "#);
    let checked = check_text("fall.md", &lesson("It touches after 0.442 s.", &stated));
    assert_eq!((right(&checked), checked.findings.len()), (1, 0));
}

/// Issue 12, line 8: an event between two samples is interpolated, so that its digits do not depend on the time grid.
#[test]
fn events_between_samples_are_interpolated() {
    let says = r#"["0.4513 s", "crossing(1 - 0.5 * 9.81 * data.time * data.time - 0.001)"],
                  ["0.7 s", "period(Math.sin(2 * Math.PI * data.time / 0.3 + 1), 0.5) + 0.4"],
                  ["0.50 s", "mean(data.time)"]"#;
    let (right, codes) = quotes("At 0.4513 s, 0.7 s and 0.50 s.", says);
    assert_eq!((right, codes), (3, vec![]));
}

/// A double pendulum that falls from above: after 20 s, a perturbation of one bit changes all digits.
fn double_pendulum(quote: &str, until: u32) -> String {
    let bob = "<geom type='sphere' size='0.03' pos='0 0 -0.3' mass='1' contype='0' conaffinity='0'/>";
    let inner = format!("<body pos='0 0 -0.3'><joint axis='0 1 0'/>{bob}</body>");
    let model = format!(
        "<mujoco><option timestep='0.002'><flag energy='enable'/></option><worldbody><body pos='0 0 1'><joint axis='0 1 0'/>{bob}{inner}</body></worldbody><keyframe><key qpos='2 0.5'/></keyframe></mujoco>"
    );
    format!(
        r##"# Two rods

The error is {quote} in the end.

```lab simlab
{{"xml": "{model}", "key": 0, "stopAt": {until},
  "readouts": [{{"label": "energy (J)", "expr": "data.energy[0] + data.energy[1]"}}]}}
```

```quiz
{{"id": "chaos", "questions": [{{
  "q": "Is the energy kept?", "options": ["Yes", "No"], "answer": 1,
  "verify": {{"lab": "#1", "runs": {{"long": {{"until": {until}}}}}, "measure": {{"angle": "data.qpos[0]"}},
    "says": [["{quote}", "long.angle"]]}}}}]}}
```
"##
    )
}

/// Issue 12, line 8: a number that changes if the start is perturbed by 1e-14 is never recommended, right or wrong.
#[test]
fn digits_of_a_chaotic_motion_are_never_recommended() {
    let check = |quote: &str, until| check_text("chaos.md", &double_pendulum(quote, until));
    let computed = |checked: &Checked| checked.claims[0].judgement.quotes[0].computed;
    let right = computed(&check("-77.25", 20));
    for quote in [format!("{right:.2}"), format!("{:.2}", right + 10.0)] {
        let checked = check(&quote, 20);
        let quote = &checked.claims[0].judgement.quotes[0];
        let found: Vec<&str> = checked.findings.iter().map(|f| f.code).collect();
        // A number that no run approaches is also wrong.
        assert!(found.contains(&"quote-chaotic") || found.contains(&"quote-wrong"), "{found:?}");
        assert_ne!(quote.state, QuoteState::Right, "{quote:?}");
        for finding in &checked.findings {
            let help = finding.help.as_deref().unwrap_or("");
            assert!(!help.contains(&format!("{right:.2}")) && finding.fix.is_none(), "{finding:?}");
        }
    }
    // The same angle after half a second is reproducible.
    let short = computed(&check("-77.25", 1));
    let checked = check(&format!("{short:.2}"), 1);
    assert_eq!(checked.claims[0].judgement.quotes[0].state, QuoteState::Right, "{:?}", checked.findings);
}

/// A lab with a claim about a displayed value: its verdicts and findings.
fn read_off(readout: &str, measure: &str) -> (Vec<QuoteState>, Vec<&'static str>) {
    let text = r#"The ball has fallen 0.441 m after 0.3 s.

```lab simlab
{
  "title": "A ball", "stopAt": 0.3,
  "xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom type='sphere' size='0.05' mass='1'/></body></worldbody></mujoco>",
  "plots": [{"window": 0.3, "traces": [{"label": "fallen (m)", "expr": "1 - data.qpos[2]"}]}],
  "readouts": [READOUT],
  "verify": {"runs": {"fall": {"set": {}, "until": 0.3}}, "measure": {"fallen": "MEASURE"}, "says": [["0.441 m", "fall.fallen - 0.003"]]}
}
```
"#;
    let text = text.replace("READOUT", readout).replace("MEASURE", measure);
    let checked = check_text("shown.md", &text);
    let states = checked.claims.iter().flat_map(|c| &c.judgement.quotes).map(|q| q.state).collect();
    (
        states,
        checked
            .findings
            .iter()
            .filter(|f| f.severity == labspec::finding::Severity::Error)
            .map(|f| f.code)
            .collect(),
    )
}

#[test]
fn displayed_values_can_be_claimed() {
    let right = r#"{"label": "way (m)", "expr": "1 - data.qpos[2]", "digits": 3}"#;
    for measure in
        ["final(shown('way (m)'))", "final(shown('fallen (m)'))", "final(shown('plot/0/fallen (m)'))"]
    {
        assert_eq!(read_off(right, measure), (vec![QuoteState::Right], vec![]), "{measure}");
    }
    for (readout, code) in [
        (r#"{"label": "way (m)", "expr": "data.qpos[2] - 1", "digits": 3}"#, "quote-wrong"),
        (r#"{"label": "way (m)", "expr": "data.qpos[1]", "digits": 3}"#, "quote-wrong"),
        (r#"{"label": "way (m)", "expr": "1 - data.qpos[2]", "digits": 1}"#, "quote-wrong"),
        (r#"{"label": "the way (m)", "expr": "1 - data.qpos[2]", "digits": 3}"#, "unknown-object"),
    ] {
        let (_, codes) = read_off(readout, "final(shown('way (m)'))");
        assert_eq!(codes, [code], "{readout}");
    }
}
