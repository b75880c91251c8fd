//! Selection of the origin of a number: the simplest measure with its digits, unless chance explains the match.

use super::candidates::{Candidate, ConstantWords, is_shape};
use super::formula::{self, Binding};
use super::lab::TracedLab;
use super::origin::{MeasureMatch, Origin};
use super::trials::TraceRun;
use super::units::{round, second, si};
use super::words::split_words;
use labspec::bind::given_by;
use labspec::run::settings;
use labspec::spec::ControlKind;
use labspec::verify::Stated;
use labspec_expr::Value;
use labspec_expr::dimension::Measure;
use std::collections::BTreeSet;

/// A match with a lower probability than this is not explained by chance.
const CHANCE: f64 = 0.05;
/// Numbers of one kind are assumed to be distributed over three decades.
const DECADES: f64 = 3.0;
/// The cost of a number with the opposite sign.
const OTHER_SIDE: f64 = 0.3;
/// The cost of a run whose setting the text does not name near the number, and of one whose setting the paragraph names.
const FAR_COST: f64 = 1.5;
const IN_PARAGRAPH: f64 = 0.7;
/// The cost of a run without some changes of the lab's setup.
const RESTORED: f64 = 1.0;
/// A time counts as near if it is named within this many bytes; its cost is `NEARBY`.
const NEAR_DISTANCE: usize = 2500;
const NEARBY: f64 = 0.4;
/// The reward for a word that also occurs in the sentence, and the maximum number of rewarded words.
const SENTENCE_REWARD: f64 = 0.4;
const MOST_WORDS: usize = 3;
/// The reward for a word that occurs only in the paragraph.
const PARAGRAPH_REWARD: f64 = 0.25;
/// The cost of each lab of another model between a number and the lab, and of a lab of another question.
const LAB: f64 = 0.3;
const OTHER_QUESTION: f64 = 0.8;
/// The cost of a constant that neither the sentence nor the paragraph mentions, and of one that the paragraph mentions.
const UNNAMED: f64 = 1.5;
const NAMED_NEAR: f64 = 0.4;
/// Words for the start of a run.
const START_WORDS: [&str; 16] = [
    "start",
    "starts",
    "started",
    "starting",
    "initial",
    "initially",
    "first",
    "begins",
    "beginning",
    "before",
    "release",
    "released",
    "dropped",
    "from",
    "comes",
    "had",
];
/// The cost of a setting if another value of the same control is named nearer to the number.
const NAMED_NEARER: f64 = 0.5;
/// The reward for a value of the run of another number of the paragraph, or for the measure of another number in another run.
const SIBLING_REWARD: f64 = 0.6;
/// The cost of a value that equals the printed number exactly.
const EXACT: f64 = 0.5;
/// Two constants of different kinds whose costs differ by less than this are ambiguous.
const MIN_COST_RATIO: f64 = 1.2;

/// A candidate with the digits of a number, and its cost.
pub(super) struct CandidateMatch {
    pub(super) cost: f64,
    /// Whether it is a constant of the model.
    constant: bool,
    pub(super) hit: MeasureMatch,
}

/// The origins of other numbers of a paragraph that are more certain.
#[derive(Default)]
pub(super) struct Siblings<'a> {
    pub(super) all: Vec<&'a MeasureMatch>,
    /// The measure that also gives the number with which the sentence contrasts this one.
    pub(super) contrasted: Option<&'a str>,
}

