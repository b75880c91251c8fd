//! The checkable claims: runs, measures over them, and conditions that must hold.

use super::{Absent, KeyRule, LAB, Map, Object, PairHalf, Type, Word, key};
use crate::spec::CodeForm;
use labspec_finding::docs;

/// The default length of a run, in s.
pub const RUN_LENGTH: f64 = 2.0;

static EXPRESSION: Type = Type::Code(CodeForm::Expression);
static TEXT: Type = Type::Text;
static INLINE: Type = Type::Object(&LAB);
static EXACT: Type = Type::Object(&CLOSED_FORM);

static RUNS: Map = Map { names: "the name of a run", ty: Type::Object(&RUN) };
static MEASURES: Map = Map { names: "the name of a measure", ty: Type::Code(CodeForm::Expression) };
static FORMS: Map = Map { names: "the label of a trace", ty: Type::Either(&EXPRESSION, &EXACT) };
static SCALAR: Type = Type::Scalar;
static NUMBER: Type = Type::Number;
static LIST: Type = Type::List(&NUMBER);
static CHANGES: Map =
    Map { names: "kind, name and attribute of an element of the model", ty: Type::Either(&SCALAR, &LIST) };
static RANGE: Type = Type::Object(&SPAN);
static IN_A_FILE: Type = Type::Object(&FILE_VALUES);
static SPANNED: Type = Type::Either(&RANGE, &IN_A_FILE);
static SWEPT: Map = Map {
    names: "the label of a control, or an attribute of the model as in `model`",
    ty: Type::Either(&SWEPT_VALUES, &SPANNED),
};
static SWEPT_VALUE: Type = Type::Either(&NUMBER, &TEXT);
static SWEPT_VALUES: Type = Type::List(&SWEPT_VALUE);
static FOUND: Map = Map { names: "the name of a value", ty: Type::Object(&FIND) };
static KEYED: [PairHalf; 2] = [
    PairHalf { what: "the heading of the column that distinguishes the rows", ty: Type::Text },
    PairHalf { what: "the list of its numbers", ty: Type::Code(CodeForm::Expression) },
];
static A_COLUMN: Type = Type::Object(&COLUMN);
static SPACE: Map = Map { names: "the label of a slider", ty: Type::List(&NUMBER) };
static SETTINGS: Map = Map { names: "the label of a slider or a select", ty: Type::Scalar };

static QUOTE: [PairHalf; 2] = [
    PairHalf { what: "the text that a reader sees, with its number", ty: Type::Text },
    PairHalf {
        what: "what the number must be, or a list: one for each of its numbers, and conditions that its words state",
        ty: Type::Either(&EXPRESSION, &EXPRESSIONS),
    },
];
static EXPRESSIONS: Type = Type::List(&EXPRESSION);
static IN_WORDS: Map = Map { names: "the text of a cell", ty: Type::Code(CodeForm::Expression) };
static WORDED: Type = Type::Map(&IN_WORDS);
static CELL: Type = Type::Either(&EXPRESSION, &WORDED);
static CELLS: Type = Type::List(&CLAIMED_CELL);
static CLAIMED_CELL: Type = Type::Either(&CELL, &Type::Null);
static HEADED: Map = Map { names: "the heading of a column", ty: Type::Either(&EXPRESSION, &WORDED) };
static SAID: Type = Type::Pair(&QUOTE);

static PRESSED: [PairHalf; 2] = [
    PairHalf { what: "the label of a button", ty: Type::Text },
    PairHalf { what: "the time in s", ty: Type::Number },
];
static PRESS: Type = Type::Pair(&PRESSED);

