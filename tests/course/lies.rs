//! False statements, inserted one after another into every answer and every claimed number of the course.

use super::places::{Place, digits, places, quotes, verifies};
use super::{CourseLesson, checked, counts, course, for_each, list_findings, models};
use crate::population::{minimum, sample};
use labspec::bind::scene::Models;
use labspec::check::CheckLevel;
use labspec::verify::QuoteState;
use std::ops::Range;

/// Changes a number to a false one; `None` if the result is the same number.
type Falsification = fn(&str) -> Option<String>;

/// The ways to falsify a number.
const FALSIFICATIONS: [(&str, Falsification); 3] = [("a digit", digit), ("a tenth", tenth), ("a unit", unit)];

/// A sample has one falsification of `STEP`.
const STEP: usize = 3;

/// Half of g h t is 0.73575 mm for the shortest step. It can be rounded to either neighbour, so the next one is not false.
const UNDETECTABLE: &str = "-0.7357";

/// Increases the last digit by one.
fn digit(quote: &str) -> Option<String> {
    let at = digits(quote);
    let decimals = quote[at.clone()].split_once('.').map_or(0, |(_, d)| d.len());
    let value: f64 = quote[at.clone()].parse().ok()?;
    let other = value + 0.1_f64.powi(decimals as i32);
    Some(format!("{}{other:.decimals$}{}", &quote[..at.start], &quote[at.end..]))
}

/// Increases the number by a tenth, with an additional digit if necessary.
fn tenth(quote: &str) -> Option<String> {
    let at = digits(quote);
    let decimals = quote[at.clone()].split_once('.').map_or(0, |(_, d)| d.len());
    let value: f64 = quote[at.clone()].parse().ok()?;
    let print = |decimals: usize| format!("{:.decimals$}", 1.1 * value);
    let same = print(decimals).parse::<f64>().ok()? == value;
    let other = print(if same { decimals + 1 } else { decimals });
    Some(format!("{}{other}{}", &quote[..at.start], &quote[at.end..]))
}

/// Units, and others that differ by a factor.
const UNITS: [(&str, &str); 24] = [
    ("kg m²", "g m²"),
    ("kg m/s", "g m/s"),
    ("g m²/s", "kg m²/s"),
    ("g m²", "kg m²"),
    ("m/s²", "mm/s²"),
    ("N s/m", "N s/mm"),
    ("N/m", "N/mm"),
    ("N m", "N mm"),
    ("mrad/s", "rad/s"),
    ("rad/s", "mrad/s"),
    ("mm/s", "m/s"),
    ("m/s", "mm/s"),
    ("rad", "mrad"),
    ("mm", "m"),
    ("cm", "m"),
    ("ms", "s"),
    ("mJ", "J"),
    ("kg", "g"),
    ("°", " rad"),
    ("m", "mm"),
    ("s", "ms"),
    ("N", "mN"),
    ("J", "mJ"),
    ("g", "kg"),
];

/// Changes the unit.
fn unit(quote: &str) -> Option<String> {
    let at = digits(quote);
    let rest = &quote[at.end..];
    let printed = rest.trim_start();
    let (_, other) = UNITS.iter().find(|(unit, _)| *unit == printed)?;
    let space = &rest[..rest.len() - printed.len()];
    Some(format!("{}{space}{other}", &quote[..at.end]))
}

/// A text with replacements at these byte ranges.
fn replaced(text: &str, changes: &[(Range<usize>, String)]) -> String {
    let (mut out, mut from) = (String::new(), 0);
    for (at, new) in changes {
        out.push_str(&text[from..at.start]);
        out.push_str(new);
        from = at.end;
    }
    out + &text[from..]
}

/// The lesson with formulas instead of measures, and with runs of one step. The location of a number does not depend on what
/// was computed, so a thousand false numbers can be tested in a short time.
fn without_runs(text: &str) -> String {
    let claims = |object: &Range<usize>| {
        let object_text = &text[object.clone()];
        let old: serde_json::Value =
            serde_json::from_str(&object_text[object_text.find('{').unwrap()..]).unwrap();
        let formula = |quote: String| {
            let at = digits(&quote);
            let sign = if quote[..at.start].ends_with('-') { "-" } else { "" };
            let value = format!("{sign}{} * 1", &quote[at]);
            serde_json::json!([quote, value])
        };
        let says: Vec<_> = quotes(object_text).into_iter().map(formula).collect();
        let mut new = serde_json::json!({ "says": says });
        if old["runs"].is_object() {
            new["runs"] = serde_json::json!({"r": {"steps": 1}});
        }
        if !old["lab"].is_null() {
            new["lab"] = old["lab"].clone();
        }
        (object.clone(), format!("\"verify\": {new}"))
    };
    let changes: Vec<_> = verifies(text).iter().map(claims).collect();
    replaced(text, &changes)
}

