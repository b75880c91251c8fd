//! The `verify` object of a question or a lab: what a machine can check about the text.
//!
//! Here it is only read; expressions stay texts with their places.

use super::fields::Fields;
use super::format::{CLOSED_FORM, COLUMN, FIND, RUN, SPAN, VERIFY};
use super::problem::{Mistake, Problem};
use super::read;
use super::{Form, Lab, LabAddress, lab};
use crate::json::read::shorten;
use crate::json::{Json, Member, Node, Number, Scalar};
use crate::source::{SourceMap, Text};
use std::ops::Range;

/// Runs, measures over them, and what must hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Verify {
    /// Bytes of the file, braces included.
    pub span: Range<usize>,
    /// The lab that runs; `None` means the question's `sim`, or the lab that carries this object.
    pub lab: Option<VerifyLab>,
    /// Whose runs and measures are those of this one, too: the lab or the question that carries them.
    pub uses: Option<(Text, LabAddress)>,
    /// The runs. Empty means one run of the lab as it stands.
    pub runs: Vec<Run>,
    /// Measures: name and expression, taken in every run.
    pub measure: Vec<(Text, Text)>,
    /// Values that are searched for.
    pub find: Vec<Find>,
    /// One condition per option of the question.
    pub options: Vec<Text>,
    /// Sliders by label, and the range of each over which the answer must hold.
    pub over: Vec<(Text, [f64; 2])>,
    /// The value of a numeric answer.
    pub value: Option<Text>,
    /// Values that the tolerance of a numeric answer must refuse: what a mistake leads to.
    pub wrong: Vec<Text>,
    /// Numbers quoted in the text, each with the expression it must equal as printed.
    pub says: Vec<Said>,
    /// Columns and cells of tables, each with what it must state.
    pub table: Vec<Column>,
    /// Closed forms that traces must follow.
    pub exact: Vec<Exact>,
}

/// Words that speak of a lab.
const OF_A_LAB: [&str; 8] = ["data", "model", "mj", "lib", "sim", "ctx", "contact", "shown"];

/// The lab of a [`Verify`].
#[derive(Clone, Debug, PartialEq)]
pub enum VerifyLab {
    /// Written out.
    Inline(Box<Lab>),
    /// Another lab of the lesson: `#2`, `#quiz-id.1`.
    Reference(Text, LabAddress),
    /// A lab of another lesson: `other.md#2`. The path of its file is from the folder of this one.
    Elsewhere(Text, String, LabAddress),
    /// Something that is no lab, which is reported.
    Broken,
}

/// A named run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Its name, which measures are read by: `name.measure`.
    pub name: Text,
    /// The lab that it runs, where it is not that of the object.
    pub lab: Option<VerifyLab>,
    /// Changes of the model's text, before it is compiled.
    pub model: Vec<Change>,
    /// The keyframe to start from, instead of the lab's.
    pub key: Option<Scalar>,
    /// Statements before every step, instead of the lab's; empty for none.
    pub controller: Option<Text>,
    /// Control labels and the values they are set to before the run.
    pub set: Vec<(Text, Scalar)>,
    /// Button labels and the times (s) of their presses.
    pub press: Vec<(Text, Number)>,
    /// Further statements, after the lab's own setup.
    pub setup: Option<Text>,
    /// Length in seconds.
    pub until: Option<Number>,
    /// Length in steps.
    pub steps: Option<Number>,
    /// The run ends at the first sample at which this holds.
    pub stop: Option<Text>,
    /// What is tried with several values: a run for each.
    pub sweep: Option<Sweep>,
    /// The lesson says that this run breaks, and then it must.
    pub breaks: bool,
}

/// What a run is made with several values of.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The label of a control, or an attribute of the model.
    pub what: Text,
    /// The values, in order.
    pub values: Vec<f64>,
}

/// A value that is searched for: the largest or the smallest one with which a condition holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Find {
    /// Its name, by which it is read like a measure.
    pub name: Text,
    /// The largest one is wanted.
    pub largest: bool,
    /// The label of a control, an attribute of the model, or `timestep`.
    pub what: Text,
    /// The smallest and the largest value that are tried.
    pub range: [f64; 2],
    /// The run; `None` for the only one.
    pub run: Option<Text>,
    /// The condition.
    pub holds: Text,
    /// How near the found value is to the true one.
    pub tol: Number,
}

