//! The correction of each pair as statements of the language.

use super::follow::servo;
use super::shape;
use super::statements::StatementWriter;
use labspec_core::geom;

/// A loop over the three elements of the inertia of a body.
fn over_moments(body: usize, statement: &str) -> String {
    format!("for (let i = {}; i < {}; i++) model.body_inertia[i] {statement}", 3 * body, 3 * body + 3)
}

pub(super) fn inertia_of_mass(s: &mut StatementWriter<'_>, bodies: &[usize]) -> Option<()> {
    s.repair.constants = true;
    if bodies.is_empty() {
        let masses = s.keep("m", "model.body_mass.slice()");
        s.add(format!(
            "for (let b = 1; b < model.nbody; b++) for (let i = 3 * b; i < 3 * b + 3; i++) if ({masses}[b] > 0) model.body_inertia[i] *= model.body_mass[b] / {masses}[b]"
        ));
    }
    for body in bodies {
        let mass = s.keep("m", &format!("model.body_mass[{body}]"));
        s.add(over_moments(*body, &format!("*= model.body_mass[{body}] / {mass}")));
    }
    Some(())
}

/// The geoms of elements of `geom_size` or `geom_pos`.
fn geoms(elements: &[usize]) -> Option<Vec<usize>> {
    let mut all: Vec<usize> = elements.iter().map(|i| i / 3).collect();
    all.dedup();
    (!all.is_empty()).then_some(all)
}

/// The three sizes of a geom as expressions of the language.
fn sizes(g: usize) -> [String; 3] {
    [0, 1, 2].map(|k| format!("model.geom_size[{}]", 3 * g + k))
}

pub(super) fn bound_of_size(s: &mut StatementWriter<'_>, written: &[usize]) -> Option<()> {
    for g in geoms(written)? {
        let [a, b, c] = sizes(g);
        let radius = match *s.model.geom_type.get(g)? {
            geom::SPHERE => a,
            geom::CAPSULE => format!("{a} + {b}"),
            geom::ELLIPSOID => format!("Math.max({a}, {b}, {c})"),
            geom::CYLINDER => format!("Math.hypot({a}, {b})"),
            geom::BOX => format!("Math.hypot({a}, {b}, {c})"),
            _ => return None,
        };
        s.add(format!("model.geom_rbound[{g}] = {radius}"));
    }
    Some(())
}

pub(super) fn inertia_of_size(s: &mut StatementWriter<'_>, written: &[usize]) -> Option<()> {
    s.repair.constants = true;
    for g in geoms(written)? {
        let body = shape::body_of_geom_mass(s.model, g)?;
        let [a, b, c] = sizes(g);
        let square = |x: &str| format!("{x} * {x}");
        let mass = format!("model.body_mass[{body}]");
        let moments = match *s.model.geom_type.get(g)? {
            geom::SPHERE => {
                s.add(over_moments(body, &format!("= 0.4 * {mass} * {}", square(&a))));
                continue;
            }
            geom::CYLINDER => {
                let across = format!("{mass} * (3 * {} + 4 * {}) / 12", square(&a), square(&b));
                [across.clone(), across, format!("{mass} * {} / 2", square(&a))]
            }
            kind @ (geom::BOX | geom::ELLIPSOID) => {
                let part = if kind == geom::BOX { 3 } else { 5 };
                [[&b, &c], [&a, &c], [&a, &b]]
                    .map(|[x, y]| format!("{mass} * ({} + {}) / {part}", square(x), square(y)))
            }
            _ => return None,
        };
        let turned = shape::to_axes(s.model, g, body)?;
        for (axis, row) in turned.chunks(3).enumerate() {
            let column = row.iter().position(|x| x.abs() > 0.999)?;
            s.add(format!("model.body_inertia[{}] = {}", 3 * body + axis, moments.get(column)?));
        }
    }
    Some(())
}

pub(super) fn centre_of_place(s: &mut StatementWriter<'_>, written: &[usize]) -> Option<()> {
    s.repair.constants = true;
    if written.is_empty() {
        return None;
    }
    for place in written {
        let body = shape::body_of_geom_mass(s.model, place / 3)?;
        let position = s.keep("p", &format!("model.geom_pos[{place}]"));
        s.add(format!("model.body_ipos[{}] += model.geom_pos[{place}] - {position}", 3 * body + place % 3));
    }
    Some(())
}

pub(super) fn bias_of_gain(s: &mut StatementWriter<'_>, written: &[usize]) -> Option<()> {
    let gains = written.iter().filter(|i| *i % 10 == 0);
    for gain in gains {
        let bias = servo(s.model, gain / 10)?;
        s.add(format!("model.actuator_biasprm[{bias}] = -model.actuator_gainprm[{gain}]"));
    }
    (!s.repair.after.is_empty()).then_some(())
}

pub(super) fn gain_of_bias(s: &mut StatementWriter<'_>, written: &[usize]) -> Option<()> {
    for bias in written {
        let gain = bias / 10 * 10;
        if servo(s.model, gain / 10) == Some(*bias) {
            s.add(format!("model.actuator_gainprm[{gain}] = -model.actuator_biasprm[{bias}]"));
        }
    }
    (!s.repair.after.is_empty()).then_some(())
}
