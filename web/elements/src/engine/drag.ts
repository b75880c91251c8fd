/** The spring that drags a body: critically damped, and proportional to the mass of the body with its descendants. */
import type { Lab } from "labspec/slim";
import type { Drag } from "./messages.js";

/** Natural frequency of the spring, rad/s: slow enough to hold a force over one frame of a page. */
const FREQUENCY = 9;

type Vector = [number, number, number];

const at = (list: ArrayLike<number>, i: number): number => list[i] ?? 0;
const three = (list: ArrayLike<number>, from: number): Vector => [at(list, from), at(list, from + 1), at(list, from + 2)];
const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const plus = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const times = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
const cross = (a: Vector, b: Vector): Vector => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The force and the torque at the centre of mass of the dragged body, in world axes. */
export function springForce(lab: Lab, drag: Drag): number[] {
  const { body, local, target } = drag;
  const { data, model } = lab;
  const grabbed = plus(three(data.xpos, 3 * body), rotated(data.xmat, body, [...local]));
  // `cvel` is the velocity (rotation, then translation) at the centre of mass of the whole tree.
  const root = at(model.body_rootid, body);
  const spin = three(data.cvel, 6 * body);
  const velocity = plus(three(data.cvel, 6 * body + 3), cross(spin, minus(grabbed, three(data.subtree_com, 3 * root))));
  const mass = at(model.body_subtreemass, body);
  const pull = minus(times(minus([...target], grabbed), FREQUENCY * FREQUENCY), times(velocity, 2 * FREQUENCY));
  const force = times(pull, mass);
  return [...force, ...cross(minus(grabbed, three(data.xipos, 3 * body)), force)];
}

/** A vector of a body's frame in world axes. */
function rotated(xmat: ArrayLike<number>, body: number, v: Vector): Vector {
  const row = (i: number): number => {
    const axis = three(xmat, 9 * body + 3 * i);
    return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
  };
  return [row(0), row(1), row(2)];
}
