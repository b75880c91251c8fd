//! The fences of a lesson as elements: labs, quizzes, other widgets, listings. A damaged one shows its source.

use crate::html::Addresses;
use crate::links::Anchors;
use crate::models::{Delivery, ModelShelf};
use crate::names::address_from;
use crate::text::{escape, json_in_script, slug};
use crate::twin::{lab_twin, quiz_twin};
use crate::verified::short_hash;
use labspec::markdown::{Block, BlockKind};
use labspec::report::counted;
use labspec::spec::{Comparison, Lab, Lesson, ModelSource, Quiz};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The version that a mark names.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A fence as a page shows it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct FencePart {
    /// `lab`, `quiz`, `widget`, `code` or `broken`.
    pub(crate) kind: &'static str,
    /// The element. It is the same as long as the text and the models of the fence are.
    pub(crate) content: String,
    /// The HTML beside the element: the mark, and the replacement for pages without JavaScript and for print.
    pub(crate) after: String,
}

/// The labs and quizzes of a lesson with their ids on the page.
#[derive(Debug, Default)]
pub(crate) struct FenceIds {
    /// By the start of the fence.
    by_start: BTreeMap<usize, String>,
}

impl FenceIds {
    /// Gives every lab and quiz its id: `lab-1`, `quiz-` and the id of the quiz.
    pub(crate) fn new(lesson: &Lesson, anchors: &mut Anchors) -> FenceIds {
        let mut ids = FenceIds::default();
        for lab in &lesson.labs {
            ids.by_start.insert(lab.span.start, anchors.add(&format!("lab-{}", lab.number), ""));
        }
        for quiz in &lesson.quizzes {
            let Some(block) = lesson.scan.blocks.iter().find(|b| contains(&b.span, &quiz.span)) else {
                continue;
            };
            let name = quiz.id.as_ref().map_or("", |id| id.as_str());
            ids.by_start.insert(block.span.start, anchors.add(&format!("quiz-{}", slug(name)), ""));
        }
        ids
    }

    /// The id of the fence that begins here.
    pub(crate) fn find(&self, start: usize) -> Option<&str> {
        self.by_start.get(&start).map(String::as_str)
    }
}

/// Whether a range contains another one.
pub(crate) fn contains(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

/// Writes the fences of one lesson.
pub(crate) struct FenceWriter<'w> {
    pub(crate) lesson: &'w Lesson,
    /// The name of its page.
    pub(crate) page: &'w str,
    pub(crate) ids: &'w FenceIds,
    /// The number of true claims of each owner whose claims are all true.
    pub(crate) verified: &'w BTreeMap<String, usize>,
    pub(crate) shelf: &'w mut ModelShelf,
    /// The number of the lesson's folder of models.
    pub(crate) folder: usize,
    /// Whether the page has what replaces its elements without JavaScript and on paper.
    pub(crate) has_twins: bool,
    /// The models that the page contains.
    pub(crate) embedded: BTreeMap<String, String>,
    /// Whether an element fetches a model from files.
    pub(crate) needs_files: bool,
}

