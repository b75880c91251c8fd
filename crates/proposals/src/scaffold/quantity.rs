//! The quantity that a question asks for, and the measures of a lab that it can mean.

use super::relation::Directions;
use super::words::{contains_any, contains_words};
use crate::trace::{Candidate, split_words};
use std::collections::BTreeSet;

/// A quantity: the words that ask for it, its units, and the measures that it can mean.
struct Quantity {
    words: &'static [&'static str],
    units: &'static [&'static str],
    /// The beginnings of measures, where the question does not say which value of a run counts: the first one that has values.
    measures: &'static [&'static str],
    /// Whether the question must be about a time.
    is_time: bool,
    /// Its own words for more and less.
    directions: Directions,
}

const fn quantity(
    words: &'static [&'static str],
    units: &'static [&'static str],
    measures: &'static [&'static str],
    up: &'static [&'static str],
    down: &'static [&'static str],
) -> Quantity {
    Quantity { words, units, measures, is_time: false, directions: Directions { up, down } }
}

impl Quantity {
    fn is_depth(&self) -> bool {
        self.measures.contains(&"model.geom(")
    }

    /// Whether its measures are times and depths, of which no other value counts.
    fn is_own(&self) -> bool {
        self.units == ["s"] || self.is_depth()
    }
}

/// Words that name nothing.
const FILLERS: [&str; 11] =
    ["the", "and", "for", "with", "from", "each", "other", "how", "what", "which", "after"];

/// Words in the labels of displayed depths.
const DEPTH_LABELS: [&str; 6] = ["depth", "deep", "floor", "penetration", "sink", "past"];

/// The quantities; the first one whose words occur counts.
const QUANTITIES: [Quantity; 11] = [
    quantity(
        &["period", "oscillation time", "one swing", "each swing", "one turn", "one oscillation"],
        &["s"],
        &["period("],
        &["longer"],
        &["shorter"],
    ),
    Quantity {
        is_time: true,
        ..quantity(
            &["touchdown", "touches", "touch", "lands", "land", "hits", "hit"],
            &["s"],
            &["first(contact("],
            &["later"],
            &["earlier", "sooner"],
        )
    },
    quantity(
        &["deep", "deeper", "depth", "sinks", "sink", "penetration"],
        &["m"],
        &["model.geom(", "final("],
        &["deeper"],
        &["shallower"],
    ),
    quantity(
        &["how high", "height", "higher", "climbs", "climb"],
        &["m"],
        &["max("],
        &["higher"],
        &["lower"],
    ),
    quantity(
        &["how far", "farther", "further", "distance"],
        &["m", "rad"],
        &["max("],
        &["farther", "further"],
        &["nearer", "closer"],
    ),
    quantity(&["energy"], &["J"], &["max(", "final("], &[], &[]),
    quantity(&["torque"], &["N m"], &["max(", "final("], &["stronger"], &["weaker"]),
    quantity(
        &["force", "pushes", "presses", "pull", "tension"],
        &["N"],
        &["max(", "final("],
        &["stronger", "harder"],
        &["weaker"],
    ),
    quantity(
        &["speed", "speeds", "fast", "faster", "fastest", "velocity", "slow", "slower", "slowest"],
        &["m/s", "rad/s"],
        &["max(", "final("],
        &["faster", "quicker"],
        &["slower"],
    ),
    quantity(&["angle", "tilt", "amplitude"], &["rad"], &["max("], &["wider"], &["narrower"]),
    quantity(
        &["slides", "slips", "creeps", "tunnels", "falls", "is held"],
        &["m"],
        &["final("],
        &["farther", "further"],
        &[],
    ),
];

/// Words for a time, in questions about contacts.
const TIME_WORDS: [&str; 9] =
    ["when", "earlier", "later", "sooner", "first", "before", "how long", "time", "detected"];

