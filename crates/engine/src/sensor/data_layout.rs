//! Data fields of contact sensors and rangefinders. A bit mask selects the fields of a sensor; they are in this
//! order.

/// A data field: its keyword in MJCF and its number of values.
type Field = (&'static str, usize);

/// Data fields of a contact sensor (mjtConDataField).
pub const CONTACT_DATA: [Field; 7] =
    [("found", 1), ("force", 3), ("torque", 3), ("dist", 1), ("pos", 3), ("normal", 3), ("tangent", 3)];

/// Data fields of a rangefinder (mjtRayDataField).
pub const RAY_DATA: [Field; 6] =
    [("dist", 1), ("dir", 3), ("origin", 3), ("point", 3), ("normal", 3), ("depth", 1)];

/// The number of values of the fields in a mask.
pub fn size(fields: &[Field], mask: i32) -> usize {
    fields.iter().enumerate().filter(|(i, _)| mask & (1 << i) != 0).map(|(_, (_, n))| n).sum()
}

/// Writes the fields of a mask one after the other. `values` contains the values of all fields, in order.
pub(super) fn write(mask: i32, values: &[&[f64]], out: &mut [f64]) {
    let mut offset = 0;
    for (_, value) in values.iter().enumerate().filter(|(i, _)| mask & (1 << i) != 0) {
        if let Some(to) = out.get_mut(offset..offset + value.len()) {
            to.copy_from_slice(value);
        }
        offset += value.len();
    }
}
