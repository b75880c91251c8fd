//! What a machine can check: runs, measures over them, and what must hold.

use super::{Absent, LAB, Map, Object, PairHalf, Together, Type, Word, key};
use crate::spec::Form;

/// How long a run is where nothing says it, in s.
pub const RUN_LENGTH: f64 = 2.0;

static EXPRESSION: Type = Type::Code(Form::Expression);
static TEXT: Type = Type::Text;
static INLINE: Type = Type::Object(&LAB);
static EXACT: Type = Type::Object(&CLOSED_FORM);

static RUNS: Map = Map { names: "the name of a run", of: Type::Object(&RUN) };
static MEASURES: Map = Map { names: "the name of a measure", of: Type::Code(Form::Expression) };
static FORMS: Map = Map { names: "the label of a trace", of: Type::Either(&EXPRESSION, &EXACT) };
static SCALAR: Type = Type::Scalar;
static NUMBER: Type = Type::Number;
static LIST: Type = Type::List(&NUMBER);
static CHANGES: Map =
    Map { names: "kind, name and attribute of an element of the model", of: Type::Either(&SCALAR, &LIST) };
static RANGE: Type = Type::Object(&SPAN);
static SWEPT: Map = Map {
    names: "the label of a control, or an attribute of the model as in `model`",
    of: Type::Either(&LIST, &RANGE),
};
static FOUND: Map = Map { names: "the name of a value", of: Type::Object(&FIND) };
static KEYED: [PairHalf; 2] = [
    PairHalf { what: "the heading of the column that tells the rows apart", of: Type::Text },
    PairHalf { what: "the list of its numbers", of: Type::Code(Form::Expression) },
];
static A_COLUMN: Type = Type::Object(&COLUMN);
static SPACE: Map = Map { names: "the label of a slider", of: Type::List(&NUMBER) };
static SETTINGS: Map = Map { names: "the label of a slider or a select", of: Type::Scalar };

static QUOTE: [PairHalf; 2] = [
    PairHalf { what: "the text that a reader sees, with its number", of: Type::Text },
    PairHalf {
        what: "what the number must be, or a list: one for each of its numbers, and conditions that its words state",
        of: Type::Either(&EXPRESSION, &EXPRESSIONS),
    },
];
static EXPRESSIONS: Type = Type::List(&EXPRESSION);
static IN_WORDS: Map = Map { names: "what stands in a cell", of: Type::Code(Form::Expression) };
static WORDED: Type = Type::Map(&IN_WORDS);
static SAID: Type = Type::Pair(&QUOTE);

static PRESSED: [PairHalf; 2] = [
    PairHalf { what: "the label of a button", of: Type::Text },
    PairHalf { what: "the time in s", of: Type::Number },
];
static PRESS: Type = Type::Pair(&PRESSED);

