//! Selection of the origin of a number: the simplest measure with its digits, unless chance explains the match.

use super::candidates::Candidate;
use super::formula::{self, Binding};
use super::lab::TracedLab;
use super::trials::TraceRun;
use super::units::si;
use super::words::split_words;
use labspec::verify::Stated;
use std::collections::BTreeSet;

/// The origin of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// The lesson already claims it, so a check computes it.
    Claimed,
    /// This measure has its digits.
    From(MeasureMatch),
    /// This measure has its digits, but other digits if the start is perturbed slightly, so that no reader can reproduce them.
    Unsteady(MeasureMatch),
    /// The text uses the number as a setting, so it is not the result of a run.
    Setting(String),
    /// A measure has its digits, but chance explains the match.
    Chance(MeasureMatch),
    /// No candidate has its digits.
    Unknown,
}

/// A measure that has the digits of a number.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureMatch {
    /// The indexes of the lab and the run; `None` for an evaluated formula.
    pub place: Option<(usize, usize)>,
    /// The measure or the formula.
    pub measure: String,
    /// The factor from its value to the number in the text: `1000 * `, `-`, or nothing.
    pub factor: String,
    /// The value in the unit of the text.
    pub value: f64,
    /// The probability that something as simple as this has these digits by chance.
    pub chance: f64,
}

impl MeasureMatch {
    /// The expression for the number in the text: `1000 * (a - b)`.
    pub fn description(&self) -> String {
        let MeasureMatch { factor, measure, .. } = self;
        let mut deep = 0;
        let sum = measure.char_indices().any(|(i, c)| {
            deep += i32::from(c == '(') - i32::from(c == ')');
            deep == 0
                && measure.get(i..).is_some_and(|rest| rest.starts_with(" - ") || rest.starts_with(" + "))
        });
        if sum && !factor.is_empty() { format!("{factor}({measure})") } else { format!("{factor}{measure}") }
    }
}

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
/// The cost of a value that equals the printed number exactly.
const EXACT: f64 = 0.5;
/// Two constants of different kinds whose costs differ by less than this are ambiguous.
const MIN_COST_RATIO: f64 = 1.2;

/// A candidate with the digits of a number, and its cost.
struct CandidateMatch {
    cost: f64,
    /// Whether it is a constant of the model.
    constant: bool,
    hit: MeasureMatch,
}

/// Determines the origin of a number.
pub(super) fn origin(s: &Stated, numbers: &[Stated], labs: &[TracedLab<'_>], bindings: &[Binding]) -> Origin {
    let around = NumberContext::new(s, numbers);
    if si(s) == 0.0 || s.bound {
        return Origin::Unknown;
    }
    let window = 2.0 * s.read.half_unit / s.read.value.abs() / (DECADES * std::f64::consts::LN_10);
    let window = window.min(1.0);
    if let Some(hit) = formula_hit(s, bindings, window).filter(|hit| hit.chance < CHANCE) {
        return Origin::From(hit);
    }
    let (tried, mut matches) = compare_values(s, &around, labs);
    matches.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let ambiguous = is_ambiguous(&matches);
    let Some(CandidateMatch { cost, mut hit, .. }) = matches.into_iter().next() else {
        return around.setting(s, labs).map_or(Origin::Unknown, Origin::Setting);
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
    around.setting(s, labs).map_or(Origin::Chance(hit), Origin::Setting)
}

/// Compares a number with every value of its dimension: returns the cost and the size of each value, and those with its digits.
fn compare_values(
    s: &Stated,
    around: &NumberContext<'_>,
    labs: &[TracedLab<'_>],
) -> (Vec<(f64, f64)>, Vec<CandidateMatch>) {
    let mut tried: Vec<(f64, f64)> = Vec::new();
    let mut matches: Vec<CandidateMatch> = Vec::new();
    let distances = distances(s, labs);
    for (l, lab) in labs.iter().enumerate() {
        let far = distances.get(l).copied().unwrap_or(0.0);
        for (t, (trial, values)) in lab.trials.iter().zip(&lab.values).enumerate() {
            let run = around.cost(trial, &lab.trials);
            let sets_it = trial.named.is_some_and(|(x, _)| close(x, si(s)));
            for (c, &value) in lab.candidates.iter().zip(values) {
                if !c.dimension.agrees(&s.dimension) || !value.is_finite() || value == 0.0 {
                    continue;
                }
                // A value that the text itself sets is not a result of the run.
                if (sets_it || t > 0) && c.constant || c.time.is_some_and(|x| close(x, si(s))) && sets_it {
                    continue;
                }
                let cost = around.cost_of_candidate(c, run, far);
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
                        constant: c.constant,
                        hit: MeasureMatch { place, measure, factor, value, chance: 1.0 },
                    });
                }
            }
        }
    }
    (tried, matches)
}

