//! The outline of a lesson: its headings, and under them its labs and quizzes with their parts.

use super::item::{OutlineItem, OutlineKind};
use labspec::source::Text;
use labspec::spec::{Control, ControlKind, Lab, Lesson, ModelSource, Question, Quiz, Verify};
use labspec::verify::plain;
use std::ops::Range;

/// The maximum number of characters of a name.
const LONGEST: usize = 60;
/// The level of labs and quizzes: below all headings.
const BLOCK: usize = 7;

/// The outline of a lesson, in the order of the text.
pub fn outline(lesson: &Lesson) -> Vec<OutlineItem> {
    let mut all: Vec<(usize, OutlineItem)> = headings(lesson);
    all.extend(lesson.labs.iter().map(|entry| (BLOCK, lab_entry(entry.number, &entry.span, &entry.lab))));
    all.extend(lesson.quizzes.iter().map(|quiz| (BLOCK, quiz_item(quiz))));
    all.extend(lesson.widgets.iter().map(|widget| {
        (BLOCK, item(OutlineKind::Lab, &format!("widget {}", widget.name), "", &widget.span, &widget.span))
    }));
    all.extend(lesson.claim_comments.iter().map(|comment| {
        let named = item(OutlineKind::Claim, "claim in a comment", "", &comment.span, &comment.span);
        (BLOCK, OutlineItem { children: claim_items(&comment.verify), ..named })
    }));
    all.sort_by_key(|(level, item)| (item.span.start, *level));
    nested(all)
}

/// The headings with their levels, from 1. Their spans are those of their sections.
fn headings(lesson: &Lesson) -> Vec<(usize, OutlineItem)> {
    let read = sections(lesson).into_iter();
    read.map(|(level, heading, section)| {
        let text = lesson.file.slice(heading.clone());
        let line = text.lines().next().unwrap_or("").trim_start_matches(['#', ' ', '\t', '>']);
        let name = line.trim_end().trim_end_matches('#');
        (level, item(OutlineKind::Heading, name, "", &section, &heading))
    })
    .collect()
}

/// The level, the heading and the section of every heading. A section ends where the next one of its level, or of a higher
/// one, begins.
pub(crate) fn sections(lesson: &Lesson) -> Vec<(usize, Range<usize>, Range<usize>)> {
    let file = &lesson.file;
    let all =
        lesson.scan.headings.iter().map(|heading| (level(file.slice(heading.clone())), heading.clone()));
    let all: Vec<(usize, Range<usize>)> = all.collect();
    let end = |index: usize, level: usize| {
        let next = all.iter().skip(index + 1).find(|(other, _)| *other <= level);
        next.map_or(file.text().len(), |(_, heading)| heading.start)
    };
    let one = |(index, (level, heading)): (usize, &(usize, Range<usize>))| {
        (*level, heading.clone(), heading.start..end(index, *level).max(heading.end))
    };
    all.iter().enumerate().map(one).collect()
}

/// The level of a heading: the number of its marks, or that of its underline.
fn level(heading: &str) -> usize {
    let text = heading.trim();
    match text.chars().take_while(|c| *c == '#').count() {
        0 if text.ends_with('=') => 1,
        0 => 2,
        marks => marks.min(BLOCK - 1),
    }
}

/// Puts each item below the last one before it that has a higher level and contains its start.
fn nested(all: Vec<(usize, OutlineItem)>) -> Vec<OutlineItem> {
    let mut top: Vec<OutlineItem> = Vec::new();
    let mut open: Vec<(usize, OutlineItem)> = Vec::new();
    for (level, item) in all {
        while open.last().is_some_and(|(other, o)| *other >= level || o.span.end <= item.span.start) {
            close(&mut open, &mut top);
        }
        open.push((level, item));
    }
    while !open.is_empty() {
        close(&mut open, &mut top);
    }
    top
}

