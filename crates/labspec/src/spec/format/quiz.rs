//! The quiz and its kinds of questions.

use super::lab::verify_key;
use super::lint::lint_key;
use super::{Absent, Family, Key, KeyRule, LAB, Object, Type, Word, key};
use labspec_finding::docs;

static KINDS: [Word; 8] = [
    Word { text: "mcq", doc: docs("one of several options") },
    Word { text: "debug", doc: docs("the same, about a mistake that the student must find") },
    Word { text: "predict", doc: docs("the same, before a simulation shows the correct answer") },
    Word { text: "multiple", doc: docs("all correct ones of several options") },
    Word { text: "truefalse", doc: docs("whether a statement is true") },
    Word { text: "numeric", doc: docs("a number, correct within a tolerance") },
    Word { text: "open", doc: docs("a text, which is not graded") },
    Word { text: "code", doc: docs("a program, which is not graded") },
];

/// A question of any kind.
pub static QUESTION: Family = Family {
    name: "question",
    what: "a question",
    doc: docs("What a quiz asks."),
    key: "kind",
    words: &KINDS,
    objects: &[&MCQ, &DEBUG, &PREDICT, &MULTIPLE, &TRUEFALSE, &NUMERIC, &OPEN, &CODE],
};

static ONE_QUESTION: Type = Type::OneOf(&QUESTION);
static HTML: Type = Type::Html;