/// What is claimed, and how it is checked.
pub static VERIFY: Object = Object {
    name: "verify",
    what: "a verify object",
    doc: "How a machine can check what the text claims: runs of a lab, measures taken in every run, and what must hold. It may also stand in a comment before a block of the text, `<!-- labspec verify {…} -->`, and is then about this block. The guide is [verify.md](../verify.md).",
    tag: None,
    minimal: r##"{"lab": "#1", "measure": {"speed": "final(-data.joint('ball').qvel[2])"}, "says": [["9.81 m/s", "speed"]]}"##,
    keys: &[
        key(
            "lab",
            Type::Either(&TEXT, &INLINE),
            "the lab that runs: `#2` is the second lab of the lesson, `#quiz-id.1` the sim of the first question of a quiz, `other.md#2` a lab of another lesson; or a lab written here",
            r##""#1""##,
        )
        .or(Absent::Said("the question's own `sim`, or the lab that carries this object")),
        key(
            "use",
            Type::Text,
            "the lab (`#1`) or the question (`#quiz-id.2`) whose `verify` has runs, measures and searches that this one uses, too; what both name is as it is here",
            r##""#1""##,
        ),
        key(
            "runs",
            Type::Map(&RUNS),
            "runs by name; measures are read as `run.measure`, or by their own name where there is one run",
            r#"{"earth": {"set": {"gravity": -9.81}, "until": 1}}"#,
        )
        .or(Absent::Said("one run of the lab as it stands")),
        key(
            "measure",
            Type::Map(&MEASURES),
            "expressions by name, taken in every run; see [measures](functions.md)",
            r#"{"speed": "final(-data.joint('ball').qvel[2])"}"#,
        )
        .or(Absent::Empty),
        key(
            "find",
            Type::Map(&FOUND),
            "values that are searched for by running: the largest or the smallest value of a control, or of an attribute of the model, with which a condition holds; each is read by its name, like a measure",
            r#"{"limit": {"largest": "timestep", "from": 0.001, "to": 0.05, "while": "final(data.qpos[2] + 4.905 * data.time ** 2) > initial(data.qpos[2]) - 0.1", "tol": 1e-3}}"#,
        )
        .or(Absent::Empty),
        key(
            "options",
            Type::List(&EXPRESSION),
            "on a question with options: one condition for each, in their order; that of the right option alone must hold; `undecided` for an option that this evidence says nothing about",
            r#"["speed < 7", "speed > 7 && speed < 15", "speed > 15"]"#,
        )
        .or(Absent::Empty),
        key(
            "over",
            Type::Map(&SPACE),
            "on a question with options: sliders and the smallest and largest value of each, over which the answer must hold as well; corners, a covering design, and a search for a counterexample are run, at values that a student can reach",
            r#"{"gravity": [-12, -8]}"#,
        )
        .or(Absent::Empty),
        key(
            "value",
            Type::Code(Form::Expression),
            "on a numeric question: what its answer must be, within `tol`",
            r#""speed""#,
        ),
        key(
            "wrong",
            Type::List(&EXPRESSION),
            "on a numeric question: values that a mistake leads to, which the tolerance must not take for right",
            r#"["2 * speed"]"#,
        )
        .or(Absent::Empty),
        key(
            "says",
            Type::List(&SAID),
            "numbers that the text states: what a reader sees, and the expression whose value it is",
            r#"[["9.81 m/s", "speed"]]"#,
        )
        .or(Absent::Empty),
        key(
            "table",
            Type::List(&A_COLUMN),
            "columns of tables of the text, and single cells: what stands in each cell must be what was measured",
            r#"[{"column": "touchdown (s)", "by": ["height (m)", "fall.value"], "is": "fall.touch"}]"#,
        )
        .or(Absent::Empty),
        key(
            "exact",
            Type::Map(&FORMS),
            "closed forms that traces must follow, by the label of the trace; an object states how far they may be off",
            r#"{"height": "2 - 0.5 * 9.81 * data.time ** 2"}"#,
        )
        .or(Absent::Empty),
    ],
    together: &[Together::OneAdvised(&["options", "value", "says", "table", "exact"])],
};

static EXPECTED: [Word; 1] =
    [Word { text: "breaks", doc: "the lesson shows this run breaking, and then it must" }];