impl FenceWriter<'_> {
    /// A fence.
    pub(crate) fn write(&mut self, block: &Block, addresses: &mut dyn Addresses) -> FencePart {
        let lesson = self.lesson;
        let is_broken =
            lesson.is_broken(&block.span) || lesson.broken.iter().any(|b| contains(&block.span, b));
        match &block.kind {
            BlockKind::Lab(_) => {
                let entry = lesson
                    .labs
                    .iter()
                    .find(|entry| entry.span.start == block.span.start || contains(&block.span, &entry.span));
                match entry.and_then(|entry| entry.lab.as_ref()).filter(|_| !is_broken) {
                    Some(lab) => self.lab(block, lab, entry.map_or(0, |e| e.number), addresses),
                    None => broken(block, "This lab cannot be read"),
                }
            }
            BlockKind::Widget(name) => widget(block, name),
            BlockKind::Quiz => match lesson.quizzes.iter().find(|quiz| contains(&block.span, &quiz.span)) {
                Some(quiz) if !is_broken => self.quiz(block, quiz, addresses),
                _ => broken(block, "This quiz cannot be read"),
            },
            BlockKind::Code { language, file } => code(block, language, file.as_deref()),
        }
    }

    fn lab(&mut self, block: &Block, lab: &Lab, number: usize, addresses: &mut dyn Addresses) -> FencePart {
        let Some(json) = shown_json(&block.body.value, lab.comparison.as_ref()) else {
            return broken(block, "This lab cannot be read");
        };
        let digest = self.deliver([lab].into_iter());
        let id = escape(self.ids.find(block.span.start).unwrap_or(""));
        let twin = self.has_twins.then(|| {
            let address = |name: &str| address_from(self.page, name);
            lab_twin(lab, &self.lesson.file, self.shelf.models(self.folder), addresses, address)
        });
        let (twin, moments) = twin.map(|twin| (twin.html, twin.moments)).unwrap_or_default();
        let start = moments.start().map(|name| escape(&address_from(self.page, name)).to_string());
        let poster = start.map_or(String::new(), |start| format!(" poster=\"{start}\""));
        self.shelf.pictures.extend(moments.files);
        let content = format!(
            "<sim-lab id=\"{id}\"{poster} data-models-hash=\"{}\"><script type=\"application/json\">{}</script></sim-lab>",
            short_hash(&[digest.as_bytes()]),
            json_in_script(&json)
        );
        let owner = format!("lab #{number}");
        let hash = short_hash(&[VERSION.as_bytes(), block.body.value.as_bytes(), digest.as_bytes()]);
        let mark = self
            .verified
            .get(&owner)
            .map_or(String::new(), |n| mark("Verified", &[counted(*n, "claim")], &hash));
        let twin = if self.has_twins { format!("<div class=\"twin\">{twin}</div>") } else { twin };
        FencePart { kind: "lab", content, after: format!("{twin}{mark}") }
    }

    fn quiz(&mut self, block: &Block, quiz: &Quiz, addresses: &mut dyn Addresses) -> FencePart {
        let Some(json) = shown_json(&block.body.value, None) else {
            return broken(block, "This quiz cannot be read");
        };
        let digest = self.deliver(quiz.numbered().filter_map(|(_, question)| question.sim()));
        let id = escape(self.ids.find(block.span.start).unwrap_or(""));
        let content = format!(
            "<lesson-quiz id=\"{id}\" data-models-hash=\"{}\"><script type=\"application/json\">{}</script></lesson-quiz>",
            short_hash(&[digest.as_bytes()]),
            json_in_script(&json)
        );
        let name = quiz.id.as_ref().map_or("", |id| id.as_str());
        let of_question = |n: usize| Some((n, *self.verified.get(&format!("quiz {name}, question {n}"))?));
        let verified: Vec<String> = (1..=quiz.questions.len())
            .filter_map(of_question)
            .map(|(n, claims)| format!("question {n} ({})", counted(claims, "claim")))
            .collect();
        let hash = short_hash(&[VERSION.as_bytes(), block.body.value.as_bytes(), digest.as_bytes()]);
        let mark = if verified.is_empty() { String::new() } else { mark("Verified", &verified, &hash) };
        let twin = match self.has_twins {
            true => format!("<div class=\"twin\">{}</div>", quiz_twin(quiz, addresses)),
            false => String::new(),
        };
        FencePart { kind: "quiz", content, after: format!("{twin}{mark}") }
    }

    /// Delivers the models of labs; returns a digest of them.
    fn deliver<'l>(&mut self, labs: impl Iterator<Item = &'l Lab>) -> String {
        let mut names = BTreeSet::new();
        for lab in labs {
            if let Some(ModelSource::Model(name)) = lab.scene() {
                names.insert(name.as_str());
            }
        }
        let mut digest = String::new();
        for name in names {
            digest.push_str(&self.shelf.digest(self.folder, name));
            if self.embedded.contains_key(name) {
                continue;
            }
            match self.shelf.deliver(self.folder, name) {
                Delivery::Embedded(text) => {
                    self.embedded.insert(name.to_string(), text);
                }
                Delivery::Files => self.needs_files = true,
                Delivery::Missing => {}
            }
        }
        digest
    }
}

/// The JSON of a block as the elements need it, without what only a check reads. `None` where it is not JSON. The list of
/// integrators is always present: by it, the elements recognize a comparison.
fn shown_json(body: &str, comparison: Option<&Comparison>) -> Option<String> {
    let mut value: Value = serde_json::from_str(body).ok()?;
    without_claims(&mut value);
    if let (Some(comparison), Some(object)) = (comparison, value.as_object_mut()) {
        object.insert("integrators".into(), comparison.integrators.as_slice().into());
    }
    Some(value.to_string())
}

fn without_claims(value: &mut Value) {
    let Some(object) = value.as_object_mut() else { return };
    object.shift_remove("verify");
    object.shift_remove("lint");
    for question in object.get_mut("questions").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(question) = question.as_object_mut() {
            question.shift_remove("verify");
            question.shift_remove("lint");
            question.get_mut("sim").into_iter().for_each(without_claims);
        }
    }
}

/// The mark of verified claims.
fn mark(word: &str, parts: &[String], hash: &str) -> String {
    format!(
        "<p class=\"verified\"><span aria-hidden=\"true\">✓</span> <b>{word}</b>: {} <small>by labspec {VERSION}, content <code>{hash}</code></small></p>",
        escape(&parts.join(", "))
    )
}

fn broken(block: &Block, why: &str) -> FencePart {
    let content = format!(
        "<div class=\"broken\"><p><b>{why}.</b> Its source:</p><pre tabindex=\"0\"><code>{}</code></pre></div>",
        escape(&block.body.value)
    );
    FencePart { kind: "broken", content, after: String::new() }
}

fn widget(block: &Block, name: &str) -> FencePart {
    let content = format!(
        "<div class=\"widget\"><p>A block of the widget <code>{}</code>, which this page does not have.</p><details><summary>Source</summary><pre tabindex=\"0\"><code>{}</code></pre></details></div>",
        escape(name),
        escape(&block.body.value)
    );
    FencePart { kind: "widget", content, after: String::new() }
}

fn code(block: &Block, language: &str, file: Option<&str>) -> FencePart {
    let class = slug(language);
    let class =
        if class.is_empty() { String::new() } else { format!(" class=\"language-{}\"", escape(&class)) };
    let caption =
        file.map_or(String::new(), |file| format!("<figcaption><code>{}</code></figcaption>", escape(file)));
    let content = format!(
        "<figure class=\"code\">{caption}<pre tabindex=\"0\"><code{class}>{}</code></pre></figure>",
        escape(&block.body.value)
    );
    FencePart { kind: "code", content, after: String::new() }
}
