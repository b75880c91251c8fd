//! Corrects coupled parameters after programs, and after modifications of a model's text.

use super::change::PartnerChange;
use super::pair_set::{PairSet, writes_field};
use super::table::PAIRS;
use crate::source::Text;
use labspec_bind::{Functions, World, functions};
use labspec_core::reflect::{FieldId, Kind, Object, View};
use labspec_core::{self as core, AccessSet, Data, Error, Model, Plan};
use labspec_expr::Program;

/// Corrects the parameters coupled to those that programs of a lab write, directly after each program.
#[derive(Clone, Debug)]
pub(crate) struct Coupled {
    /// Programs, and the pairs that are corrected after each.
    pub(crate) programs: Vec<(Text, PairSet)>,
    /// The pairs for all other programs: the setups of the runs of a `verify` object.
    pub(crate) others: PairSet,
    /// The pairs for modifications of the model, which a run of a `verify` object may make.
    pub(crate) changes: PairSet,
    /// Whether constants are also recomputed (`mj_setConst`, with qpos preserved) where a program changes a field on which
    /// they depend.
    pub(crate) refresh: bool,
}

impl Coupled {
    /// Whether a modification of a model's text omits a coupled parameter; `before` is the model without it.
    pub(crate) fn leaves_coupled(&self, before: &Model, current: &Model) -> bool {
        same_objects(before, current) && has_uncoupled_change(self.changes, before, current)
    }

    /// Corrects a model with modifications of its text; `before` is the model without them.
    pub(crate) fn changed(&self, before: &Model, current: &mut Model) {
        let mut world = World {
            model: current.clone(),
            data: Data::planned(current, Plan::new(current, &AccessSet::ANY)),
            key: None,
            functions: Functions::new(),
            displayed: Vec::new(),
            numbers: Vec::new(),
            playback: None,
        };
        if same_objects(before, current)
            && correct_partners(self.changes, before, &mut world).is_ok_and(|done| done.is_some())
        {
            *current = world.model;
        }
    }

    /// The pairs that are corrected after a program; `None` where there are none.
    pub(crate) fn pairs_after(&self, program: &Program, text: &Text) -> Option<PairSet> {
        let listed = self.programs.iter().find(|(program_text, _)| program_text == text);
        let pairs = listed.map_or(self.others, |(_, pairs)| *pairs);
        let written = pairs.pairs().any(|(_, pair)| writes_field(program, pair.parameter));
        (written || listed.is_some() && self.refresh && writes_inertial(program)).then_some(pairs)
    }

    /// Corrects the coupled parameters that a program did not update. `before` is the model before it ran.
    ///
    /// # Errors
    /// An error of the engine.
    pub(crate) fn follow(
        &self,
        pairs: PairSet,
        before: &Model,
        program: &Program,
        world: &mut World,
    ) -> Result<(), Error> {
        // If the program does not recompute constants, the correction does so only with `refresh`: the omission is a
        // separate fault.
        let forgotten = writes_inertial(program) && !calls_set_const(program);
        let done = correct_fields(pairs, before, world)?;
        if self.refresh && writes_inertial(program) || done == Some(true) && !forgotten {
            recompute_constants(world)?;
        }
        Ok(())
    }
}

/// Whether two models have the same bodies, geoms and actuators.
fn same_objects(a: &Model, b: &Model) -> bool {
    a.nbody == b.nbody && a.ngeom == b.ngeom && a.nactuator == b.nactuator
}

/// Whether a coupled parameter differs from the value that follows from its parameter. `before` is the model before the
/// change.
pub(crate) fn has_uncoupled_change(pairs: PairSet, before: &Model, current: &Model) -> bool {
    pairs.pairs().any(|(_, pair)| !(pair.follow)(before, current).is_empty())
}

/// Corrects coupled parameters, and the constants that depend on them; `None` where nothing was wrong.
fn correct_partners(pairs: PairSet, before: &Model, world: &mut World) -> Result<Option<bool>, Error> {
    let done = correct_fields(pairs, before, world)?;
    if done == Some(true) {
        recompute_constants(world)?;
    }
    Ok(done)
}

/// Corrects coupled parameters. Returns `None` where nothing was wrong, and `true` where constants depend on a corrected
/// one.
fn correct_fields(pairs: PairSet, before: &Model, world: &mut World) -> Result<Option<bool>, Error> {
    let mut changes: Vec<(FieldId, usize, PartnerChange)> = Vec::new();
    for (_, pair) in pairs.pairs() {
        changes.extend((pair.follow)(before, &world.model).into_iter().map(|(i, c)| (pair.partner, i, c)));
    }
    let mut inertial = None;
    for (partner, index, change) in changes {
        let Some(old) = core::element(&world.model, &world.data, partner, index) else { continue };
        let new = match change {
            PartnerChange::Times(f) => old * f,
            PartnerChange::Plus(x) => old + x,
            PartnerChange::Becomes(x) => x,
        };
        core::view_mut(&mut world.model, &mut world.data, partner)?.set(index, new);
        inertial = Some(inertial == Some(true) || partner.info().kind == Kind::Inertial);
    }
    Ok(inertial)
}

/// Calls `mj_setConst` and preserves qpos.
fn recompute_constants(world: &mut World) -> Result<(), Error> {
    let qpos = world.data.fields().qpos.clone();
    core::set_const(&mut world.model, &mut world.data)?;
    world.data.edit().qpos.copy_from_slice(&qpos);
    Ok(())
}

/// Whether two models have the same coupled parameters, up to rounding.
pub(crate) fn agree(a: &Model, b: &Model) -> bool {
    let mut fields = PAIRS.iter().flat_map(|pair| [pair.parameter, pair.partner]);
    fields.all(|f| match (a.field(f), b.field(f)) {
        (Some(View::F64(a)), Some(View::F64(b))) => {
            let near = |(x, y): (&f64, &f64)| (x - y).abs() <= ROUNDING * x.abs().max(y.abs());
            a.len() == b.len() && a.iter().zip(b).all(near)
        }
        (Some(View::I32(a)), Some(View::I32(b))) => a == b,
        _ => false,
    })
}

/// Relative difference that another order of operations may cause.
const ROUNDING: f64 = 1e-9;

/// Whether a program may write a field on which constants depend.
fn writes_inertial(program: &Program) -> bool {
    let written = |f: FieldId| f.info().object == Object::Model && f.info().kind == Kind::Inertial;
    program.effects().writes.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).any(written)
}

/// Whether a program recomputes constants.
fn calls_set_const(program: &Program) -> bool {
    program.effects().calls.iter().any(|f| functions::name(*f) == Some("mj_setConst"))
}