/// Moves the last open item to the children of the one before it.
fn close(open: &mut Vec<(usize, OutlineItem)>, top: &mut Vec<OutlineItem>) {
    let Some((_, item)) = open.pop() else { return };
    match open.last_mut() {
        Some((_, parent)) => {
            parent.span.end = parent.span.end.max(item.span.end);
            parent.children.push(item);
        }
        None => top.push(item),
    }
}

fn lab_entry(number: usize, span: &Range<usize>, lab: &Option<Lab>) -> OutlineItem {
    let name = match lab.as_ref().and_then(|lab| lab.title.as_ref()) {
        Some(title) => format!("{number}. {}", title.value),
        None => format!("lab {number}"),
    };
    let selection = lab.as_ref().map_or(span, |lab| &lab.span);
    let model = lab.as_ref().map_or("", model_of);
    let named = item(OutlineKind::Lab, &name, model, span, selection);
    OutlineItem { children: lab.as_ref().map_or(Vec::new(), lab_items), ..named }
}

/// The name of the model of a lab.
fn model_of(lab: &Lab) -> &str {
    match lab.scene() {
        Some(ModelSource::Model(name)) => name.as_str(),
        _ => "",
    }
}

/// The controls, traces and readouts of a lab, and the parts of its claim.
fn lab_items(lab: &Lab) -> Vec<OutlineItem> {
    let control = |c: &Control| {
        let kind = match &c.kind {
            ControlKind::Slider { .. } => "slider",
            ControlKind::Select { .. } => "select",
            ControlKind::Button { .. } => "button",
        };
        item(OutlineKind::Control, &c.label.value, kind, &c.span, &c.label.span())
    };
    let mut all: Vec<OutlineItem> = lab.authored_controls().iter().map(control).collect();
    // A comparison adds the first plot.
    let added = usize::from(lab.comparison.is_some());
    let traces = lab.traces().skip(added);
    all.extend(traces.map(|t| item(OutlineKind::Trace, &t.label.value, "trace", &t.span, &t.label.span())));
    let readouts = lab.readouts.iter();
    all.extend(
        readouts.map(|r| item(OutlineKind::Readout, &r.label.value, "readout", &r.span, &r.label.span())),
    );
    all.extend(lab.verify.iter().flat_map(claim_items));
    all
}

/// The runs and the measures of a claim.
fn claim_items(verify: &Verify) -> Vec<OutlineItem> {
    let named = |kind, name: &Text, what: &str| item(kind, &name.value, what, &name.span(), &name.span());
    let mut all: Vec<OutlineItem> =
        verify.runs.iter().map(|run| named(OutlineKind::Run, &run.name, "run")).collect();
    all.extend(verify.measure.iter().map(|(name, code)| {
        let span = name.span().start..code.span().end;
        item(OutlineKind::Measure, &name.value, "measure", &span, &name.span())
    }));
    all.extend(verify.find.iter().map(|find| named(OutlineKind::Measure, &find.name, "search")));
    all
}

fn quiz_item(quiz: &Quiz) -> OutlineItem {
    let id = quiz.id.as_ref().map_or("", Text::as_str);
    let questions = quiz.numbered().map(|(number, question)| question_item(number, question));
    let named = item(OutlineKind::Quiz, quiz.title(), id, &quiz.span, &quiz.span);
    OutlineItem { children: questions.collect(), ..named }
}

fn question_item(number: usize, question: &Question) -> OutlineItem {
    let name = format!("{number}. {}", plain(&question.q.value));
    let named = item(OutlineKind::Question, &name, "", &question.span, &question.q.span());
    let mut children: Vec<OutlineItem> = question
        .sim()
        .map(|sim| {
            let named = item(OutlineKind::Lab, sim.title(), model_of(sim), &sim.span, &sim.span);
            OutlineItem { children: lab_items(sim), ..named }
        })
        .into_iter()
        .collect();
    children.extend(question.verify.iter().flat_map(claim_items));
    OutlineItem { children, ..named }
}

