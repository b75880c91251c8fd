//! A sphere at rest on the floor, compared with the closed form of its penetration depth.

use labspec_core::xml::compile;
use labspec_core::{self as core, Data, Model};
use proptest::prelude::*;

/// Contact parameters of a resting sphere.
#[derive(Clone, Copy, Debug)]
struct RestingContact {
    time: f64,
    damping: f64,
    solimp: [f64; 5],
    mass: f64,
    timestep: f64,
    friction: Option<f64>,
}

/// Parameters of any contact, or of one that comes to rest. A contact with a time constant of a few steps and low damping
/// continues to bounce, in MuJoCo as here, because each step applies the force of its start.
fn contact_parameters(settles: bool) -> impl Strategy<Value = RestingContact> {
    let (steps, damping, end) = if settles { (4.0, 0.8, 0.8) } else { (0.5, 0.3, 0.3) };
    let solimp = (0.3..1.0, end..0.98, 2e-4..5e-3, 0.2..0.8, 1.0..4.0);
    (steps..20.0, damping..1.5, solimp, 0.01..10.0, 0.0005..0.005, prop::option::of(0.2..1.5)).prop_map(
        |(steps, damping, (share, dw, width, mid, power), mass, timestep, friction)| RestingContact {
            time: steps * timestep,
            damping,
            solimp: [share * dw, dw, width, mid, power],
            mass,
            timestep,
            friction,
        },
    )
}

impl RestingContact {
    /// The impedance at a penetration depth.
    fn impedance(&self, depth: f64) -> f64 {
        let [d0, dw, width, mid, power] = self.solimp;
        let x = (depth / width).min(1.0);
        let y = if x <= mid {
            x.powf(power) / mid.powf(power - 1.0)
        } else {
            1.0 - (1.0 - x).powf(power) / (1.0 - mid).powf(power - 1.0)
        };
        d0 + y * (dw - d0)
    }

    /// The depth at which the contact force balances the weight: K d r = g (1 - d) / d, with K = 1 / (dw tc ζ)². For a pyramid
    /// with four edges, each with R = 2 µ² (1 + µ²) (1 - d) / (d m), the depth is µ² (1 + µ²) / 2 times as large.
    fn depth(&self) -> f64 {
        let time = self.time.max(2.0 * self.timestep);
        let k = 1.0 / (self.solimp[1] * time * self.damping).powi(2);
        let share = self.friction.map_or(1.0, |mu| 0.5 * mu * mu * (1.0 + mu * mu));
        let excess = |r: f64| {
            let d = self.impedance(r);
            k * d * r - share * 9.81 * (1.0 - d) / d
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        low
    }

    fn model(&self) -> Model {
        let [a, b, c, d, e] = self.solimp;
        let contact = match self.friction {
            Some(mu) => format!("condim='3' friction='{mu}'"),
            None => "condim='1'".into(),
        };
        let same = format!("solref='{} {}' solimp='{a} {b} {c} {d} {e}' {contact}", self.time, self.damping);
        compile(&format!(
            "<mujoco><option timestep='{}'/><worldbody><geom type='plane' size='1 1 1' {same}/>
             <body pos='0 0 2'><freejoint/><geom size='2' mass='{}' {same}/></body></worldbody></mujoco>",
            self.timestep, self.mass
        ))
        .unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, max_shrink_iters: 300, ..ProptestConfig::default() })]

    #[test]
    fn the_depth_of_a_resting_sphere_has_a_closed_form(rest in contact_parameters(true)) {
        let mut m = rest.model();
        // With the default tolerance, the solver stops early and the sphere moves up and down with 1e-9 m/s.
        (*m.edit().opt.tolerance, *m.edit().opt.ls_tolerance) = (0.0, 1e-10);
        let mut d = Data::new(&m);
        for _ in 0..20_000 {
            core::step(&m, &mut d).unwrap();
        }
        let depth = 2.0 - d.qpos[2];
        let expected = rest.depth();
        // The motion has decayed. A depth of 1e-5 m is accurate to 1e-16 of the height of 2 m.
        prop_assert!((depth - expected).abs() <= 1e-10 * expected + 1e-14, "{depth} {expected}");
        prop_assert!(d.qvel.iter().all(|v| v.abs() < 1e-12), "{:?}", d.qvel);
    }

    /// At that depth the forces are balanced, whether or not a simulation with this timestep converges to it.
    #[test]
    fn the_closed_form_is_in_balance(rest in contact_parameters(false)) {
        let mut m = rest.model();
        (*m.edit().opt.tolerance, *m.edit().opt.ls_tolerance) = (0.0, 1e-10);
        let mut d = Data::new(&m);
        d.edit().qpos[2] = 2.0 - rest.depth();
        core::forward(&m, &mut d).unwrap();
        prop_assert_eq!(d.ncon, 1);
        // The depth is accurate to 1e-16 of the radius. The reference acceleration is its product with K d.
        let stiffness = d.efc_KBIP[0] * d.efc_KBIP[2];
        prop_assert!(d.qacc[2].abs() <= 1e-9 + 1e-14 * stiffness, "{:?} {stiffness}", d.qacc);
    }
}
