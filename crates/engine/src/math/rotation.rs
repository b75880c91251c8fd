//! Unit quaternions, `w x y z`: products, rotations, matrices, and the integration of angular velocities.

use super::{EYE, IDENTITY, MINVAL, Mat3, Quat, Vec3, cross, dot, normalize, scale};

/// The unit quaternion in the direction of q. A zero quaternion becomes the identity. A quaternion whose norm differs
/// from 1 only by rounding is returned unchanged, bit for bit.
pub fn quat_normalize(q: Quat) -> Quat {
    let square = dot(q, q);
    // The square of a norm differs from 1 by twice as much as the norm.
    if (square - 1.0).abs() > 2.0 * MINVAL {
        let n = square.sqrt();
        if n < MINVAL { IDENTITY } else { scale(q, 1.0 / n) }
    } else {
        q
    }
}

/// Hamilton product.
pub fn quat_mul(a: Quat, b: Quat) -> Quat {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// The inverse rotation.
pub fn quat_conj(q: Quat) -> Quat {
    [q[0], -q[1], -q[2], -q[3]]
}

/// Rotation by `angle` (rad) about the unit vector `axis`.
pub fn quat_axis_angle(axis: Vec3, angle: f64) -> Quat {
    if angle == 0.0 {
        return IDENTITY;
    }
    let (s, c) = libm::sincos(0.5 * angle);
    [c, axis[0] * s, axis[1] * s, axis[2] * s]
}

/// v rotated by q: v + 2 w (u × v) + 2 u × (u × v).
pub fn rotate(v: Vec3, q: Quat) -> Vec3 {
    if q == IDENTITY {
        return v;
    }
    let u = [q[1], q[2], q[3]];
    let t = cross(u, v);
    let w = q[0];
    let t = [w * v[0] + t[0], w * v[1] + t[1], w * v[2] + t[2]];
    let c = cross(u, t);
    [v[0] + 2.0 * c[0], v[1] + 2.0 * c[1], v[2] + 2.0 * c[2]]
}

/// The rotation matrix of a unit quaternion.
pub fn quat_to_mat(q: Quat) -> Mat3 {
    if q == IDENTITY {
        return EYE;
    }
    let [w, x, y, z] = q;
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    let (wx, wy, wz, xy, xz, yz) = (w * x, w * y, w * z, x * y, x * z, y * z);
    [
        ww + xx - yy - zz,
        2.0 * (xy - wz),
        2.0 * (xz + wy),
        2.0 * (xy + wz),
        ww - xx + yy - zz,
        2.0 * (yz - wx),
        2.0 * (xz - wy),
        2.0 * (yz + wx),
        ww - xx - yy + zz,
    ]
}

/// The rotation vector (axis times angle, rad, angle in (-π, π]) of a unit quaternion.
pub fn quat_to_vel(q: Quat) -> Vec3 {
    let (axis, s) = normalize([q[1], q[2], q[3]]);
    let mut angle = 2.0 * libm::atan2(s, q[0]);
    if angle > std::f64::consts::PI {
        angle -= 2.0 * std::f64::consts::PI;
    }
    scale(axis, angle)
}

/// q rotated for a time h (s) by the angular velocity w (rad/s), given in the rotating frame.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn quat_integrate(q: Quat, w: Vec3, h: f64) -> Quat {
    if w == [0.0; 3] {
        return quat_normalize(q);
    }
    let (axis, speed) = normalize(w);
    let angle = h * speed;
    if angle == 0.0 { quat_normalize(q) } else { quat_mul(quat_normalize(q), quat_axis_angle(axis, angle)) }
}
