/** Vectors of three numbers, rotation matrices (row-major, as MuJoCo's `xmat`), and 4×4 matrices (column-major, as WebGL's). */
export type Vec3 = readonly [number, number, number];
/** A rotation, row-major: its columns are the axes of the rotated frame. */
export type Mat3 = readonly [number, number, number, number, number, number, number, number, number];
export type Mat4 = Float32Array;
/** Element `i`; 0 beyond the end. */
export declare const at: (a: ArrayLike<number>, i: number) => number;
/** Row `i` of an array with three columns. */
export declare const row3: (a: ArrayLike<number>, i: number) => Vec3;
/** Matrix `i` of an array with nine columns. */
export declare function rotationAt(a: ArrayLike<number>, i: number): Mat3;
export declare const IDENTITY: Mat3;
export declare const add: (a: Vec3, b: Vec3) => Vec3;
export declare const sub: (a: Vec3, b: Vec3) => Vec3;
export declare const scale: (a: Vec3, s: number) => Vec3;
/** a + s b. */
export declare const addScaled: (a: Vec3, b: Vec3, s: number) => Vec3;
export declare const mix: (a: Vec3, b: Vec3, t: number) => Vec3;
export declare const dot: (a: Vec3, b: Vec3) => number;
export declare const cross: (a: Vec3, b: Vec3) => Vec3;
export declare const length: (a: Vec3) => number;
/** The unit vector along `a`; +z where `a` is zero. */
export declare function normalize(a: Vec3): Vec3;
/** m v: from the rotated frame to the world. */
export declare const rotate: (m: Mat3, v: Vec3) => Vec3;
/** mᵀ v: from the world to the rotated frame. */
export declare const unrotate: (m: Mat3, v: Vec3) => Vec3;
/** A rotation whose z axis is along `z`. */
export declare function rotationToZ(z: Vec3): Mat3;
/** a b. */
export declare function multiply(a: Mat4, b: Mat4): Mat4;
/** From the world to a camera at `eye` with these axes; the camera looks along −z. */
export declare function viewMatrix(eye: Vec3, right: Vec3, up: Vec3, forward: Vec3): Mat4;
/** A perspective projection; `halfWidth` and `halfHeight` are those of the picture at distance 1. */
export declare function perspective(halfWidth: number, halfHeight: number, near: number, far: number): Mat4;
/** An orthographic projection; `halfWidth` and `halfHeight` in m. */
export declare function orthographic(halfWidth: number, halfHeight: number, near: number, far: number): Mat4;
