//! Simulation data, separate from their model.

use crate::error::{call_error, refused};
use crate::fields::{by_index, copied, is_live, place};
use crate::model::{RawModel, kind, past_the_end, store};
use labspec::Functions;
use labspec::bind::World;
use labspec::run::Budget;
use labspec_core::reflect::{self, Object};
use labspec_core::state::INTEGRATION;
use labspec_core::{self as core, AccessSet, Contact, Data, Error, Model, Plan, Scope};
use wasm_bindgen::prelude::*;

/// The state and results of a simulation. Its model is passed to every call.
#[wasm_bindgen]
pub struct RawData {
    world: World,
    poses: Vec<f32>,
    /// The state before a call that is undone when its work is spent.
    before: Vec<f64>,
}

impl RawData {
    /// Calls a function with the model of the page in the world.
    pub(crate) fn with_world<T>(&mut self, model: &mut RawModel, what: impl FnOnce(&mut World) -> T) -> T {
        std::mem::swap(&mut self.world.model, &mut model.model);
        let result = what(&mut self.world);
        std::mem::swap(&mut self.world.model, &mut model.model);
        result
    }

    /// Performs one step with a model whose views have been synchronized.
    pub(crate) fn step_once(&mut self, model: &RawModel) -> Result<(), JsValue> {
        self.within(model, MOST_WORK, |m, d| core::step(m, d))
    }

    /// Runs a call with a limit of work. What needs more is undone: the state is the one before the call.
    fn within(
        &mut self,
        model: &RawModel,
        work: u64,
        what: impl FnOnce(&Model, &mut Data<core::Planned>) -> Result<(), Error>,
    ) -> Result<(), JsValue> {
        let (m, d) = (&model.model, &mut self.world.data);
        core::state::get(m, d, &mut self.before, INTEGRATION).map_err(|e| refused(&e))?;
        core::limit(d, work);
        let done = what(m, d);
        let spent = core::exhausted(d);
        core::limit(d, u64::MAX);
        done.map_err(|e| refused(&e))?;
        if !spent {
            return Ok(());
        }
        core::state::set(m, d, &self.before, INTEGRATION).map_err(|e| refused(&e))?;
        Err(call_error(
            "too-much-work",
            &format!(
                "this call needs more than {work} units of work, each about a nanosecond, and was undone: make fewer steps, simplify the model, or allow more work"
            ),
        ))
    }

    fn data(&self) -> &Data<core::Planned> {
        &self.world.data
    }
}

/// Functions of the model and the data.
type Pass = fn(&Model, &mut Data<core::Planned>) -> Result<(), Error>;
const PASSES: [(&str, Pass); 13] = [
    ("mj_step1", core::step1),
    ("mj_step2", core::step2),
    ("mj_forward", core::forward),
    ("mj_inverse", core::inverse),
    ("mj_resetData", core::reset_data),
    ("mj_kinematics", core::kinematics),
    ("mj_fwdPosition", core::fwd_position),
    ("mj_fwdVelocity", core::fwd_velocity),
    ("mj_collision", core::collision),
    ("mj_energyPos", core::energy_pos),
    ("mj_energyVel", core::energy_vel),
    ("mj_subtreeVel", core::subtree_vel),
    ("mj_rnePostConstraint", core::rne_post_constraint),
];

/// The maximum number of steps of one call.
const MAX_STEPS: usize = 100_000_000;
/// Work of one call, where the page sets no limit: as for a lab that is played.
const MOST_WORK: u64 = Budget::ASKED.left;

#[wasm_bindgen]
impl RawData {
    /// Creates data for a model, at its default configuration.
    #[wasm_bindgen(constructor)]
    pub fn new(model: &RawModel) -> Result<RawData, JsValue> {
        let data = Data::planned(&model.model, Plan::new(&model.model, &AccessSet::ANY));
        let world = World {
            // Each call brings its model, with what a page has changed.
            model: model.model.clone(),
            data,
            key: None,
            functions: Functions::new(),
            displayed: Vec::new(),
            numbers: Vec::new(),
            playback: None,
        };
        let size = core::state::size(&model.model, INTEGRATION).map_err(|e| refused(&e))?;
        Ok(RawData { world, poses: Vec::new(), before: vec![0.0; size] })
    }

    /// Makes at most this many steps, within this work budget.
    pub fn step(&mut self, model: &mut RawModel, steps: usize, work: Option<f64>) -> Result<(), JsValue> {
        if steps > MAX_STEPS {
            return Err(call_error(
                "too-long",
                &format!("{steps} steps are too many for one call; the limit is {MAX_STEPS}"),
            ));
        }
        model.sync();
        self.within(model, work.map_or(MOST_WORK, |work| work as u64), |m, d| {
            for _ in 0..steps {
                core::step(m, d)?;
                if core::exhausted(d) {
                    break;
                }
            }
            Ok(())
        })
    }

