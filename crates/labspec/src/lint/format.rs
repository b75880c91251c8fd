//! What is said about objects that are not as the format says. What is wrong is found in `spec/`, where they are read.

use crate::finding::{Finding, Severity};
use crate::json::nearest;
use crate::json::read::{named, shorten};
use crate::rules;
use crate::source::MAX_FILE;
use crate::spec::format::{CONTROL, QUESTION, texts};
use crate::spec::{Expected, MOST_SWEPT, Meant, Misfit, Mistake};
use std::ops::Range;

/// What is said about a misfit.
pub(super) fn to_finding(misfit: &Misfit) -> Finding {
    let mut finding = finding_at(misfit.span.clone(), &misfit.mistake);
    // The page does not read a `verify` object: it is nothing to the student, and everything to the check.
    let reason = |rule: &rules::Rule| *finding.code == *rule && finding.why.as_deref() == Some(rule.why);
    if misfit.in_verify && [rules::UNKNOWN_KEY, rules::WRONG_TYPE].into_iter().any(reason) {
        finding.why =
            Some("only this checker reads `verify`: what it does not understand is not checked".into());
    }
    finding
}

/// One row for each mistake: a table of texts, which is long because the format has many rules.
fn finding_at(span: Range<usize>, mistake: &Mistake) -> Finding {
    let open = || span.start..span.end.min(span.start + 1);
    let wrong = |message: String| Finding::new(rules::WRONG_TYPE, span.clone(), message);
    match mistake {
        Mistake::Type { what, expected, found, text } => of_type(&span, what, *expected, found, text.as_deref()),
        Mistake::NotWhole { key, value } => {
            wrong(format!("`{key}` must be an integer, not {value}")).help("write a number without a decimal point")
        }
        Mistake::UnknownKey { of, key, meant } => unknown_key(span, of, key, meant),
        Mistake::MissingKey { of, key, why, advised } => {
            Finding::new(rules::MISSING_KEY, span, format!("{of} needs `{key}`"))
                .severity(if *advised { Severity::Warning } else { Severity::Error })
                .why(*why)
                .help(format!("add \"{key}\": …"))
        }
        Mistake::ControlType(word) => unknown_control_type(span, word),
        Mistake::QuestionKind(word) => unknown_question_kind(span, word),
        Mistake::LabExpects(word) => unknown_expectation(span, word),
        Mistake::RunExpects(word) => wrong(format!("the `expect` of a run cannot be {}", named(word)))
            .help("write \"expect\": \"breaks\" for a run that the lesson shows breaking, or delete it"),
        Mistake::NoChoice => {
            Finding::new(rules::SELECT_OPTIONS, span, "an option of a select must be a pair [text, value]")
                .help("write [\"RK4\", 1]")
        }
        Mistake::NothingOffered => {
            Finding::new(rules::SELECT_OPTIONS, open(), "this select has no options")
                .help("add \"options\": [[\"Euler\", 0], [\"RK4\", 1]]")
        }
        Mistake::NoTraces => Finding::new(rules::EMPTY_PLOT, open(), "this plot has no traces")
            .help("add \"traces\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]"),
        Mistake::NoPoint => {
            wrong("`target` must be three numbers, in metres".into()).help("write \"target\": [0, 0, 0.5]")
        }
        Mistake::NoSwitch => wrong("an overlay must be true or false".into())
            .help("write true or false, without quotes"),
        // A text of the right type, which the format cannot tell from an address.
        Mistake::NoPlace(text) => Finding::new(rules::UNKNOWN_LAB, span.clone(), format!("{} is not the address of a lab", named(text)))
            .help("write \"#2\" for the second lab of the lesson, \"#quiz-id.1\" for the sim of a quiz's first question, or a lab object"),
        Mistake::NoLab(found) => wrong(format!("`lab` must be a text or a lab object; this is {found}"))
            .help("write \"#2\" for the second lab of the lesson, or a lab object"),
        Mistake::NoSweep => wrong("a sweep must change exactly one thing: a control or an attribute of the model".into())
            .help("write {\"timestep h\": [0.002, 0.005, 0.01]}"),
        Mistake::NoRows => wrong("a column needs `by`, and a single cell needs `row`".into())
            .help("write \"by\": [\"height (m)\", \"fall.value\"], or \"row\": \"0.65\""),
        Mistake::FindsNothing => wrong("a search needs either `largest` or `smallest`".into())
            .help("write \"largest\": \"timestep h\", or \"smallest\""),
        Mistake::FindsBackwards => wrong("the `from` of a search must be below its `to`".into()).help("write `from` below `to`"),
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
        Mistake::ClaimsNothing => {
            Finding::new(rules::VERIFY_NOTHING, open(), "nothing is compared with these runs")
                .help("add `options`, `value`, `says` or `exact`")
        }
        Mistake::HoldsQuiz(right) => holds(span, "this fence says `lab`, but it holds a quiz", "quiz", right),
        Mistake::HoldsLab(right) => {
            holds(span, "this fence says `quiz`, but it holds a lab", "lab simlab", right)
        }
        Mistake::EmptyFence => Finding::new(rules::JSON_SYNTAX, span, "this fence is empty")
            .help("write one JSON object between the two ``` lines: { … }"),
        Mistake::UnknownObject => Finding::new(rules::UNKNOWN_SPEC, open(), "the object is neither a lab nor a quiz")
            .help("add `model` or `xml` for a lab, or `questions` for a quiz"),
        Mistake::TooLarge => {
            let limit = MAX_FILE >> 20;
            Finding::new(rules::LESSON_LIMIT, span, format!("this file is larger than {limit} MB"))
        }
    }
}

