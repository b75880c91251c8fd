//! Finds parts of a model that are too stiff, or damped too strongly, for its timestep.
//!
//! Along one degree of freedom or one tendon with inverse inertia w, stiffness K, damping B that is applied at the start of
//! a step (explicit) and damping D that is applied at its end (implicit), a step of semi-implicit Euler is
//!
//! > v⁺ = (v - h w (K x + B v)) / (1 + h w D), x⁺ = x + h v⁺
//!
//! The roots of its characteristic polynomial are inside the unit circle when h² w K + 2 h w B < 4 + 2 h w D (Jury's
//! criterion). The diagonal of M⁻¹ K is never larger than its largest eigenvalue, so a reported part is unstable near the
//! default configuration. An instability that couples several joints may be missed. The reference of a constraint is an
//! acceleration, so w = 1 for constraints.

use labspec_core::math::{MINVAL, rows};
use labspec_core::{Model, Obj, disable, integrator, joint, servo_gains, trntype};
use labspec_finding::{order, without_zeros};

/// A spring, servo or constraint that is unstable at the timestep of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct UnstablePart {
    /// The type of the object whose parameters cause it: an actuator, joint, tendon, geom, contact pair or equality.
    pub object: Obj,
    /// Its id.
    pub id: usize,
    /// The part of the object.
    pub part: StiffPart,
    /// Ratio of the stiffness to the stable limit, above 1.
    pub excess: f64,
    /// The largest stable timestep, s.
    pub timestep: f64,
}

/// The part of an object that is too stiff.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StiffPart {
    /// A servo: `kp` or `kv` of an actuator.
    Servo,
    /// A spring or a damper of a joint or a tendon.
    Spring,
    /// A limit of a joint or a tendon: its `solreflimit`.
    Limit,
    /// A contact or an equality: its `solref`.
    Constraint,
}

/// All parts that are too stiff for the timestep and the integrator of the model, in order of decreasing excess.
pub fn unstable_parts(m: &Model) -> Vec<UnstablePart> {
    let mut list = Vec::new();
    if m.opt.integrator != integrator::DISCRETE {
        springs(m, &mut list);
        if !m.opt.disabled(disable::CONSTRAINT) {
            constraints(m, &mut list);
        }
    }
    list.retain(|s| s.excess > 1.0);
    order::sort_by(&mut list, |a, b| b.excess.total_cmp(&a.excess));
    list
}

/// Ratio of the largest to the smallest energy during an oscillation of the stiffest spring or servo. A symplectic step
/// with s = hω/2 < 1 conserves a modified energy, and ½ m v² + ½ k x² is between 1 - s and 1 + s times that energy.
/// Dimensionless, at least 1; infinite beyond the stability limit.
pub fn swing(m: &Model) -> f64 {
    let mut list = Vec::new();
    if !matches!(m.opt.integrator, integrator::DISCRETE | integrator::RK4) {
        springs(m, &mut list);
    }
    let s = list.iter().map(|suspect| suspect.excess).fold(0.0, f64::max).sqrt();
    if s < 1.0 { (1.0 + s) / (1.0 - s) } else { f64::INFINITY }
}

/// The stiffness and damping along one coordinate.
#[derive(Clone, Copy, Debug, Default)]
struct Spring {
    stiff: f64,
    /// Damping that is applied at the start and at the end of a step.
    explicit: f64,
    implicit: f64,
}

impl Spring {
    /// Ratio to the stable limit, and the largest stable timestep, for an inverse inertia.
    fn judge(self, m: &Model, inverse: f64) -> (f64, f64) {
        let h = m.opt.timestep;
        let [k, b, d] = [self.stiff, self.explicit, self.implicit].map(|x| (x * inverse).max(0.0));
        if m.opt.integrator == integrator::RK4 {
            // The stability region of RK4 ends at 2.83 on the imaginary axis and at 2.79 on the real axis.
            let excess = (k * h * h / 8.0).max(b * h / 2.785);
            return (excess, (8.0 / k).sqrt().min(2.785 / b));
        }
        let excess = (h * h * k + 2.0 * h * b) / (4.0 + 2.0 * h * d);
        let net = b - d;
        let longest = if k > 0.0 { 4.0 / (net + (net * net + 4.0 * k).sqrt()) } else { 2.0 / net.max(0.0) };
        (excess, longest)
    }
}

