//! Finds texts that compare two runs in the wrong direction: "a wide swing takes less time than a small one" beside
//! `wide.T > small.T`. Where a text says how a result changes, the question tells from which setting to which: "from 9.81 m/s² to
//! 1.62 m/s²".

use super::bound::BoundVerify;
use super::given::settings_of;
use super::option_numbers::{constant, is_below};
use super::outcome::MeasuredRuns;
use super::quote::quantities_in;
use super::ratio_order::{measure_of, run_of};
use super::units;
use crate::finding::Finding;
use crate::json::read::named;
use crate::language::Languages;
use crate::language::degrees::{Degree, Side};
use crate::language::words::{find, split_words};
use crate::rules;
use crate::source::Text;
use labspec_bind::units::parse;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp};
use labspec_expr::dimension::Dimension;
use labspec_expr::{Value, parse_expression, print};

/// Reports a text whose condition requires the other direction. `question` is the text before an option, empty for a statement or a
/// quote. Returns the reason.
pub(super) fn check_direction(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    question: &str,
    (text, condition): (&Text, &Text),
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let languages = bound.stage().languages();
    let tree = parse_expression(condition.as_str()).tree;
    let required = required_order(&tree)?;
    let [smaller, larger] = [required.smaller, required.larger].map(print);
    let measured = |term: &str| {
        let text = Text::derived(term.to_string(), condition.span());
        match bound.find(outcome, &text, &mut Vec::new())?.value {
            Value::Number(x) => Some(x),
            _ => None,
        }
    };
    // The size of a negative number is not its order.
    if [&smaller, &larger].into_iter().any(|term| measured(term).is_none_or(|x| x <= 0.0)) {
        return None;
    }
    let dimension = units::of_claim(bound, outcome, &Text::derived(larger.clone(), condition.span()))?;
    let lower = text.as_str().to_lowercase();
    if languages.comparisons(|c| c.negations).any(|word| find(&lower, word).is_some()) {
        return None;
    }
    let (word, side) = stated_side(&lower, &dimension, languages)?;
    let runs = [run_of(required.smaller)?, run_of(required.larger)?];
    let about = format!("{} {lower}", question.to_lowercase());
    let [subject, reference] = compared_runs(&about, runs, languages)
        .or_else(|| changed_runs(bound, &format!("{question} {}", text.as_str()), runs))?;
    let is_larger = subject == runs[1];
    if is_larger == (side == Side::Larger) {
        return None;
    }
    let message = format!(
        "the text says \"{word}\" of {} beside {}, but its condition requires `{smaller} < {larger}`",
        named(subject),
        named(reference)
    );
    findings.push(
        Finding::error(rules::QUOTE_WRONG, text.span(), message.clone())
            .why("a student who measures both runs finds the other direction")
            .help("exchange the conditions of the options, or correct the text")
            .related(condition.span(), "the condition"),
    );
    Some(message)
}

/// Two terms of one measure in two runs, of which a condition requires the first to be smaller.
struct RequiredOrder<'e> {
    smaller: &'e Expr,
    larger: &'e Expr,
}

/// The order that a condition requires; `None` if it requires none, or that of several pairs.
fn required_order(e: &Expr) -> Option<RequiredOrder<'_>> {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And, left, right } => {
            match (required_order(left), required_order(right)) {
                (Some(one), None) | (None, Some(one)) => Some(one),
                _ => None,
            }
        }
        ExprKind::Binary { op, left, right } => {
            let (smaller, larger) = match is_below(*op, false)? {
                true => (left, right),
                false => (right, left),
            };
            // `a < 0.9 * b` requires `a < b`, `a < 2 * b` does not.
            let (of_smaller, smaller) = multiple(smaller);
            let (of_larger, larger) = multiple(larger);
            let same = measure_of(smaller)? == measure_of(larger)? && run_of(smaller)? != run_of(larger)?;
            (same && of_larger > 0.0 && of_smaller >= of_larger).then_some(RequiredOrder { smaller, larger })
        }
        _ => None,
    }
}

/// A factor, and the term that it multiplies.
fn multiple(e: &Expr) -> (f64, &Expr) {
    if let ExprKind::Binary { op: BinaryOp::Multiply, left, right } = &e.kind {
        if let Some(factor) = constant(left) {
            return (factor, right);
        }
        if let Some(factor) = constant(right) {
            return (factor, left);
        }
    }
    (1.0, e)
}

/// The only word of a text that says that a quantity of this dimension is larger, or smaller.
fn stated_side(lower: &str, dimension: &Dimension, languages: Languages) -> Option<(&'static str, Side)> {
    let is = |unit: &str| parse(unit).is_some_and(|d| d.agrees(dimension));
    let side = |degree: Degree| match degree {
        Degree::Amount(side) => Some(side),
        Degree::Length(side) if is("s") || is("m") => Some(side),
        Degree::Time(side) if is("s") => Some(side),
        Degree::Speed(side) if is("m/s") || is("rad/s") => Some(side),
        // What is faster takes less time.
        Degree::Speed(side) if is("s") => Some(side.opposite()),
        _ => None,
    };
    let mut found = languages.degrees().filter(|(word, _)| find(lower, word).is_some());
    let (word, degree) = found.next()?;
    if found.next().is_some() {
        return None;
    }
    Some((word, side(degree)?))
}

