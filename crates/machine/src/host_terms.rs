//! What the host calls its things. The language knows nothing of what it computes with: examples and advice that name a field, a
//! text or a control of the host come from here.

/// The words of a host, for messages.
#[derive(Clone, Copy, Debug)]
pub struct HostTerms {
    /// What the texts belong to: `lab`.
    pub lab: &'static str,
    /// What an author writes: `lesson`.
    pub lesson: &'static str,
    /// What the fields are the memory of: `simulation`.
    pub world: &'static str,
    /// What the sizes of the fields follow from: `model`.
    pub model: &'static str,
    /// A number of the host.
    pub number: &'static str,
    /// An array.
    pub array: &'static str,
    /// An array whose rows follow each other.
    pub matrix: &'static str,
    /// How an object is chosen by its name.
    pub choice: &'static str,
    /// A call that gives a record, with names for its parts: `{a, b} = f()`.
    pub parts: &'static str,
    /// The names that every text has.
    pub names: &'static str,
    /// The texts that may hold statements.
    pub statements: &'static str,
    /// The text that computes what others only show.
    pub keeper: &'static str,
    /// Where a value is shown.
    pub display: &'static str,
    /// What tells the time.
    pub clock: &'static str,
    /// What to write where JavaScript would wait.
    pub wait: &'static str,
    /// How a text that is too long is split.
    pub split: &'static str,
    /// What gives `value`, and what to do where nothing does.
    pub input: (&'static str, &'static str),
    /// Where a variable is stored first; `{name}` is the variable.
    pub store: &'static str,
    /// Where a number is rounded for a reader, behind another way to do it.
    pub rounding: &'static str,
    /// What computes anew what follows from a parameter.
    pub recompute: &'static str,
}

impl HostTerms {
    /// The words of a host that says nothing.
    pub const PLAIN: HostTerms = HostTerms {
        lab: "program",
        lesson: "program",
        world: "host",
        model: "host",
        number: "x",
        array: "list",
        matrix: "list",
        choice: "choose(\"name\")",
        parts: "{a, b} = record",
        names: "`ctx` and those of the host",
        statements: "a text of statements",
        keeper: "a text of statements",
        display: "an expression",
        clock: "the values from the host are the same in every run",
        wait: "store in `ctx` what to wait for, and test it in every run of the text",
        split: "split it",
        input: ("the host provides it to some texts only", "store the value in `ctx`"),
        store: "store it first, as `ctx.{name} = 0`",
        rounding: "",
        recompute: "a recomputation of the derived values",
    };
}