/// Determines the origin of a number.
pub(super) fn origin(
    s: &Stated,
    numbers: &[Stated],
    labs: &[TracedLab<'_>],
    bindings: &[Binding],
    siblings: &Siblings<'_>,
) -> Origin {
    let around = NumberContext::new(s, numbers);
    if si(s) == 0.0 || s.bound {
        return Origin::Unknown;
    }
    let window = 2.0 * s.read.half_unit / s.read.value.abs() / (DECADES * std::f64::consts::LN_10);
    let window = window.min(1.0);
    if let Some(words) = around.slider(s, labs) {
        return Origin::Setting(words);
    }
    if let Some(hit) = formula_hit(s, bindings, window).filter(|hit| hit.chance < CHANCE) {
        return Origin::From(hit);
    }
    let (tried, mut matches) = compare_values(s, &around, labs, siblings);
    matches.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let ambiguous = is_ambiguous(&matches);
    let Some(CandidateMatch { cost, mut hit, .. }) = matches.into_iter().next() else {
        return Origin::Unknown;
    };
    // Both constants and rounded numbers have few digits, so exact equality of a constant is weaker evidence.
    let exact = close(hit.value, s.read.value);
    let cost = if exact { cost + EXACT } else { cost };
    let mut simpler: Vec<f64> = tried.iter().filter(|(c, _)| *c <= cost).map(|(_, x)| *x).collect();
    simpler.sort_by(f64::total_cmp);
    simpler.dedup_by(|a, b| close(*a, *b));
    let window = if exact { window / 2.0 } else { window };
    hit.chance = 1.0 - (1.0 - window).powf(simpler.len() as f64);
    if hit.chance < CHANCE && !ambiguous {
        return Origin::From(hit);
    }
    Origin::Chance(hit)
}

/// Compares a number with every value of its dimension: returns the cost and the size of each value, and those with its digits.
pub(super) fn compare_values(
    s: &Stated,
    around: &NumberContext<'_>,
    labs: &[TracedLab<'_>],
    siblings: &Siblings<'_>,
) -> (Vec<(f64, f64)>, Vec<CandidateMatch>) {
    let mut tried: Vec<(f64, f64)> = Vec::new();
    let mut matches: Vec<CandidateMatch> = Vec::new();
    let distances = distances(s, labs);
    let nearest: BTreeSet<&str> = labs
        .iter()
        .zip(&distances)
        .filter(|(_, far)| **far < LAB)
        .flat_map(|(lab, _)| &lab.candidates)
        .filter_map(|c| c.constant.as_ref())
        .flat_map(|constant| constant.owner.iter().map(String::as_str))
        .collect();
    let contrasted = siblings.contrasted;
    let filter = CandidateFilter { s, around, nearest, object: object(s, labs), contrasted };
    for (l, lab) in labs.iter().enumerate() {
        let far = distances.get(l).copied().unwrap_or(0.0);
        for (t, (trial, values)) in lab.trials.iter().zip(&lab.values).enumerate() {
            let run = around.cost(trial, &lab.trials);
            for (c, &value) in lab.candidates.iter().zip(values) {
                if !filter.accepts(c, value, (lab, t, far)) {
                    continue;
                }
                let start = if is_start(lab, values, c, value) { around.cost_of_start() } else { 0.0 };
                let reward = if is_beside(siblings, (l, t), &c.text) { SIBLING_REWARD } else { 0.0 };
                let cost = around.cost_of_candidate(c, run, far) + start - reward;
                let ratio = s.dimension.factor / c.dimension.factor;
                let in_unit = value * ratio;
                tried.push((cost, in_unit.abs()));
                for (sign, more) in [("", 0.0), ("-", OTHER_SIDE)] {
                    let value = if sign.is_empty() { in_unit } else { -in_unit };
                    if !s.read.is(value) {
                        continue;
                    }
                    let (place, measure, factor) = (Some((l, t)), c.text.clone(), factor(sign, ratio));
                    let exact = if close(value, s.read.value) { EXACT } else { 0.0 };
                    matches.push(CandidateMatch {
                        cost: cost + more - exact,
                        constant: c.constant.is_some(),
                        hit: MeasureMatch { place, measure, factor, value, chance: 1.0, fragile: false },
                    });
                }
            }
        }
    }
    (tried, matches)
}

/// Whether other numbers of the paragraph have this run, or this measure.
fn is_beside(siblings: &Siblings<'_>, run: (usize, usize), measure: &str) -> bool {
    siblings.all.iter().any(|sibling| sibling.place == Some(run) || sibling.measure == measure)
}

/// Which candidates can be the origin of a number.
struct CandidateFilter<'a> {
    s: &'a Stated,
    around: &'a NumberContext<'a>,
    /// The words for the objects of the nearest lab.
    nearest: BTreeSet<&'a str>,
    /// The object that the number describes.
    object: Option<String>,
    /// The measure of the number with which this one is contrasted.
    contrasted: Option<&'a str>,
}

impl CandidateFilter<'_> {
    /// Whether a value of a candidate can be the origin: in a run of a lab at this distance, by its index.
    fn accepts(&self, c: &Candidate, value: f64, (lab, run, far): (&TracedLab<'_>, usize, f64)) -> bool {
        let CandidateFilter { s, around, nearest, object, contrasted } = self;
        if contrasted.is_some_and(|measure| c.text != measure) {
            return false;
        }
        if !c.dimension.agrees(&s.dimension) || !value.is_finite() || value == 0.0 {
            return false;
        }
        // A share is no angle.
        if s.unit.starts_with(['%', '‰']) && c.dimension.has_angle() {
            return false;
        }
        // A constant that the sentence does not name, and a force at its limit, have these digits by coincidence.
        let is_named = c.constant.as_ref().is_none_or(|words| around.names(words, far, nearest));
        if !is_named || c.text.contains("_force") && lab.is_limit(value / c.dimension.factor) {
            return false;
        }
        // A length of an object is a constant of it.
        let is_owner = |object: &String| c.constant.as_ref().is_some_and(|c| c.owner.contains(object));
        if object.as_ref().is_some_and(|object| !is_owner(object)) {
            return false;
        }
        // What the run sets is no result of it, and neither is a constant.
        let trial = lab.trials.get(run);
        let sets_it = trial.and_then(|trial| trial.named).is_some_and(|(x, _)| close(x, si(s)));
        let is_set = trial.is_some_and(|trial| is_set(trial, value / c.dimension.factor));
        if c.constant.is_some() && (sets_it || run > 0) || c.constant.is_none() && sets_it && is_set {
            return false;
        }
        // A time is not what is measured at this time.
        let is_read_then = c.time.is_some_and(|x| close(x, si(s)));
        !is_read_then || !sets_it && !c.dimension.agrees(&second())
    }
}

/// The object that a length or a mass describes: "the 40 mm cube", "a rod of 0.5 m".
fn object(s: &Stated, labs: &[TracedLab<'_>]) -> Option<String> {
    let is_property = ["m", "kg"]
        .iter()
        .any(|unit| labspec_bind::units::parse(unit).is_some_and(|dimension| dimension.agrees(&s.dimension)));
    let (before, rest) = (s.paragraph.get(..s.offset)?, s.paragraph.get(s.offset..)?);
    let after = rest.find(s.unit.as_str()).and_then(|start| rest.get(start + s.unit.len()..)).unwrap_or("");
    let next = after.strip_prefix(' ').and_then(|after| after.split(|c: char| !c.is_alphanumeric()).next());
    let of = before
        .trim_end()
        .strip_suffix(" of")
        .and_then(|text| text.rsplit(|c: char| !c.is_alphanumeric()).next());
    let is_object = |word: &String| {
        let mut constants = labs.iter().flat_map(|lab| &lab.candidates).filter_map(|c| c.constant.as_ref());
        is_shape(word) || constants.any(|constant| constant.owner.contains(word))
    };
    let named = [next, of].into_iter().flatten().map(str::to_lowercase).find(is_object);
    named.filter(|_| is_property && !s.unit.is_empty())
}

/// Whether a run sets a value, with either sign.
fn is_set(trial: &TraceRun, value: f64) -> bool {
    trial.named.is_some_and(|(x, _)| close(value.abs(), x.abs()))
}

/// Whether a measure is the value of the start: what the lab sets, not what its run gives.
fn is_start(lab: &TracedLab<'_>, values: &[f64], c: &Candidate, value: f64) -> bool {
    if c.text.starts_with("initial(") {
        return true;
    }
    let Some(inner) = c.text.strip_prefix("max(").or_else(|| c.text.strip_prefix("min(")) else {
        return false;
    };
    let initial = lab.initial(inner).and_then(|i| values.get(i)).copied();
    initial.is_some_and(|start| close(value, start))
}

/// Whether the best match is a constant, and a constant of another kind is about as good.
fn is_ambiguous(matches: &[CandidateMatch]) -> bool {
    let [best, others @ ..] = matches else { return false };
    let kind = |m: &CandidateMatch| m.hit.measure.rsplit('.').next().unwrap_or("").to_string();
    let rivals =
        |m: &CandidateMatch| m.constant && m.cost - best.cost < MIN_COST_RATIO && kind(m) != kind(best);
    best.constant && others.iter().any(rivals)
}

pub(super) fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * b.abs()
}

/// The formula before a number, if it has its digits. `window` is the share of numbers that have them.
fn formula_hit(s: &Stated, bindings: &[Binding], window: f64) -> Option<MeasureMatch> {
    let found = formula::before(s, bindings)?;
    let hit = |factor: String, value: f64| MeasureMatch {
        place: None,
        measure: found.code.clone(),
        factor,
        value,
        // It may be read in two ways.
        chance: 1.0 - (1.0 - window).powi(2),
        fragile: false,
    };
    let ratio = s.dimension.factor;
    // Its numbers are in SI units, or all in the unit of the result.
    let all = [hit(factor("", ratio), found.value * ratio), hit(String::new(), found.value)];
    all.into_iter().find(|hit| s.read.is(hit.value))
}

/// The factor from one unit to another.
pub(crate) fn factor(sign: &str, ratio: f64) -> String {
    if close(ratio, 1.0) {
        return sign.to_string();
    }
    let near = |x: f64| close(x, x.round()) && x.round() != 0.0;
    match ratio {
        r if near(r) => format!("{sign}{} * ", r.round()),
        r if near(1.0 / r) => format!("{sign}1 / {} * ", (1.0 / r).round()),
        r => format!("{sign}{r} * "),
    }
}

/// The distance of each lab: the number of labs of other models in between, and whether it belongs to another question.
fn distances(s: &Stated, labs: &[TracedLab<'_>]) -> Vec<f64> {
    let away = |tried: &TracedLab<'_>| {
        let span = &tried.lab.span;
        span.start.saturating_sub(s.span.start).max(s.span.start.saturating_sub(span.end))
    };
    let mut order: Vec<usize> = (0..labs.len()).collect();
    order.sort_by_key(|i| labs.get(*i).map(away));
    let mut all = vec![0.0; labs.len()];
    let mut models: Vec<Option<&str>> = Vec::new();
    for i in order {
        let (Some(tried), Some(place)) = (labs.get(i), all.get_mut(i)) else { continue };
        let name = tried.lab.model.as_ref().map(|m| m.as_str());
        let rank = match models.iter().position(|model| name.is_some() && *model == name) {
            Some(rank) => rank,
            None => {
                models.push(name);
                models.len() - 1
            }
        };
        let inside = tried.owner.as_ref().is_none_or(|owner| owner.contains(&s.span.start));
        *place = LAB * rank as f64 + if inside { 0.0 } else { OTHER_QUESTION };
    }
    all
}

/// The text around a number.
pub(super) struct NumberContext<'n> {
    words: BTreeSet<String>,
    /// The words of the whole paragraph.
    wide: BTreeSet<String>,
    text: String,
    beside: Vec<&'n Stated>,
    paragraph: Vec<&'n Stated>,
    near: Vec<&'n Stated>,
    /// The place of the number in the file.
    offset: usize,
}

