//! The access of the table's rows to the simulation: numbers to read, and functions of the engine. The model and the data are
//! private here, so that a row cannot call the engine in another way. An error of the engine always becomes the error of the
//! call; no row can replace it by a value.

use crate::World;
use crate::world::{NUMBERS, Playback};
use labspec_core::{self as core, Contact, Data, Error, Fields, Jacobian, Model, Names, Planned, enable};
use labspec_expr::{Heap, Host, Value};
use std::cell::RefCell;

/// The simulation during one call of a function.
pub(crate) struct EngineAccess<'w> {
    world: &'w mut World,
    /// The first error of the engine.
    failed: RefCell<Option<String>>,
}

/// An error of the engine that has been recorded.
pub(super) struct Failed(String);

impl From<Failed> for String {
    fn from(Failed(message): Failed) -> String {
        message
    }
}

/// The implementation of a row: computes the result or an error.
pub(crate) type Run = fn(&mut EngineAccess<'_>, &mut Heap, &[Value]) -> Result<Value, String>;

/// Calls the implementation of a row.
pub(crate) fn call(run: Run, world: &mut World, heap: &mut Heap, args: &[Value]) -> Result<Value, String> {
    let mut access = EngineAccess { world, failed: RefCell::new(None) };
    let result = run(&mut access, heap, args);
    match access.failed.into_inner() {
        Some(message) => Err(message),
        None => result,
    }
}

/// Defines passes of the engine over the model and the data.
macro_rules! passes {
    ($($name:ident)*) => {
        $(pub(super) fn $name(&mut self) -> Result<(), Failed> {
            self.pass(core::$name)
        })*
    };
}

impl EngineAccess<'_> {
    passes! {
        forward step step1 step2 reset_data kinematics fwd_position fwd_velocity collision energy_pos energy_vel
        inverse subtree_vel rne_post_constraint
    }

    fn pass(&mut self, run: fn(&Model, &mut Data<Planned>) -> Result<(), Error>) -> Result<(), Failed> {
        let result = run(&self.world.model, &mut self.world.data);
        self.record_error(result)
    }

    /// Returns the result of the engine, and records its error.
    fn record_error<T>(&self, result: Result<T, Error>) -> Result<T, Failed> {
        result.map_err(|error| {
            let message = String::from(error);
            self.failed.borrow_mut().get_or_insert_with(|| message.clone());
            Failed(message)
        })
    }

    pub(super) fn set_const(&mut self) -> Result<(), Failed> {
        let result = core::set_const(&mut self.world.model, &mut self.world.data);
        self.record_error(result)
    }

    /// Resets the simulation to a keyframe, or to the default configuration.
    pub(super) fn reset_to(&mut self, key: Option<usize>) -> Result<(), Failed> {
        let result = self.world.reset_to(key);
        self.record_error(result)
    }

    /// Asks the page to play or to pause.
    pub(super) fn ask_playback(&mut self, asked: Playback) -> Result<Value, String> {
        self.world.ask_playback(asked);
        super::NOTHING
    }

    /// Resets the simulation to the keyframe of the lab.
    pub(super) fn reset(&mut self) -> Result<(), Failed> {
        self.reset_to(self.world.key)
    }

    /// The force (N) and the torque (N m) of a contact in the contact frame.
    pub(super) fn contact_force(&self, contact: &Contact) -> Result<[f64; 6], Failed> {
        self.record_error(core::contact_force(&self.world.model, &self.world.data, contact))
    }

    /// The mass matrix: nv rows of nv numbers in one list.
    pub(super) fn full_m(&self) -> Result<Vec<f64>, Failed> {
        self.record_error(core::full_m(&self.world.model, &self.world.data))
    }

    pub(super) fn jac_site(&self, site: usize) -> Result<Jacobian, Failed> {
        self.record_error(core::jac_site(&self.world.model, &self.world.data, site))
    }

    pub(super) fn integrate_pos(&self, q: &mut [f64], v: &[f64], h: f64) -> Result<(), Failed> {
        self.record_error(core::integrate_pos(&self.world.model, q, v, h))
    }

    pub(super) fn differentiate_pos(&self, h: f64, from: &[f64], to: &[f64]) -> Result<Vec<f64>, Failed> {
        self.record_error(core::differentiate_pos(&self.world.model, h, from, to))
    }

    /// The potential and the kinetic energy in J; enables their computation.
    pub(super) fn energy(&mut self) -> Result<[f64; 2], Failed> {
        if !self.world.model.opt.enabled(enable::ENERGY) {
            self.world.model.set_enabled(enable::ENERGY, true);
            self.forward()?;
        }
        Ok(self.fields().energy)
    }

    /// The fields of the data.
    pub(super) fn fields(&self) -> &Fields {
        self.world.data.fields()
    }

    pub(super) fn contacts(&self) -> &[Contact] {
        &self.fields().contact
    }

    pub(super) fn names(&self) -> &Names {
        &self.world.model.names
    }

    /// The number of degrees of freedom.
    pub(super) fn nv(&self) -> usize {
        self.world.model.nv
    }

    pub(super) fn nkey(&self) -> usize {
        self.world.model.nkey
    }

    /// The first coordinate of a joint.
    pub(super) fn qpos_of(&self, joint: usize) -> Option<f64> {
        let &first = self.world.model.jnt_qposadr.get(joint)?;
        self.fields().qpos.get(usize::try_from(first).ok()?).copied()
    }

    /// The body to which a geom belongs.
    pub(super) fn body_of(&self, geom: usize) -> Option<usize> {
        usize::try_from(*self.world.model.geom_bodyid.get(geom)?).ok()
    }

    /// The value that is displayed under a label.
    pub(super) fn displayed_value(&self, label: usize) -> Option<&Value> {
        self.world.displayed.get(label)
    }

    /// A number of the members of sweeps.
    pub(super) fn number(&self, index: usize) -> Option<f64> {
        self.world.get(NUMBERS, index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec_core::{AccessSet, Plan};

    #[test]
    fn no_row_turns_an_error_of_the_engine_into_a_value() {
        let model = core::xml::compile("<mujoco><worldbody><site name='s'/></worldbody></mujoco>").unwrap();
        let data = Data::planned(&model, Plan::new(&model, &AccessSet::ANY));
        let mut world = World {
            model,
            data,
            key: None,
            functions: crate::Functions::new(),
            displayed: Vec::new(),
            numbers: Vec::new(),
            playback: None,
        };
        core::forward(&world.model, &mut world.data).unwrap();
        let rows: [Run; 4] = [
            |w, _, _| Ok(Value::Number(w.jac_site(7).map_or(0.0, |j| j.jacp[0]))),
            |w, _, _| {
                let Ok(j) = w.jac_site(7) else { return Ok(Value::Null) };
                Ok(Value::Number(j.jacp[0]))
            },
            |w, _, _| {
                Ok(Value::Number(w.differentiate_pos(1.0, &[1.0], &[]).unwrap_or_default().iter().sum()))
            },
            |w, _, _| {
                w.jac_site(7)?;
                Ok(Value::Null)
            },
        ];
        for run in rows {
            let result = call(run, &mut world, &mut Heap::default(), &[]);
            assert!(result.is_err_and(|message| !message.is_empty()));
        }
        let fine: Run = |w, _, _| Ok(Value::Number(w.jac_site(0)?.jacp.len() as f64));
        assert_eq!(call(fine, &mut world, &mut Heap::default(), &[]), Ok(Value::Number(0.0)));
    }
}