    /// Calls a function by its name in MuJoCo.
    pub fn pass(&mut self, model: &mut RawModel, name: &str) -> Result<(), JsValue> {
        let found = PASSES.iter().find(|(listed, _)| *listed == name);
        let (_, pass) =
            found.ok_or_else(|| call_error("unknown-function", &format!("there is no function `{name}`")))?;
        model.sync();
        self.within(model, MOST_WORK, |m, d| pass(m, d))
    }

    /// Resets the simulation to a keyframe.
    #[wasm_bindgen(js_name = resetKeyframe)]
    pub fn reset_keyframe(&mut self, model: &mut RawModel, key: usize) -> Result<(), JsValue> {
        model.sync();
        let count = model.model.nkey;
        let id = model.model.keys().nth(key);
        let id = id.ok_or(Error::NoId { kind: "keyframe", id: key, count }).map_err(|e| refused(&e))?;
        core::reset_data_keyframe(&model.model, &mut self.world.data, id).map_err(|e| refused(&e))
    }

    /// Stores the state in a keyframe.
    #[wasm_bindgen(js_name = setKeyframe)]
    pub fn set_keyframe(&mut self, model: &mut RawModel, key: usize) -> Result<(), JsValue> {
        let count = model.model.nkey;
        let id = model.model.keys().nth(key);
        let id = id.ok_or(Error::NoId { kind: "keyframe", id: key, count }).map_err(|e| refused(&e))?;
        core::set_keyframe(&mut model.model, &self.world.data, id).map_err(|e| refused(&e))
    }

    /// Computes the constants that depend on masses, inertias and poses.
    #[wasm_bindgen(js_name = setConst)]
    pub fn set_const(&mut self, model: &mut RawModel) -> Result<(), JsValue> {
        model.sync();
        core::set_const(&mut model.model, &mut self.world.data).map_err(|e| refused(&e))
    }

    /// The address and the element count of a field that the page can view in memory.
    pub fn place(&mut self, field: usize) -> Result<Vec<u32>, JsValue> {
        let field = by_index(field)?;
        let view = self.data().read(field).map_err(|e| refused(&e))?;
        let found = place(view).filter(|_| is_live(field));
        found
            .map(|found| found.to_vec())
            .ok_or_else(|| call_error("unknown-field", "this field is seen as a copy"))
    }

    /// A copy of a field.
    pub fn field(&self, field: usize) -> Result<JsValue, JsValue> {
        self.data().read(by_index(field)?).map(copied).map_err(|e| refused(&e))
    }

    /// The first element of a field.
    pub fn number(&self, field: usize) -> f64 {
        by_index(field).ok().and_then(|f| self.data().read(f).ok()?.get(0)).unwrap_or(f64::NAN)
    }

    /// Writes numbers into a field, starting at an element.
    pub fn write(&mut self, field: usize, from: usize, values: &[f64]) -> Result<(), JsValue> {
        let field = by_index(field)?;
        if field.info().object == Object::Data && !reflect::is_writable(field) {
            return Err(refused(&Error::NotWritable(field)));
        }
        let mut view = self.world.data.write(field).map_err(|e| refused(&e))?;
        if store(&mut view, from, values) { Ok(()) } else { Err(past_the_end(field)) }
    }

    /// Saves the complete simulation as bytes.
    pub fn save(&self, model: &RawModel) -> Result<Vec<u8>, JsValue> {
        core::save::save(&model.model, self.data()).map_err(|e| refused(&e))
    }

    /// Restores a saved simulation.
    pub fn restore(&mut self, model: &mut RawModel, bytes: &[u8]) -> Result<(), JsValue> {
        model.sync();
        core::save::restore(&model.model, &mut self.world.data, bytes).map_err(|e| refused(&e))
    }

    /// The contacts with their forces, see [`contacts`].
    pub fn contacts(&self, model: &RawModel) -> Result<Vec<f64>, JsValue> {
        contacts(&model.model, self.data())
    }

    /// The poses of all geoms: a 4 x 4 matrix for each, in column-major order.
    pub fn poses(&mut self) -> js_sys::Float32Array {
        let fields = self.world.data.fields();
        write_poses(&fields.geom_xpos, &fields.geom_xmat, &mut self.poses);
        // SAFETY: the page copies it before its next call.
        unsafe { js_sys::Float32Array::view(&self.poses) }
    }