/// Whether damping is implicit (applied at the end of a step): of joints, and of everything else.
fn implicit(m: &Model) -> [bool; 2] {
    match m.opt.integrator {
        integrator::IMPLICIT | integrator::IMPLICITFAST => [true; 2],
        integrator::EULER => [!m.opt.disabled(disable::EULERDAMP), false],
        _ => [false; 2],
    }
}

/// Springs and dampers of joints and tendons, with the servos that act along them.
fn springs(m: &Model, list: &mut Vec<UnstablePart>) {
    let [joints, others] = implicit(m);
    let on = |x: f64, flag: i32| if m.opt.disabled(flag) { 0.0 } else { x };
    for j in (0..m.njnt).filter(|&j| matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE)) {
        let k = m.jnt_dofadr[j] as usize;
        let attributes = [on(m.jnt_stiffness[j], disable::SPRING), on(m.dof_damping[k], disable::DAMPER)];
        let along = |a: usize| {
            matches!(m.actuator_trntype[a], trntype::JOINT | trntype::JOINTINPARENT)
                && m.actuator_trnid[2 * a] == j as i32
        };
        judge(m, list, (Obj::Joint, j), attributes, [joints, others], m.dof_invweight0[k], along);
    }
    for t in 0..m.ntendon {
        let attributes =
            [on(m.tendon_stiffness[t], disable::SPRING), on(m.tendon_damping[t], disable::DAMPER)];
        let along =
            |a: usize| m.actuator_trntype[a] == trntype::TENDON && m.actuator_trnid[2 * a] == t as i32;
        judge(m, list, (Obj::Tendon, t), attributes, [others; 2], m.tendon_invweight0[t], along);
    }
}

/// Adds up the stiffness and damping along one coordinate. The stiffest part is reported.
fn judge(
    m: &Model,
    list: &mut Vec<UnstablePart>,
    (object, id): (Obj, usize),
    [stiff, damping]: [f64; 2],
    [own_implicit, servo_implicit]: [bool; 2],
    inverse: f64,
    along: impl Fn(usize) -> bool,
) {
    let mut sum = Spring { stiff, ..Spring::default() };
    *(if own_implicit { &mut sum.implicit } else { &mut sum.explicit }) += damping;
    let alone = |stiff: f64, damping: f64| stiff * m.opt.timestep + 2.0 * damping;
    let mut worst = (alone(stiff, if own_implicit { 0.0 } else { damping }), StiffPart::Spring, object, id);
    if !m.opt.disabled(disable::ACTUATION) {
        for a in (0..m.nactuator).filter(|&a| along(a)) {
            let Some(gains) = servo_gains(m, a) else { continue };
            let gear = rows::<6>(&m.actuator_gear).get(m.actuator_outadr[a] as usize).map_or(0.0, |g| g[0]);
            let [kp, kv] = gains.map(|g| (g * gear * gear).max(0.0));
            sum.stiff += kp;
            *(if servo_implicit { &mut sum.implicit } else { &mut sum.explicit }) += kv;
            let servo = alone(kp, if servo_implicit { 0.0 } else { kv });
            if servo > worst.0 {
                worst = (servo, StiffPart::Servo, Obj::Actuator, a);
            }
        }
    }
    let (excess, timestep) = sum.judge(m, inverse);
    let (_, part, object, id) = worst;
    list.push(UnstablePart { object, id, part, excess, timestep });
}