/// The claims, and how they are checked.
pub static VERIFY: Object = Object {
    name: "verify",
    what: "a verify object",
    doc: docs("How the checker tests the claims of the text: runs of a lab, measures of every run, and conditions that must hold. It can also be in a comment before a block of the text, `<!-- labspec verify {…} -->`, and then it is about this block. The guide is [verify.md](../verify.md)."),
    tag: None,
    minimal: r##"{"lab": "#1", "measure": {"speed": "final(-data.joint('ball').qvel[2])"}, "says": [["9.81 m/s", "speed"]]}"##,
    keys: &[
        key(
            "lab",
            Type::Either(&TEXT, &INLINE),
            "the lab that runs: `#2` is the second lab of the lesson, `#quiz-id.1` the sim of the first question of a quiz, `other.md#2` a lab of another lesson; or a lab written here",
            r##""#1""##,
        )
        .or(Absent::Described("the question's own `sim`, or the lab that carries this object")),
        key(
            "use",
            Type::Text,
            "the lab (`#1`) or the question (`#quiz-id.2`) whose `verify` provides further runs, measures and searches, or the name of a comment `<!-- labspec define NAME {…} -->` that contains them; a name that is also defined here keeps its meaning here",
            r##""#1""##,
        ),
        key(
            "runs",
            Type::Map(&RUNS),
            "runs by name; measures are read as `run.measure`, or by their own name where there is one run; a name that lists several, `light, heavy`, is a run for each value of its `sweep`",
            r#"{"earth": {"set": {"gravity": -9.81}, "until": 1}}"#,
        )
        .or(Absent::Described("one run of the lab as it stands")),
        key(
            "measure",
            Type::Map(&MEASURES),
            "expressions by name, evaluated in every run; one that names a whole array, `final(data.qpos)`, is a list; see [measures](functions.md)",
            r#"{"speed": "final(-data.joint('ball').qvel[2])"}"#,
        )
        .or(Absent::Empty),
        key(
            "find",
            Type::Map(&FOUND),
            "values found by a search over runs: the largest or the smallest value of a control, or of an attribute of the model, for which a condition holds; each is read by its name, like a measure",
            r#"{"limit": {"largest": "timestep", "from": 0.001, "to": 0.05, "while": "final(data.qpos[2] + 4.905 * data.time ** 2) > initial(data.qpos[2]) - 0.1", "tol": 1e-3}}"#,
        )
        .or(Absent::Empty),
        key(
            "options",
            Type::List(&EXPRESSION),
            "on a question with options: one condition for each, in order; only those of the correct options may hold; on a question of kind `truefalse`: one condition, the statement; `undecided` for an option that this evidence does not decide",
            r#"["speed < 7", "speed > 7 && speed < 15", "speed > 15"]"#,
        )
        .or(Absent::Empty),
        key(
            "over",
            Type::Map(&SPACE),
            "on a question with options: sliders with the smallest and largest value of each, over which the answer must hold as well; the checker runs the corners, a covering design and a search for a counterexample, at values that a student can reach",
            r#"{"gravity": [-12, -8]}"#,
        )
        .or(Absent::Empty),
        key(
            "value",
            Type::Code(CodeForm::Expression),
            "on a numeric question: what its answer must be, within `tol`",
            r#""speed""#,
        ),
        key(
            "wrong",
            Type::List(&EXPRESSION),
            "on a numeric question: values that a mistake leads to, which the tolerance must not accept",
            r#"["2 * speed"]"#,
        )
        .or(Absent::Empty),
        key(
            "says",
            Type::List(&SAID),
            "numbers that the text states: what a reader sees, and the expression for its value",
            r#"[["9.81 m/s", "speed"]]"#,
        )
        .or(Absent::Empty),
        key(
            "table",
            Type::List(&A_COLUMN),
            "columns of tables of the text, and single cells: each cell must match what was measured",
            r#"[{"column": "touchdown (s)", "by": ["height (m)", "fall.value"], "is": "fall.touch"}]"#,
        )
        .or(Absent::Empty),
        key(
            "exact",
            Type::Map(&FORMS),
            "closed forms that traces must follow, by the label of the trace; an object states the allowed difference",
            r#"{"height": "2 - 0.5 * 9.81 * data.time ** 2"}"#,
        )
        .or(Absent::Empty),
    ],
    key_rules: &[KeyRule::OneAdvised(&["options", "value", "says", "table", "exact"])],
};

static EXPECTED: [Word; 2] = [
    Word { text: "breaks", doc: docs("the lesson shows this run breaking, and then it must break") },
    Word {
        text: "may break",
        doc: docs(
            "it may or may not break, like some runs of a sweep; claims read its measures over all samples, also those after MuJoCo resets the data",
        ),
    },
];