/// The run that a text compares, and the one with which: `a wide swing … than a small one`.
fn compared_runs<'r>(lower: &str, runs: [&'r str; 2], languages: Languages) -> Option<[&'r str; 2]> {
    let mut marks = languages.comparisons(|c| c.than).filter_map(|than| Some((find(lower, than)?, than)));
    let (start, than) = marks.next()?;
    if marks.next().is_some() {
        return None;
    }
    let behind = lower.get(start + than.len()..)?;
    let end = behind.find(['.', ',', ';', '?', '!', ':']).unwrap_or(behind.len());
    let (object, rest) = behind.split_at_checked(end)?;
    let names = |text: &str| runs.map(|run| split_words(text).any(|word| word == run.to_lowercase()));
    let others = [lower.get(..start)?, rest].map(names);
    let elsewhere = |run: usize| others.iter().any(|named| named[run]);
    match names(object) {
        [true, false] if !elsewhere(0) => Some([runs[1], runs[0]]),
        [false, true] if !elsewhere(1) => Some([runs[0], runs[1]]),
        _ => None,
    }
}

/// The run to which a text changes a setting, and the one from which: `from 9.81 m/s² to 1.62 m/s²`.
fn changed_runs<'r>(bound: &BoundVerify<'_>, text: &str, runs: [&'r str; 2]) -> Option<[&'r str; 2]> {
    let languages = bound.stage().languages();
    let stated = quantities_in(text, languages);
    let [from, to] = stated.as_slice() else { return None };
    let lower = text.to_lowercase();
    let number = |text: &str| text.split_whitespace().next().map(str::to_lowercase);
    let first = lower.find(&number(&from.text)?)?;
    let between = lower.get(first..)?.split_once(&number(&to.text)?)?.0;
    if !languages.comparisons(|c| c.to).any(|to| find(between, to).is_some()) {
        return None;
    }
    let has = |run: &str, other: &str, quantity| {
        let given = |name: &str| {
            let (run, scene) = bound.runs_with_scenes().find(|(bound, _)| bound.name == name)?;
            Some(settings_of(bound, run, scene))
        };
        let is = |name: &str| given(name).is_some_and(|all| all.iter().any(|(_, given)| given.is(quantity)));
        is(run) && !is(other)
    };
    let [a, b] = runs;
    match () {
        () if has(a, b, from) && has(b, a, to) => Some([b, a]),
        () if has(b, a, from) && has(a, b, to) => Some([a, b]),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    /// How many findings about a direction there are for a pendulum that swings from 0.1 rad and from 1.5 rad, whose wide swing takes
    /// longer.
    fn found(question: &str, options: &[&str], conditions: &[&str], answer: usize) -> usize {
        let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
        let control = serde_json::json!({"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true});
        let lab = serde_json::json!({"stopAt": 6, "xml": xml, "controls": [control], "setup": "data.qpos[0] = ctx.q"});
        let verify = serde_json::json!({"lab": lab, "runs": {"small": {"set": {"start (rad)": 0.1}}, "wide": {"set": {"start (rad)": 1.5}}},
            "measure": {"T": "period(data.qpos[0])"}, "options": conditions});
        let question = match options {
            [] => serde_json::json!({"kind": "truefalse", "q": question, "answer": true, "verify": verify}),
            _ => {
                serde_json::json!({"kind": "mcq", "q": question, "options": options, "answer": answer, "verify": verify})
            }
        };
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        report
            .findings
            .iter()
            .filter(|finding| finding.message.contains("but its condition requires"))
            .count()
    }

    #[test]
    fn the_other_direction_is_found() {
        let wide = &["wide.T > small.T"][..];
        for (text, count) in [
            ("A wide swing takes less time than a small one.", 1),
            ("A wide swing is faster than a small one.", 1),
            ("Than a small swing, a wide one is never shorter.", 0),
            ("A wide swing takes more time than a small one.", 0),
            ("A wide swing is slower than a small one.", 0),
            ("A small swing is shorter than a wide one.", 0),
            ("A small swing is longer than a wide one.", 1),
        ] {
            assert_eq!(found(text, &[], wide, 0), count, "{text}");
        }
        let conditions = &["wide.T > 1.05 * small.T", "wide.T < 0.95 * small.T"];
        for (question, right, wrong) in [
            (
                "How does a wide swing compare with a small one?",
                ["It is longer", "It is shorter"],
                ["It is shorter", "It is longer"],
            ),
            (
                "The start is changed from 0.1 rad to 1.5 rad. What happens to the period?",
                ["It grows", "It shrinks"],
                ["It shrinks", "It grows"],
            ),
        ] {
            assert_eq!(found(question, &right, conditions, 0), 0, "{question}");
            assert_eq!(found(question, &wrong, conditions, 0), 1, "{question}");
        }
        let back = "The start is changed from 1.5 rad to 0.1 rad. What happens to the period?";
        assert_eq!(found(back, &["It grows", "It shrinks"], conditions, 0), 1);
    }

    #[test]
    fn a_quote_states_a_direction_too() {
        let found = |quote: &str| {
            let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
            let control = serde_json::json!({"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true});
            let verify = serde_json::json!({"runs": {"small": {}, "wide": {"set": {"start (rad)": 1.5}}}, "measure": {"T": "period(data.qpos[0])"},
                "says": [[quote, "wide.T > small.T"]]});
            let lab = serde_json::json!({"stopAt": 6, "xml": xml, "controls": [control], "setup": "data.qpos[0] = ctx.q", "plots": [], "verify": verify});
            let lesson = format!("A wide swing takes {quote}.\n\n```lab simlab\n{lab}\n```\n");
            let report = crate::Checker::new(|_: &str| None::<String>).check("l.md", &lesson);
            report
                .findings
                .iter()
                .filter(|finding| finding.message.contains("but its condition requires"))
                .count()
        };
        assert_eq!(found("less time than a small one"), 1);
        assert_eq!(found("more time than a small one"), 0);
    }
}
