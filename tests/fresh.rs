//! Random scenes that were not used to develop the criteria of `monitors/`. The truth about a run comes from a second one with
//! steps a hundred times shorter; `stability.rs` writes the results into `docs/measured/stability.md`.

#![allow(clippy::unwrap_used)]

use crate::population::sample;
use crate::support::compile;
use labspec::monitors::watch;
use labspec_core::math::rows;
use labspec_core::{self as core, Data, Model, Warning, geom, integrator, solver};
use std::fmt::Write;

/// The seed, the number of scenes, the steps of a run, and how many times shorter the steps of the reference run are.
const SEED: u64 = 20_261_123;
const SCENES: usize = 240;
const STEPS: usize = 300;
const SHORTER: usize = 100;
/// One of so many scenes is in a sample. It has no common divisor with the number of kinds, so that all kinds occur.
pub(crate) const SAMPLE_STEP: usize = 7;
/// The thickness up to which a box counts as a wall, m; its middle is at 1 m.
const WALL_THICKNESS: f64 = 0.03;

/// Random numbers, reproducible for a seed.
struct Random(u64);

impl Random {
    /// A number from 0 up to 1 (splitmix64).
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn from(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    /// A number that is distributed evenly over powers of ten.
    fn over(&mut self, low: f64, high: f64) -> f64 {
        self.from(low.ln(), high.ln()).exp()
    }

    fn one<'t>(&mut self, list: &[&'t str]) -> &'t str {
        list[(self.part() * list.len() as f64) as usize]
    }
}

/// A scene: its kind, its model, and its timestep, s.
struct Scene {
    kind: &'static str,
    xml: String,
    step: f64,
}

const FLOOR: &str = "<geom type='plane' size='50 50 1'/>";

fn scene(
    kind: &'static str,
    r: &mut Random,
    steps: [f64; 2],
    make: impl FnOnce(&mut Random) -> [String; 4],
) -> Scene {
    let step = r.over(steps[0], steps[1]);
    let method = r.one(&["Euler", "RK4", "implicit", "implicitfast", "discrete"]);
    let [option, body, rest, key] = make(r);
    let xml = format!(
        "<mujoco><option timestep='{step:.3e}' integrator='{method}' {option}/><worldbody>{body}</worldbody>{rest}\
         <keyframe><key {key}/></keyframe></mujoco>"
    );
    Scene { kind, xml, step }
}

/// Links connected by hinges.
fn links(n: usize, length: f64, more: &str) -> String {
    let link = |inner: String| {
        format!(
            "<body pos='{length} 0 0'><joint axis='0 1 0' {more}/><geom type='capsule' fromto='0 0 0 {length} 0 0' size='.02' mass='1' \
             contype='0' conaffinity='0'/>{inner}</body>"
        )
    };
    (0..n).fold(String::new(), |inner, _| link(inner))
}

fn box_at(z: f64, half: f64, mass: f64) -> String {
    format!(
        "<body pos='0 0 {z}'><freejoint/><geom type='box' size='{half} {half} {half}' mass='{mass:.3}'/></body>"
    )
}

