//! Sinking: whether bodies are in each other by a large part of their size, and stay so.
//!
//! A contact is soft: it gives way while it stops what arrives, and by a little under a load. A scene looks wrong when one body
//! stays in another by a large part of its own thickness: the load is more than the contact carries (heavy on light, strong
//! gravity, friction so large that the rows of a pyramidal cone push next to nothing along the normal), or the solver
//! stopped before its forces held.

use labspec_core::{Contact, Data, Fields, Model, Scope, geom_thickness};

/// A contact deeper than this part of the thinner geom's thickness, and of the smaller one's length.
const THICKNESS: f64 = 0.3;
const LENGTH: f64 = 0.03;
/// For so long, s, so many steps and so many of the contact's own time constants it has to be as deep, to this part: what
/// arrives and comes back is no deeper for a moment, as is what the contact pushes out.
const LASTS: f64 = 0.25;
const STEPS: u32 = 32;
const CONSTANTS: f64 = 4.0;
const SAME: f64 = 0.1;
/// A body that is wholly below a plane for so many time constants is not on its way out, however deep it is.
const BELOW: f64 = 6.0;

/// Two bodies in each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sunk {
    /// Since when, s.
    pub time: f64,
    /// The geoms.
    pub geoms: [usize; 2],
    /// How deep, m.
    pub depth: f64,
    /// The thickness of the thinner one, m.
    pub thickness: f64,
    /// The force along the normal, N.
    pub force: f64,
}

/// What is known of the geoms, and what has lasted for how long.
#[derive(Clone, Debug)]
pub struct SinkMonitor {
    sizes: Vec<Size>,
    /// No contact less deep than this is worth a second look.
    least: f64,
    pair: [usize; 2],
    /// How deep it was when that began.
    depth: f64,
    lasted: u32,
    since: f64,
    /// Since when it has been wholly below a plane; infinite when it is not.
    below: f64,
}

/// Of a geom, m; both are infinite where it has none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    /// Its smallest extent.
    pub(super) thickness: f64,
    /// Its largest.
    pub(super) length: f64,
}

/// How large a geom is.
pub(super) fn size(m: &Model, g: usize) -> Size {
    let thickness = geom_thickness(m, g);
    let length = if thickness.is_finite() { 2.0 * m.geom_rbound[g] } else { f64::INFINITY };
    Size { thickness, length }
}

/// The geoms of a model.
pub fn watch(m: &Model) -> SinkMonitor {
    let sizes: Vec<Size> = (0..m.ngeom).map(|g| size(m, g)).collect();
    let least = |s: &Size| (THICKNESS * s.thickness).max(0.0);
    let least = sizes.iter().map(least).fold(f64::INFINITY, f64::min);
    SinkMonitor { sizes, least, pair: [0; 2], depth: 0.0, lasted: 0, since: 0.0, below: f64::INFINITY }
}

/// Forgets what was seen: something from outside has changed the state.
pub fn restart(w: &mut SinkMonitor) {
    (w.lasted, w.below) = (0, f64::INFINITY);
}

/// To be called after each step.
#[inline]
pub fn observe<S: Scope>(w: &mut SinkMonitor, m: &Model, d: &Data<S>) -> Option<Sunk> {
    let f = d.fields();
    let deep = f.contact.iter().take(f.ncon).any(|c| c.dist < -w.least);
    if deep {
        return deepest(w, m, f);
    }
    (w.lasted, w.below) = (0, f64::INFINITY);
    None
}

/// The contact that is the deepest for its geoms: it has to be of the same two for long enough.
#[cold]
fn deepest(w: &mut SinkMonitor, m: &Model, f: &Fields) -> Option<Sunk> {
    let sizes = |c: &Contact| Some([*w.sizes.get(c.geom1)?, *w.sizes.get(c.geom2)?]);
    let part = |c: &Contact| {
        let Some([a, b]) = sizes(c) else { return 0.0 };
        let limit = (THICKNESS * a.thickness.min(b.thickness)).max(LENGTH * a.length.min(b.length));
        if c.exclude == 0 { -c.dist / limit } else { 0.0 }
    };
    let c = f.contact.iter().take(f.ncon).max_by(|a, b| part(a).total_cmp(&part(b)))?;
    let pair = [c.geom1, c.geom2];
    if part(c) <= 1.0 {
        (w.lasted, w.below) = (0, f64::INFINITY);
        return None;
    }
    let depth = -c.dist;
    if w.lasted == 0 || w.pair != pair || (depth - w.depth).abs() > SAME * w.depth {
        (w.pair, w.depth, w.lasted, w.since) = (pair, depth, 0, f.time);
    }
    let [a, b] = sizes(c)?;
    let whole = (a.length.is_infinite() || b.length.is_infinite()) && depth > a.length.min(b.length);
    w.lasted += 1;
    w.below = if whole { w.below.min(f.time) } else { f64::INFINITY };
    let constant = time_constant(m, c);
    let stays = f.time - w.below >= LASTS.max(BELOW * constant);
    let lasts = w.lasted >= STEPS && f.time - w.since >= LASTS.max(CONSTANTS * constant);
    let force = normal_force(f, c, m.opt.cone == 0);
    (stays || lasts).then(|| Sunk {
        time: w.since.min(w.below),
        geoms: pair,
        depth,
        thickness: a.thickness.min(b.thickness),
        force,
    })
}