/// Whether a false number in the text is found while the claim is right: at its location, or at the claim,
/// whose quote is then missing.
fn is_detected(name: &str, text: &str, place: &Place, falsified: &str, models: &Models) -> bool {
    let lied = replaced(text, &[(place.at.clone(), falsified.to_string())]);
    let checked = checked(name, &lied, models, CheckLevel::CLAIMS);
    let end = place.at.start + falsified.len();
    let claim = |span: &Range<usize>| lied.get(span.clone()).is_some_and(|t| t.contains(&place.quote));
    checked.findings.iter().filter(|f| counts(f)).any(|f| {
        let here = |span: &Range<usize>| span.start < end && place.at.start < span.end;
        here(&f.span) || claim(&f.span) || f.related.iter().any(|p| here(&p.span))
    })
}

/// An author changes a number in the text but not in the claim.
#[test]
fn a_number_that_is_changed_in_the_text_is_found() {
    let models = models();
    let mut cases = Vec::new();
    let lessons: Vec<CourseLesson> = course()
        .into_iter()
        .map(|lesson| CourseLesson { text: without_runs(&lesson.text), ..lesson })
        .collect();
    for (l, lesson) in lessons.iter().enumerate() {
        let plain = checked(&lesson.name, &lesson.text, &models, CheckLevel::CLAIMS);
        // An object without a number claims nothing any more.
        let findings = list_findings(&plain).into_iter().filter(|f| !f.contains("verify-nothing"));
        assert_eq!(findings.collect::<Vec<_>>(), [] as [&str; 0], "{}", lesson.name);
        for place in places(&lesson.text) {
            for (how, falsified) in FALSIFICATIONS {
                cases.extend(falsified(&place.quote).map(|falsified| (l, place.clone(), how, falsified)));
            }
        }
    }
    let cases = sample(cases, STEP);
    let found = for_each(cases.len(), |i| {
        let (l, place, _, falsified) = &cases[i];
        is_detected(&lessons[*l].name, &lessons[*l].text, place, falsified, &models)
    });
    let mut undetected = Vec::new();
    for ((l, place, how, falsified), _) in cases.iter().zip(&found).filter(|(_, found)| !**found) {
        let line = lessons[*l].text[..place.at.start].matches('\n').count() + 1;
        undetected.push(format!("{}:{line}: {} as {falsified} ({how})", lessons[*l].name, place.quote));
    }
    eprintln!("{} lies in the text, {} missed", cases.len(), undetected.len());
    assert!(cases.len() > minimum(900, STEP), "{}", cases.len());
    assert!(undetected.is_empty(), "{}", undetected.join("\n"));
}

/// Falsifies all numbers of a lesson that can be falsified in this way, in the text and in the claims. Returns how many there
/// are, and which of them are judged right.
fn undetected(
    lesson: &CourseLesson,
    how: &str,
    falsified: Falsification,
    models: &Models,
) -> (usize, Vec<String>) {
    // All at once, because each is judged separately.
    let mut changes: Vec<_> =
        places(&lesson.text).into_iter().filter_map(|p| Some((p.at, falsified(&p.quote)?))).collect();
    let mut lies = Vec::new();
    for object in verifies(&lesson.text) {
        let mut from = object.start;
        for quote in quotes(&lesson.text[object.clone()]) {
            let pair = format!("[\"{quote}\"");
            let at = from + lesson.text[from..object.end].find(&pair).unwrap() + 2;
            from = at;
            let Some(other) = falsified(&quote) else { continue };
            changes.push((at..at + quote.len(), other.clone()));
            lies.push(other);
        }
    }
    changes.sort_by_key(|(at, _)| at.start);
    let checked = checked(&lesson.name, &replaced(&lesson.text, &changes), models, CheckLevel::CLAIMS);
    let quoted: Vec<_> = checked.claims.iter().flat_map(|c| &c.judgement.quotes).collect();
    let all: Vec<_> = quoted.into_iter().filter(|q| lies.contains(&q.text)).collect();
    assert_eq!(all.len(), lies.len(), "{}", lesson.name);
    let either = digit(UNDETECTABLE).unwrap();
    let right = all.iter().filter(|q| q.state == QuoteState::Right && q.text != either);
    (lies.len(), right.map(|q| format!("{}: {} ({how})", lesson.name, q.text)).collect())
}