/// The scenes of a seed.
fn scenes(seed: u64) -> Vec<Scene> {
    let mut dice = Random(seed);
    let r = &mut dice;
    let none = String::new;
    let cart = |more: String| {
        format!("<body><joint name='j' type='slide' {more}/><geom size='.1' mass='1'/></body>")
    };
    let make = |i: usize, r: &mut Random| match i % 8 {
        0 => scene("links that swing", r, [1e-3, 1.0], |r| {
            let n = 1 + (3.0 * r.part()) as usize;
            let body = links(n, r.over(0.1, 1.0), &format!("damping='{:.1e}'", r.over(1e-4, 1e-2)));
            [none(), body, none(), none()]
        }),
        1 => scene("a servo", r, [1e-3, 3e-2], |r| {
            let (kp, kv) = (r.over(10.0, 1e7), r.one(&["0", "1", "30"]));
            let rest = format!("<actuator><position joint='j' kp='{kp:.2e}' kv='{kv}'/></actuator>");
            ["gravity='0 0 0'".into(), cart(none()), rest, "ctrl='.1'".into()]
        }),
        2 => scene("a spring", r, [1e-3, 3e-2], |r| {
            let more = format!("stiffness='{:.2e}' damping='{:.2e}'", r.over(1.0, 1e7), r.over(1e-3, 1e3));
            ["gravity='0 0 0'".into(), cart(more), none(), "qpos='.05'".into()]
        }),
        3 => scene("a ball on a floor", r, [5e-4, 2e-2], |r| {
            let k = r.over(1e3, 1e9);
            let b = 2.0 * k.sqrt() * r.over(0.01, 2.0);
            let contact = format!("solref='-{k:.2e} -{b:.2e}'");
            let ball = format!(
                "<body pos='0 0 {:.3}'><freejoint/><geom size='.1' mass='1' {contact}/></body>",
                r.from(0.1, 0.6)
            );
            let floor = FLOOR.replace("/>", &format!(" {contact}/>"));
            [none(), floor + &ball, none(), none()]
        }),
        4 => scene("a ball thrown at a plate", r, [5e-4, 1e-2], |r| {
            let plate = format!("<geom type='box' pos='1 0 0' size='{:.4} 2 2'/>", r.over(5e-4, 3e-2));
            let ball = format!("<body><freejoint/><geom size='{:.3}' mass='.1'/></body>", r.over(0.01, 0.1));
            let key = format!("qvel='{:.3} 0 0 0 0 0'", r.over(3.0, 300.0));
            ["gravity='0 0 0'".into(), plate + &ball, none(), key]
        }),
        5 => scene("a slam into a limit", r, [5e-4, 1e-2], |r| {
            let arm = "<body><joint axis='0 1 0' range='-45 45'/><geom type='capsule' fromto='0 0 0 .4 0 0' size='.03' mass='.5'/></body>";
            let key = format!("qvel='{:.3}'", r.over(1.0, 3e4));
            ["gravity='0 0 0'".into(), arm.into(), none(), key]
        }),
        6 => scene("boxes on boxes", r, [1e-3, 0.1], |r| {
            let n = 2 + (3.0 * r.part()) as usize;
            let boxes: String = (0..n).map(|k| box_at(0.1 + 0.2 * k as f64, 0.1, 1.0)).collect();
            [none(), FLOOR.to_string() + &boxes, none(), none()]
        }),
        _ => scene("a solver that may stop early", r, [1e-3, 4e-3], |r| {
            let method = r.one(&["CG", "PGS", "Newton"]);
            let boxes: String = (0..8).map(|k| box_at(0.1 + 0.2 * f64::from(k), 0.1, 1.0)).collect();
            let option = format!("solver='{method}' iterations='{}'", r.over(1.0, 60.0) as usize);
            [option, FLOOR.to_string() + &boxes, none(), none()]
        }),
    };
    (0..SCENES).map(|i| make(i, r)).collect()
}

/// The observations of a run.
#[derive(Default)]
struct Observations {
    warned: bool,
    reported: bool,
    /// The largest kinetic energy, J.
    fastest: f64,
    /// The ranges of the positions of body centres, m.
    ends: Vec<[f64; 2]>,
    /// How far a joint was outside its limits, relative to its range.
    beyond: f64,
    /// The penetration depth of bodies at the end, relative to a side or a diameter of 0.2 m.
    depth: f64,
}

/// Performs a run and observes it `STEPS` times; a watched run is monitored like the run of a lab.
fn run(m: &Model, each: usize, watched: bool) -> Observations {
    let mut d = Data::new(m);
    core::reset_data_keyframe(m, &mut d, m.keys().next().unwrap()).unwrap();
    core::forward(m, &mut d).unwrap();
    let mut scratch = Data::new(m);
    let mut watch = watched.then(|| watch::watch(m, &d, false));
    let mut seen = Observations {
        ends: vec![[f64::INFINITY, f64::NEG_INFINITY]; 3 * m.nbody],
        ..Observations::default()
    };
    for k in 0..=STEPS {
        for _ in 0..if k == 0 { 0 } else { each } {
            core::step(m, &mut d).unwrap();
            if let Some(w) = &mut watch {
                watch::observe(w, m, &d);
            }
        }
        seen.warned |= [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc]
            .iter()
            .any(|w| d.warning[*w as usize].number > 0);
        if seen.warned {
            break;
        }
        let edit = scratch.edit();
        edit.qpos.copy_from_slice(&d.qpos);
        edit.qvel.copy_from_slice(&d.qvel);
        let energy = core::mechanical_energy(m, &mut scratch).unwrap();
        seen.fastest = seen.fastest.max(energy.map_or(0.0, |e| e.kinetic));
        for (ends, x) in seen.ends.iter_mut().zip(&scratch.xipos) {
            *ends = [ends[0].min(*x), ends[1].max(*x)];
        }
        for j in (0..m.njnt).filter(|&j| m.jnt_limited[j]) {
            let ([low, high], q) = (rows::<2>(&m.jnt_range)[j], d.qpos[m.jnt_qposadr[j] as usize]);
            seen.beyond = seen.beyond.max((low - q).max(q - high) / (high - low));
        }
    }
    seen.depth = d.contact.iter().map(|c| -c.dist / 0.2).fold(0.0, f64::max);
    seen.reported = watch.is_some_and(|w| watch::observations(&w).time().is_finite());
    seen
}

/// The truth about a run, from a comparison with the same run with much shorter steps.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Truth {
    Well,
    Wrong,
    /// The error is moderate, so that reporting it or not is both acceptable; or the run with short steps fails as well.
    Between,
}