/// How long a contact takes to push out, s.
fn time_constant(m: &Model, c: &Contact) -> f64 {
    let [time, ratio] = c.solref;
    let constant = if time > 0.0 { time * ratio.max(1.0) } else { (-time).sqrt().recip() };
    constant.max(2.0 * m.opt.timestep)
}

/// The force of a contact along its normal, N: of a pyramidal cone the sum of its edges.
fn normal_force(f: &Fields, c: &Contact, pyramidal: bool) -> f64 {
    let Some(row) = c.efc_address else { return 0.0 };
    let rows = if pyramidal && c.dim > 1 { 2 * (c.dim - 1) } else { 1 };
    f.efc_force.get(row..row + rows).map_or(0.0, |list| list.iter().sum())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use labspec_core::{step, xml};

    fn run(option: &str, light: &str, rest: &str, steps: usize) -> Option<Sunk> {
        let text = format!(
            "<mujoco><option {option}/><worldbody><geom type=\"plane\" size=\"1 1 1\"/><body pos=\"0 0 .1\"><freejoint/>\
             <geom type=\"box\" size=\".1 .1 .1\" {light}/></body>{rest}</worldbody></mujoco>"
        );
        let m = xml::compile(&text).unwrap();
        let (mut d, mut w) = (Data::new(&m), watch(&m));
        (0..steps).find_map(|_| {
            step(&m, &mut d).unwrap();
            observe(&mut w, &m, &d)
        })
    }

    /// Another box on top.
    fn on_top(mass: f64) -> String {
        format!(
            "<body pos=\"0 0 .3\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\" mass=\"{mass}\"/></body>"
        )
    }

    #[test]
    fn a_box_that_is_pressed_into_the_floor_is_told() {
        let found = run("", "mass=\".001\"", &on_top(1e4), 2000).unwrap();
        assert!(found.geoms == [0, 1] || found.geoms == [1, 2], "{found:?}");
        assert!(found.depth > 0.06 && (found.thickness - 0.2).abs() < 1e-12, "{found:?}");
        for mass in [1e-3, 1.0, 10.0, 100.0] {
            assert_eq!(run("", "mass=\"1\"", &on_top(mass), 2000), None, "{mass} kg");
        }
    }

    #[test]
    fn what_the_floor_does_not_hold_is_told() {
        for (gravity, sinks) in [(10.0, false), (1e3, false), (1e5, true), (1e6, true)] {
            let option = format!("gravity=\"0 0 -{gravity}\"");
            let found = run(&option, "mass=\"1\"", "", 1000);
            assert_eq!(found.is_some(), sinks, "{gravity} m/s^2: {found:?}");
            if let Some(found) = found {
                let weight = found.force / gravity;
                assert!(found.geoms == [0, 1] && weight > 0.2, "{found:?}");
            }
        }
        // The rows of a pyramid with so much friction have nothing left along the normal.
        let found = run("", "mass=\"1\" friction=\"1e9 .005 .0001\"", "", 1000).unwrap();
        assert!(found.force < 0.1, "{found:?}");
    }

    #[test]
    fn an_impact_is_not_told() {
        let ball = |contact: &str| {
            format!("<body pos=\"1 0 2\"><freejoint/><geom size=\".1\" mass=\"1\" {contact}/></body>")
        };
        assert_eq!(run("gravity=\"0 0 -50\"", "mass=\"1\"", &ball(""), 1000), None);
        // Half in the floor, and pushed out within half a second.
        assert_eq!(run("", "mass=\"1\"", &ball("solref=\".1 1\""), 2000), None);
    }
}
