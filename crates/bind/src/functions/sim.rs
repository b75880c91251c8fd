//! The functions of `sim`: the simulation as seen by the page. Playing and pausing are requests to the page, which have no
//! effect without one.

use super::lib::{ENERGIES, energy};
use super::{AccessedPart, Function, ROW, Unit, pass_result};
use crate::world::Playback;
use labspec_expr::{Type, Value};
use labspec_finding::docs;

const SIM: Function = Function { object: "sim", returns: Type::Void, ..ROW };

pub(super) const ROWS: &[Function] = &[
    Function {
        name: "play",
        doc: docs("resumes the page"),
        example: (docs("sim.play(); data.time"), docs("0")),
        run: |w, _, _| w.ask_playback(Playback::Play),
        ..SIM
    },
    Function {
        name: "pause",
        doc: docs("pauses the page"),
        example: (docs("sim.pause(); data.time"), docs("0")),
        run: |w, _, _| w.ask_playback(Playback::Pause),
        ..SIM
    },
    Function {
        name: "toggle",
        doc: docs("pauses or resumes the page"),
        example: (docs("sim.toggle(); data.time"), docs("0")),
        run: |w, _, _| w.ask_playback(Playback::Toggle),
        ..SIM
    },
    Function {
        name: "forward",
        writes: &[AccessedPart::Derived],
        doc: docs("computes every derived field from the state"),
        example: (docs("data.qpos[0] = Math.PI; sim.forward(); data.site_xpos[2].toFixed(2)"), docs("1.50")),
        run: |w, _, _| pass_result(w.forward()),
        ..SIM
    },
    Function {
        name: "reset",
        writes: &[AccessedPart::State, AccessedPart::Derived],
        doc: docs(
            "resets the data to the initial state, or to the keyframe of the lab, and computes the derived fields",
        ),
        example: (docs("data.qpos[0] = 1; sim.reset(); data.qpos[0]"), docs("0")),
        run: |w, _, _| {
            w.reset()?;
            pass_result(w.forward())
        },
        ..SIM
    },
    Function {
        name: "energy",
        returns: Type::Record,
        members: ENERGIES,
        reads: AccessedPart::Energy,
        writes: &[AccessedPart::Flags, AccessedPart::Derived],
        unit: Unit::Of("J"),
        doc: docs("potential, kinetic and total energy, J; the first use turns the energy computation on"),
        example: (docs("sim.energy().potential"), docs("4.905")),
        run: |w, heap, _| energy(w, heap),
        ..SIM
    },
    Function {
        name: "contacts",
        returns: Type::List,
        reads: AccessedPart::Contacts,
        doc: docs("the contacts, each a record of geom1, geom2, dist (m), pos (m), frame, force (N) and dim"),
        example: (docs("sim.contacts().length"), docs("0")),
        run: |w, heap, _| {
            let full = |_| "the lists of this lab take too much memory".to_owned();
            let mut contacts = Vec::new();
            for c in w.contacts() {
                let force = w.contact_force(c)?;
                let entries = vec![
                    ("geom1".into(), Value::Number(c.geom1 as f64)),
                    ("geom2".into(), Value::Number(c.geom2 as f64)),
                    ("dist".into(), Value::Number(c.dist)),
                    ("pos".into(), heap.numbers(&c.pos).map_err(full)?),
                    ("frame".into(), heap.numbers(&c.frame).map_err(full)?),
                    ("force".into(), heap.numbers(&force).map_err(full)?),
                    ("dim".into(), Value::Number(c.dim as f64)),
                ];
                contacts.push(heap.record(entries).map_err(full)?);
            }
            heap.list(contacts).map_err(full)
        },
        ..SIM
    },
];
