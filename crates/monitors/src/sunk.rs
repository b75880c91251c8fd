//! Sinking: detects bodies that penetrate each other by a large part of their size and stay there.
//!
//! A contact is soft: it yields while it stops an impact, and a little under a load. A scene looks wrong when one body
//! stays inside another by a large part of its own thickness. Either the load exceeds what the contact carries (a heavy
//! body on a light one, strong gravity, friction so large that the rows of a pyramidal cone have almost no normal
//! component), or the solver stopped before its forces were sufficient.

use labspec_core::{Contact, Data, Fields, Model, Scope, geom_thickness};

/// Thresholds of the depth: a fraction of the thickness of the thinner geom, and of the length of the smaller one.
const THICKNESS: f64 = 0.3;
const LENGTH: f64 = 0.03;
/// A contact must be this deep for `MIN_DURATION` seconds, `MIN_STEPS` steps and `MIN_TIME_CONSTANTS` time constants of
/// the contact, with a depth that changes by at most the fraction `MAX_DEPTH_CHANGE`. An impact is shorter, and a contact
/// that pushes the bodies apart changes its depth.
const MIN_DURATION: f64 = 0.25;
const MIN_STEPS: u32 = 32;
const MIN_TIME_CONSTANTS: f64 = 4.0;
const MAX_DEPTH_CHANGE: f64 = 0.1;
/// A body that is entirely below a plane for this many time constants will not return, even if its depth still changes.
const MAX_TIME_CONSTANTS_BELOW: f64 = 6.0;

/// Two bodies that penetrate each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunkContact {
    /// Time at which the penetration began, s.
    pub time: f64,
    /// The geoms.
    pub geoms: [usize; 2],
    /// Penetration depth, m.
    pub depth: f64,
    /// Thickness of the thinner geom, m.
    pub thickness: f64,
    /// Normal force, N.
    pub force: f64,
}

/// The sizes of the geoms, and the deepest contact with its duration.
#[derive(Clone, Debug)]
pub struct SinkMonitor {
    sizes: Vec<GeomSize>,
    /// Contacts less deep than this are skipped, m.
    least: f64,
    pair: [usize; 2],
    /// Depth at the time `since`.
    depth: f64,
    lasted: u32,
    since: f64,
    /// Time since which the body has been entirely below a plane; infinite when it is not.
    below: f64,
}

/// The size of a geom, m; both values are infinite for a geom without a size.
#[derive(Clone, Copy, Debug)]
pub(super) struct GeomSize {
    /// Its smallest extent.
    pub(super) thickness: f64,
    /// Its largest.
    pub(super) length: f64,
}

/// The size of a geom.
pub(super) fn size(m: &Model, g: usize) -> GeomSize {
    let thickness = geom_thickness(m, g);
    let length = if thickness.is_finite() { 2.0 * m.geom_rbound[g] } else { f64::INFINITY };
    GeomSize { thickness, length }
}

/// Starts monitoring the geoms of a model.
pub fn watch(m: &Model) -> SinkMonitor {
    let sizes: Vec<GeomSize> = (0..m.ngeom).map(|g| size(m, g)).collect();
    let least = |s: &GeomSize| (THICKNESS * s.thickness).max(0.0);
    let least = sizes.iter().map(least).fold(f64::INFINITY, f64::min);
    SinkMonitor { sizes, least, pair: [0; 2], depth: 0.0, lasted: 0, since: 0.0, below: f64::INFINITY }
}

/// Resets the monitor after the state was changed from outside.
pub fn restart(w: &mut SinkMonitor) {
    (w.lasted, w.below) = (0, f64::INFINITY);
}

/// Call after each step.
#[inline]
pub fn observe<S: Scope>(w: &mut SinkMonitor, m: &Model, d: &Data<S>) -> Option<SunkContact> {
    let f = d.fields();
    let deep = f.contact.iter().take(f.ncon).any(|c| c.dist < -w.least);
    if deep {
        return deepest(w, m, f);
    }
    (w.lasted, w.below) = (0, f64::INFINITY);
    None
}