/// Contacts, limits and equalities by their `solref`.
fn constraints(m: &Model, list: &mut Vec<UnstablePart>) {
    let mut push = |object: Obj, id: usize, part: StiffPart, solref: [f64; 2]| {
        let (excess, timestep) = reference(m, solref).judge(m, 1.0);
        list.push(UnstablePart { object, id, part, excess, timestep });
    };
    let on = |flag: i32| !m.opt.disabled(flag);
    if on(disable::CONTACT) {
        for g in (0..m.ngeom).filter(|&g| m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0) {
            push(Obj::Geom, g, StiffPart::Constraint, rows::<2>(&m.geom_solref)[g]);
        }
        for p in 0..m.npair {
            push(Obj::Pair, p, StiffPart::Constraint, rows::<2>(&m.pair_solref)[p]);
        }
    }
    if on(disable::LIMIT) {
        for j in (0..m.njnt).filter(|&j| m.jnt_limited[j]) {
            push(Obj::Joint, j, StiffPart::Limit, rows::<2>(&m.jnt_solref)[j]);
        }
        for t in (0..m.ntendon).filter(|&t| m.tendon_limited[t]) {
            push(Obj::Tendon, t, StiffPart::Limit, rows::<2>(&m.tendon_solref_lim)[t]);
        }
    }
    if on(disable::EQUALITY) {
        for e in (0..m.neq).filter(|&e| m.eq_active0[e]) {
            push(Obj::Equality, e, StiffPart::Constraint, rows::<2>(&m.eq_solref)[e]);
        }
    }
}

/// The spring and the damper of a `solref`, per unit of inertia. MuJoCo scales them so that the impedance cancels.
fn reference(m: &Model, [time, ratio]: [f64; 2]) -> Spring {
    let [stiff, explicit] = if time > 0.0 {
        let safe = !m.opt.disabled(disable::REFSAFE);
        let time = if safe { time.max(2.0 * m.opt.timestep) } else { time };
        [1.0 / (time * time * ratio * ratio).max(MINVAL), 2.0 / time]
    } else {
        [-time, -ratio]
    };
    Spring { stiff, explicit, implicit: 0.0 }
}

/// The name of the stiff part: `the servo "lift"`, `the spring of joint "knee"`.
pub fn owner(model: &Model, s: &UnstablePart) -> String {
    let names = model.names.of_kind(s.object);
    let name = match names.get(s.id) {
        Some(name) if !name.is_empty() => format!("\"{name}\""),
        _ => s.id.to_string(),
    };
    match (s.part, s.object) {
        (StiffPart::Servo, _) => format!("the servo {name}"),
        (StiffPart::Constraint, Obj::Geom) => format!("the contact of geom {name}"),
        (StiffPart::Constraint, Obj::Pair) => format!("the contact of pair {name}"),
        (StiffPart::Constraint, _) => format!("the equality {name}"),
        (part, object) => {
            let what = if part == StiffPart::Limit { "limit" } else { "spring or damper" };
            format!("the {what} of {} {name}", if object == Obj::Tendon { "tendon" } else { "joint" })
        }
    }
}

