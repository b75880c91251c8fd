//! Parameters of a model that belong together: what a program changes, and the partner that it leaves behind.
//!
//! A body of ten times the mass has ten times the inertia, a servo of twice the gain has twice the bias. A program that writes
//! one of a pair alone makes a body, or a servo, that does not exist. [`Coupled`] makes a lab run with the partners corrected
//! behind every program, so that what the omission changes is measured and not guessed.
//!
//! | piece | module |
//! |---|---|
//! | the pairs, and how each partner follows | `table` |
//! | contact bits, and what stands between them and a contact | `bits` |
//! | shapes: bounding radius, inertia, the geom that carries the mass of a body | `shape` |
//! | the correction as statements of the language | `repair` |

mod bits;
mod repair;
mod shape;
mod table;

pub(crate) use repair::Repair;
pub(crate) use table::Pair;

use table::PAIRS;

use super::{Bound, ModelNames, Programs, Scope, World, functions, include};
use crate::source::Text;
use labspec_core::reflect::{FieldId, Kind, Object, View};
use labspec_core::{self as core, AccessSet, Data, Error, Model, Plan};
use labspec_expr::{Compiler, Globals, Program};

/// Some of the pairs of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PairSet(u32);

impl PairSet {
    pub(crate) const NONE: PairSet = PairSet(0);
    pub(crate) const ALL: PairSet = PairSet(u32::MAX);

    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    pub(crate) fn without(self, other: PairSet) -> PairSet {
        PairSet(self.0 & !other.0)
    }

    /// The pairs whose parameter a program may write.
    pub(crate) fn written_by(program: &Program) -> PairSet {
        let set = PAIRS.iter().enumerate().filter(|(_, pair)| writes(program, pair.parameter));
        PairSet(set.fold(0, |all, (i, _)| all | 1 << i))
    }

    /// The pairs of the set, each with the set of it alone.
    pub(crate) fn pairs(self) -> impl Iterator<Item = (PairSet, &'static Pair)> {
        let all = PAIRS.iter().enumerate().map(|(i, pair)| (PairSet(1 << i), pair));
        all.filter(move |(one, _)| self.0 & one.0 != 0)
    }
}

impl FromIterator<PairSet> for PairSet {
    fn from_iter<I: IntoIterator<Item = PairSet>>(sets: I) -> PairSet {
        PairSet(sets.into_iter().fold(0, |all, set| all | set.0))
    }
}

/// Whether a program may write a field of the model.
fn writes(program: &Program, field: FieldId) -> bool {
    let effects = program.effects();
    effects.writes_everything
        || effects.calls_values
        || effects.writes.iter().any(|a| a.field.0 as usize == field.index())
}

/// How an element of a partner changes.
#[derive(Clone, Copy, Debug)]
enum Change {
    Times(f64),
    Plus(f64),
    Becomes(f64),
}

/// Corrects the partners of what programs of a lab write, right behind each of them.
#[derive(Clone, Debug)]
pub(crate) struct Coupled {
    /// Programs, and the pairs of each that are corrected.
    pub(crate) programs: Vec<(Text, PairSet)>,
    /// Those of all other programs: the setups of the runs of a `verify` object.
    pub(crate) others: PairSet,
    /// Those of changes of the model itself, which a run of a `verify` object may make.
    pub(crate) changes: PairSet,
    /// Constants are computed anew besides (`mj_setConst`, with qpos kept) where a program changes what they follow from.
    pub(crate) refresh: bool,
}

impl Coupled {
    /// Makes the runs of these programs corrected ones.
    pub(crate) fn install(self, programs: &mut Programs, model: &Model) {
        // What the correction reads and writes belongs to what the lab needs.
        let names = ModelNames::new(model, Scope::Lab);
        let mut globals = Globals::new();
        let set_const = "const q = data.qpos.slice(); mj.mj_setConst(model, data); data.qpos.set(q)";
        if let Some(program) = Compiler::new(&names, &mut globals).statements(set_const).program {
            include(program.effects(), &mut programs.demand);
        }
        PAIRS.iter().for_each(|pair| programs.demand.writes.insert(pair.partner));
        programs.coupled = Some(self);
    }

    /// Whether a change of a model's text leaves a partner behind; `before` is the model without it.
    pub(crate) fn is_left_by_change(&self, before: &Model, now: &Model) -> bool {
        same_objects(before, now) && left_behind(self.changes, before, now)
    }

    /// A model with changes of its text, corrected; `before` is the one without them.
    pub(crate) fn changed(&self, before: &Model, now: &mut Model) {
        let mut world = World {
            model: now.clone(),
            data: Data::planned(now, Plan::new(now, &AccessSet::ANY)),
            key: None,
            own: super::Functions::new(),
            shown: Vec::new(),
            numbers: Vec::new(),
        };
        if same_objects(before, now)
            && correct(self.changes, before, &mut world).is_ok_and(|done| done.is_some())
        {
            *now = world.model;
        }
    }

    /// What is corrected behind a program; `None` where nothing is.
    pub(crate) fn behind(&self, program: &Program, text: &Text) -> Option<PairSet> {
        let known = self.programs.iter().find(|(own, _)| own == text);
        let pairs = known.map_or(self.others, |(_, pairs)| *pairs);
        let written = pairs.pairs().any(|(_, pair)| writes(program, pair.parameter));
        (written || known.is_some() && self.refresh && inertial(program)).then_some(pairs)
    }

