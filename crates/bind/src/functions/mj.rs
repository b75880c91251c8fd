//! The functions of `mj`: functions of MuJoCo on the model and the data of the lab.

use super::{AccessedPart, Arg, Function, NOTHING, ROW, number, pass_result};
use labspec_core::Obj;
use labspec_expr::{Heap, Type, Value};
use labspec_finding::docs;

/// A function of `mj` that takes the model and the data.
const ENGINE: Function =
    Function { object: "mj", args: &[Arg::Model, Arg::Data], returns: Type::Void, ..ROW };

pub(super) const ROWS: &[Function] = &[
    Function {
        name: "mj_setConst",
        writes: &[AccessedPart::Coordinates, AccessedPart::Derived],
        doc: docs(
            "recomputes the constants that follow from masses, inertias and poses; resets qpos to qpos0",
        ),
        example: (
            docs("model.body_mass[1] = 2; mj.mj_setConst(model, data); model.body_subtreemass[0]"),
            docs("2"),
        ),
        run: |w, _, _| pass_result(w.set_const()),
        ..ENGINE
    },
    Function {
        name: "mj_forward",
        writes: &[AccessedPart::Derived],
        doc: docs("computes every derived field from the state, without advancing time"),
        example: (
            docs("data.qpos[0] = Math.PI / 2; mj.mj_forward(model, data); data.site_xpos[0].toFixed(3)"),
            docs("-0.500"),
        ),
        run: |w, _, _| pass_result(w.forward()),
        ..ENGINE
    },
    Function {
        name: "mj_step",
        writes: &[AccessedPart::State, AccessedPart::Derived],
        doc: docs("advances the simulation by one step"),
        example: (docs("mj.mj_step(model, data); data.time"), docs("0.002")),
        run: |w, _, _| pass_result(w.step()),
        ..ENGINE
    },
    Function {
        name: "mj_resetData",
        writes: &[AccessedPart::State, AccessedPart::Derived],
        doc: docs("resets the data to the default configuration"),
        example: (docs("data.qpos[0] = 1; mj.mj_resetData(model, data); data.qpos[0]"), docs("0")),
        run: |w, _, _| pass_result(w.reset_data()),
        ..ENGINE
    },
    Function {
        name: "mj_resetDataKeyframe",
        args: &[Arg::Model, Arg::Data, Arg::Number],
        writes: &[AccessedPart::State, AccessedPart::Derived],
        doc: docs("resets the data to a keyframe, counted from 0"),
        example: (docs("mj.mj_resetDataKeyframe(model, data, 1); data.qpos[0]"), docs("1.5")),
        run: |w, _, args| {
            let key = args.first().map_or(0.0, Value::to_number);
            if !(key >= 0.0 && key < w.nkey() as f64) {
                return Err(format!("keyframe {key} does not exist: the model has {}", w.nkey()));
            }
            pass_result(w.reset_to(Some(key as usize)))
        },
        ..ENGINE
    },
    Function {
        name: "mj_step1",
        writes: &[AccessedPart::Derived],
        doc: docs("computes everything that follows from position and velocity: the first half of a step"),
        example: (docs("mj.mj_step1(model, data); data.time"), docs("0")),
        run: |w, _, _| pass_result(w.step1()),
        ..ENGINE
    },
    Function {
        name: "mj_step2",
        writes: &[AccessedPart::State, AccessedPart::Derived],
        doc: docs("computes forces and advances the simulation: the second half of a step"),
        example: (docs("mj.mj_step1(model, data); mj.mj_step2(model, data); data.time"), docs("0.002")),
        run: |w, _, _| pass_result(w.step2()),
        ..ENGINE
    },
    Function {
        name: "mj_kinematics",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Derived],
        doc: docs("computes the poses of bodies, joints, geoms and sites from the coordinates"),
        example: (
            docs("data.qpos[0] = Math.PI; mj.mj_kinematics(model, data); data.site_xpos[2].toFixed(2)"),
            docs("1.50"),
        ),
        run: |w, _, _| pass_result(w.kinematics()),
        ..ENGINE
    },
    Function {
        name: "mj_fwdPosition",
        writes: &[AccessedPart::Derived],
        doc: docs("computes everything that follows from positions: poses, the mass matrix, contacts"),
        example: (
            docs("data.qpos[0] = Math.PI; mj.mj_fwdPosition(model, data); data.site_xpos[2].toFixed(2)"),
            docs("1.50"),
        ),
        run: |w, _, _| pass_result(w.fwd_position()),
        ..ENGINE
    },
    Function {
        name: "mj_fwdVelocity",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Derived],
        doc: docs("computes everything that follows from velocities, after the position stage"),
        example: (
            docs(
                "data.qvel[0] = 2; mj.mj_fwdPosition(model, data); mj.mj_fwdVelocity(model, data); data.cvel[7]",
            ),
            docs("2"),
        ),
        run: |w, _, _| pass_result(w.fwd_velocity()),
        ..ENGINE
    },
    Function {
        name: "mj_collision",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Contacts],
        doc: docs("finds the contacts of geoms at their current poses"),
        example: (docs("mj.mj_kinematics(model, data); mj.mj_collision(model, data); data.ncon"), docs("0")),
        run: |w, _, _| pass_result(w.collision()),
        ..ENGINE
    },
    Function {
        name: "mj_integratePos",
        args: &[Arg::Model, Arg::Any, Arg::Numbers, Arg::Number],
        doc: docs(
            "integrates coordinates in place (the list in the second argument) with a velocity over a time in s",
        ),
        example: (docs("ctx.q = [0.5]; mj.mj_integratePos(model, ctx.q, [2], 0.1); ctx.q[0]"), docs("0.7")),
        run: |w, heap, args| {
            let mut q = numbers(heap, args, 0)?;
            w.integrate_pos(
                &mut q,
                &numbers(heap, args, 1)?,
                args.get(2).map_or(f64::NAN, Value::to_number),
            )?;
            written(heap, args, &q, "the second argument receives the result: pass a list of `nq` numbers")
        },
        ..ENGINE
    },
    Function {
        name: "mj_differentiatePos",
        args: &[Arg::Model, Arg::Any, Arg::Number, Arg::Numbers, Arg::Numbers],
        doc: docs(
            "computes the velocity that leads from one list of coordinates to another over a time in s, and writes it into the list in the second argument",
        ),
        example: (
            docs("ctx.v = [0]; mj.mj_differentiatePos(model, ctx.v, 0.1, [0.5], [0.7]); ctx.v[0].toFixed(6)"),
            docs("2.000000"),
        ),
        run: |w, heap, args| {
            let [from, to] = [numbers(heap, args, 2)?, numbers(heap, args, 3)?];
            let v = w.differentiate_pos(args.get(1).map_or(f64::NAN, Value::to_number), &from, &to)?;
            written(
                heap,
                args,
                &v,
                "the second argument receives the result: write `const v = new Array(model.nv).fill(0)` first, and pass `v`",
            )
        },
        ..ENGINE
    },
    Function {
        name: "mj_energyPos",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Energy],
        doc: docs("computes the potential energy of the current poses into data.energy[0], J"),
        example: (docs("mj.mj_energyPos(model, data); data.energy[0]"), docs("4.905")),
        run: |w, _, _| pass_result(w.energy_pos()),
        ..ENGINE
    },
    Function {
        name: "mj_energyVel",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Energy],
        doc: docs("computes the kinetic energy of the current velocities into data.energy[1], J"),
        example: (
            docs("data.qvel[0] = 2; mj.mj_energyVel(model, data); data.energy[1].toFixed(5)"),
            docs("0.50072"),
        ),
        run: |w, _, _| pass_result(w.energy_vel()),
        ..ENGINE
    },
    Function {
        name: "mj_inverse",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Derived],
        doc: docs("computes qfrc_inverse, the generalized force that causes the acceleration in qacc"),
        example: (
            docs("mj.mj_inverse(model, data); Math.abs(data.qfrc_inverse[0]).toFixed(4)"),
            docs("0.0000"),
        ),
        run: |w, _, _| pass_result(w.inverse()),
        ..ENGINE
    },
    Function {
        name: "mj_subtreeVel",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Derived],
        doc: docs("computes velocity and angular momentum of the subtrees"),
        example: (
            docs(
                "data.qvel[0] = 2; mj.mj_forward(model, data); mj.mj_subtreeVel(model, data); data.subtree_linvel[3].toFixed(3)",
            ),
            docs("-1.000"),
        ),
        run: |w, _, _| pass_result(w.subtree_vel()),
        ..ENGINE
    },
    Function {
        name: "mj_rnePostConstraint",
        reads: AccessedPart::Derived,
        writes: &[AccessedPart::Derived],
        doc: docs("computes accelerations of bodies and the forces between them"),
        example: (docs("mj.mj_rnePostConstraint(model, data); data.cfrc_int[11].toFixed(2)"), docs("9.81")),
        run: |w, _, _| pass_result(w.rne_post_constraint()),
        ..ENGINE
    },
    Function {
        name: "mj_contactForce",
        args: &[Arg::Model, Arg::Data, Arg::Number, Arg::Any],
        reads: AccessedPart::Contacts,
        doc: docs(
            "writes the force and torque of a contact, counted from 0, into a list of six: N along the normal and two tangents, then N m about them; zeros if the contact has no constraint",
        ),
        example: (
            docs(
                "ctx.f = [0, 0, 0, 0, 0, 0]; if (data.ncon > 0) { mj.mj_contactForce(model, data, 0, ctx.f) }; ctx.f[0]",
            ),
            docs("0"),
        ),
        run: |w, heap, args| {
            let id = number(args)?;
            let found = if id >= 0.0 { w.contacts().get(id as usize) } else { None };
            let Some(contact) = found else {
                return Err(format!(
                    "contact {id} does not exist: there are {} now; test `data.ncon` first",
                    w.fields().ncon
                ));
            };
            let force = w.contact_force(contact)?;
            if !args.get(1).is_some_and(|list| heap.overwrite(list, &force)) {
                return Err("the fourth argument receives the result: write `const f = [0, 0, 0, 0, 0, 0]` first, and pass `f`".into());
            }
            NOTHING
        },
        ..ENGINE
    },
    Function {
        name: "mj_name2id",
        args: &[Arg::Model, Arg::Number, Arg::Text],
        returns: Type::Number,
        doc: docs(
            "index of the object of this kind (as mj.mjtObj.mjOBJ_BODY.value) and name; -1 if there is none",
        ),
        example: (docs("mj.mj_name2id(model, mj.mjtObj.mjOBJ_BODY.value, 'bob')"), docs("1")),
        run: |w, _, args| {
            let name = args.get(1).map(Value::to_string).unwrap_or_default();
            let id = kind(number(args)?).and_then(|kind| w.names().id(kind, &name));
            Ok(Value::Number(id.map_or(-1.0, |i| i as f64)))
        },
        ..ENGINE
    },
    Function {
        name: "mj_id2name",
        args: &[Arg::Model, Arg::Number, Arg::Number],
        returns: Type::Any,
        doc: docs("name of the object of this kind and index; null if there is none"),
        example: (docs("mj.mj_id2name(model, mj.mjtObj.mjOBJ_SITE.value, 0)"), docs("tip")),
        run: |w, _, args| {
            let index = args.get(1).map_or(-1.0, Value::to_number);
            let names = kind(number(args)?).map(|kind| w.names().of_kind(kind)).unwrap_or(&[]);
            let name = if index >= 0.0 { names.get(index as usize) } else { None };
            let name = name.filter(|n| !n.is_empty());
            Ok(name.map_or(Value::Null, |n| Value::from(n.as_str())))
        },
        ..ENGINE
    },
];

/// An argument that is a list of numbers.
fn numbers(heap: &Heap, args: &[Value], i: usize) -> Result<Vec<f64>, String> {
    args.get(i).and_then(|v| heap.to_numbers(v)).ok_or_else(|| "a list of numbers is missing".into())
}

/// Writes a result into the list that is the first argument.
fn written(heap: &mut Heap, args: &[Value], result: &[f64], otherwise: &str) -> Result<Value, String> {
    if args.first().is_some_and(|list| heap.overwrite(list, result)) {
        NOTHING
    } else {
        Err(otherwise.into())
    }
}

/// The kind of object for a number of `mjtObj`.
fn kind(number: f64) -> Option<Obj> {
    let kinds = crate::handle::KINDS.iter().map(|(kind, _)| *kind).chain([Obj::XBody]);
    kinds.into_iter().find(|kind| f64::from(*kind as i32) == number)
}