/// Most runs of a sweep.
pub const MOST_SWEPT: usize = 50;

/// A change of a model: an attribute of an element, and what stands in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Kind, name and attribute: `geom ball friction`.
    pub path: Text,
    /// The attribute as a model's text has it.
    pub value: String,
}

/// A closed form of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    /// Label of the trace.
    pub trace: Text,
    /// The closed form, in the language of the lab.
    pub form: Text,
    /// How far the trace may be from it at most, in the trace's unit; `None` to judge by convergence.
    pub tol: Option<Number>,
}

/// A column of a table, or one cell of it, and where its numbers come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The heading of the column.
    pub column: Text,
    /// The heading of the column that tells the rows apart, and the list of its numbers.
    pub by: Option<(Text, Text)>,
    /// What stands in the first column of the one row that is meant.
    pub row: Option<Text>,
    /// What stands in the cells.
    pub is: Stands,
}

/// What stands in the cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Stands {
    /// Numbers: a list of them, or one for one cell.
    Number(Text),
    /// Words, each with the list of what must hold for it, or one condition for one cell.
    Words(Vec<(Text, Text)>),
}

impl Column {
    /// Its expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Text> {
        let (number, words) = match &self.is {
            Stands::Number(text) => (Some(text), &[][..]),
            Stands::Words(words) => (None, words.as_slice()),
        };
        self.by.iter().map(|(_, list)| list).chain(number).chain(words.iter().map(|(_, holds)| holds))
    }
}

/// What the text says and where that comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// The quoted text, such as `0.442 s`.
    pub quote: Text,
    /// The expressions whose values it states, in the order of its numbers; a condition is what its words say.
    pub exprs: Vec<Text>,
}

impl Verify {
    /// One that only measures.
    pub(crate) fn measuring(span: Range<usize>, runs: Vec<Run>, measure: Vec<(Text, Text)>) -> Verify {
        Verify {
            span,
            lab: None,
            uses: None,
            runs,
            measure,
            find: Vec::new(),
            options: Vec::new(),
            over: Vec::new(),
            value: None,
            wrong: Vec::new(),
            says: Vec::new(),
            table: Vec::new(),
            exact: Vec::new(),
        }
    }

    /// Whether it says how the answer of its question is checked.
    pub fn claims_answer(&self) -> bool {
        !self.options.is_empty() || self.value.is_some()
    }

    /// Whether it works out formulas alone, and reads nothing of a lab.
    pub fn is_formulas(&self) -> bool {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let reads = |text: &Text| text.value.split(|c| !word(c)).any(|w| OF_A_LAB.contains(&w));
        self.runs.is_empty()
            && self.find.is_empty()
            && self.exact.is_empty()
            && !self.code().iter().any(|(_, text)| reads(text))
    }

    /// The labs that it names: its own, and those of its runs.
    pub fn labs(&self) -> impl Iterator<Item = &VerifyLab> {
        self.lab.iter().chain(self.runs.iter().filter_map(|run| run.lab.as_ref()))
    }

    /// Whether no lab is needed besides those of its runs.
    pub fn every_run_names_its_lab(&self) -> bool {
        !self.runs.is_empty() && self.exact.is_empty() && self.runs.iter().all(|run| run.lab.is_some())
    }

    /// Every text that is code, with what it is.
    pub fn code(&self) -> Vec<(Form, &Text)> {
        self.runs.iter().flat_map(Run::code).chain(self.expressions()).collect()
    }

    /// The expressions of what the text says.
    pub fn quoted(&self) -> impl Iterator<Item = &Text> {
        self.says.iter().flat_map(|s| &s.exprs).chain(self.table.iter().flat_map(Column::expressions))
    }

    /// The measures and what is claimed of them: every text that is code, but for that of the runs.
    pub fn expressions(&self) -> impl Iterator<Item = (Form, &Text)> {
        let measures = self.measure.iter().map(|(_, expr)| expr).chain(self.exact.iter().map(|e| &e.form));
        let measures = measures.chain(self.find.iter().map(|f| &f.holds));
        let values = self.options.iter().chain(&self.value).chain(&self.wrong).chain(self.quoted());
        measures.chain(values).map(|t| (Form::Expression, t))
    }
}