/// Words for the value of a run that counts, with the beginning of the measure.
const VALUES: [(&str, &[&str]); 5] = [
    (
        "max(",
        &[
            "largest", "greatest", "highest", "maximum", "maximal", "peak", "top", "reach", "reaches",
            "climb", "climbs",
        ],
    ),
    ("min(", &["smallest", "lowest", "minimum", "minimal", "nearest"]),
    ("before(contact(", &["impact", "on landing", "just before"]),
    (
        "final(",
        &[
            "rest",
            "rests",
            "at the end",
            "finally",
            "comes to",
            "settles",
            "settle",
            "steady",
            "after the",
            "afterwards",
            "leave",
            "leaves",
            "left over",
        ],
    ),
    ("mean(", &["average", "mean"]),
];

/// Words with which a question begins to ask.
const ASKING: [&str; 9] =
    ["how", "what", "which", "when", "where", "with which", "with what", "at which", "by how"];

/// Whether the largest or the smallest value is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Extreme {
    Largest,
    Smallest,
}

/// Words for the larger and the smaller one of several objects, of any quantity and of one.
const LARGER: [&str; 12] = [
    "larger",
    "largest",
    "greater",
    "greatest",
    "bigger",
    "biggest",
    "more",
    "most",
    "stronger",
    "strongest",
    "highest",
    "maximum",
];
const SMALLER: [&str; 8] = ["smaller", "smallest", "less", "least", "weaker", "weakest", "lowest", "minimum"];
/// The words of a quantity, by a word for more of it: the larger and the largest, the smaller and the smallest.
const EXTREMES: [(&str, [&str; 2], [&str; 2]); 5] = [
    ("faster", ["faster", "fastest"], ["slower", "slowest"]),
    ("higher", ["higher", "highest"], ["lower", "lowest"]),
    ("farther", ["farther", "farthest"], ["nearer", "nearest"]),
    ("longer", ["longer", "longest"], ["shorter", "shortest"]),
    ("deeper", ["deeper", "deepest"], ["shallower", "shallowest"]),
];

/// The extreme that a question asks for. Its word must be one of the quantity that it asks for, or one of any quantity.
pub(super) fn extreme(question: &str) -> Option<Extreme> {
    let asking = asking_part(question);
    let up = row(question, asking, "").map_or(&[][..], |q| q.directions.up);
    let extremes = EXTREMES.iter().find(|(word, ..)| up.contains(word));
    let own_words =
        |k: usize| extremes.map_or(&[][..], |(_, larger, smaller)| if k == 0 { larger } else { smaller });
    let [larger, smaller] = [(&LARGER[..], 0), (&SMALLER[..], 1)]
        .map(|(general, k)| contains_any(asking, general) || contains_any(asking, own_words(k)));
    match (larger, smaller) {
        (true, false) => Some(Extreme::Largest),
        (false, true) => Some(Extreme::Smallest),
        _ => None,
    }
}

/// The quantity of a question.
pub(super) struct AskedQuantity {
    /// The measures that it can mean, by their indexes: if those of a group have no value, those of the next one count.
    pub(super) groups: Vec<Vec<usize>>,
    /// Its own words for more and less.
    pub(super) directions: Directions,
    /// Whether the question states which value of a run counts.
    pub(super) is_explicit: bool,
}

/// The part of a text that asks: its last sentence, from the clause that begins with a word such as "how".
pub(super) fn asking_part(text: &str) -> &str {
    let text = text.trim();
    let ends = |(i, c): (usize, char)| {
        matches!(c, '.' | '?' | '!' | ':') && text.get(i + 1..).is_some_and(|rest| rest.starts_with(' '))
    };
    let last =
        text.char_indices().filter(|(i, c)| ends((*i, *c))).map(|(i, _)| i + 1).next_back().unwrap_or(0);
    let sentence = text.get(last..).unwrap_or(text).trim();
    let clause = sentence.match_indices(", ").map(|(i, _)| sentence.get(i + 2..).unwrap_or(""));
    let asks = |clause: &&str| {
        ASKING.iter().any(|word| clause.strip_prefix(word).is_some_and(|rest| rest.starts_with(' ')))
    };
    clause.into_iter().find(asks).unwrap_or(sentence)
}

