//! What follows from data but is no field: contacts with their forces, rays, Jacobians.

use crate::arguments::{Buffer, VersionedStruct, list, store, text, write_struct};
use crate::data::{DataHandle, with_data};
use crate::report::item;
use crate::status::{Failure, Status, call};
use labspec_core::{self as core, Contact, Jacobian, RayFilter};
use std::ffi::c_char;

/// A contact of the last collision detection.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ContactDescription {
    /// sizeof(labspec_contact), set by the caller.
    pub struct_size: usize,
    /// The geom with the smaller type.
    pub geom1: i32,
    /// The other geom.
    pub geom2: i32,
    /// Distance of the nearest points, m; negative is penetration.
    pub dist: f64,
    /// Midpoint between the two surfaces, m, world.
    pub pos: [f64; 3],
    /// Rows: the normal from geom 1 to geom 2 and two tangents, world.
    pub frame: [f64; 9],
    /// Friction: two sliding, spinning, two rolling.
    pub friction: [f64; 5],
    /// Force and torque in the frame of the contact, N and N m: the normal force first.
    pub force: [f64; 6],
    /// Dimension of the contact space: 1, 3, 4 or 6.
    pub dim: i32,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for ContactDescription {
    const FIRST_SIZE: usize = std::mem::offset_of!(ContactDescription, dim) + size_of::<i32>();
    const NAME: &'static str = "labspec_contact";
}

/// The number of contacts of the last collision detection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_contact_count(data: *const DataHandle, count: *mut usize) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| {
        with_data(data, |_, d| unsafe {
            store(count, d.fields().contact.len(), "the pointer to the number of contacts")
        })
    })
}

/// Describes a contact, from 0, with its force.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_contact(
    data: *const DataHandle,
    index: usize,
    contact: *mut ContactDescription,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| {
        with_data(data, |m, d| {
            let found: &Contact = item(&d.fields().contact, index, "contact")?;
            let force = core::contact_force(m, d, found)?;
            let described = ContactDescription {
                struct_size: size_of::<ContactDescription>(),
                geom1: found.geom1 as i32,
                geom2: found.geom2 as i32,
                dist: found.dist,
                pos: found.pos,
                frame: found.frame,
                friction: found.friction,
                force,
                dim: found.dim as i32,
            };
            unsafe { write_struct(contact, &described) }
        })
    })
}

/// Finds the nearest geom on a ray from a point along a direction (3 numbers each): its index, or -1 if the ray hits none; the distance
/// as a multiple of the length of the direction, or -1; and the unit normal of its surface (3 numbers). The ray does not hit geoms of
/// `exclude_body`, which may be -1, and those of the world only if `statics` is not 0. `distance` and `normal` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_ray(
    data: *const DataHandle,
    from: *const f64,
    along: *const f64,
    statics: i32,
    exclude_body: i32,
    geom: *mut i32,
    distance: *mut f64,
    normal: *mut f64,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let (from, along) = (list(from, 3, "the point")?, list(along, 3, "the direction")?);
        let (&[a, b, c], &[x, y, z]) = (from, along) else { return Ok(()) };
        let exclude_body = usize::try_from(exclude_body).ok();
        let filter = RayFilter { groups: None, statics: statics != 0, exclude_body };
        with_data(data, |m, d| {
            let hit = core::ray(m, d, [a, b, c], [x, y, z], &filter)?;
            store(geom, hit.as_ref().map_or(-1, |hit| hit.geom as i32), "the pointer to the geom")?;
            if !distance.is_null() {
                store(
                    distance,
                    hit.as_ref().map_or(-1.0, |hit| hit.distance),
                    "the pointer to the distance",
                )?;
            }
            match (normal.is_null(), hit) {
                (true, _) => Ok(()),
                (false, hit) => Buffer::new(normal, 3, std::ptr::null_mut())?
                    .write(&hit.map_or([0.0; 3], |hit| hit.normal)),
            }
        })
    })
}

/// Copies a Jacobian: the velocities of an object for each unit velocity of a degree of freedom. 6 rows of nv numbers: three of the
/// linear velocity, world, and three of the angular velocity. `of` is "body" (its origin), "bodyCom", "geom" or "site", or "point": the
/// point `point` (3 numbers, world), fixed to the body `index`. For the others, `point` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_jacobian(
    data: *const DataHandle,
    of: *const c_char,
    index: usize,
    point: *const f64,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let of = text(of, "the kind of the object")?;
        let buffer = Buffer::new(buffer, capacity, length)?;
        with_data(data, |m, d| {
            let Jacobian { mut jacp, jacr } = match of {
                "body" => core::jac_body(m, d, index)?,
                "bodyCom" => core::jac_body_com(m, d, index)?,
                "geom" => core::jac_geom(m, d, index)?,
                "site" => core::jac_site(m, d, index)?,
                "point" => core::jac(m, d, three(list(point, 3, "the point")?), index)?,
                _ => {
                    let message = format!(
                        "there is no Jacobian of `{of}`; use \"body\", \"bodyCom\", \"geom\", \"site\" or \"point\""
                    );
                    return Err(Failure::new(Status::LabspecErrorName, "unknown-kind", message));
                }
            };
            jacp.extend(jacr);
            buffer.write(&jacp)
        })
    })
}

/// The first three numbers of a list.
fn three(list: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| list.get(i).copied().unwrap_or(0.0))
}

/// Copies the mass matrix, nv rows of nv numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_data_mass_matrix(
    data: *const DataHandle,
    buffer: *mut f64,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        with_data(data, |m, d| Buffer::new(buffer, capacity, length)?.write(&core::full_m(m, d)?))
    })
}