fn unknown_control_type(span: Range<usize>, word: &str) -> Finding {
    let message = format!("{} is not a type of control", named(word));
    let finding = Finding::new(rules::WRONG_TYPE, span, message)
        .why("the page knows sliders, selects and buttons; it shows nothing for other types");
    let help = "write \"select\" or \"button\", or delete `type` for a slider";
    one_of(finding, word, texts(CONTROL.words), help.to_string())
}

fn unknown_question_kind(span: Range<usize>, word: &str) -> Finding {
    let message = format!("{} is not a kind of question", named(word));
    let finding = Finding::new(rules::WRONG_TYPE, span, message).why("the page can neither ask nor grade it");
    let kinds: Vec<&str> = texts(QUESTION.words).collect();
    one_of(finding, word, texts(QUESTION.words), format!("use one of the kinds {}", kinds.join(", ")))
}

fn unknown_expectation(span: Range<usize>, word: &str) -> Finding {
    let message = format!("`expect` cannot be {}", named(word));
    let finding = Finding::new(rules::WRONG_TYPE, span, message)
        .why("`expect` describes the result of a run, and \"breaks\" is its only value");
    let help = "write \"breaks\" if the lab shows a simulation that breaks, or delete it";
    one_of(finding, word, ["breaks"].into_iter(), help.to_string())
}

/// A value of another type. "5" for 5 is the common case, and it has one repair.
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
    let finding = Finding::new(rules::WRONG_TYPE, span.clone(), message);
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

fn unknown_key(span: Range<usize>, of: &str, key: &str, meant: &Meant) -> Finding {
    let message = match key.trim().is_empty() {
        true => format!("a key of {of} has no name"),
        false => format!("{of} has no key `{}`", shorten(key)),
    };
    let finding = Finding::new(rules::UNKNOWN_KEY, span.clone(), message);
    match meant {
        Meant::There(right) => {
            finding.help(format!("did you mean `{right}`? the object already has it: delete one of the two"))
        }
        Meant::Likely(right) => finding.help(format!("did you mean `{right}`?")).guess(span, *right),
        Meant::Other { key, takes } => finding.help(format!("did you mean `{key}`? it takes {takes}")),
        Meant::Unclear(keys) => finding.help(format!("use one of its keys: {}", keys.join(", "))),
    }
}

/// One of several words: the nearest, or else `help`.
fn one_of(finding: Finding, word: &str, words: impl Iterator<Item = &'static str>, help: String) -> Finding {
    match nearest(word, words) {
        Some(right) => {
            let span = finding.span.clone();
            finding.help(format!("did you mean `{right}`?")).guess(span, right)
        }
        None => finding.help(help),
    }
}

/// A fence of the wrong kind.
fn holds(span: Range<usize>, message: &str, kind: &str, right: &str) -> Finding {
    Finding::new(rules::FENCE_KIND, span.clone(), message).help(format!("write ```{kind}")).fix(span, right)
}
