/** Vectors of three numbers, rotation matrices (row-major, as MuJoCo's `xmat`), and 4×4 matrices (column-major, as WebGL's). */

export type Vec3 = readonly [number, number, number];
/** A rotation, row-major: its columns are the axes of the rotated frame. */
export type Mat3 = readonly [number, number, number, number, number, number, number, number, number];
export type Mat4 = Float32Array;

/** Element `i`; 0 beyond the end. */
export const at = (a: ArrayLike<number>, i: number): number => a[i] ?? 0;

/** Row `i` of an array with three columns. */
export const row3 = (a: ArrayLike<number>, i: number): Vec3 => [at(a, 3 * i), at(a, 3 * i + 1), at(a, 3 * i + 2)];

/** Matrix `i` of an array with nine columns. */
export function rotationAt(a: ArrayLike<number>, i: number): Mat3 {
  const o = 9 * i;
  return [at(a, o), at(a, o + 1), at(a, o + 2), at(a, o + 3), at(a, o + 4), at(a, o + 5), at(a, o + 6), at(a, o + 7), at(a, o + 8)];
}

export const IDENTITY: Mat3 = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
/** a + s b. */
export const addScaled = (a: Vec3, b: Vec3, s: number): Vec3 => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const mix = (a: Vec3, b: Vec3, t: number): Vec3 => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);

/** The unit vector along `a`; +z where `a` is zero. */
export function normalize(a: Vec3): Vec3 {
  const n = length(a);
  return n > 0 ? scale(a, 1 / n) : [0, 0, 1];
}

/** m v: from the rotated frame to the world. */
export const rotate = (m: Mat3, v: Vec3): Vec3 => [
  m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
  m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
  m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
];

/** mᵀ v: from the world to the rotated frame. */
export const unrotate = (m: Mat3, v: Vec3): Vec3 => [
  m[0] * v[0] + m[3] * v[1] + m[6] * v[2],
  m[1] * v[0] + m[4] * v[1] + m[7] * v[2],
  m[2] * v[0] + m[5] * v[1] + m[8] * v[2],
];

/** A rotation whose z axis is along `z`. */
export function rotationToZ(z: Vec3): Mat3 {
  const n = normalize(z);
  const x = normalize(cross(Math.abs(n[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], n));
  const y = cross(n, x);
  return [x[0], y[0], n[0], x[1], y[1], n[1], x[2], y[2], n[2]];
}

/** a b. */
export function multiply(a: Mat4, b: Mat4): Mat4 {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += at(a, 4 * k + row) * at(b, 4 * column + k);
      out[4 * column + row] = sum;
    }
  }
  return out;
}

/** From the world to a camera at `eye` with these axes; the camera looks along −z. */
export function viewMatrix(eye: Vec3, right: Vec3, up: Vec3, forward: Vec3): Mat4 {
  return Float32Array.of(
    right[0], up[0], -forward[0], 0, right[1], up[1], -forward[1], 0, right[2], up[2], -forward[2], 0,
    -dot(right, eye), -dot(up, eye), dot(forward, eye), 1,
  );
}

/** A perspective projection; `halfWidth` and `halfHeight` are those of the picture at distance 1. */
export function perspective(halfWidth: number, halfHeight: number, near: number, far: number): Mat4 {
  const d = 1 / (near - far);
  return Float32Array.of(1 / halfWidth, 0, 0, 0, 0, 1 / halfHeight, 0, 0, 0, 0, (far + near) * d, -1, 0, 0, 2 * far * near * d, 0);
}

/** An orthographic projection; `halfWidth` and `halfHeight` in m. */
export function orthographic(halfWidth: number, halfHeight: number, near: number, far: number): Mat4 {
  const d = 1 / (near - far);
  return Float32Array.of(1 / halfWidth, 0, 0, 0, 0, 1 / halfHeight, 0, 0, 0, 0, 2 * d, 0, 0, 0, (far + near) * d, 1);
}