impl Run {
    /// A run of the lab as it stands.
    pub fn named(name: &str) -> Run {
        Run {
            name: Text { value: name.to_string(), map: SourceMap::point(0) },
            lab: None,
            model: Vec::new(),
            key: None,
            controller: None,
            set: Vec::new(),
            press: Vec::new(),
            setup: None,
            until: None,
            steps: None,
            stop: None,
            sweep: None,
            breaks: false,
        }
    }

    /// Every text that is code, with what it is.
    pub fn code(&self) -> impl Iterator<Item = (Form, &Text)> {
        let statements = self.setup.iter().chain(&self.controller).map(|t| (Form::Statements, t));
        statements.chain(self.stop.iter().map(|t| (Form::Expression, t)))
    }
}

/// Reads a `verify` object.
pub(super) fn read(node: &Node, problems: &mut Vec<Problem>) -> Option<Verify> {
    let before = problems.len();
    let mut fields = Fields::open(node, &VERIFY, problems)?;
    let f = &mut fields;
    if !["options", "value", "says", "table", "exact"].iter().any(|key| f.has(key)) {
        let mistake = Mistake::ClaimsNothing.at(f.span());
        f.problems.push(mistake);
    }
    let verify = Verify {
        span: f.span(),
        lab: f.node("lab").map(|n| which(n, f.problems).unwrap_or(VerifyLab::Broken)),
        uses: f.text("use").and_then(|text| uses(text, f.problems)),
        runs: f.map("runs").iter().filter_map(|m| run(m, f.problems)).collect(),
        measure: expressions(f, "measure"),
        find: f.map("find").iter().filter_map(|m| find(m, f.problems)).collect(),
        options: f.list("options").iter().filter_map(|n| read::text(n, "a condition", f.problems)).collect(),
        over: f.map("over").iter().filter_map(|m| over(m, f.problems)).collect(),
        value: f.text("value"),
        wrong: f.list("wrong").iter().filter_map(|n| read::text(n, "a wrong value", f.problems)).collect(),
        says: f.list("says").iter().filter_map(|n| read_says(n, f.problems)).collect(),
        table: f.list("table").iter().filter_map(|n| column(n, f.problems)).collect(),
        exact: f.map("exact").iter().filter_map(|m| exact(m, f.problems)).collect(),
    };
    fields.finish();
    for problem in problems.iter_mut().skip(before) {
        if let Problem::Format(misfit) = problem {
            misfit.in_verify = true;
        }
    }
    Some(verify)
}

fn which(node: &Node, problems: &mut Vec<Problem>) -> Option<VerifyLab> {
    match &node.json {
        Json::Text(text) => {
            let (file, place) = text.value.rsplit_once('#').unwrap_or((&text.value, ""));
            match (file, LabAddress::parse(&format!("#{place}"))) {
                ("", Some(address)) => Some(VerifyLab::Reference(text.clone(), address)),
                (file, Some(address)) => Some(VerifyLab::Elsewhere(text.clone(), file.to_string(), address)),
                (_, None) => {
                    problems.push(Mistake::NoPlace(text.value.clone()).at(text.span()));
                    None
                }
            }
        }
        Json::Object(_) => lab::read(node, problems).map(|l| VerifyLab::Inline(Box::new(l))),
        Json::Broken => None,
        _ => {
            problems.push(Mistake::NoLab(node.describe()).at(node.span.clone()));
            None
        }
    }
}

/// Whose runs and measures are used.
fn uses(text: Text, problems: &mut Vec<Problem>) -> Option<(Text, LabAddress)> {
    let address = LabAddress::parse(&text.value);
    if address.is_none() {
        problems.push(Mistake::NoPlace(text.value.clone()).at(text.span()));
    }
    Some((text, address?))
}

fn run(member: &Member, problems: &mut Vec<Problem>) -> Option<Run> {
    let mut fields = Fields::open(&member.value, &RUN, problems)?;
    let f = &mut fields;
    let run = Run {
        name: member.key.clone(),
        lab: f.node("lab").map(|n| which(n, f.problems).unwrap_or(VerifyLab::Broken)),
        model: f.map("model").iter().filter_map(|m| change(m, f.problems)).collect(),
        key: f.node("key").and_then(|n| read::scalar(n, "key", f.problems)),
        controller: f.text("controller"),
        set: f
            .map("set")
            .iter()
            .filter_map(|m| {
                Some((m.key.clone(), read::scalar(&m.value, "the value of a control", f.problems)?))
            })
            .collect(),
        press: f.list("press").iter().filter_map(|n| press(n, f.problems)).collect(),
        setup: f.text("setup"),
        until: f.number("until"),
        steps: f.whole("steps"),
        stop: f.text("stop"),
        sweep: f.node("sweep").and_then(|n| sweep(n, f.problems)),
        breaks: f.text("expect").is_some_and(|t| breaks(&t, f.problems)),
    };
    fields.finish();
    Some(run)
}