    /// M as a dense matrix.
    #[wasm_bindgen(js_name = fullM)]
    pub fn full_m(&self, model: &RawModel) -> Result<Vec<f64>, JsValue> {
        core::full_m(&model.model, self.data()).map_err(|e| refused(&e))
    }

    /// The Jacobian of the constraints as a dense matrix.
    #[wasm_bindgen(js_name = fullJ)]
    pub fn full_j(&self, model: &RawModel) -> Result<Vec<f64>, JsValue> {
        core::full_j(&model.model, self.data()).map_err(|e| refused(&e))
    }

    /// M v, or the solution of M x = v.
    #[wasm_bindgen(js_name = massTimes)]
    pub fn mass_times(&self, model: &RawModel, v: Vec<f64>, inverse: bool) -> Result<Vec<f64>, JsValue> {
        let mut out = v.clone();
        let done = match inverse {
            true => core::solve_m(&model.model, self.data(), &mut out),
            false => core::mul_m(&model.model, self.data(), &v, &mut out),
        };
        done.map(|()| out).map_err(|e| refused(&e))
    }

    /// A Jacobian: its translational rows, then its rotational rows.
    pub fn jacobian(
        &self,
        model: &RawModel,
        of: &str,
        id: usize,
        point: &[f64],
    ) -> Result<Vec<f64>, JsValue> {
        let (m, d) = (&model.model, self.data());
        let position = || match *point {
            [x, y, z] => Ok([x, y, z]),
            _ => Err(Error::Length { what: "the point", expected: 3, found: point.len() }),
        };
        let found = match of {
            "point" => position().and_then(|point| core::jac(m, d, point, id)),
            "body" => core::jac_body(m, d, id),
            "bodyCom" => core::jac_body_com(m, d, id),
            "geom" => core::jac_geom(m, d, id),
            "site" => core::jac_site(m, d, id),
            "subtreeCom" => return core::jac_subtree_com(m, d, id).map_err(|e| refused(&e)),
            _ => return Err(call_error("unknown-kind", &format!("there is no Jacobian of `{of}`"))),
        };
        let core::Jacobian { mut jacp, jacr } = found.map_err(|e| refused(&e))?;
        jacp.extend(jacr);
        Ok(jacp)
    }

    /// The velocity of an object: angular, then linear.
    #[wasm_bindgen(js_name = objectVelocity)]
    pub fn object_velocity(
        &self,
        model: &RawModel,
        of: &str,
        id: usize,
        local: bool,
    ) -> Result<Vec<f64>, JsValue> {
        let found = core::object_velocity(&model.model, self.data(), kind(of)?, id, local);
        found.map(|v| v.to_vec()).map_err(|e| refused(&e))
    }

    /// The nearest geom on a ray: distance, geom and normal; `undefined` if it hits none.
    pub fn ray(
        &self,
        model: &RawModel,
        from: &[f64],
        along: &[f64],
        statics: bool,
        exclude: i32,
    ) -> Result<Vec<f64>, JsValue> {
        let (&[a, b, c], &[x, y, z]) = (from, along) else {
            return Err(call_error("wrong-length", "a ray has a point and a direction of 3 numbers each"));
        };
        let filter = core::RayFilter { groups: None, statics, exclude_body: usize::try_from(exclude).ok() };
        let hit =
            core::ray(&model.model, self.data(), [a, b, c], [x, y, z], &filter).map_err(|e| refused(&e))?;
        Ok(hit.map_or(Vec::new(), |hit| {
            vec![hit.distance, hit.geom as f64, hit.normal[0], hit.normal[1], hit.normal[2]]
        }))
    }

    /// The generalized force of a force and a torque at a point of a body.
    #[wasm_bindgen(js_name = applyFt)]
    pub fn apply_ft(
        &self,
        model: &RawModel,
        given: &[f64],
        body: usize,
        mut qfrc: Vec<f64>,
    ) -> Result<Vec<f64>, JsValue> {
        let &[fx, fy, fz, tx, ty, tz, px, py, pz] = given else {
            return Err(call_error("wrong-length", "a force, a torque and a point have 3 numbers each"));
        };
        let (ft, point) = ([[fx, fy, fz], [tx, ty, tz]], [px, py, pz]);
        let done = core::apply_ft(&model.model, self.data(), ft, point, body, &mut qfrc);
        done.map(|()| qfrc).map_err(|e| refused(&e))
    }