fn truth(m: &Model, coarse: &Observations, fine: &Observations) -> Truth {
    if fine.warned || !fine.fastest.is_finite() {
        return Truth::Between;
    }
    let mass: f64 = m.body_mass.iter().sum();
    let size = fine.ends.iter().map(|[a, b]| b - a).fold(0.1, f64::max);
    // Negligible motion: the kinetic energy of a fall by a hundredth of the scene, and that of this distance
    // per second without gravity.
    let weight = mass * labspec_core::math::norm(m.opt.gravity);
    let least = 0.01 * weight * size + 0.5 * mass * (0.01 * size).powi(2);
    let faster = (coarse.fastest + least) / (fine.fastest + least);
    let out = coarse
        .ends
        .iter()
        .zip(&fine.ends)
        .map(|(c, f)| (f[0] - c[0]).max(c[1] - f[1]) / size)
        .fold(0.0, f64::max);
    // A limit, a wall and a floor must hold independent of the short steps, because they are soft in that run as well.
    let [past, deep] = [coarse.beyond, coarse.depth.max(fine.depth)];
    let passed =
        m.geom_type[0] == geom::BOX && coarse.ends.iter().any(|[_, high]| *high > 1.0 + WALL_THICKNESS);
    if faster > 10.0 || out > 1.0 || past > 0.5 || deep > 0.3 || passed {
        Truth::Wrong
    } else if faster < 1.5 && out < 0.3 && past < 0.25 && deep < 0.2 {
        Truth::Well
    } else {
        Truth::Between
    }
}

/// The number of scenes of each kind.
#[derive(Clone, Copy, Default)]
pub(crate) struct Rates {
    pub(crate) scenes: usize,
    pub(crate) warned: usize,
    pub(crate) wrong: usize,
    pub(crate) reported: usize,
    pub(crate) well: usize,
    pub(crate) alarms: usize,
    pub(crate) between: usize,
}

/// The section of the page, the rates, and the missed faults and false alarms.
pub(crate) fn section() -> (String, Rates, Vec<String>) {
    let mut kinds: Vec<(&str, Rates)> = Vec::new();
    let mut list = Vec::new();
    let mut all = Rates::default();
    for scene in sample(scenes(SEED), SAMPLE_STEP) {
        let mut m = compile(&scene.xml);
        let coarse = run(&m, 1, true);
        let opt = m.edit().opt;
        (*opt.timestep, *opt.solver, *opt.iterations) = (scene.step / SHORTER as f64, solver::NEWTON, 100);
        // A method of second order without faults of its own: `implicit` alone makes free chains gain energy.
        if *opt.integrator != integrator::RK4 {
            *opt.integrator = integrator::EULER;
        }
        let fine = if coarse.warned { Observations::default() } else { run(&m, SHORTER, false) };
        let truth = truth(&m, &coarse, &fine);
        if kinds.iter().all(|(kind, _)| *kind != scene.kind) {
            kinds.push((scene.kind, Rates::default()));
        }
        let of = &mut kinds.iter_mut().find(|(kind, _)| *kind == scene.kind).unwrap().1;
        for r in [of, &mut all] {
            r.scenes += 1;
            match truth {
                _ if coarse.warned => r.warned += 1,
                Truth::Wrong => {
                    (r.wrong, r.reported) = (r.wrong + 1, r.reported + usize::from(coarse.reported))
                }
                Truth::Well => (r.well, r.alarms) = (r.well + 1, r.alarms + usize::from(coarse.reported)),
                Truth::Between => r.between += 1,
            }
        }
        if !coarse.warned && coarse.reported != (truth == Truth::Wrong) && truth != Truth::Between {
            list.push(format!(
                "{truth:?}, told: {}; energy {:.3e} beside {:.3e}, depth {:.2} beside {:.2}, beyond {:.2} beside {:.2}\n  {}",
                coarse.reported, coarse.fastest, fine.fastest, coarse.depth, fine.depth, coarse.beyond, fine.beyond, scene.xml
            ));
        }
    }
    let mut text = String::from(
        "\n## A random test set\n\n\
         The criteria were chosen on the scenes above. The scenes of this section are independent: `tests/fresh.rs` generates them from a seed, with \
         random timesteps, gains, stiffnesses, speeds and integrators. The reference is the same run with steps a hundred times shorter and a \
         converged solver. A run is *wrong* if it has ten times the kinetic energy of the reference, if it leaves the place where the reference \
         stays by the size of the scene, or if it is half a joint's range beyond a limit, behind the wall, or has bodies in each other by three \
         tenths of a side. A run is *well* if it is near the reference in all of these, with at most half as much kinetic energy again. All other \
         runs are counted as *between*.\n\n\
         | kind | scenes | with a warning | silently wrong | of these reported | well | false alarms | between |\n|---|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for (kind, r) in kinds.iter().map(|(k, r)| (*k, *r)).chain([("**all**", all)]) {
        let _ = writeln!(
            text,
            "| {kind} | {} | {} | {} | {} | {} | {} | {} |",
            r.scenes, r.warned, r.wrong, r.reported, r.well, r.alarms, r.between
        );
    }
    (text, all, list)
}