/// A change of a model. Several numbers are written as a list.
fn change(member: &Member, problems: &mut Vec<Problem>) -> Option<Change> {
    let what = "the value of an attribute";
    let value = match &member.value.json {
        Json::Array(items) => {
            let numbers = items.iter().map(|n| read::number(n, what, problems).map(|n| n.value.to_string()));
            numbers.collect::<Option<Vec<_>>>()?.join(" ")
        }
        _ => match read::scalar(&member.value, what, problems)? {
            Scalar::Number(n) => n.value.to_string(),
            Scalar::Text(t) => t.value,
            Scalar::Bool(b, _) => b.to_string(),
        },
    };
    Some(Change { path: member.key.clone(), value })
}

/// What a sweep changes, and the values: written one by one, or so many from one end to the other.
fn sweep(node: &Node, problems: &mut Vec<Problem>) -> Option<Sweep> {
    let [member] = node.members() else {
        if !node.is_broken() {
            problems.push(Mistake::NoSweep.at(node.span.clone()));
        }
        return None;
    };
    let what = member.key.clone();
    let values: Vec<f64> = match &member.value.json {
        Json::Array(items) => {
            let numbers =
                items.iter().map(|n| read::number(n, "a value of a sweep", problems).map(|n| n.value));
            numbers.collect::<Option<_>>()?
        }
        _ => {
            let mut fields = Fields::open(&member.value, &SPAN, problems)?;
            let [from, to, count] = [fields.number("from"), fields.number("to"), fields.whole("count")];
            fields.finish();
            let ([from, to], count) = ([from?.value, to?.value], count?.value.clamp(0.0, 1e6) as usize);
            let part = |i: usize| i as f64 / count.saturating_sub(1).max(1) as f64;
            (0..count.min(MOST_SWEPT + 1)).map(|i| from + (to - from) * part(i)).collect()
        }
    };
    if !(2..=MOST_SWEPT).contains(&values.len()) {
        problems.push(Mistake::SweptValues(values.len()).at(member.value.span.clone()));
        return None;
    }
    Some(Sweep { what, values })
}

/// The range of a slider over which an answer holds.
fn over(member: &Member, problems: &mut Vec<Problem>) -> Option<(Text, [f64; 2])> {
    if member.value.is_broken() {
        return None;
    }
    if let Json::Array(items) = &member.value.json
        && let [low, high] = items.as_slice()
    {
        let [low, high] = [low, high].map(|n| read::number(n, "an end of the range", problems));
        let ends = [low?.value, high?.value];
        if ends[0] < ends[1] {
            return Some((member.key.clone(), ends));
        }
    }
    problems.push(Mistake::NoRange.at(member.value.span.clone()));
    None
}

/// A value that is searched for.
fn find(member: &Member, problems: &mut Vec<Problem>) -> Option<Find> {
    let mut fields = Fields::open(&member.value, &FIND, problems)?;
    let f = &mut fields;
    let ends = [f.text("largest"), f.text("smallest")];
    let [from, to, tol] = ["from", "to", "tol"].map(|key| f.number(key));
    let (run, holds) = (f.text("run"), f.text("while"));
    let largest = ends[0].is_some();
    let what = match ends {
        [Some(what), None] | [None, Some(what)] => Some(what),
        _ => {
            let mistake = Mistake::FindsNothing.at(f.span());
            f.problems.push(mistake);
            None
        }
    };
    let range = from.zip(to).map(|(from, to)| [from.value, to.value]);
    if let Some([from, to]) = range
        && from >= to
    {
        let mistake = Mistake::FindsBackwards.at(f.span());
        f.problems.push(mistake);
        return None;
    }
    fields.finish();
    let name = member.key.clone();
    Some(Find { name, largest, what: what?, range: range?, run, holds: holds?, tol: tol? })
}

