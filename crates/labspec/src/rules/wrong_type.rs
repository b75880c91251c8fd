use crate::json::nearest;
use crate::json::read::named;
use crate::spec::format::{CONTROL, QUESTION, texts};
use crate::spec::{Expected, MOST_SWEPT, Mistake};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A value has another type than its key takes.
pub const WRONG_TYPE: &Rule = &Rule {
    code: "wrong-type",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a value has another type than its key takes",
    why: "the page uses the value as it is, and computes or shows nonsense",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": ⟦"2"⟧}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};

/// Reports a value whose type differs from the one that its key requires.
pub(crate) fn describe_type(span: &Range<usize>, mistake: &Mistake) -> Finding {
    let wrong = |message: String| Finding::new(WRONG_TYPE, span.clone(), message);
    match mistake {
        Mistake::Type { what, expected, found, text } => {
            of_type(span, what, *expected, found, text.as_deref())
        }
        Mistake::NotWhole { key, value } => wrong(format!("`{key}` must be an integer, not {value}"))
            .help("write a number without a decimal point"),
        Mistake::ControlType(word) => unknown_control_type(span.clone(), word),
        Mistake::QuestionKind(word) => unknown_question_kind(span.clone(), word),
        Mistake::LabExpects(word) => unknown_expectation(span.clone(), word),
        Mistake::RunExpects(word) => wrong(format!("the `expect` of a run cannot be {}", named(word)))
            .help("write \"expect\": \"breaks\" for a run that the lesson shows breaking, or delete it"),
        Mistake::NoPoint => {
            wrong("`target` must be three numbers, in metres".into()).help("write \"target\": [0, 0, 0.5]")
        }
        Mistake::NoSwitch => {
            wrong("an overlay must be true or false".into()).help("write true or false, without quotes")
        }
        Mistake::NoLab(found) => wrong(format!("`lab` must be a text or a lab object; this is {found}"))
            .help("write \"#2\" for the second lab of the lesson, or a lab object"),
        Mistake::NoSweep => {
            wrong("a sweep must change exactly one thing: a control or an attribute of the model".into())
                .help("write {\"timestep h\": [0.002, 0.005, 0.01]}")
        }
        Mistake::NoRows => wrong("a column needs `by`, and a single cell needs `row`".into())
            .help("write \"by\": [\"height (m)\", \"fall.value\"], or \"row\": \"0.65\""),
        Mistake::FindsNothing => wrong("a search needs either `largest` or `smallest`".into())
            .help("write \"largest\": \"timestep h\", or \"smallest\""),
        Mistake::FindsBackwards => {
            wrong("the `from` of a search must be below its `to`".into()).help("write `from` below `to`")
        }
        Mistake::SweptValues(count) => {
            wrong(format!("a sweep must have 2 to {MOST_SWEPT} values; this one has {count}"))
                .help("write [0.002, 0.005, 0.01], or {\"from\": 0.2, \"to\": 2, \"count\": 5}")
        }
        Mistake::NoRange => wrong("a range must be a pair [smallest, largest]".into())
            .help("write the smaller end first: `\"gravity\": [-20, -1]`"),
        Mistake::NoPress => wrong("a press must be a pair [label, time]".into())
            .help("write [\"Drop\", 0.5]: the button's label and the time in seconds"),
        Mistake::NoQuote => wrong("an entry of `says` must be a pair [quote, expression]".into())
            .help("write [\"0.442 s\", \"fine.touch\"]"),
        // `lint/format.rs` lists the mistakes that this function describes.
        _ => {
            debug_assert!(false, "this mistake is of another rule: {mistake:?}");
            wrong("this value has another type than its key takes".into())
        }
    }
}

fn unknown_control_type(span: Range<usize>, word: &str) -> Finding {
    let message = format!("{} is not a type of control", named(word));
    let finding = Finding::new(WRONG_TYPE, span, message)
        .why("the page knows sliders, selects and buttons; it shows nothing for other types");
    let help = "write \"select\" or \"button\", or delete `type` for a slider";
    one_of(finding, word, texts(CONTROL.words), help.to_string())
}

fn unknown_question_kind(span: Range<usize>, word: &str) -> Finding {
    let message = format!("{} is not a kind of question", named(word));
    let finding = Finding::new(WRONG_TYPE, span, message).why("the page can neither ask nor grade it");
    let kinds: Vec<&str> = texts(QUESTION.words).collect();
    one_of(finding, word, texts(QUESTION.words), format!("use one of the kinds {}", kinds.join(", ")))
}

fn unknown_expectation(span: Range<usize>, word: &str) -> Finding {
    let message = format!("`expect` cannot be {}", named(word));
    let finding = Finding::new(WRONG_TYPE, span, message)
        .why("`expect` describes the result of a run, and \"breaks\" is its only value");
    let help = "write \"breaks\" if the lab shows a simulation that breaks, or delete it";
    one_of(finding, word, ["breaks"].into_iter(), help.to_string())
}

/// Reports a value of another type. "5" for 5 is the common case, and it has one repair.
fn of_type(span: &Range<usize>, what: &str, expected: Expected, found: &str, text: Option<&str>) -> Finding {
    let right = match expected {
        Expected::Text => "a text in double quotes",
        Expected::Number => "a number, without quotes",
        Expected::Flag => "true or false, without quotes",
        Expected::Scalar => "a number, a text or true/false",
        Expected::List => "a list [ … ]",
        Expected::Object => "an object { … }",
    };
    let message = format!("{what} must be {right}; this is {found}");
    let finding = Finding::new(WRONG_TYPE, span.clone(), message);
    let bare = match (expected, text.map(str::trim)) {
        (Expected::Number, Some(text)) => crate::json::literal::repaired(text),
        (Expected::Flag, Some(text @ ("true" | "false"))) => Some(text.to_string()),
        _ => None,
    };
    match bare {
        Some(bare) => finding.help(format!("write {bare} without the quotes")).fix(span.clone(), bare),
        None if expected == Expected::Text && found == "a number" => finding.help("put quotes around it"),
        None => finding.help(format!("write {right}")),
    }
}

/// Reports a value that is not an allowed word. The help names the nearest word, or is `help`.
fn one_of(finding: Finding, word: &str, words: impl Iterator<Item = &'static str>, help: String) -> Finding {
    match nearest(word, words) {
        Some(right) => {
            let span = finding.span.clone();
            finding.help(format!("did you mean `{right}`?")).guess(span, right)
        }
        None => finding.help(help),
    }
}