/// By how much it is too stiff: `1.8 times too stiff`, `just too stiff`.
pub fn how_stiff(s: &UnstablePart) -> String {
    match s.excess {
        x if x < 1.1 => "just too stiff".into(),
        x if x < 10.0 => format!("{} times too stiff", without_zeros(format!("{x:.1}"))),
        x => format!("{x:.0} times too stiff"),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use labspec_core::{Data, step, xml};

    /// A slide of 2 kg with a servo, and additional attributes.
    fn servo(option: &str, servo: &str, joint: &str) -> Model {
        let text = format!(
            "<mujoco><option gravity=\"0 0 0\" {option}/><worldbody><body><joint name=\"j\" type=\"slide\" {joint}/>\
             <geom size=\".1\" mass=\"2\"/></body></worldbody><actuator><position joint=\"j\" {servo}/></actuator></mujoco>"
        );
        xml::compile(&text).unwrap()
    }

    /// A slide with an actuator of another kind.
    fn driven(option: &str, actuator: &str) -> Model {
        let text = format!(
            "<mujoco><option gravity=\"0 0 0\" {option}/><worldbody><body><joint name=\"j\" type=\"slide\"/>\
             <geom size=\".1\" mass=\"2\"/></body></worldbody><actuator>{actuator}</actuator></mujoco>"
        );
        xml::compile(&text).unwrap()
    }

    /// The largest displacement of the slide within 3000 steps, from an initial displacement of 1 mm.
    fn farthest(m: &Model) -> f64 {
        let mut d = Data::new(m);
        d.edit().qpos[0] = 1e-3;
        let mut most: f64 = 0.0;
        for _ in 0..3000 {
            step(m, &mut d).unwrap();
            most = most.max(d.qpos[0].abs());
        }
        most
    }

    #[test]
    fn reported_parts_diverge_and_others_do_not() {
        for integrator in ["Euler", "implicit", "implicitfast"] {
            for (kp, kv, damping, h) in [
                (1e3, 0.0, 0.0, 1.0),
                (1e5, 10.0, 5.0, 0.01),
                (10.0, 300.0, 0.0, 0.02),
                (1e6, 0.0, 1e3, 0.005),
            ] {
                let option = |h: f64| format!("integrator=\"{integrator}\" timestep=\"{h}\"");
                let with = |h: f64| {
                    let gains = format!("kp=\"{kp}\" kv=\"{kv}\"");
                    servo(&option(h), &gains, &format!("damping=\"{damping}\""))
                };
                let Some(found) = unstable_parts(&with(h)).first().cloned() else {
                    assert!(farthest(&with(h)) < 0.1, "{integrator} {kp} {kv} {h}");
                    continue;
                };
                assert_eq!((found.object, found.id, found.part), (Obj::Actuator, 0, StiffPart::Servo));
                let (above, below) = (with(1.02 * found.timestep), with(0.98 * found.timestep));
                assert!(farthest(&above) > 0.1, "{integrator} {kp} {kv}: {}", found.timestep);
                assert!(farthest(&below) < 0.1, "{integrator} {kp} {kv}: {}", found.timestep);
                assert!(unstable_parts(&below).is_empty() && unstable_parts(&above).len() == 1);
            }
        }
    }

    #[test]
    fn controllers_and_motors_are_servos_too() {
        for integrator in ["Euler", "implicit", "implicitfast"] {
            for actuator in [
                "<pid joint=\"j\" kp=\"5e3\" kv=\"4\"/>",
                "<pid joint=\"j\" kp=\"3e3\" kv=\"300\" gear=\"2\"/>",
                "<dcmotor joint=\"j\" motorconst=\".5\" resistance=\"2\" input=\"pos\" controller=\"5e3 0 4\"/>",
                "<dcmotor joint=\"j\" motorconst=\".5\" resistance=\"2\" input=\"pos\" controller=\"3e3 0 300\" gear=\"3\"/>",
            ] {
                let with =
                    |h: f64| driven(&format!("integrator=\"{integrator}\" timestep=\"{h}\""), actuator);
                let found = unstable_parts(&with(0.5)).first().cloned().unwrap();
                assert_eq!((found.object, found.id, found.part), (Obj::Actuator, 0, StiffPart::Servo));
                let (above, below) = (with(1.02 * found.timestep), with(0.98 * found.timestep));
                assert!(farthest(&above) > 0.1, "{integrator} {actuator}: {}", found.timestep);
                assert!(farthest(&below) < 0.1, "{integrator} {actuator}: {}", found.timestep);
            }
        }
        // A motor with a voltage input only brakes. With inductance, the equation has a higher order.
        for actuator in [
            "<dcmotor joint=\"j\" motorconst=\".5\" resistance=\"2\"/>",
            "<dcmotor joint=\"j\" motorconst=\".5\" resistance=\"2\" inductance=\".1\" input=\"pos\" controller=\"5e3 0 4\"/>",
        ] {
            assert_eq!(unstable_parts(&driven("timestep=\".5\"", actuator)), []);
        }
    }

    #[test]
    fn the_discrete_integrator_follows_everything() {
        let m = servo("integrator=\"discrete\" timestep=\"1\"", "kp=\"1e8\"", "");
        assert!(unstable_parts(&m).is_empty() && farthest(&m) < 0.1);
    }

    #[test]
    fn a_stiff_contact_is_named() {
        let text = "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\" solref=\"-1e8 0\"/><body pos=\"0 0 .1\">\
                    <freejoint/><geom size=\".1\"/></body></worldbody></mujoco>";
        let found = unstable_parts(&xml::compile(text).unwrap());
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].object, found[0].id, found[0].part), (Obj::Geom, 0, StiffPart::Constraint));
        assert!(found[0].excess > 90.0 && found[0].timestep < 2.1e-4, "{found:?}");
        assert!(unstable_parts(&xml::compile(&text.replace(" solref=\"-1e8 0\"", "")).unwrap()).is_empty());
    }
}