/// A run.
pub static RUN: Object = Object {
    name: "run",
    what: "a run",
    doc: docs("One run of the lab, with what a student does in it, or a change that the text asks for."),
    tag: None,
    minimal: r#"{"until": 1}"#,
    keys: &[
        key(
            "lab",
            Type::Either(&TEXT, &INLINE),
            "the lab of this run, written as the `lab` of the object; a measure without a meaning in it is skipped",
            r##""#1""##,
        )
        .or(Absent::Described("the lab of the object")),
        key(
            "model",
            Type::Map(&CHANGES),
            "attributes of the model to change before it is compiled: `geom ball friction`, or `option timestep` for an element without a name; the mass of a body with one geom is `body ball mass`; in a default class, `default steel geom friction`; without an attribute, `motor drive`, the XML of an element that replaces it",
            r#"{"body ball mass": 5, "option timestep": 0.01}"#,
        )
        .or(Absent::Empty),
        key("key", Type::Scalar, "the keyframe to start from, by its name or its index", "0")
            .or(Absent::Described("that of the lab")),
        key(
            "controller",
            Type::Code(CodeForm::Statements),
            "runs before every step instead of the `controller` of the lab; empty for none",
            r#""data.qfrc_applied[0] = -data.qvel[0]""#,
        )
        .or(Absent::Described("that of the lab")),
        key(
            "set",
            Type::Map(&SETTINGS),
            "values of controls before the run, by their labels; a slider accepts only values that a student can reach",
            r#"{"gravity": -9.81}"#,
        )
        .or(Absent::Empty),
        key(
            "press",
            Type::List(&PRESS),
            "buttons to press, each with the time of the press",
            r#"[["Push", 0.5]]"#,
        )
        .or(Absent::Empty),
        key(
            "setup",
            Type::Code(CodeForm::Statements),
            "runs after the `setup` of the lab",
            r#""model.opt.timestep = 0.001""#,
        ),
        key("until", Type::Number, "the length of the run", "1")
            .unit("s")
            .positive()
            .or(Absent::Described("`steps`, else the `stopAt` of the lab, else 2 s")),
        key("steps", Type::Whole, "the length of the run, in steps", "500").positive(),
        key(
            "stop",
            Type::Code(CodeForm::Expression),
            "the run ends at the first sample where this holds, and at the latest after `until` or `steps`",
            r#""data.time >= 1""#,
        )
        .or(Absent::Described("the run goes on to its end")),
        key(
            "sweep",
            Type::Map(&SWEPT),
            "makes a run for each of these values of a control, or of an attribute of the model, and for each combination of several; a measure of such a run is a list: `run.measure[0]`, `slope(run.measure)`, and `run.value` holds the values, `run.value2` those of the second control or attribute; a text of an option counts with its place in the list, from 0",
            r#"{"option timestep": [0.002, 0.005, 0.01]}"#,
        ),
        key("expect", Type::Words(&EXPECTED), "the intended result of the run", r#""breaks""#)
            .or(Absent::Described("the run must go well")),
    ],
    key_rules: &[KeyRule::AtMostOne(&["until", "steps"])],
};

/// A column of a table.
pub static COLUMN: Object = Object {
    name: "column",
    what: "a column of a table",
    doc: docs("The origin of the numbers in a column of a table of the text, or of the number in one cell."),
    tag: None,
    minimal: r#"{"column": "touchdown (s)", "by": ["height (m)", "fall.value"], "is": "fall.touch"}"#,
    keys: &[
        key("column", Type::Text, "the heading of the column, as a reader sees it", r#""touchdown (s)""#),
        key(
            "columns",
            Type::Map(&HEADED),
            "instead of `column` and `is`: several columns by their headings, each with what its cells state",
            r#"{"touchdown (s)": "fall.touch", "speed (m/s)": "fall.speed"}"#,
        ),
        key(
            "by",
            Type::Pair(&KEYED),
            "how to distinguish the rows: the heading of another column, and the list of its values",
            r#"["height (m)", "fall.value"]"#,
        ),
        key(
            "row",
            Type::Text,
            "instead of `by`: the text in the first cell of the row; in a table of a sweep its number also tells the member",
            r#""0.65""#,
        ),
        key(
            "is",
            Type::Either(&CELL, &CELLS),
            "what the cells state: a list in the order of the values, or one number for one cell; for words an object with a list of conditions for each, as `{\"stable\": \"fall.depth.map(d => d < 1)\", …}`; with `row` and no `column`, a list for the cells after the first, with `null` for a cell that is not claimed",
            r#""fall.touch""#,
        ),
    ],
    key_rules: &[KeyRule::ExactlyOne(&["by", "row"])],
};

/// A search.
pub static FIND: Object = Object {
    name: "find",
    what: "a search",
    doc: docs("The largest or the smallest value for which a condition holds, found by bisection over runs."),
    tag: None,
    minimal: r#"{"largest": "timestep", "from": 0.001, "to": 0.05, "while": "final(data.qpos[2] + 4.905 * data.time ** 2) > initial(data.qpos[2]) - 0.1", "tol": 1e-3}"#,
    keys: &[
        key(
            "largest",
            Type::Text,
            "what to maximize: the label of a control, an attribute of the model as in `model`, or `timestep`",
            r#""timestep""#,
        ),
        key("smallest", Type::Text, "what to minimize, as in `largest`", r#""timestep""#),
        key("from", Type::Number, "the smallest value to test", "0.001")
            .must("without it the range of the search is unknown"),
        key("to", Type::Number, "the largest value to test", "0.05")
            .must("without it the range of the search is unknown"),
        key("run", Type::Text, "the run to test it in", r#""run""#)
            .or(Absent::Described("the only run")),
        key(
            "while",
            Type::Code(CodeForm::Expression),
            "the condition that holds up to the limit, on measures of the run, by their own names, or written as a measure",
            r#""final(data.qpos[2] + 4.905 * data.time ** 2) > initial(data.qpos[2]) - 0.1""#,
        )
        .must("without it there is no limit"),
        key("tol", Type::Number, "the accuracy of the limit", "1e-3")
            .positive()
            .must("without it the accuracy of the search is unknown"),
    ],
    key_rules: &[KeyRule::ExactlyOne(&["largest", "smallest"])],
};

/// Equidistant values.
pub static SPAN: Object = Object {
    name: "span",
    what: "a span of values",
    doc: docs("Values between two ends: at equal distances with both ends included, or drawn at random."),
    tag: None,
    minimal: r#"{"from": 0.2, "to": 2, "count": 5}"#,
    keys: &[
        key("from", Type::Number, "the first value", "0.2").must("without it there is no first value"),
        key("to", Type::Number, "the last value", "2").must("without it there is no last value"),
        key("count", Type::Whole, "how many values there are", "5")
            .must("without it the number of runs is unknown"),
        key(
            "seed",
            Type::Whole,
            "draws the values at random between the two ends, the same for the same seed on every machine",
            "1",
        )
        .or(Absent::Described("the values have equal distances")),
    ],
    key_rules: &[],
};

/// Values in a file.
pub static FILE_VALUES: Object = Object {
    name: "fileValues",
    what: "values of a file",
    doc: docs(
        "The values of a column of a text file beside the lesson. The columns are separated by commas, semicolons or tabs.",
    ),
    tag: None,
    minimal: r#"{"file": "masses.csv"}"#,
    keys: &[
        key("file", Type::Text, "the path of the file from this lesson", r#""masses.csv""#)
            .must("without it there are no values"),
        key(
            "column",
            Type::Text,
            "the heading of the column, in the first line of the file",
            r#""mass (kg)""#,
        )
        .or(Absent::Described("the only column")),
    ],
    key_rules: &[],
};

/// A model that the lesson shows.
pub static LISTING: Object = Object {
    name: "listing",
    what: "a listing",
    doc: docs("A model that the lesson shows in a listing, for the lab of a claim."),
    tag: None,
    minimal: r#"{"listing": "pendulum.xml"}"#,
    keys: &[key(
        "listing",
        Type::Text,
        "the `file` of the listing: the fence begins with ```` ```xml file=pendulum.xml ````",
        r#""pendulum.xml""#,
    )
    .must("without it there is no model")],
    key_rules: &[],
};

/// A closed form with a tolerance.
pub static CLOSED_FORM: Object = Object {
    name: "closedForm",
    what: "a closed form",
    doc: docs("A formula that a trace must follow, with the allowed difference."),
    tag: None,
    minimal: r#"{"is": "2 - 0.5 * 9.81 * data.time ** 2", "tol": 0.01}"#,
    keys: &[
        key(
            "is",
            Type::Code(CodeForm::Expression),
            "the formula, in the language of the lab",
            r#""2 - 0.5 * 9.81 * data.time ** 2""#,
        )
        .must("without it there is nothing to compare the trace with"),
        key(
            "tol",
            Type::Number,
            "the largest allowed difference between the trace and the formula, in the unit of the trace",
            "0.01",
        )
        .or(Absent::Described("decided by the convergence of the lab")),
    ],
    key_rules: &[],
};
