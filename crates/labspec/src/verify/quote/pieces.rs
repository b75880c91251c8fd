//! The rendered texts of a lesson: its prose, and the displayed texts of its labs and quizzes.

use super::hidden::HiddenElement;
use super::html::visible_text;
use super::prose;
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab, Lesson, Question, QuestionKind};

pub(super) fn rendered_pieces(lesson: &Lesson) -> Vec<Text> {
    let mut all = prose::pieces(lesson);
    for (_, lab) in lesson.addressed() {
        push_lab(lab, &mut all);
    }
    for quiz in &lesson.quizzes {
        push_plain(&quiz.title, &mut all);
        for (_, question) in quiz.numbered() {
            push_question(question, &mut all);
        }
    }
    for piece in &mut all {
        if let Some(visible) = lesson.conventions.without_macros(&piece.value) {
            piece.value = visible;
        }
    }
    all
}

fn push_plain<'a>(texts: impl IntoIterator<Item = &'a Text>, all: &mut Vec<Text>) {
    all.extend(texts.into_iter().cloned());
}

fn push_html<'a>(texts: impl IntoIterator<Item = &'a Text>, all: &mut Vec<Text>) {
    all.extend(texts.into_iter().map(|text| visible_text(text, &mut HiddenElement::default())));
}

fn push_question(question: &Question, all: &mut Vec<Text>) {
    push_plain(&question.label, all);
    if let QuestionKind::Numeric { unit, .. } = &question.kind {
        push_plain(unit, all);
    }
    push_html(question.html(), all);
}

fn push_lab(lab: &Lab, all: &mut Vec<Text>) {
    push_plain(lab.title.iter().chain(&lab.kind), all);
    push_html(&lab.note, all);
    lab.controls.iter().for_each(|control| push_control(control, all));
    for plot in &lab.plots {
        push_plain(plot.ylabel.iter().chain(&plot.xlabel), all);
        push_plain(plot.ref_lines.iter().filter_map(|line| line.label.as_ref()), all);
        push_plain(plot.traces.iter().map(|trace| &trace.label), all);
    }
    push_plain(lab.readouts.iter().map(|readout| &readout.label), all);
}

fn push_control(control: &Control, all: &mut Vec<Text>) {
    push_plain([&control.label], all);
    match &control.kind {
        ControlKind::Slider { unit, .. } => push_plain(unit, all),
        ControlKind::Select { options, .. } => push_plain(options.iter().map(|choice| &choice.text), all),
        ControlKind::Button { .. } => {}
    }
}
