//! The host terms of labs, for the messages of the language.

use labspec_expr::HostTerms;

/// The terms of a claim about runs, for messages of the language.
pub static CLAIM_TERMS: HostTerms = HostTerms {
    names: "the runs, and the measures of the only run",
    own_number: "write it under `measure`, and read it of a run: `run.{name}`",
    ..LAB
};

/// The terms of a lab, for messages of the language.
pub static HOST_TERMS: HostTerms = LAB;

const LAB: HostTerms = HostTerms {
    lab: "lab",
    lesson: "lesson",
    world: "simulation",
    model: "model",
    number: "data.time",
    array: "data.qpos",
    matrix: "data.xpos",
    choice: "data.joint(\"name\")",
    parts: "{kinetic, potential} = lib.energy()",
    names: "`model`, `data`, `ctx`",
    statements: "`setup`, `controller`, `apply` or `run`",
    keeper: "`controller`",
    display: "a readout or a trace",
    clock: "the simulation time is `data.time`, in seconds",
    wait: "test `data.time` in the controller instead",
    split: "split it: into several controls, or a `setup` and a `controller`",
    input: (
        "`value` is the value of a slider or select, in its own `set` or `apply`",
        "give the control a `param` and read it as `ctx.<param>`",
    ),
    store: "store it first, as `ctx.{name} = 0` in `setup`, or give a control `\"param\": \"{name}\"`",
    own_number: "store it as `ctx.{name} = …` in `setup`, and read `ctx.{name}` here",
    rounding: ", or set `digits` of the readout",
    recompute: "`mj_setConst`",
};