/// Whether the best match is a constant, and a constant of another kind is about as good.
fn is_ambiguous(matches: &[CandidateMatch]) -> bool {
    let [best, others @ ..] = matches else { return false };
    let kind = |m: &CandidateMatch| m.hit.measure.rsplit('.').next().unwrap_or("").to_string();
    let rivals =
        |m: &CandidateMatch| m.constant && m.cost - best.cost < MIN_COST_RATIO && kind(m) != kind(best);
    best.constant && others.iter().any(rivals)
}

/// The number of digits from which a repeated number is recognized.
const KNOWN: f64 = 3.0;

/// A repeated number has the same origin, and a time at which something was measured is a setting.
pub(super) fn share(numbers: &[Stated], origins: &mut [Origin]) {
    let open = |o: &Origin| matches!(o, Origin::Unknown | Origin::Chance(_));
    let traced: Vec<(usize, Origin)> =
        origins.iter().cloned().enumerate().filter(|(_, o)| !open(o)).collect();
    for (s, origin) in numbers.iter().zip(origins.iter_mut()).filter(|(s, o)| open(o) && !s.bound) {
        let digits = (s.read.value / (2.0 * s.read.half_unit)).abs().log10();
        let again = traced.iter().find(|(i, o)| {
            matches!(o, Origin::From(_)) && numbers.get(*i).is_some_and(|n| n.quote == s.quote)
        });
        // A measure that explains the number there and is the best candidate here needs fewer digits.
        let same = |from: &Origin| match (from, &*origin) {
            (Origin::From(a), Origin::Chance(b)) => (a.place, &a.measure) == (b.place, &b.measure),
            _ => false,
        };
        let again = again.filter(|(_, from)| digits >= KNOWN || same(from));
        let marked = format!("at(data.time >= {} - ", si(s));
        let read_then = |o: &Origin| matches!(o, Origin::From(hit) if hit.measure.contains(&marked));
        if let Some((_, from)) = again {
            *origin = from.clone();
        } else if s.unit.ends_with('s') && traced.iter().any(|(_, o)| read_then(o)) {
            *origin = Origin::Setting("the time at which other numbers are read".into());
        }
    }
}

fn close(a: f64, b: f64) -> bool {
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
    };
    let ratio = s.dimension.factor;
    // Its numbers are in SI units, or all in the unit of the result.
    let all = [hit(factor("", ratio), found.value * ratio), hit(String::new(), found.value)];
    all.into_iter().find(|hit| s.read.is(hit.value))
}

/// The factor from one unit to another.
fn factor(sign: &str, ratio: f64) -> String {
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
struct NumberContext<'n> {
    words: BTreeSet<String>,
    /// The words of the whole paragraph.
    wide: BTreeSet<String>,
    text: String,
    beside: Vec<&'n Stated>,
    paragraph: Vec<&'n Stated>,
    near: Vec<&'n Stated>,
}

impl<'n> NumberContext<'n> {
    fn new(s: &Stated, numbers: &'n [Stated]) -> NumberContext<'n> {
        let other = |n: &&Stated| n.span != s.span;
        let beside = numbers.iter().filter(other).filter(|n| n.context == s.context).collect();
        let paragraph = numbers.iter().filter(other).filter(|n| n.paragraph == s.paragraph).collect();
        let text = format!("{} {}", s.context, s.column).to_lowercase();
        let wide = split_words(&s.paragraph).collect();
        let near = numbers.iter().filter(|n| n.span.start.abs_diff(s.span.start) < NEAR_DISTANCE).collect();
        NumberContext { words: split_words(&text).collect(), wide, text, beside, paragraph, near }
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
        let unnamed = match c.constant && shared == 0 {
            true if c.words.is_disjoint(&self.wide) => UNNAMED,
            true => NAMED_NEAR,
            false => 0.0,
        };
        let wide = c.words.intersection(&self.wide).count().saturating_sub(shared).min(MOST_WORDS);
        c.cost + run + far + named + unnamed
            - SENTENCE_REWARD * shared as f64
            - PARAGRAPH_REWARD * wide as f64
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
                () if self.near.iter().any(|n| is(&n)) => FAR_COST,
                () => 2.0 * FAR_COST,
            };
        }
        if trial.label.is_empty() {
            return 0.0;
        }
        if self.text.contains(&trial.label.to_lowercase()) { 0.0 } else { FAR_COST }
    }

    /// The setting that has this number as its value, if there is one.
    fn setting(&self, s: &Stated, labs: &[TracedLab<'_>]) -> Option<String> {
        let has_value = |trial: &TraceRun| {
            trial.named.is_some_and(|(x, unit)| unit.agrees(&s.dimension) && close(x, si(s)))
        };
        labs.iter().flat_map(|l| &l.trials).find(|t| has_value(t)).map(|t| t.words.clone())
    }
}
