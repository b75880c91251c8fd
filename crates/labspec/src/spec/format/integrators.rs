//! The lab that compares integrators: the keys of a lab, and those of the comparison.

use super::{Absent, Key, KeyRule, LAB, Object, Type, Word, key};
use labspec_finding::docs;

/// The integrators that can be compared: those of MuJoCo that a page can run.
pub static INTEGRATOR_NAMES: [Word; 4] = [
    Word { text: "Euler", doc: docs("semi-implicit Euler, with implicit joint damping; first order") },
    Word { text: "RK4", doc: docs("the explicit Runge-Kutta method; fourth order") },
    Word { text: "implicit", doc: docs("implicit in all velocity-dependent forces; first order") },
    Word {
        text: "implicitfast",
        doc: docs("implicit in velocity-dependent forces, without those of rotation; first order"),
    },
];

static NAME: Type = Type::Words(&INTEGRATOR_NAMES);

/// The keys of the comparison.
const OF_COMPARISON: [Key; 2] = [
    key("integrators", Type::List(&NAME), "the integrators, in display order", r#"["Euler", "RK4"]"#)
        .or(Absent::Described("all four")),
    key("timestep", Type::Number, "the timestep of all runs", "0.01")
        .unit("s")
        .positive()
        .or(Absent::Described("the timestep of the model")),
];

const COUNT: usize = LAB.keys.len() + OF_COMPARISON.len();

/// The keys of a lab, then those of the comparison.
static KEYS: [Key; COUNT] = {
    let mut all = [OF_COMPARISON[0]; COUNT];
    let mut i = 0;
    while i < COUNT {
        all[i] = if i < LAB.keys.len() { LAB.keys[i] } else { OF_COMPARISON[i - LAB.keys.len()] };
        i += 1;
    }
    all
};

/// A lab that runs under several integrators at once.
pub static INTEGRATORS: Object = Object {
    name: "integrators",
    what: "an integrators lab",
    doc: docs(
        "One lab under several integrators at once, in a fence `lab integrators`. It is read as a lab with a select \"integrator\", which resets, and a first plot \"energy drift\": the change of the total energy since the last reset, relative to its first value, or in J where that is 0. A page shows every plot and readout once, with a curve or a column for each integrator. `verify` has a run for each integrator, named after it; with `runs`, a run that has the name of an integrator uses it.",
    ),
    tag: None,
    minimal: r#"{"model": "fall", "integrators": ["Euler", "RK4"]}"#,
    keys: &KEYS,
    key_rules: &[KeyRule::ExactlyOne(&["model", "xml"])],
};