/// An author is wrong about a number and writes the wrong number into the text and into the claim.
#[test]
fn a_number_that_is_claimed_wrongly_is_refuted() {
    let models = models();
    let lessons = course();
    let cases: Vec<_> = (0..lessons.len())
        .flat_map(|l| FALSIFICATIONS[..2].iter().map(move |falsified| (l, *falsified)))
        .collect();
    let undetected = for_each(cases.len(), |i| {
        let (l, (how, falsified)) = cases[i];
        undetected(&lessons[l], how, falsified, &models)
    });
    let count: usize = undetected.iter().map(|(count, _)| count).sum();
    let undetected: Vec<String> = undetected.into_iter().flat_map(|(_, undetected)| undetected).collect();
    eprintln!("{count} false claims, {} held to be right", undetected.len());
    assert!(count > 600 && undetected.is_empty(), "{}", undetected.join("\n"));
}

/// An author is wrong about the unit of a number and writes it into the text and into the claim. This is found if the fields
/// that the claim reads have a unit: not for numbers from texts, gains and `solref`, and not where a factor may have a unit.
#[test]
fn a_unit_that_is_claimed_wrongly_is_refuted() {
    let models = models();
    let lessons = course();
    let undetected = for_each(lessons.len(), |l| undetected(&lessons[l], "a unit", unit, &models));
    let count: usize = undetected.iter().map(|(count, _)| count).sum();
    let undetected: Vec<String> = undetected.into_iter().flat_map(|(_, undetected)| undetected).collect();
    eprintln!("{count} false units, {} held to be right", undetected.len());
    assert!(
        count > 300 && undetected.len() * 7 <= count,
        "{} of {count}:\n{}",
        undetected.len(),
        undetected.join("\n")
    );
}

/// The keyed options of a lesson: the byte range of each `"answer": N` of a question with options, the key,
/// and the number of options.
fn keys(text: &str) -> Vec<(Range<usize>, usize, usize)> {
    let mut all = Vec::new();
    for (start, _) in text.match_indices("\"options\": [\"") {
        let open = start + "\"options\": ".len();
        let mut stream = serde_json::Deserializer::from_str(&text[open..]).into_iter::<Vec<String>>();
        let Some(Ok(options)) = stream.next() else { continue };
        let end = open + stream.byte_offset();
        let Some(answer) = text[end..].strip_prefix(",\n   \"answer\": ") else { continue };
        let length = answer.find(',').unwrap();
        let at = text.len() - answer.len();
        all.push((at..at + length, answer[..length].parse().unwrap(), options.len()));
    }
    all
}

/// Each other option is marked as the right one, in turn, and every numeric answer is increased by a tenth.
#[test]
fn every_wrong_key_is_found() {
    let models = models();
    let lessons = course();
    let mut cases = Vec::new();
    for (l, lesson) in lessons.iter().enumerate() {
        for (at, right, count) in keys(&lesson.text) {
            cases.extend((0..count).filter(|k| *k != right).map(|k| (l, at.clone(), k.to_string())));
        }
        for (start, found) in lesson.text.match_indices("\"answer\": ") {
            let at = start + found.len();
            let end = at + lesson.text[at..].find(',').unwrap();
            if lesson.text[end..].starts_with(", \"tol\"") {
                let value: f64 = lesson.text[at..end].parse().unwrap();
                cases.push((l, at..end, format!("{}", 1.1 * value)));
            }
        }
    }
    let cases = sample(cases, STEP);
    let found = for_each(cases.len(), |i| {
        let (l, at, key) = &cases[i];
        let lesson = &lessons[*l];
        let lied = replaced(&lesson.text, &[(at.clone(), key.clone())]);
        let checked = checked(&lesson.name, &lied, &models, CheckLevel::CLAIMS);
        let end = at.start + key.len();
        checked.findings.iter().any(|f| counts(f) && f.span.start < end && at.start < f.span.end)
    });
    let undetected: Vec<String> = cases
        .iter()
        .zip(&found)
        .filter(|(_, found)| !**found)
        .map(|((l, at, key), _)| {
            let line = lessons[*l].text[..at.start].matches('\n').count() + 1;
            format!("{}:{line}: answer {key}", lessons[*l].name)
        })
        .collect();
    eprintln!("{} wrong keys, {} missed", cases.len(), undetected.len());
    assert!(
        cases.len() > minimum(80, STEP) && undetected.is_empty(),
        "{} of {}:\n{}",
        undetected.len(),
        cases.len(),
        undetected.join("\n")
    );
}