/// A quiz.
pub static QUIZ: Object = Object {
    name: "quiz",
    what: "a quiz",
    doc: docs("Questions with answers."),
    tag: None,
    minimal: r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    keys: &[
        key("id", Type::Text, "its name, unique in a course: the page stores answers under it", r#""fall""#)
            .must("the page stores a student's answers under the id of the quiz"),
        key("title", Type::Text, "the title of the quiz", r#""Predict before you run""#)
            .or(Absent::Text("Knowledge check")),
        key(
            "questions",
            Type::List(&ONE_QUESTION),
            "the questions, in display order",
            r#"[{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]"#,
        )
        .items(1)
        .must("a quiz is a list of questions"),
        lint_key(),
    ],
    key_rules: &[],
};

const KIND: Key = key("kind", Type::Words(&KINDS), "how the question is answered", r#""mcq""#);

const Q: Key = key("q", Type::Html, "the question", r#""How fast is the ball after 1 s?""#)
    .must("it is the text of the question");

const EXPLAIN: Key = key(
    "explain",
    Type::Html,
    "displayed after the answer",
    r#""<p>It gains 9.81 m/s in every second.</p>""#,
);

const NAME: Key = key("label", Type::Text, "a short name above the question", r#""Fall""#);

const OPTIONS: Key = key(
    "options",
    Type::List(&HTML),
    "the choices for the student, in display order",
    r#"["about 5 m/s", "about 10 m/s", "about 20 m/s"]"#,
)
.items(2)
.must("the student chooses one of them");

const ANSWER: Key =
    key("answer", Type::Whole, "the index of the correct option, counted from 0", "1").at_least(0.0);

static INDEX: Type = Type::Whole;

const HASHED: Key = key(
    "hash",
    Type::Object(&HASH),
    "instead of `answer`: the hash of the answer, so that the page does not show it",
    r#"{"salt": "fall", "sha256": "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb"}"#,
);

const ATTEMPTS: Key =
    key("attempts", Type::Whole, "how often the student can try", "2").at_least(1.0).or(Absent::Number(1.0));

/// A key is written openly or as a hash.
const ONE_KEY: &[KeyRule] = &[KeyRule::ExactlyOne(&["answer", "hash"])];

/// The hash of an answer.
pub static HASH: Object = Object {
    name: "hash",
    what: "a hash",
    doc: docs(
        "The answer of a question, hidden from readers of the page source: the SHA-256 of the salt, a colon and the answer. The answer is the index of the option, the indexes of a question of kind `multiple` in ascending order with commas between them, or `true` or `false`. A reader who tries all choices finds it.",
    ),
    tag: None,
    minimal: r#"{"salt": "fall", "sha256": "c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb"}"#,
    keys: &[
        key("salt", Type::Text, "any text of at most 256 bytes, different for each question", r#""fall""#)
            .must("the hash is that of the salt and the answer"),
        key(
            "sha256",
            Type::Text,
            "the hash, as 64 hexadecimal digits",
            r#""c2b13ffa5d46ef6535899ba40be9e4490faad74ee58ea5aaed7c2eecf7da4cfb""#,
        )
        .must("it is the hash of the answer"),
    ],
    key_rules: &[],
};

/// A question with options.
pub static MCQ: Object = Object {
    name: "mcq",
    what: "a question of kind mcq",
    doc: docs("The student chooses one of several options."),
    tag: Some(("kind", "mcq")),
    minimal: r#"{"q": "How fast is the ball after 1 s?", "options": ["about 5 m/s", "about 10 m/s", "about 20 m/s"], "answer": 1}"#,
    keys: &[
        Key { absent: Absent::Text("mcq"), ..KIND },
        Q,
        EXPLAIN,
        NAME,
        OPTIONS,
        ANSWER,
        HASHED,
        ATTEMPTS,
        verify_key(),
        lint_key(),
    ],
    key_rules: ONE_KEY,
};

/// A question about an error.
pub static DEBUG: Object = Object {
    name: "debug",
    what: "a question of kind debug",
    doc: docs(
        "Like `mcq`, but about a mistake: the student finds the fault in a listing, a model or a plot.",
    ),
    tag: Some(("kind", "debug")),
    minimal: r#"{"kind": "debug", "q": "The ball rises. What is wrong?", "options": ["gravity is positive", "the mass is too large"], "answer": 0}"#,
    keys: &[
        Key { example: r#""debug""#, ..KIND }.must(""),
        Key { example: r#""The ball rises. What is wrong?""#, ..Q },
        EXPLAIN,
        NAME,
        Key { example: r#"["gravity is positive", "the mass is too large"]"#, ..OPTIONS },
        ANSWER,
        HASHED,
        ATTEMPTS,
        verify_key(),
        lint_key(),
    ],
    key_rules: ONE_KEY,
};

/// A question whose answer a simulation shows.
pub static PREDICT: Object = Object {
    name: "predict",
    what: "a question of kind predict",
    doc: docs("Like `mcq`; after the student chooses, a lab shows what happens."),
    tag: Some(("kind", "predict")),
    minimal: r#"{"kind": "predict", "q": "How fast is the ball after 1 s?", "options": ["about 5 m/s", "about 10 m/s"], "answer": 1, "sim": {"model": "fall"}}"#,
    keys: &[
        Key { example: r#""predict""#, ..KIND }.must(""),
        Q,
        EXPLAIN,
        NAME,
        OPTIONS,
        ANSWER,
        HASHED,
        key(
            "sim",
            Type::Object(&LAB),
            "the lab displayed after the choice",
            r#"{"model": "fall", "readouts": [{"label": "speed (m/s)", "expr": "-data.joint('ball').qvel[2]"}]}"#,
        )
        .advised("a prediction needs a simulation that decides it; without one, use kind mcq"),
        verify_key(),
        lint_key(),
    ],
    key_rules: ONE_KEY,
};

/// A question with several correct options.
pub static MULTIPLE: Object = Object {
    name: "multiple",
    what: "a question of kind multiple",
    doc: docs("The student chooses all correct options. The answer is correct if exactly these are chosen."),
    tag: Some(("kind", "multiple")),
    minimal: r#"{"kind": "multiple", "q": "What makes a ball fall faster in a vacuum?", "options": ["more mass", "more gravity", "a larger planet of the same density"], "answer": [1, 2]}"#,
    keys: &[
        Key { example: r#""multiple""#, ..KIND }.must(""),
        Key { example: r#""What makes a ball fall faster in a vacuum?""#, ..Q },
        EXPLAIN,
        NAME,
        Key { example: r#"["more mass", "more gravity", "a larger planet of the same density"]"#, ..OPTIONS },
        key(
            "answer",
            Type::List(&INDEX),
            "the indexes of the correct options, counted from 0; an empty list if none is correct",
            "[1, 2]",
        )
        .at_least(0.0),
        HASHED,
        ATTEMPTS,
        verify_key(),
        lint_key(),
    ],
    key_rules: ONE_KEY,
};

/// A statement that is true or false.
pub static TRUEFALSE: Object = Object {
    name: "truefalse",
    what: "a question of kind truefalse",
    doc: docs(
        "The student says whether a statement is true. Under `verify`, the only condition of `options` is the statement.",
    ),
    tag: Some(("kind", "truefalse")),
    minimal: r#"{"kind": "truefalse", "q": "A heavy ball falls faster in a vacuum.", "answer": false}"#,
    keys: &[
        Key { example: r#""truefalse""#, ..KIND }.must(""),
        Key { example: r#""A heavy ball falls faster in a vacuum.""#, ..Q },
        EXPLAIN,
        NAME,
        key("answer", Type::Flag, "whether the statement is true", "true").or(Absent::Nothing),
        HASHED,
        ATTEMPTS,
        verify_key(),
        lint_key(),
    ],
    key_rules: ONE_KEY,
};

/// The default tolerance of a numeric answer, relative to the answer.
pub const TOLERANCE: f64 = 0.02;

/// A question with a numeric answer.
pub static NUMERIC: Object = Object {
    name: "numeric",
    what: "a question of kind numeric",
    doc: docs("The student types a number and can try again."),
    tag: Some(("kind", "numeric")),
    minimal: r#"{"kind": "numeric", "q": "How fast is the ball after 1 s, in m/s?", "answer": 9.81}"#,
    keys: &[
        Key { example: r#""numeric""#, ..KIND }.must(""),
        Key { example: r#""How fast is the ball after 1 s, in m/s?""#, ..Q },
        EXPLAIN,
        NAME,
        key("answer", Type::Number, "the correct number", "9.81")
            .must("without it no answer is graded as correct"),
        key(
            "tol",
            Type::Number,
            "how far an answer may be off, in its unit: it is correct if |given - answer| is at most this",
            "0.1",
        )
        .at_least(0.0)
        .or(Absent::Described("2 % of the answer; an answer of 0 needs a tolerance")),
        key("unit", Type::Text, "the unit, displayed after the box", r#""m/s""#),
        Key { absent: Absent::Described("no limit"), ..ATTEMPTS },
        verify_key(),
        lint_key(),
    ],
    key_rules: &[],
};

const REFERENCE: Key = key(
    "reference",
    Type::Html,
    "a sample answer, displayed after the student's own",
    r#""<p>Because weight and inertia both grow with mass.</p>""#,
);

/// A question with a text as the answer.
pub static OPEN: Object = Object {
    name: "open",
    what: "an open question",
    doc: docs("The student writes a text and compares it with the reference. It is not graded."),
    tag: Some(("kind", "open")),
    minimal: r#"{"kind": "open", "q": "Why does mass not matter?"}"#,
    keys: &[
        Key { example: r#""open""#, ..KIND }.must(""),
        Key { example: r#""Why does mass not matter?""#, ..Q },
        EXPLAIN,
        NAME,
        REFERENCE,
        verify_key(),
        lint_key(),
    ],
    key_rules: &[],
};

/// A question with a program as the answer.
pub static CODE: Object = Object {
    name: "code",
    what: "a question of kind code",
    doc: docs("Like `open`, with a program instead of a text."),
    tag: Some(("kind", "code")),
    minimal: r#"{"kind": "code", "q": "Print the height of the ball after every step."}"#,
    keys: &[
        Key { example: r#""code""#, ..KIND }.must(""),
        Key { example: r#""Print the height of the ball after every step.""#, ..Q },
        EXPLAIN,
        NAME,
        Key { example: r#""<pre>mujoco.mj_step(model, data)\nprint(data.qpos[2])</pre>""#, ..REFERENCE },
        verify_key(),
        lint_key(),
    ],
    key_rules: &[],
};