/// The measures of a lab that a question can mean. There are none if the question names no quantity that the lab has.
/// `times` are the times that the question states, s, and `end` is the time at which the lab ends by itself.
pub(super) fn measures(
    candidates: &[Candidate],
    question: &str,
    options: &str,
    times: &[f64],
    end: Option<f64>,
) -> AskedQuantity {
    let asking = asking_part(question);
    let row = row(question, asking, options);
    let value = VALUES.iter().find(|(_, words)| contains_any(asking, words));
    let asked: BTreeSet<String> = split_words(question).collect();
    let labelled = |c: &Candidate| label_words(c, asking);
    let kinds: Vec<&str> = match (row, value) {
        // Times and depths are measures of their own.
        (Some(q), _) if q.is_own() => q.measures.to_vec(),
        (_, Some((form, _))) => vec![form],
        (Some(q), None) => q.measures.to_vec(),
        (None, None) => vec!["final("],
    };
    let is_end = |t: f64| end.is_none_or(|end| (end - t).abs() <= 1e-6 * t);
    let fits = |c: &Candidate, kind: &str| {
        let of_time = match c.time {
            Some(t) => times.contains(&t) && !is_end(t),
            None => !c.text.ends_with("- model.opt.timestep"),
        };
        if c.constant.is_some() || !of_time || is_span(c) || is_formula(c) {
            return false;
        }
        let has_unit = |unit: &&str| labspec_bind::units::parse(unit).is_some_and(|d| d.agrees(&c.dimension));
        match row {
            Some(q) if !q.units.iter().any(has_unit) => false,
            // A displayed depth says so.
            Some(q) if q.is_depth() && kind == "final(" => {
                c.text.starts_with(kind) && DEPTH_LABELS.iter().any(|w| c.words.contains(*w))
            }
            Some(q) if q.is_own() => c.text.starts_with(kind),
            // Without a known quantity, the question must name the whole label, or a part of it and the value that counts.
            None if labelled(c) == 0 && (value.is_none() || !shares_label(c, &asked)) => false,
            _ => match (c.time, times) {
                (Some(_), _) => true,
                (None, [t]) if is_end(*t) => c.text.starts_with("final("),
                (None, [_, ..]) => false,
                (None, []) => c.text.starts_with(kind),
            },
        }
    };
    let asking_words: BTreeSet<String> = split_words(asking).collect();
    let shared = |words: &BTreeSet<String>, i: &usize| {
        let is_shared = |w: &&String| words.contains(*w) && !FILLERS.contains(&w.as_str());
        let named = |c: &Candidate| c.words.iter().filter(is_shared).count() + 2 * labelled(c);
        candidates.get(*i).map_or(0, named)
    };
    // What the whole question names, otherwise what the asking part names: "the speed is raised; what is the period?"
    let group = |kind: &&str| {
        let fitting = candidates.iter().enumerate().filter(|(_, c)| fits(c, kind)).map(|(i, _)| i);
        let fitting: Vec<usize> = fitting.collect();
        [&asked, &asking_words].map(|words| simplest(candidates, fitting.clone(), &|i| shared(words, i)))
    };
    let mut groups: Vec<Vec<usize>> =
        kinds.iter().flat_map(group).filter(|group| !group.is_empty()).collect();
    groups.dedup();
    let directions = row.map_or(Directions::default(), |q| q.directions);
    AskedQuantity { groups, directions, is_explicit: value.is_some() }
}

/// The quantity that the asking part names, otherwise the whole question, otherwise most options.
fn row(question: &str, asking: &str, options: &str) -> Option<&'static Quantity> {
    let is_asked = |q: &&Quantity, text: &str| {
        let is_time = || contains_any(question, &TIME_WORDS) || contains_any(options, &TIME_WORDS);
        contains_any(text, q.words) && (!q.is_time || is_time())
    };
    let named = |text: &str| QUANTITIES.iter().find(|q| is_asked(q, text));
    named(asking).or_else(|| {
        let count = |q: &Quantity| options.lines().filter(|option| is_asked(&q, option)).count();
        let most = QUANTITIES.iter().map(count).max().filter(|most| *most > 0);
        most.and_then(|most| QUANTITIES.iter().find(|q| count(q) == most)).or_else(|| named(question))
    })
}