/// Evaluates the contact that is deepest relative to its geoms. It is reported when the same two geoms have been in contact
/// long enough.
#[cold]
fn deepest(w: &mut SinkMonitor, m: &Model, f: &Fields) -> Option<SunkContact> {
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
    if w.lasted == 0 || w.pair != pair || (depth - w.depth).abs() > MAX_DEPTH_CHANGE * w.depth {
        (w.pair, w.depth, w.lasted, w.since) = (pair, depth, 0, f.time);
    }
    let [a, b] = sizes(c)?;
    let whole = (a.length.is_infinite() || b.length.is_infinite()) && depth > a.length.min(b.length);
    w.lasted += 1;
    w.below = if whole { w.below.min(f.time) } else { f64::INFINITY };
    let constant = time_constant(m, c);
    let stays = f.time - w.below >= MIN_DURATION.max(MAX_TIME_CONSTANTS_BELOW * constant);
    let lasts = w.lasted >= MIN_STEPS && f.time - w.since >= MIN_DURATION.max(MIN_TIME_CONSTANTS * constant);
    let force = normal_force(f, c, m.opt.cone == 0);
    (stays || lasts).then(|| SunkContact {
        time: w.since.min(w.below),
        geoms: pair,
        depth,
        thickness: a.thickness.min(b.thickness),
        force,
    })
}

/// Time constant with which a contact separates the geoms, s.
fn time_constant(m: &Model, c: &Contact) -> f64 {
    let [time, ratio] = c.solref;
    let constant = if time > 0.0 { time * ratio.max(1.0) } else { (-time).sqrt().recip() };
    constant.max(2.0 * m.opt.timestep)
}

/// The normal force of a contact, N: the sum of the edges for a pyramidal cone.
fn normal_force(f: &Fields, c: &Contact, pyramidal: bool) -> f64 {
    let Some(row) = c.efc_address else { return 0.0 };
    let rows = if pyramidal && c.dim > 1 { 2 * (c.dim - 1) } else { 1 };
    f.efc_force.get(row..row + rows).map_or(0.0, |list| list.iter().sum())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use labspec_core::{step, xml};

    fn run(option: &str, light: &str, rest: &str, steps: usize) -> Option<SunkContact> {
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
    fn a_box_pressed_into_the_floor_is_reported() {
        let found = run("", "mass=\".001\"", &on_top(1e4), 2000).unwrap();
        assert!(found.geoms == [0, 1] || found.geoms == [1, 2], "{found:?}");
        assert!(found.depth > 0.06 && (found.thickness - 0.2).abs() < 1e-12, "{found:?}");
        for mass in [1e-3, 1.0, 10.0, 100.0] {
            assert_eq!(run("", "mass=\"1\"", &on_top(mass), 2000), None, "{mass} kg");
        }
    }

    #[test]
    fn bodies_that_sink_through_the_floor_are_reported() {
        for (gravity, sinks) in [(10.0, false), (1e3, false), (1e5, true), (1e6, true)] {
            let option = format!("gravity=\"0 0 -{gravity}\"");
            let found = run(&option, "mass=\"1\"", "", 1000);
            assert_eq!(found.is_some(), sinks, "{gravity} m/s^2: {found:?}");
            if let Some(found) = found {
                let weight = found.force / gravity;
                assert!(found.geoms == [0, 1] && weight > 0.2, "{found:?}");
            }
        }
        // With so much friction, the rows of a pyramidal cone have no normal component left.
        let found = run("", "mass=\"1\" friction=\"1e9 .005 .0001\"", "", 1000).unwrap();
        assert!(found.force < 0.1, "{found:?}");
    }

    #[test]
    fn an_impact_is_not_reported() {
        let ball = |contact: &str| {
            format!("<body pos=\"1 0 2\"><freejoint/><geom size=\".1\" mass=\"1\" {contact}/></body>")
        };
        assert_eq!(run("gravity=\"0 0 -50\"", "mass=\"1\"", &ball(""), 1000), None);
        // Half inside the floor, and pushed out within half a second.
        assert_eq!(run("", "mass=\"1\"", &ball("solref=\".1 1\""), 2000), None);
    }
}