    /// The acceleration of an object as an accelerometer measures it: angular, then linear.
    #[wasm_bindgen(js_name = objectAcceleration)]
    pub fn object_acceleration(
        &self,
        model: &RawModel,
        of: &str,
        id: usize,
        local: bool,
    ) -> Result<Vec<f64>, JsValue> {
        let found = core::object_acceleration(&model.model, self.data(), kind(of)?, id, local);
        found.map(|v| v.to_vec()).map_err(|e| refused(&e))
    }

    /// The distance of two geoms, and the nearest points.
    #[wasm_bindgen(js_name = geomDistance)]
    pub fn geom_distance(
        &mut self,
        model: &RawModel,
        geom1: usize,
        geom2: usize,
        most: f64,
    ) -> Result<Vec<f64>, JsValue> {
        let found = core::geom_distance(&model.model, &mut self.world.data, geom1, geom2, most);
        let found = found.map_err(|e| refused(&e))?;
        let [[a, b, c], [x, y, z]] = found.fromto;
        Ok(vec![found.dist, a, b, c, x, y, z])
    }

    /// The position after moving with a velocity for some time.
    #[wasm_bindgen(js_name = integratePos)]
    pub fn integrate_pos(
        &self,
        model: &RawModel,
        mut qpos: Vec<f64>,
        v: &[f64],
        h: f64,
    ) -> Result<Vec<f64>, JsValue> {
        core::integrate_pos(&model.model, &mut qpos, v, h).map(|()| qpos).map_err(|e| refused(&e))
    }

    /// The velocity that moves from one position to another in some time.
    #[wasm_bindgen(js_name = differentiatePos)]
    pub fn differentiate_pos(
        &self,
        model: &RawModel,
        h: f64,
        from: &[f64],
        to: &[f64],
    ) -> Result<Vec<f64>, JsValue> {
        core::differentiate_pos(&model.model, h, from, to).map_err(|e| refused(&e))
    }

    /// A state as a list of numbers.
    #[wasm_bindgen(js_name = getState)]
    pub fn get_state(&self, model: &RawModel, signature: i32) -> Result<Vec<f64>, JsValue> {
        let size = core::state::size(&model.model, signature).map_err(|e| refused(&e))?;
        let mut out = vec![0.0; size];
        core::state::get(&model.model, self.data(), &mut out, signature).map_err(|e| refused(&e))?;
        Ok(out)
    }

    /// Sets a state.
    #[wasm_bindgen(js_name = setState)]
    pub fn set_state(&mut self, model: &mut RawModel, values: &[f64], signature: i32) -> Result<(), JsValue> {
        core::state::set(&model.model, &mut self.world.data, values, signature).map_err(|e| refused(&e))
    }

    /// The number of warnings of each kind.
    pub fn warnings(&self) -> Vec<u32> {
        self.data().fields().warning.iter().map(|w| w.number as u32).collect()
    }
}

/// The number of values per contact in a list of contacts.
const CONTACT: usize = 40;

/// All contacts with their forces, as 40 numbers each: geom1, geom2, dist, pos (3), frame (9), dim, friction (5), force
/// and torque in the contact frame (6), includemargin, solref (2), solreffriction (2), solimp (5), mu, exclude,
/// efc_address (-1: none), and a zero.
pub(crate) fn contacts<S: Scope>(model: &Model, data: &Data<S>) -> Result<Vec<f64>, JsValue> {
    let list: &[Contact] = &data.fields().contact;
    let mut out = Vec::with_capacity(list.len() * CONTACT);
    for c in list {
        let force = core::contact_force(model, data, c).map_err(|e| refused(&e))?;
        out.extend([c.geom1 as f64, c.geom2 as f64, c.dist]);
        out.extend(c.pos);
        out.extend(c.frame);
        out.push(c.dim as f64);
        out.extend(c.friction);
        out.extend(force);
        out.push(c.includemargin);
        out.extend(c.solref);
        out.extend(c.solreffriction);
        out.extend(c.solimp);
        out.extend([c.mu, f64::from(c.exclude), c.efc_address.map_or(-1.0, |address| address as f64), 0.0]);
    }
    Ok(out)
}

/// Writes poses as 4 x 4 matrices in column-major order, for drawing.
pub(crate) fn write_poses(xpos: &[f64], xmat: &[f64], out: &mut Vec<f32>) {
    out.clear();
    for (p, r) in xpos.chunks_exact(3).zip(xmat.chunks_exact(9)) {
        for column in 0..3 {
            out.extend([r[column] as f32, r[3 + column] as f32, r[6 + column] as f32, 0.0]);
        }
        out.extend([p[0] as f32, p[1] as f32, p[2] as f32, 1.0]);
    }
}