/// What a run is expected to do.
fn breaks(text: &Text, problems: &mut Vec<Problem>) -> bool {
    if text.value != "breaks" {
        problems.push(Mistake::RunExpects(text.value.clone()).at(text.span()));
    }
    text.value == "breaks"
}

/// The closed form of a trace: an expression, or an object with a tolerance.
fn exact(member: &Member, problems: &mut Vec<Problem>) -> Option<Exact> {
    let trace = member.key.clone();
    if !matches!(member.value.json, Json::Object(_)) {
        let form = read::text(&member.value, &shorten(&trace.value), problems)?;
        return Some(Exact { trace, form, tol: None });
    }
    let mut fields = Fields::open(&member.value, &CLOSED_FORM, problems)?;
    let form = fields.text("is");
    let tol = fields.number("tol");
    fields.finish();
    Some(Exact { trace, form: form?, tol })
}

fn press(node: &Node, problems: &mut Vec<Problem>) -> Option<(Text, Number)> {
    if node.is_broken() {
        return None;
    }
    if let Json::Array(pair) = &node.json
        && let [label, time] = pair.as_slice()
    {
        let label = read::text(label, "the label of a button", problems);
        let time = read::number(time, "the time of a press", problems);
        return Some((label?, time?));
    }
    problems.push(Mistake::NoPress.at(node.span.clone()));
    None
}

fn read_says(node: &Node, problems: &mut Vec<Problem>) -> Option<Said> {
    if node.is_broken() {
        return None;
    }
    if let Json::Array(pair) = &node.json
        && let [quote, expr] = pair.as_slice()
    {
        let quote = read::text(quote, "a quoted number", problems);
        let mut expression = |node: &Node| read::text(node, "the expression of a quoted number", problems);
        let exprs = match &expr.json {
            Json::Array(items) if !items.is_empty() => items.iter().map(&mut expression).collect(),
            _ => expression(expr).map(|one| vec![one]),
        };
        return Some(Said { quote: quote?, exprs: exprs? });
    }
    problems.push(Mistake::NoQuote.at(node.span.clone()));
    None
}

/// The heading that tells rows apart, and the list of what stands below it.
fn keyed(node: &Node, problems: &mut Vec<Problem>) -> Option<(Text, Text)> {
    if let Json::Array(pair) = &node.json
        && let [heading, list] = pair.as_slice()
    {
        let heading = read::text(heading, "a heading", problems);
        let list = read::text(list, "the list of its values", problems);
        return Some((heading?, list?));
    }
    if !node.is_broken() {
        problems.push(Mistake::NoQuote.at(node.span.clone()));
    }
    None
}

/// What stands in cells: numbers, or words with what must hold for each.
fn stands(node: &Node, problems: &mut Vec<Problem>) -> Option<Stands> {
    let text = |node: &Node, problems: &mut Vec<Problem>| read::text(node, "what the cells state", problems);
    match &node.json {
        Json::Object(members) => {
            let one = |m: &Member| Some((m.key.clone(), text(&m.value, problems)?));
            members.iter().map(one).collect::<Option<_>>().map(Stands::Words)
        }
        _ => text(node, problems).map(Stands::Number),
    }
}

/// A column of a table, or a cell of it.
fn column(node: &Node, problems: &mut Vec<Problem>) -> Option<Column> {
    let mut fields = Fields::open(node, &COLUMN, problems)?;
    let f = &mut fields;
    let (column, row) = (f.text("column"), f.text("row"));
    let is = f.node("is").and_then(|n| stands(n, f.problems));
    let by = f.node("by").and_then(|n| keyed(n, f.problems));
    if by.is_some() == row.is_some() {
        let mistake = Mistake::NoRows.at(f.span());
        f.problems.push(mistake);
    }
    let apart = by.is_some() != row.is_some();
    fields.finish();
    Some(Column { column: column?, by, row, is: is? }).filter(|_| apart)
}

fn expressions(fields: &mut Fields<'_, '_>, key: &'static str) -> Vec<(Text, Text)> {
    let mut all = Vec::new();
    for member in fields.map(key) {
        if let Some(text) = read::text(&member.value, &shorten(&member.key.value), fields.problems) {
            all.push((member.key.clone(), text));
        }
    }
    all
}
