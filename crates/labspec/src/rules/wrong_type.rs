use crate::json::read::named;
use crate::json::{encode, nearest};
use crate::spec::format::{CONTROL, QUESTION, texts};
use crate::spec::{Expected, MOST_AXES, MOST_SWEPT, Mistake};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A value has another type than its key takes.
pub const WRONG_TYPE: &Rule = &Rule {
    code: "wrong-type",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a value has another type than its key takes",
    why: "the page uses the value as it is, and computes or shows nonsense",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": ⟦"2"⟧}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};

/// Reports a definition without a name, or with that of another one.
pub(crate) fn no_definition_name(span: Range<usize>, name: &str) -> Finding {
    let message = match name {
        "" => "a definition needs a name".to_string(),
        name => format!("the name {} is already defined", named(name)),
    };
    Finding::new(WRONG_TYPE, span, message)
        .help("write `labspec define NAME {\"runs\": …}` with a name of letters, digits, `-` and `_`")
}

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
            .help("write \"expect\": \"breaks\" for a run that the lesson shows breaking, \"may break\" for a sweep of which some members break, or delete it"),
        Mistake::NoPoint => {
            wrong("`target` must be three numbers, in metres".into()).help("write \"target\": [0, 0, 0.5]")
        }
        Mistake::NoSwitch => {
            wrong("an overlay must be true or false".into()).help("write true or false, without quotes")
        }
        Mistake::NoLab(found) => wrong(format!("`lab` must be a text or a lab object; this is {found}"))
            .help("write \"#2\" for the second lab of the lesson, or a lab object"),
        Mistake::NoPress => wrong("a press must be a pair [label, time]".into())
            .help("write [\"Drop\", 0.5]: the button's label and the time in seconds"),
        Mistake::NoQuote => wrong("an entry of `says` must be a pair [quote, expression]".into())
            .help("write [\"0.442 s\", \"fine.touch\"]"),
        Mistake::QuoteWithoutList([quote, expression]) => {
            wrong("`says` must be a list of lists [quote, expression]".into())
                .help(format!("write [[\"{}\", \"{}\"]]", encode(quote), encode(expression)))
        }
        Mistake::AnswerText(index) => {
            wrong("`answer` must be the index of an option, not its text or its letter".into())
                .help(format!("write {index}, the index of this option"))
                .guess(span.clone(), index.to_string())
        }
        _ => describe_run(span, mistake),
    }
}

/// Describes a mistake in the runs and tables of a claim.
fn describe_run(span: &Range<usize>, mistake: &Mistake) -> Finding {
    let wrong = |message: String| Finding::new(WRONG_TYPE, span.clone(), message);
    match mistake {
        Mistake::NoSweep => {
            wrong(format!("a sweep must change 1 to {MOST_AXES} things, each a control or an attribute of the model"))
                .help("write {\"timestep h\": [0.002, 0.005, 0.01]}")
        }
        Mistake::NoRows => wrong("a column needs `by`, and a single cell needs `row`".into())
            .help("write \"by\": [\"height (m)\", \"fall.value\"], or \"row\": \"0.65\""),
        Mistake::NoColumn => wrong("an entry of a table needs either `column` with `is`, or `columns`, or `row` with a list".into())
            .help(
                "write \"column\": \"touchdown (s)\", \"is\": \"fall.touch\"; or \"columns\": {\"touchdown (s)\": \"fall.touch\", …}; or \"row\": \"0.65\", \"is\": [\"fall.touch\", null, …] for the cells after the first",
            ),
        Mistake::FindsNothing => wrong("a search needs either `largest` or `smallest`".into())
            .help("write \"largest\": \"timestep h\", or \"smallest\""),
        Mistake::FindsBackwards => {
            wrong("the `from` of a search must be below its `to`".into()).help("write `from` below `to`")
        }
        Mistake::SweptValues(count) => {
            wrong(format!("a sweep must have 2 to {MOST_SWEPT} runs; this one has {count}"))
                .help("write [0.002, 0.005, 0.01], or {\"from\": 0.2, \"to\": 2, \"count\": 5}")
        }
        Mistake::RunNames { names, members } => {
            wrong(format!("this list has {names} names, but the sweep has {members} runs"))
                .help(format!("list {members} names, one for each run; or write one name, whose measures are lists"))
        }
        Mistake::RunTwice(name) => wrong(format!("there are two runs {}", named(name)))
            .help("give each run a name of its own"),
        Mistake::NoRange => wrong("a range must be a pair [smallest, largest]".into())
            .help("write the smaller end first: `\"gravity\": [-20, -1]`"),
        // `lint/format.rs` lists the mistakes that these functions describe.
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
        .why("`expect` describes the result of a run: \"breaks\" or \"may break\"");
    let help = "write \"breaks\" if the lab shows a simulation that breaks, \"may break\" if some settings break it, or delete it";
    one_of(finding, word, ["breaks", "may break"].into_iter(), help.to_string())
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
    if let Some(bare) = bare {
        return finding.help(format!("write {bare} without the quotes")).fix(span.clone(), bare);
    }
    match text.and_then(|text| meant(expected, text.trim())) {
        Some((bare, left)) => {
            finding.help(format!("write {bare}, without quotes{left}")).guess(span.clone(), bare)
        }
        None if expected == Expected::Text && found == "a number" => finding.help("put quotes around it"),
        None => finding.help(format!("write {right}")),
    }
}

/// The number or the flag that a text probably means, and what it leaves out: `2 s` is 2, and `yes` is true.
fn meant(expected: Expected, text: &str) -> Option<(String, String)> {
    match (expected, text.to_ascii_lowercase().as_str()) {
        (Expected::Flag, "yes" | "on" | "1") => Some(("true".into(), String::new())),
        (Expected::Flag, "no" | "off" | "0") => Some(("false".into(), String::new())),
        (Expected::Number, _) => {
            let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.' | ',');
            let (number, unit) = text.split_at(text.find(|c| !is_of_number(c))?);
            let bare = crate::json::literal::repaired(&number.replace(',', "."))?;
            Some((bare, format!(" and without `{}`", unit.trim())))
        }
        _ => None,
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