impl<'n> NumberContext<'n> {
    pub(super) fn new(s: &Stated, numbers: &'n [Stated]) -> NumberContext<'n> {
        let other = |n: &&Stated| n.span != s.span;
        let beside = numbers.iter().filter(other).filter(|n| n.context == s.context).collect();
        let paragraph = numbers.iter().filter(other).filter(|n| n.paragraph == s.paragraph).collect();
        let text = format!("{} {}", s.context, s.column).to_lowercase();
        let wide = split_words(&s.paragraph).collect();
        let near = numbers.iter().filter(|n| n.span.start.abs_diff(s.span.start) < NEAR_DISTANCE).collect();
        NumberContext {
            words: split_words(&text).collect(),
            wide,
            text,
            beside,
            paragraph,
            near,
            offset: s.span.start,
        }
    }

    /// The cost of a time for this number.
    fn time(&self, t: f64) -> f64 {
        let among = |list: &[&Stated]| list.iter().any(|n| close(si(n), t));
        match () {
            () if among(&self.beside) || among(&self.paragraph) => 0.0,
            () if among(&self.near) => NEARBY,
            () => FAR_COST,
        }
    }

    /// The cost of a run for this number.
    fn cost(&self, trial: &TraceRun, all: &[TraceRun]) -> f64 {
        let restored = if trial.restored.is_some() { RESTORED } else { 0.0 };
        restored + self.cost_of_setting(trial, all)
    }

    /// The cost of a measure for this number, given the costs of the run and the lab.
    fn cost_of_candidate(&self, c: &Candidate, run: f64, far: f64) -> f64 {
        let shared = c.words.intersection(&self.words).count().min(MOST_WORDS);
        let named = c.time.map_or(0.0, |x| self.time(x));
        let unnamed = match c.constant.is_some() && shared == 0 {
            true if c.words.is_disjoint(&self.wide) => UNNAMED,
            true => NAMED_NEAR,
            false => 0.0,
        };
        let wide = c.words.intersection(&self.wide).count().saturating_sub(shared).min(MOST_WORDS);
        c.cost + run + far + named + unnamed
            - SENTENCE_REWARD * shared as f64
            - PARAGRAPH_REWARD * wide as f64
    }

    /// The cost of a value of the start: the sentence should speak of a start.
    fn cost_of_start(&self) -> f64 {
        if START_WORDS.iter().any(|word| self.words.contains(*word)) { 0.0 } else { NAMED_NEAR }
    }

    fn cost_of_setting(&self, trial: &TraceRun, all: &[TraceRun]) -> f64 {
        if let Some((x, unit)) = trial.named {
            let is = |n: &&&Stated| n.dimension.agrees(&unit) && close(si(n), x);
            // "29 mm at h = 2 ms" is not a number of a run at 10 ms.
            let others =
                || all.iter().filter(|t| t.sets_same_controls(trial)).filter_map(|t| Some(t.named?.0));
            let another = |n: &&Stated| {
                n.dimension.agrees(&unit) && others().chain(trial.nominal).any(|other| close(si(n), other))
            };
            return match () {
                () if self.beside.iter().any(|n| is(&n)) => 0.0,
                () if self.beside.iter().any(another) => 2.0 * FAR_COST,
                () if self.paragraph.iter().any(|n| is(&n)) => IN_PARAGRAPH,
                () if self.near.iter().any(|n| is(&n)) => {
                    let away = |x: f64| {
                        let named = self.near.iter().filter(|n| n.dimension.agrees(&unit) && close(si(n), x));
                        named.map(|n| n.span.start.abs_diff(self.offset)).min().unwrap_or(usize::MAX)
                    };
                    let nearer = others().any(|other| away(other) < away(x));
                    FAR_COST + if nearer { NAMED_NEARER } else { 0.0 }
                }
                () => 2.0 * FAR_COST,
            };
        }
        if trial.label.is_empty() {
            return 0.0;
        }
        if self.text.contains(&trial.label.to_lowercase()) { 0.0 } else { FAR_COST }
    }

    /// Whether the sentence names a constant: its kind and its object. A word that names an object of the nearest lab
    /// names none of another lab.
    fn names(&self, constant: &ConstantWords, far: f64, nearest: &BTreeSet<&str>) -> bool {
        let ConstantWords { kind, owner } = constant;
        let is_near = far < LAB;
        let is_named =
            |word: &String| self.words.contains(word) && (is_near || !nearest.contains(word.as_str()));
        let is_owner = is_near && owner.is_empty() || owner.iter().any(is_named);
        !kind.is_disjoint(&self.words) && is_owner
    }

    /// The slider that the sentence names together with a value that it can have.
    fn slider(&self, s: &Stated, labs: &[TracedLab<'_>]) -> Option<String> {
        let controls = labs.iter().flat_map(|tried| &tried.lab.controls);
        controls.into_iter().find_map(|control| {
            let Measure::Dimension(unit) = given_by(control) else { return None };
            let x = round(si(s) * unit.factor);
            let ControlKind::Slider { .. } = &control.kind else { return None };
            let fits = s.dimension.agrees(&unit) && settings::value(control, &Value::Number(x)).is_ok();
            (fits && self.names_label(control.label.as_str()))
                .then(|| format!("\"{}\" at {x}", control.label.as_str()))
        })
    }

    /// Whether the sentence contains the words of a label: all of a short one, two of a long one.
    fn names_label(&self, label: &str) -> bool {
        let label = label.split('(').next().unwrap_or(label);
        let words: BTreeSet<String> = split_words(label).collect();
        match words.len() {
            0 => {
                let symbol = label.trim().to_lowercase();
                let is_word = |word: &str| word.trim_matches('$') == symbol;
                !symbol.is_empty() && self.text.split(|c: char| c.is_whitespace() || c == '=').any(is_word)
            }
            count => words.intersection(&self.words).count() >= count.min(2),
        }
    }
}
