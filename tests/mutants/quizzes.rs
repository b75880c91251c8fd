//! Kinds of mistakes in quizzes.

use super::Kind;
use super::edit::{each, text};
use serde_json::{Value, json};

const fn kind(name: &'static str, words: &'static str, plant: fn(&Value) -> Vec<Value>) -> Kind {
    Kind { name, words, plant, right: None }
}

/// Changes every question.
fn questions(quiz: &Value, change: fn(&mut Value) -> Option<()>) -> Vec<Value> {
    each(quiz, &["questions", "*"], |old| {
        let mut new = old.clone();
        change(&mut new)?;
        Some(new)
    })
}

/// Sets a key of every numeric question to a value computed from its answer.
fn numeric(quiz: &Value, key: &'static str, value: impl Fn(f64) -> f64) -> Vec<Value> {
    each(quiz, &["questions", "*"], |old| {
        let mut new = old.clone();
        let answer = (new["kind"] == "numeric").then(|| new["answer"].as_f64())??;
        new[key] = json!(value(answer));
        Some(new)
    })
}

pub(super) const QUIZZES: [Kind; 26] = [
    kind("key-shifted", "the key is the next option", |q| {
        questions(q, |q| {
            let count = q["options"].as_array()?.len() as u64;
            q["answer"] = json!((q["answer"].as_u64()? + 1) % count);
            Some(())
        })
    }),
    kind("key-outside", "the key is not an option", |q| {
        questions(q, |q| {
            q["answer"] = json!(q["options"].as_array()?.len());
            Some(())
        })
    }),
    kind("key-is-text", "the key is a text", |q| {
        questions(q, |q| {
            q["answer"] = json!(q["answer"].as_f64()?.to_string());
            Some(())
        })
    }),
    kind("no-answer", "the answer is missing", |q| {
        questions(q, |q| q.as_object_mut()?.shift_remove("answer").map(drop))
    }),
    kind("same-options", "two options are identical", |q| {
        questions(q, |q| {
            let first = q["options"].get(0)?.clone();
            *q["options"].get_mut(1)? = first;
            Some(())
        })
    }),
    kind("one-option", "there is only one option", |q| {
        questions(q, |q| {
            q["options"].as_array_mut()?.truncate(1);
            q["answer"] = json!(0);
            Some(())
        })
    }),
    kind("takes-everything", "the tolerance accepts every answer", |q| {
        numeric(q, "tol", |a| 3.0 * a.abs() + 1.0)
    }),
    kind("takes-zero", "the tolerance accepts 0 as well", |q| numeric(q, "tol", |a| 1.05 * a.abs())),
    kind("no-tolerance", "the tolerance is 0", |q| numeric(q, "tol", |_| 0.0)),
    kind("negative-tolerance", "the tolerance is negative", |q| numeric(q, "tol", |a| -0.1 * a.abs())),
    kind("tiny-tolerance", "the tolerance is smaller than a student can type", |q| {
        numeric(q, "tol", |a| 1e-13 * a.abs())
    }),
    kind("ten-times", "the answer is ten times too large", |q| numeric(q, "answer", |a| 10.0 * a)),
    kind("answer-sign", "the answer has the wrong sign", |q| numeric(q, "answer", |a| -a)),
    kind("no-question", "a question has no text", |q| {
        questions(q, |q| q.as_object_mut()?.shift_remove("q").map(drop))
    }),
    kind("unknown-kind", "the kind of a question is misspelt", |q| {
        text(q, &["questions", "*", "kind"], |k| Some(format!("{k}s")))
    }),
    kind("no-id", "a quiz has no id", |q| super::edit::without(q, "id")),
    kind("no-questions", "a quiz has no questions", |q| super::edit::with(q, "questions", json!([]))),
    kind("latex", "the backslash of a formula is not escaped in JSON", |q| {
        text(q, &["questions", "*", "explain"], |t| t.contains("\\t").then(|| t.replacen("\\t", "\t", 1)))
    }),
    kind("unclosed-tag", "an element is not closed", |q| {
        text(q, &["questions", "*", "explain"], |t| super::edit::swap(t, "</code>", ""))
    }),
    kind("misspelt-question-key", "a key is misspelt", |q| {
        questions(q, |q| {
            let object = q.as_object_mut()?;
            let old = object.shift_remove("explain")?;
            object.insert("explian".into(), old);
            Some(())
        })
    }),
    kind("answer-digit", "the last digit of the answer is wrong", |q| {
        numeric(q, "answer", |a| {
            let text = a.to_string();
            let decimals = text.split_once('.').map_or(0, |(_, d)| d.len());
            format!("{:.decimals$}", a + 0.1_f64.powi(decimals as i32)).parse().unwrap()
        })
    }),
    kind("takes-half", "the tolerance accepts half of the answer", |q| numeric(q, "tol", |a| 0.6 * a.abs())),
    kind("reworded-option", "an option repeats another one in different capitalization", |q| {
        questions(q, |q| {
            let first = q["options"].get(0)?.as_str()?.to_string();
            *q["options"].get_mut(1)? = json!(format!("The {first}."));
            Some(())
        })
    }),
    kind("open-formula", "a formula is not closed", |q| {
        text(q, &["questions", "*", "explain"], |t| {
            t.rfind('$').map(|at| format!("{}{}", &t[..at], &t[at + 1..])).filter(|_| t.contains("$"))
        })
    }),
    kind("misspelt-tag", "the name of an element is misspelt", |q| {
        text(q, &["questions", "*", "explain"], |t| super::edit::swap(t, "<code>", "<cdoe>"))
    }),
    kind("other-letter", "the explanation calls another option right", |q| {
        questions(q, |q| {
            let count = q["options"].as_array()?.len() as u64;
            let other = (q["answer"].as_u64()? + 1) % count;
            let letter = char::from(b'A' + other as u8);
            q["explain"] =
                json!(format!("Option {letter} is right. {}", q["explain"].as_str().unwrap_or("")));
            Some(())
        })
    }),
];
