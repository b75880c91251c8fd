//! The linearization of one step by finite differences (`mjd_transitionFD`).
//!
//! A step maps the state x and the controls u to the next state. Near a state, small differences satisfy δx⁺ = A δx + B δu, and
//! differences of sensors satisfy δs = C δx + D δu. Differences of positions are in the tangent space: a quaternion counts as
//! three numbers, the rotation vector in the axes of the body.

use crate::api::call;
use crate::api::data::{Data, Scope};
use crate::api::error::Error;
use crate::api::model::Model;
use crate::kinds::disable;
use crate::model::Warning;
use crate::model::reflect::{View, data};
use nalgebra::DMatrix;

/// The parameters of the finite differences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteDifferences {
    /// The perturbation of a coordinate, in its own unit. The error of rounding is about 1e-16 / `eps`; the error of curvature is
    /// about `eps` (or its square if the differences are centered).
    pub eps: f64,
    /// Whether a coordinate is perturbed in both directions. This doubles the number of steps.
    pub centered: bool,
    /// Whether C and D are computed. Otherwise they have no rows.
    pub sensors: bool,
}

impl Default for FiniteDifferences {
    /// Centered, 1e-6, without sensors.
    fn default() -> FiniteDifferences {
        FiniteDifferences { eps: 1e-6, centered: true, sensors: false }
    }
}

/// The derivatives of one step. States have n = 2 nv + na numbers: positions in the tangent space, velocities, activations.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// n × n: of the next state with respect to the state.
    pub a: DMatrix<f64>,
    /// n × nu: of the next state with respect to the controls.
    pub b: DMatrix<f64>,
    /// nsensordata × n: of the sensors with respect to the state.
    pub c: DMatrix<f64>,
    /// nsensordata × nu: of the sensors with respect to the controls.
    pub d: DMatrix<f64>,
}

/// A coordinate that is perturbed.
#[derive(Clone, Copy)]
enum Coordinate {
    Position(usize),
    Velocity(usize),
    Activation(usize),
    Control(usize),
}

/// The derivatives of one step at the state and the inputs of the data, by finite differences (`mjd_transitionFD`).
///
/// The data do not change: the steps are made with copies, each from the same state and the same warm start. Any integrator is
/// supported, including Runge–Kutta methods. If a control is at a limit of its range, it is perturbed into the range. If it is
/// beyond the range, its column is zero, because the engine clamps the control. The sensors are those that the step computes,
/// which belong to the state before the step.
///
/// MuJoCo 3.14.0 returns D with the opposite sign if the differences are centered. Here D has the sign of the derivative.
///
/// With constraints, the solver's `tolerance` limits how accurately a step is a function of its state. Set `opt.tolerance` to 0,
/// or far below `eps`, for derivatives as accurate as those without constraints.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, nalgebra::{FiniteDifferences, transition_fd}};
/// let model = Model::from_xml(
///     "<mujoco><option timestep='0.01' gravity='0 0 0'/>
///      <worldbody><body><joint name='x' type='slide'/><geom size='0.1' mass='2'/></body></worldbody>
///      <actuator><motor joint='x'/></actuator></mujoco>",
/// )?;
/// let step = transition_fd(&model, &Data::new(&model), &FiniteDifferences::default())?;
/// // v⁺ = v + h u / m, x⁺ = x + h v⁺.
/// assert!((step.a[(0, 1)] - 0.01).abs() < 1e-9 && (step.b[(1, 0)] - 0.005).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// The data belong to another model, `eps` is not positive or exceeds the range of a control, the plan left `sensordata` out
/// although `sensors` is set, a tree sleeps, the work limit of the data is exceeded, or a step gives values that are not finite.
pub fn transition_fd<S: Scope>(
    m: &Model,
    d: &Data<S>,
    differences: &FiniteDifferences,
) -> Result<Transition, Error> {
    d.belongs_to(m)?;
    if !(differences.eps > 0.0 && differences.eps.is_finite()) {
        return Err(Error::Value { what: "`eps` of finite differences", must: "above zero" });
    }
    if differences.sensors {
        d.has(&[data::sensordata])?;
    }
    let state = (0..m.nv).map(Coordinate::Position);
    let state = state.chain((0..m.nv).map(Coordinate::Velocity)).chain((0..m.na).map(Coordinate::Activation));
    let nominal = next(m, d, None)?;
    let (a, c) = columns(m, d, &nominal, state, differences)?;
    let (b, d) = columns(m, d, &nominal, (0..m.nu).map(Coordinate::Control), differences)?;
    Ok(Transition { a, b, c, d })
}

