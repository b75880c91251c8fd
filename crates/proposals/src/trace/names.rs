//! Names of runs and measures, as an author would choose them.

use super::candidates::Candidate;
use super::words::split_words;
use labspec::json::Scalar;
use labspec::spec::{Control, ControlKind};

/// The maximum number of words of a name.
const WORDS: usize = 2;
/// Words that carry no information in a name.
const FILLERS: [&str; 24] = [
    "data", "model", "with", "contact", "joint", "math", "time", "opt", "1000", "the", "and", "for", "from",
    "qpos", "qvel", "lib", "start", "initial", "abs", "left", "right", "free", "geom", "body",
];

/// The words of a text as a part of a name: `mass of the bob` becomes `mass_bob`.
pub(super) fn slug(text: &str) -> String {
    let words: Vec<String> = split_words(text).collect();
    let meaningful: Vec<&String> =
        words.iter().filter(|w| !FILLERS.contains(&w.as_str())).take(WORDS).collect();
    // Words such as "left" count where there are no others.
    let chosen = if meaningful.is_empty() { words.iter().take(WORDS).collect() } else { meaningful };
    let joined = chosen.into_iter().map(String::as_str).collect::<Vec<_>>().join("_");
    joined.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').collect()
}

/// The name of a run in which a control has a value: `mass_10`, `wide`.
pub(crate) fn named_value(control: &Control, value: &Scalar) -> String {
    let option = match &control.kind {
        ControlKind::Select { options, .. } => options.iter().find(|choice| choice.value == *value),
        _ => None,
    };
    match (option, value) {
        (Some(choice), _) => match slug(choice.text.as_str()) {
            text if text.is_empty() => {
                format!("{}_{}", slug(control.label.as_str()), symbol(choice.text.as_str()))
            }
            text => text,
        },
        (None, Scalar::Number(n)) => format!("{}_{}", slug(control.label.as_str()), digits(n.value)),
        (None, _) => slug(control.label.as_str()),
    }
}

/// A short text as a part of a name.
fn symbol(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// A number as a part of a name: `0_02`, `minus_1_5`.
pub(super) fn digits(x: f64) -> String {
    x.to_string().replace('-', "minus_").replace('.', "_")
}

/// The name of a measure.
pub(super) fn measure_name(c: &Candidate) -> String {
    let label = if c.label.is_empty() { String::new() } else { slug(&c.label) };
    let with = |prefix: &str| match label.as_str() {
        "" => prefix.to_string(),
        label => format!("{prefix}_{label}"),
    };
    let text = c.text.as_str();
    let of_object = || text.split('\'').nth(1).map_or(String::new(), slug);
    if let Some(constant) = c.constant.as_ref() {
        let (_, field) = text.rsplit_once('.').unwrap_or(("", text));
        let field = field.split('[').next().unwrap_or(field);
        let owner = if constant.owner.is_empty() { String::new() } else { of_object() };
        return if owner.is_empty() { field.to_string() } else { format!("{field}_{owner}") };
    }
    match () {
        () if text.starts_with("period(") => "period".into(),
        () if text.starts_with("crossing(") => with("crossing"),
        () if text.starts_with("first(contact(") && text.ends_with("timestep") => "before_touch".into(),
        () if text.starts_with("first(contact(") => "touch".into(),
        () if text.starts_with("before(contact(") => with("impact"),
        () if text.starts_with("at(contact(") => with("touching"),
        () if text.starts_with("model.geom(") => "depth".into(),
        () if text.starts_with("max(") && text.contains(" - min(") => with("range"),
        () => {
            let function = text.split('(').next().unwrap_or("value");
            match c.time {
                Some(t) => format!("{}_at_{}", if label.is_empty() { "value" } else { &label }, digits(t)),
                None => with(function),
            }
        }
    }
}