/// An item without children. The selection is inside of the span, and the name is not empty.
fn item(
    kind: OutlineKind,
    name: &str,
    detail: &str,
    span: &Range<usize>,
    selection: &Range<usize>,
) -> OutlineItem {
    let words = name.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut short: String = words.chars().take(LONGEST).collect();
    if short.len() < words.len() {
        short.push('…');
    }
    if short.is_empty() {
        short = kind.as_str().to_string();
    }
    let is_inside = span.start <= selection.start && selection.end <= span.end;
    OutlineItem {
        name: short,
        detail: detail.to_string(),
        kind,
        span: span.clone(),
        selection: if is_inside { selection.clone() } else { span.start..span.start },
        children: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::{ModelFolder, load_lesson};
    use labspec::source::SourceFile;
    use std::fmt::Write;

    fn tree(items: &[OutlineItem], depth: usize, out: &mut String) {
        for item in items {
            let detail = if item.detail.is_empty() { String::new() } else { format!(" ({})", item.detail) };
            writeln!(out, "{}{}: {}{detail}", "  ".repeat(depth), item.kind.as_str(), item.name).unwrap();
            tree(&item.children, depth + 1, out);
        }
    }

    /// Names are not empty, selections are inside of spans, and children inside of their parents.
    pub(crate) fn check_nesting(items: &[OutlineItem], within: &Range<usize>) {
        for item in items {
            assert!(within.start <= item.span.start && item.span.end <= within.end, "{item:?} in {within:?}");
            assert!(
                item.span.start <= item.selection.start && item.selection.end <= item.span.end,
                "{item:?}"
            );
            assert!(!item.name.is_empty());
            check_nesting(&item.children, &item.span);
        }
    }

    #[test]
    fn the_outline_has_headings_labs_and_questions() {
        let text = r##"Before

# Fälle *of* 𝄞 ##

```lab simlab
{"model": "a", "title": "A drop",
 "controls": [{"label": "h", "min": 0, "max": 1, "value": 0, "set": "data.qpos[2]"}, {"type": "button", "label": "go", "run": ""}],
 "plots": [{"traces": [{"label": "z", "expr": "1"}]}],
 "readouts": [{"label": "speed", "expr": "2"}, {"label": "", "expr": "2"}],
 "verify": {"runs": {"fall": {"until": 1}}, "measure": {"touch": "first(1)"}, "says": []}}
```

Under
-----

<!-- labspec verify {"lab": "#1", "measure": {"low": "min(1)"}, "says": []} -->
It is low.

```quiz
{"id": "q", "title": "Check", "questions": [
 {"kind": "predict", "q": "Which <b>one</b> of all these very many words is the one that is the very last one here?", "options": ["a", "b"], "answer": 0,
  "sim": {"model": "b", "readouts": [{"label": "r", "expr": "1"}]}, "verify": {"measure": {"m": "1"}, "options": ["m", "m"]}}]}
```

# Last

```lab
{broken
```

```lab integrators
{"model": "c", "plots": [{"traces": [{"label": "own", "expr": "1"}]}]}
```
"##;
        let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown());
        let all = outline(&lesson);
        check_nesting(&all, &(0..text.len()));
        let mut written = String::new();
        tree(&all, 0, &mut written);
        let expected = "heading: Fälle *of* 𝄞
  lab: 1. A drop (a)
    control: h (slider)
    control: go (button)
    trace: z (trace)
    readout: speed (readout)
    readout: readout (readout)
    run: fall (run)
    measure: touch (measure)
  heading: Under
    claim: claim in a comment
      measure: low (measure)
    quiz: Check (q)
      question: 1. Which one of all these very many words is the one that is…
        lab: lab (b)
          readout: r (readout)
        measure: m (measure)
heading: Last
  lab: lab 2
  lab: lab 3 (c)
    trace: own (trace)
";
        assert_eq!(written, expected);
        // A lab as JSON has no headings.
        let alone = load_lesson(SourceFile::new("a.json", "{\"model\": \"a\"}"), &ModelFolder::unknown());
        assert_eq!(outline(&alone).len(), 1);
    }
}