/// Of these candidates those that share most words with the question, and of those the simplest ones.
fn simplest(candidates: &[Candidate], fitting: Vec<usize>, shared: &dyn Fn(&usize) -> usize) -> Vec<usize> {
    let most = fitting.iter().map(shared).max().unwrap_or(0);
    let named: Vec<usize> = fitting.into_iter().filter(|i| shared(i) == most).collect();
    let cost = |i: &usize| candidates.get(*i).map_or(f64::INFINITY, |c| c.cost);
    let least = named.iter().map(cost).fold(f64::INFINITY, f64::min);
    named.into_iter().filter(|i| cost(i) <= least + SAME_COST).collect()
}

/// The number of words of a label, if a text contains all of them.
fn label_words(c: &Candidate, text: &str) -> usize {
    let words: Vec<String> = split_words(&c.label).collect();
    if words.iter().all(|word| contains_words(text, word)) { words.len() } else { 0 }
}

fn shares_label(c: &Candidate, asked: &BTreeSet<String>) -> bool {
    split_words(&c.label).any(|word| asked.contains(&word))
}

/// Measures whose costs differ by less than this are equally simple.
const SAME_COST: f64 = 0.25;

/// Whether a displayed value is a formula of the model alone, which no run changes.
fn is_formula(c: &Candidate) -> bool {
    c.text.contains("model.")
        && !["data.", "lib.", "ctx.", "contact("].iter().any(|part| c.text.contains(part))
}

/// Whether a measure is the difference of the largest and the smallest value.
fn is_span(c: &Candidate) -> bool {
    c.text.starts_with("max(") && c.text.contains(" - min(")
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec_expr::dimension::Dimension;

    fn candidate(text: &str, unit: &str, label: &str) -> Candidate {
        Candidate {
            text: text.to_string(),
            dimension: labspec_bind::units::parse(unit).unwrap_or(Dimension::NUMBER),
            cost: 2.0,
            words: split_words(label).collect(),
            constant: None,
            label: label.to_string(),
            time: None,
        }
    }

    #[test]
    fn the_last_clause_asks() {
        for (text, part) in [
            ("a ball of 0.5 m falls. how fast is it?", "how fast is it?"),
            ("if the mass is doubled, what becomes of the period?", "what becomes of the period?"),
            ("it rises, then falls", "it rises, then falls"),
        ] {
            assert_eq!(asking_part(text), part);
        }
    }

    #[test]
    fn questions_select_measures() {
        let all = [
            candidate("period(data.qpos[0])", "s", "angle"),
            candidate("final(data.qpos[0])", "rad", "angle"),
            candidate("max(data.qpos[0])", "rad", "angle"),
            candidate("max(data.qvel[0])", "rad/s", "speed"),
            candidate("final(data.qvel[0])", "rad/s", "speed"),
            candidate("first(contact('a', 'b'))", "s", ""),
            candidate("final(data.qpos[2])", "m", "ball height"),
            candidate("final(data.qpos[9])", "m", "cube height"),
        ];
        let select = |question: &str, times: &[f64], end: Option<f64>| {
            let asked = measures(&all, question, "", times, end);
            asked.groups.first().into_iter().flatten().map(|i| all[*i].text.as_str()).collect::<Vec<_>>()
        };
        for (question, times, end, found) in [
            ("what happens to the period?", &[][..], None, &["period(data.qpos[0])"][..]),
            ("how fast does it get?", &[], None, &["max(data.qvel[0])"]),
            ("how fast is it after 2 s?", &[2.0], Some(2.0), &["final(data.qvel[0])"]),
            ("how fast is it after 1 s?", &[1.0], Some(2.0), &[]),
            ("what is the largest speed?", &[], None, &["max(data.qvel[0])"]),
            ("when does it land?", &[], None, &["first(contact('a', 'b'))"]),
            ("how does it land?", &[], None, &[]),
            ("at which height does the cube rest?", &[], None, &["final(data.qpos[9])"]),
            ("what happens?", &[], None, &[]),
            ("why?", &[], None, &[]),
            ("the speed is doubled. what happens to the angle?", &[], None, &["max(data.qpos[0])"]),
            ("with twice the speed, what is the period?", &[], None, &["period(data.qpos[0])"]),
        ] {
            assert_eq!(select(question, times, end), found, "{question}");
        }
    }
}
