/** A contact of two geoms. */
export interface ContactInfo {
  readonly geom1: number;
  readonly geom2: number;
  /** Distance of the nearest points, m; negative is penetration. */
  readonly dist: number;
  /** Midpoint, m, world. */
  readonly pos: Float64Array;
  /** Rows: the normal from geom 1 to geom 2 and two tangents, world. */
  readonly frame: Float64Array;
  /** Dimension of the contact space: 1, 3, 4 or 6. */
  readonly dim: number;
  readonly friction: Float64Array;
  /** Force (N) and torque (N m) in the frame of the contact: normal, two tangents, three torques. */
  readonly force: Float64Array;
  readonly includemargin: number;
  readonly solref: Float64Array;
  readonly solreffriction: Float64Array;
  readonly solimp: Float64Array;
  readonly mu: number;
  /** 0 the contact acts; otherwise why it does not. */
  readonly exclude: number;
  /** First row in the constraint arrays, -1 when there is none. */
  readonly efc_address: number;
}

/** Numbers of a contact in the module's list. */
const SIZE = 40;

export function contactsOf(list: Float64Array): ContactInfo[] {
  const out: ContactInfo[] = [];
  for (let at = 0; at + SIZE <= list.length; at += SIZE) {
    const n = (i: number): number => list[at + i] ?? NaN;
    const part = (from: number, to: number): Float64Array => list.slice(at + from, at + to);
    out.push({
      geom1: n(0), geom2: n(1), dist: n(2), pos: part(3, 6), frame: part(6, 15), dim: n(15), friction: part(16, 21),
      force: part(21, 27), includemargin: n(27), solref: part(28, 30), solreffriction: part(30, 32), solimp: part(32, 37),
      mu: n(37), exclude: n(38), efc_address: n(39),
    });
  }
  return out;
}
