//! The terms of the host. The language itself does not depend on the kind of the host, so examples and advice that name a
//! field, a text or a control of the host are taken from here.

/// The terms of a host, for messages.
#[derive(Clone, Copy, Debug)]
pub struct HostTerms {
    /// The unit to which the source texts belong: `lab`.
    pub lab: &'static str,
    /// The document that an author writes: `lesson`.
    pub lesson: &'static str,
    /// The system whose state the fields store: `simulation`.
    pub world: &'static str,
    /// The object that determines the sizes of the fields: `model`.
    pub model: &'static str,
    /// An example of a number of the host.
    pub number: &'static str,
    /// An example of an array.
    pub array: &'static str,
    /// An example of an array of rows.
    pub matrix: &'static str,
    /// How an object is selected by its name.
    pub choice: &'static str,
    /// A call that returns a record, with names for its parts: `{a, b} = f()`.
    pub parts: &'static str,
    /// The names that every source text can use.
    pub names: &'static str,
    /// The source texts that may contain statements.
    pub statements: &'static str,
    /// The source text that computes what others only display.
    pub keeper: &'static str,
    /// Where a value is displayed.
    pub display: &'static str,
    /// The expression for the current time.
    pub clock: &'static str,
    /// What to write where JavaScript would wait.
    pub wait: &'static str,
    /// How to split a source text that is too long.
    pub split: &'static str,
    /// What supplies `value`, and what to do where nothing does.
    pub input: (&'static str, &'static str),
    /// Where a variable is first stored; `{name}` is the variable.
    pub store: &'static str,
    /// How an author defines a number of their own, in an expression; `{name}` is the number.
    pub own_number: &'static str,
    /// Where a number is rounded for a reader, as an alternative to another way.
    pub rounding: &'static str,
    /// The call that recomputes what depends on a parameter.
    pub recompute: &'static str,
}

impl HostTerms {
    /// The terms of a host that does not define its own.
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
        own_number: "store it as `ctx.{name} = …` in a text of statements, and read `ctx.{name}` here",
        rounding: "",
        recompute: "a recomputation of the derived values",
    };
}