/// The derivatives of the next state and of the sensors with respect to some coordinates, one column per coordinate.
fn columns<S: Scope>(
    m: &Model,
    d: &Data<S>,
    nominal: &Data<S>,
    coordinates: impl Iterator<Item = Coordinate>,
    differences: &FiniteDifferences,
) -> Result<(DMatrix<f64>, DMatrix<f64>), Error> {
    let (mut states, mut sensors, mut count) = (Vec::new(), Vec::new(), 0);
    let eps = differences.eps;
    for coordinate in coordinates {
        let [forth, back] = match coordinate {
            Coordinate::Control(i) => inside_range(m, d, i, eps),
            _ => [true; 2],
        };
        let (forth, back) = match (forth, back) {
            (false, false) => {
                return Err(Error::Value {
                    what: "`eps` of finite differences",
                    must: "smaller than the range of every control",
                });
            }
            (true, true) => (true, differences.centered),
            one_way => one_way,
        };
        let moved = |so: bool, by: f64| so.then(|| next(m, d, Some((coordinate, by)))).transpose();
        let (after, before) = (moved(forth, eps)?, moved(back, -eps)?);
        let length = if forth && back { 2.0 * eps } else { eps };
        let (from, to) = (before.as_ref().unwrap_or(nominal), after.as_ref().unwrap_or(nominal));
        let first = states.len();
        append_difference(m, from, to, length, &mut states)?;
        if differences.sensors {
            let (from, to) = (sensordata(from)?, sensordata(to)?);
            sensors.extend(from.iter().zip(to).map(|(from, to)| (to - from) / length));
        }
        if !states[first..].iter().all(|x| x.is_finite()) {
            return Err(not_finite());
        }
        count += 1;
    }
    let height = if differences.sensors { m.nsensordata } else { 0 };
    Ok((DMatrix::from_vec(2 * m.nv + m.na, count, states), DMatrix::from_vec(height, count, sensors)))
}

/// Whether a control can be perturbed up and down without crossing a limit of its range. A control at a limit is perturbed into
/// the range.
fn inside_range<S: Scope>(m: &Model, d: &Data<S>, control: usize, eps: f64) -> [bool; 2] {
    let limited = m.actuator_ctrllimited.get(control) == Some(&true) && !m.is_disabled(disable::CLAMPCTRL);
    let range = m.actuator_ctrlrange.as_chunks::<2>().0.get(control).filter(|_| limited);
    let Some((&[low, high], &u)) = range.zip(d.fields().ctrl.get(control)) else { return [true; 2] };
    // Below the range, inside it, or above it.
    let part = |x: f64| (x >= low, x > high);
    [eps, -eps].map(|by| part(u + by) == part(u))
}

/// A copy of the data, one step later, that starts with one coordinate perturbed.
fn next<S: Scope>(m: &Model, d: &Data<S>, moved: Option<(Coordinate, f64)>) -> Result<Data<S>, Error> {
    let mut next = d.clone();
    if let Some((coordinate, by)) = moved {
        let edit = next.edit();
        match coordinate {
            Coordinate::Position(dof) => {
                let along: Vec<f64> = (0..m.nv).map(|k| f64::from(u8::from(k == dof))).collect();
                call::integrate_pos(m, edit.qpos, &along, by)?;
            }
            Coordinate::Velocity(dof) => edit.qvel[dof] += by,
            Coordinate::Activation(i) => edit.act[i] += by,
            Coordinate::Control(i) => edit.ctrl[i] += by,
        }
    }
    call::step(m, &mut next)?;
    if call::exhausted(&next) {
        return Err(Error::Value { what: "the work limit of the data", must: "enough for all steps" });
    }
    let (from, to) = (d.fields(), next.fields());
    if [from, to].iter().any(|f| f.tree_asleep.iter().any(|&tree| tree >= 0)) {
        return Err(Error::Value { what: "every tree", must: "awake while a step is linearized" });
    }
    let resets = [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc, Warning::BadCtrl];
    if resets.iter().any(|&w| from.warning[w as usize].number != to.warning[w as usize].number) {
        return Err(not_finite());
    }
    Ok(next)
}

fn not_finite() -> Error {
    Error::Value { what: "the state after one step", must: "finite and within the engine's limits" }
}

/// Appends the difference of two states in the tangent space, divided by `length`.
fn append_difference<S: Scope>(
    m: &Model,
    from: &Data<S>,
    to: &Data<S>,
    length: f64,
    out: &mut Vec<f64>,
) -> Result<(), Error> {
    let (from, to) = (from.fields(), to.fields());
    out.extend(call::differentiate_pos(m, length, &from.qpos, &to.qpos)?);
    out.extend(from.qvel.iter().zip(&to.qvel).map(|(from, to)| (to - from) / length));
    out.extend(from.act.iter().zip(&to.act).map(|(from, to)| (to - from) / length));
    Ok(())
}

fn sensordata<S: Scope>(d: &Data<S>) -> Result<&[f64], Error> {
    match d.read(data::sensordata)? {
        View::F64(values) => Ok(values),
        _ => Err(Error::NoField("sensordata".into())),
    }
}