/// A run.
pub static RUN: Object = Object {
    name: "run",
    what: "a run",
    doc: "One run of the lab, with what a student does in it, or a reader is told to change.",
    tag: None,
    minimal: r#"{"until": 1}"#,
    keys: &[
        key(
            "lab",
            Type::Either(&TEXT, &INLINE),
            "the lab that this run is of, written as the `lab` of the object; a measure that has no meaning in it is not taken there",
            r##""#1""##,
        )
        .or(Absent::Said("the lab of the object")),
        key(
            "model",
            Type::Map(&CHANGES),
            "attributes of the model that are changed before it is compiled: `geom ball friction`, or `option timestep` where an element has no name; the mass of a body with one geom is `body ball mass`",
            r#"{"body ball mass": 5, "option timestep": 0.01}"#,
        )
        .or(Absent::Empty),
        key("key", Type::Scalar, "the keyframe to start from, by its name or its index", "0")
            .or(Absent::Said("the lab's own")),
        key(
            "controller",
            Type::Code(Form::Statements),
            "runs before every step instead of the lab's own `controller`; empty for none",
            r#""data.qfrc_applied[0] = -data.qvel[0]""#,
        )
        .or(Absent::Said("the lab's own")),
        key(
            "set",
            Type::Map(&SETTINGS),
            "values that controls are set to before the run, by their labels; a slider takes only what a student can reach",
            r#"{"gravity": -9.81}"#,
        )
        .or(Absent::Empty),
        key(
            "press",
            Type::List(&PRESS),
            "buttons that are pressed, each with the time at which it is",
            r#"[["Push", 0.5]]"#,
        )
        .or(Absent::Empty),
        key(
            "setup",
            Type::Code(Form::Statements),
            "runs after the lab's own `setup`",
            r#""model.opt.timestep = 0.001""#,
        ),
        key("until", Type::Number, "how long the run is", "1")
            .unit("s")
            .positive()
            .or(Absent::Said("`steps`, else the lab's `stopAt`, else 2 s")),
        key("steps", Type::Whole, "how long the run is, in steps", "500").positive(),
        key(
            "stop",
            Type::Code(Form::Expression),
            "the run ends at the first sample at which this holds; `until` or `steps` is its end at the latest",
            r#""data.time >= 1""#,
        )
        .or(Absent::Said("the run goes on to its end")),
        key(
            "sweep",
            Type::Map(&SWEPT),
            "makes a run for each of these values of one control, or of one attribute of the model; a measure of such a run is a list: `run.measure[0]`, `slope(run.measure)`, and `run.value` are the values",
            r#"{"option timestep": [0.002, 0.005, 0.01]}"#,
        ),
        key("expect", Type::Words(&EXPECTED), "what the run is meant to do", r#""breaks""#)
            .or(Absent::Said("the run goes well")),
    ],
    together: &[Together::AtMostOne(&["until", "steps"])],
};

/// A column of a table.
pub static COLUMN: Object = Object {
    name: "column",
    what: "a column of a table",
    doc: "Where the numbers in a column of a table of the text come from, or the number in one cell.",
    tag: None,
    minimal: r#"{"column": "touchdown (s)", "by": ["height (m)", "fall.value"], "is": "fall.touch"}"#,
    keys: &[
        key("column", Type::Text, "the heading of the column, as a reader sees it", r#""touchdown (s)""#)
            .must("without it nobody knows which numbers are meant"),
        key(
            "by",
            Type::Pair(&KEYED),
            "how the rows are told apart: the heading of another column, and the list of the values that stand in it",
            r#"["height (m)", "fall.value"]"#,
        ),
        key(
            "row",
            Type::Text,
            "instead of `by`: what stands in the first cell of the one row that is meant",
            r#""0.65""#,
        ),
        key(
            "is",
            Type::Either(&EXPRESSION, &WORDED),
            "what the cells state: a list in the order of the values, or one number for one cell; for words an object with a list of conditions for each, as `{\"stable\": \"fall.depth.map(d => d < 1)\", …}`",
            r#""fall.touch""#,
        )
        .must("without it there is nothing that the cells are compared with"),
    ],
    together: &[Together::ExactlyOne(&["by", "row"])],
};

/// A search.
pub static FIND: Object = Object {
    name: "find",
    what: "a search",
    doc: "The largest or the smallest value with which a condition holds, found by running and halving.",
    tag: None,
    minimal: r#"{"largest": "timestep", "from": 0.001, "to": 0.05, "while": "final(data.qpos[2] + 4.905 * data.time ** 2) > initial(data.qpos[2]) - 0.1", "tol": 1e-3}"#,
    keys: &[
        key(
            "largest",
            Type::Text,
            "the largest value of this is wanted: the label of a control, an attribute of the model as in `model`, or `timestep`",
            r#""timestep""#,
        ),
        key("smallest", Type::Text, "the smallest value of this is wanted", r#""timestep""#),
        key("from", Type::Number, "the smallest value that is tried", "0.001")
            .must("without it nobody knows where to search"),
        key("to", Type::Number, "the largest value that is tried", "0.05")
            .must("without it nobody knows where to search"),
        key("run", Type::Text, "the run in which it is tried", r#""run""#)
            .or(Absent::Said("the only run")),
        key(
            "while",
            Type::Code(Form::Expression),
            "what holds up to the limit: a condition on measures of the run, by their own names, or written as a measure",
            r#""final(data.qpos[2] + 4.905 * data.time ** 2) > initial(data.qpos[2]) - 0.1""#,
        )
        .must("without it there is no limit"),
        key("tol", Type::Number, "how near the limit is found", "1e-3")
            .positive()
            .must("without it nobody knows how near is near enough"),
    ],
    together: &[Together::ExactlyOne(&["largest", "smallest"])],
};

/// Values at equal distances.
pub static SPAN: Object = Object {
    name: "span",
    what: "a span of values",
    doc: "Values at equal distances, both ends included.",
    tag: None,
    minimal: r#"{"from": 0.2, "to": 2, "count": 5}"#,
    keys: &[
        key("from", Type::Number, "the first value", "0.2").must("without it there is no first value"),
        key("to", Type::Number, "the last value", "2").must("without it there is no last value"),
        key("count", Type::Whole, "how many values there are", "5")
            .must("without it nobody knows how many runs are meant"),
    ],
    together: &[],
};

/// A closed form with a tolerance.
pub static CLOSED_FORM: Object = Object {
    name: "closedForm",
    what: "a closed form",
    doc: "A formula that a trace must follow, with the distance that is allowed.",
    tag: None,
    minimal: r#"{"is": "2 - 0.5 * 9.81 * data.time ** 2", "tol": 0.01}"#,
    keys: &[
        key(
            "is",
            Type::Code(Form::Expression),
            "the formula, in the language of the lab",
            r#""2 - 0.5 * 9.81 * data.time ** 2""#,
        )
        .must("without it there is nothing that the trace is held to"),
        key("tol", Type::Number, "how far the trace may be from it at most, in the trace's unit", "0.01")
            .or(Absent::Said("the convergence of the lab itself decides")),
    ],
    together: &[],
};