    /// Corrects what a program left behind. `before` is the model before it ran.
    ///
    /// # Errors
    /// What the engine says.
    pub(crate) fn follow(
        &self,
        pairs: PairSet,
        before: &Model,
        program: &Program,
        world: &mut World,
    ) -> Result<(), Error> {
        // Where a program changes what constants follow from and leaves them, they stay: that is another omission.
        let forgotten = inertial(program) && !calls_set_const(program);
        let done = correct_fields(pairs, before, world)?;
        if self.refresh && inertial(program) || done == Some(true) && !forgotten {
            constants(world)?;
        }
        Ok(())
    }
}

/// Whether two models have the same bodies, geoms and actuators.
fn same_objects(a: &Model, b: &Model) -> bool {
    a.nbody == b.nbody && a.ngeom == b.ngeom && a.nactuator == b.nactuator
}

/// Whether a partner of these pairs is not what follows from its parameter. `before` is the model before that was changed.
pub(crate) fn left_behind(pairs: PairSet, before: &Model, now: &Model) -> bool {
    pairs.pairs().any(|(_, pair)| !(pair.follow)(before, now).is_empty())
}

/// Corrects partners, and the constants that follow from them; `None` where nothing was wrong.
fn correct(pairs: PairSet, before: &Model, world: &mut World) -> Result<Option<bool>, Error> {
    let done = correct_fields(pairs, before, world)?;
    if done == Some(true) {
        constants(world)?;
    }
    Ok(done)
}

/// Corrects partners: `None` where nothing was wrong, `true` where constants follow from what was.
fn correct_fields(pairs: PairSet, before: &Model, world: &mut World) -> Result<Option<bool>, Error> {
    let mut changes: Vec<(FieldId, usize, Change)> = Vec::new();
    for (_, pair) in pairs.pairs() {
        changes.extend((pair.follow)(before, &world.model).into_iter().map(|(i, c)| (pair.partner, i, c)));
    }
    let mut inertial = None;
    for (partner, index, change) in changes {
        let Some(old) = core::element(&world.model, &world.data, partner, index) else { continue };
        let new = match change {
            Change::Times(f) => old * f,
            Change::Plus(x) => old + x,
            Change::Becomes(x) => x,
        };
        core::view_mut(&mut world.model, &mut world.data, partner)?.set(index, new);
        inertial = Some(inertial == Some(true) || partner.info().kind == Kind::Inertial);
    }
    Ok(inertial)
}

/// `mj_setConst`, with qpos kept.
fn constants(world: &mut World) -> Result<(), Error> {
    let qpos = world.data.fields().qpos.clone();
    core::set_const(&mut world.model, &mut world.data)?;
    world.data.edit().qpos.copy_from_slice(&qpos);
    Ok(())
}

/// Whether two models have the same parameters and partners, to rounding.
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

/// A part of a number by which another order of operations may change it.
const ROUNDING: f64 = 1e-9;

/// Whether a program may write what constants follow from.
fn inertial(program: &Program) -> bool {
    let written = |f: FieldId| f.info().object == Object::Model && f.info().kind == Kind::Inertial;
    program.effects().writes.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).any(written)
}

/// Whether a program computes constants anew.
fn calls_set_const(program: &Program) -> bool {
    program.effects().calls.iter().any(|f| functions::name(*f) == Some("mj_setConst"))
}

/// The pairs that some control of a lab leaves to the student on purpose: the partner has a control of its own, which does not
/// write the parameter. Both numbers are then chosen apart from each other.
pub(crate) fn chosen_apart(programs: &Programs, bound: &Bound, pairs: PairSet) -> PairSet {
    let controls = programs.controls.iter().filter_map(|(_, c)| match c {
        super::ControlProgram::Change(_, action) => action.run.as_ref(),
        super::ControlProgram::Press(_) => None,
    });
    let others: Vec<&Bound> = controls.filter(|other| other.text != bound.text).collect();
    let apart = |pair: &Pair| {
        let wanted: Vec<_> =
            elements(bound, pair.parameter).into_iter().flatten().flat_map(pair.partners).collect();
        let has = |other: &&Bound| {
            let theirs = elements(other, pair.partner).unwrap_or_default();
            !writes(&other.program, pair.parameter) && wanted.iter().any(|i| theirs.contains(i))
        };
        others.iter().any(has)
    };
    pairs.pairs().filter(|(_, pair)| apart(pair)).map(|(one, _)| one).collect()
}

/// Most elements of a field that are taken one by one.
const MOST_ELEMENTS: usize = 64;

/// The elements of a field that a program writes itself, where it says which.
fn elements(bound: &Bound, field: FieldId) -> Option<Vec<usize>> {
    let own = bound.program.own_writes();
    let mut all = Vec::new();
    for access in own.iter().filter(|a| a.field.0 as usize == field.index()) {
        let count = access.count.filter(|n| *n <= MOST_ELEMENTS)?;
        all.extend(access.first..access.first + count);
    }
    all.sort_unstable();
    all.dedup();
    (!all.is_empty()).then_some(all)
}
