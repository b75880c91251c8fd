//! The fields that a page draws. The steps of a lab compute what its programs read; the others are computed here from the
//! state, when a page requests them.

use super::Player;
use crate::error::Error;
use crate::run::Budget;
use labspec_core::reflect::{FieldId, FieldSet, Kind, Object, View, ViewMut};
use labspec_core::{Data, Full, Model, Planned, exhausted, forward, limit};

/// All fields for one state of a lab.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    data: Data<Full>,
    /// Whether the lab has moved since.
    pub(super) is_stale: bool,
}

impl Player {
    /// All fields of the data at the current state: poses, contacts, forces. They are computed like `mj_forward`, once for
    /// each state for which they are requested, and do not affect the lab. The data of the lab ([`Player::data`]) belong to
    /// the state before the last step, as after `mj_step`, and contain the fields that its programs read.
    ///
    /// # Errors
    /// The engine refuses the model as changed by the lab, or the scene needs more work than a page allows.
    pub fn scene(&mut self) -> Result<&Data<Full>, Error> {
        self.model_and_scene().map(|(_, scene)| scene)
    }

    /// The model, as changed by controls and programs, and [`Player::scene`].
    ///
    /// # Errors
    /// As for [`Player::scene`].
    pub fn model_and_scene(&mut self) -> Result<(&Model, &Data<Full>), Error> {
        let world = &self.current.session.world;
        let scene = self.scene.get_or_insert_with(|| Scene { data: Data::new(&world.model), is_stale: true });
        if scene.is_stale {
            limit(&mut scene.data, Budget::TRIAL.left);
            refresh(&world.model, &world.data, &mut scene.data).map_err(|e| Error::Call(e.to_string()))?;
            if exhausted(&scene.data) {
                return Err(Error::Call("this scene needs more work than a page allows: simplify it".into()));
            }
            scene.is_stale = false;
        }
        Ok((&world.model, &scene.data))
    }
}

/// Copies state and inputs, and computes all other fields.
fn refresh(model: &Model, from: &Data<Planned>, to: &mut Data<Full>) -> Result<(), labspec_core::Error> {
    let written = |f: &FieldId| {
        let info = f.info();
        info.object == Object::Data && matches!(info.kind, Kind::State | Kind::Input)
    };
    for field in FieldSet::ALL.iter().filter(written) {
        match (from.read(field)?, to.write(field)?) {
            (View::F64(from), ViewMut::F64(to)) if from.len() == to.len() => to.copy_from_slice(from),
            (View::I32(from), ViewMut::I32(to)) if from.len() == to.len() => to.copy_from_slice(from),
            (View::Bool(from), ViewMut::Bool(to)) if from.len() == to.len() => to.copy_from_slice(from),
            _ => debug_assert!(false, "state and inputs of one model have one size: {}", field.info().name),
        }
    }
    forward(model, to)
}
