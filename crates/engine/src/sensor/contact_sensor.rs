//! Contact sensors: touch, and contacts that are filtered and reduced.

use super::SensorScratch;
use super::data_layout;
use super::data_layout::CONTACT_DATA;
use super::put;
use crate::constraint::contact_force;
use crate::geometry::{Shape, ray_shape};
use crate::math::sort::sort_by;
use crate::math::*;
use crate::model::index::object_index;
use crate::model::{Contact, Fields, Model, Obj};
use crate::query::inside_site;

/// The sum of the normal forces on the body of a site. It includes each contact whose normal, as a ray from the
/// contact point into the other body, hits the volume of the site: the volume contains the contact point or is behind
/// it.
pub(super) fn touch(m: &Model, d: &mut Fields, s: usize, out: &mut [f64]) {
    let site = object_index(m.sensor_objid[s]);
    let body = m.site_bodyid[site];
    d.meter.add(10 * d.contact.len() as u64);
    let zone = Shape::site(m, d, site);
    let (mut sum, mut work) = (0.0, 0);
    for c in d.contact.iter().filter(|c| c.efc_address.is_some()) {
        let sides = [m.geom_bodyid[c.geom1], m.geom_bodyid[c.geom2]];
        if !sides.contains(&body) {
            continue;
        }
        let push = contact_force(m, d, c)[0];
        let sign = if sides[1] == body { -1.0 } else { 1.0 };
        if push > 0.0 && ray_shape(&zone, c.pos, scale(normal(c), sign), &mut work).is_some() {
            sum += push;
        }
    }
    d.meter.add(work);
    put(out, [sum]);
}

fn normal(c: &Contact) -> Vec3 {
    [c.frame[0], c.frame[1], c.frame[2]]
}

/// How several contacts are reduced to few: the second parameter of a contact sensor.
mod reduce {
    /// Selects the contacts with the smallest distances.
    pub(super) const MINDIST: i32 = 1;
    /// Selects the contacts with the largest forces.
    pub(super) const MAXFORCE: i32 = 2;
    /// Replaces all contacts by their net force.
    pub(super) const NETFORCE: i32 = 3;
}

/// A contact that passes the filter of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContactMatch {
    contact: usize,
    /// Whether the contact is reported from the side of geom 2.
    flip: bool,
    /// Sort key, smallest first.
    key: f64,
}

/// Writes the contacts that pass the filter, one slot of data fields each, up to the number of slots. Unused slots
/// are zero.
pub(super) fn contacts(m: &Model, d: &mut Fields, w: &mut SensorScratch, s: usize, out: &mut [f64]) {
    out.fill(0.0);
    d.meter.add(20 * d.contact.len() as u64);
    let [mask, reduction] = [m.sensor_intprm[3 * s], m.sensor_intprm[3 * s + 1]];
    let list = &mut w.matches;
    list.clear();
    for (i, c) in d.contact.iter().enumerate() {
        let Some(flip) = admitted(m, d, s, c) else { continue };
        let key = match reduction {
            reduce::MINDIST => c.dist,
            reduce::MAXFORCE => {
                let f = contact_force(m, d, c);
                -dot([f[0], f[1], f[2]], [f[0], f[1], f[2]])
            }
            _ => 0.0,
        };
        list.push(ContactMatch { contact: i, flip, key });
    }
    if reduction == reduce::NETFORCE {
        net(m, d, list, mask, out);
    } else {
        sort_by(list, |a, b| a.key.total_cmp(&b.key).then(a.contact.cmp(&b.contact)));
        let size = data_layout::size(&CONTACT_DATA, mask).max(1);
        for (found, out) in list.iter().zip(out.chunks_exact_mut(size)) {
            single(m, d, found, list.len(), mask, out);
        }
    }
}

/// Whether a contact passes the filter. If it does, returns whether it is reported from the side of geom 2: the first
/// object must be on the side where the normal starts.
fn admitted(m: &Model, d: &Fields, s: usize, c: &Contact) -> Option<bool> {
    let first = (m.sensor_objtype[s], m.sensor_objid[s]);
    let second = (m.sensor_reftype[s], m.sensor_refid[s]);
    if let (kind, Ok(site)) = (first.0, usize::try_from(first.1))
        && kind == Obj::Site as i32
        && !inside_site(m, d, site, c.pos)
    {
        return None;
    }
    let is_selected = |object, geom| is_selected(m, object, geom);
    let (first1, first2) = (is_selected(first, c.geom1), is_selected(first, c.geom2));
    let (second1, second2) = (is_selected(second, c.geom1), is_selected(second, c.geom2));
    if !(first1 || first2) || !(second1 || second2) {
        return None;
    }
    match (first.0 != 0, second.0 != 0) {
        (true, true) if first1 && second2 => Some(false),
        (true, true) => (first2 && second1).then_some(true),
        (true, false) => Some(!first1),
        (false, true) => Some(!second2),
        (false, false) => Some(false),
    }
}

/// Whether a geom of a contact is an object of the filter or belongs to one. An unspecified object and a site admit
/// every geom.
fn is_selected(m: &Model, (kind, id): (i32, i32), geom: usize) -> bool {
    let body = m.geom_bodyid[geom];
    match kind {
        k if k == Obj::Geom as i32 => id == geom as i32,
        k if k == Obj::Body as i32 => id == body,
        k if k == Obj::XBody as i32 => {
            // Parents have smaller indexes than their children; the world has no parent.
            let mut up = body;
            while up > id.max(0) {
                up = m.body_parentid[up as usize];
            }
            up == id
        }
        _ => true,
    }
}

/// Writes the fields of one contact. Reported from the other side, its frame is rotated by 180° about the second
/// tangent.
fn single(m: &Model, d: &Fields, found: &ContactMatch, count: usize, mask: i32, out: &mut [f64]) {
    let c = &d.contact[found.contact];
    let f = contact_force(m, d, c);
    let sign = if found.flip { -1.0 } else { 1.0 };
    let force = [f[0], f[1], sign * f[2]];
    let torque = [f[3], f[4], sign * f[5]];
    let normal = scale(normal(c), sign);
    let tangent = scale([c.frame[3], c.frame[4], c.frame[5]], sign);
    data_layout::write(mask, &[&[count as f64], &force, &torque, &[c.dist], &c.pos, &normal, &tangent], out);
}

/// Writes the net force and torque, world frame, at the mean of the contact points weighted by force.
fn net(m: &Model, d: &Fields, list: &[ContactMatch], mask: i32, out: &mut [f64]) {
    let wrench = |found: &ContactMatch| {
        let c = &d.contact[found.contact];
        let f = scale(contact_force(m, d, c), if found.flip { -1.0 } else { 1.0 });
        let [force, torque] = [[f[0], f[1], f[2]], [f[3], f[4], f[5]]].map(|v| mat_t_mul_vec(&c.frame, v));
        (c.pos, force, torque)
    };
    let (mut point, mut weight) = ([0.0; 3], 0.0);
    for (pos, force, _) in list.iter().map(wrench) {
        point = add_scaled(point, pos, norm(force));
        weight += norm(force);
    }
    point = if weight > 0.0 { scale(point, 1.0 / weight) } else { [0.0; 3] };
    let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
    for (pos, f, t) in list.iter().map(wrench) {
        force = add(force, f);
        torque = add(torque, add(t, cross(sub(pos, point), f)));
    }
    let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    data_layout::write(mask, &[&[list.len() as f64], &force, &torque, &[0.0], &point, &x, &y], out);
}
