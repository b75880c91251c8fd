//! The functions of `lib`: shortcuts for what lessons need most often.

use super::access::EngineAccess;
use super::{AccessedPart, Arg, Function, ROW, Unit, index, number};
use labspec_core::reflect::data;
use labspec_core::{self as core, Obj};
use labspec_expr::{Heap, Type, Value};
use labspec_finding::order;

const LIST: Function = Function { object: "lib", returns: Type::List, ..ROW };

/// The members of the result of `energy`, in J.
pub(super) const ENERGIES: &[(&str, Type)] =
    &[("potential", Type::Number), ("kinetic", Type::Number), ("total", Type::Number)];

pub(super) const ROWS: &[Function] = &[
    Function {
        object: "lib",
        name: "bodyId",
        args: &[Arg::Name(Obj::Body)],
        unit: Unit::Of("1"),
        doc: "index of a body",
        example: ("lib.bodyId('bob')", "1"),
        run: |_, _, args| index(args).map(|i| Value::Number(i as f64)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "jointId",
        args: &[Arg::Name(Obj::Joint)],
        unit: Unit::Of("1"),
        doc: "index of a joint",
        example: ("lib.jointId('swing')", "0"),
        run: |_, _, args| index(args).map(|i| Value::Number(i as f64)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "qpos",
        args: &[Arg::Name(Obj::Joint)],
        reads: AccessedPart::State,
        doc: "first coordinate of a joint",
        example: ("data.qpos[0] = 0.1; lib.qpos('swing')", "0.1"),
        run: |w, _, args| {
            let x = w.qpos_of(index(args)?);
            Ok(x.map_or(Value::Undefined, Value::Number))
        },
        ..ROW
    },
    Function {
        object: "lib",
        name: "normalForce",
        args: &[Arg::Name(Obj::Geom)],
        optional: 1,
        reads: AccessedPart::Contacts,
        unit: Unit::Of("N"),
        doc: "normal force in N, summed over all contacts or over those of one geom",
        example: ("lib.normalForce()", "0"),
        run: |w, _, args| {
            let geom = if args.is_empty() { None } else { Some(index(args)?) };
            let touching = |c: &&core::Contact| geom.is_none_or(|g| c.geom1 == g || c.geom2 == g);
            // JavaScript's reduce starts from 0, not from -0.
            let mut sum = 0.0;
            for c in w.contacts().iter().filter(touching) {
                sum += w.contact_force(c)?[0];
            }
            Ok(Value::Number(sum))
        },
        ..ROW
    },
    Function {
        object: "lib",
        name: "deg",
        args: &[Arg::Angle],
        unit: Unit::Argument(180.0 / std::f64::consts::PI),
        doc: "radians to degrees",
        example: ("lib.deg(Math.PI)", "180"),
        run: |_, _, args| number(args).map(|x| Value::Number(x * 180.0 / std::f64::consts::PI)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "rad",
        args: &[Arg::Number],
        unit: Unit::Argument(std::f64::consts::PI / 180.0),
        doc: "degrees to radians",
        example: ("lib.rad(180)", "3.141592653589793"),
        run: |_, _, args| number(args).map(|x| Value::Number(x * std::f64::consts::PI / 180.0)),
        ..ROW
    },
    Function {
        name: "sitePos",
        args: &[Arg::Name(Obj::Site)],
        length: Some(3),
        gives: Some((data::site_xpos, Obj::Site)),
        reads: AccessedPart::Places,
        unit: Unit::Of("m"),
        doc: "world position of a site, m",
        example: ("lib.sitePos('tip')[2]", "0.5"),
        run: |w, heap, args| place(heap, &w.fields().site_xpos, index(args)?),
        ..LIST
    },
    Function {
        name: "bodyPos",
        args: &[Arg::Name(Obj::Body)],
        length: Some(3),
        gives: Some((data::xpos, Obj::Body)),
        reads: AccessedPart::Places,
        unit: Unit::Of("m"),
        doc: "world position of a body, m",
        example: ("lib.bodyPos('bob')[2]", "1"),
        run: |w, heap, args| place(heap, &w.fields().xpos, index(args)?),
        ..LIST
    },
    Function {
        object: "lib",
        name: "energy",
        returns: Type::Record,
        members: ENERGIES,
        reads: AccessedPart::Energy,
        writes: &[AccessedPart::Flags, AccessedPart::Derived],
        unit: Unit::Of("J"),
        doc: "potential, kinetic and total energy, J; the first use turns the energy computation on",
        example: ("lib.energy().total", "4.905"),
        run: |w, heap, _| energy(w, heap),
        ..ROW
    },
    Function {
        name: "contactPairs",
        reads: AccessedPart::Contacts,
        doc: "pairs of geoms in contact, each as text; a geom without a name is shown by its body",
        example: ("lib.contactPairs().length", "0"),
        run: |w, heap, _| {
            let pairs = w
                .contacts()
                .iter()
                .map(|c| Value::String(format!("{} / {}", label(w, c.geom1), label(w, c.geom2)).into()));
            let pairs = pairs.collect();
            heap.list(pairs).map_err(|_| full())
        },
        ..LIST
    },
    Function {
        name: "jacobian",
        args: &[Arg::Name(Obj::Site), Arg::Number],
        optional: 1,
        length: Some(6),
        reads: AccessedPart::Motion,
        doc: "Jacobian of a site: three rows of linear and three of angular velocity per degree of freedom; the second argument keeps only the first columns",
        example: ("lib.jacobian('tip')[0][0]", "-0.5"),
        run: |w, heap, args| {
            let rows = jacobian(w, index(args)?, args.get(1).map(Value::to_number))?;
            matrix(heap, &rows)
        },
        ..LIST
    },
    Function {
        name: "jacobianSV",
        args: &[Arg::Name(Obj::Site), Arg::Any],
        optional: 1,
        reads: AccessedPart::Motion,
        doc: "singular values of the Jacobian of a site, largest first; the second argument is {cols, rows: \"full\" or \"pos\"}",
        example: ("lib.jacobianSV('tip', {rows: 'pos'})[0]", "0.5"),
        run: |w, heap, args| {
            let option = |key| args.get(1).and_then(|o| heap.get(o, key)).filter(|v| !v.is_nothing());
            let only = option("rows").is_some_and(|v| v.to_string() == "pos");
            let mut rows = jacobian(w, index(args)?, option("cols").map(|v| v.to_number()))?;
            if only {
                rows.truncate(3);
            }
            heap.numbers(&singular_values(&rows)).map_err(|_| full())
        },
        ..LIST
    },
    Function {
        name: "massMatrix",
        reads: AccessedPart::Mass,
        writes: &[AccessedPart::Derived],
        doc: "the mass matrix, nv rows of nv numbers; computes all derived fields first",
        example: ("lib.massMatrix()[0][0].toFixed(5)", "0.25036"),
        run: |w, heap, _| {
            w.forward()?;
            let m = w.full_m()?;
            let rows: Vec<Vec<f64>> = m.chunks(w.nv().max(1)).map(<[f64]>::to_vec).collect();
            matrix(heap, &rows)
        },
        ..LIST
    },
    Function {
        object: "lib",
        name: "norm",
        args: &[Arg::Numbers],
        unit: Unit::Argument(1.0),
        doc: "length of a vector: the root of the sum of its squares",
        example: ("lib.norm([3, 4])", "5"),
        run: |_, heap, args| {
            let numbers = args.first().and_then(|v| heap.to_numbers(v)).unwrap_or_default();
            Ok(Value::Number(labspec_expr::hypot(&numbers)))
        },
        ..ROW
    },
];

fn full() -> String {
    "the lists of this lab take too much memory".into()
}

fn place(heap: &mut Heap, places: &[f64], index: usize) -> Result<Value, String> {
    let place = places.get(3 * index..3 * index + 3).unwrap_or(&[]);
    heap.numbers(place).map_err(|_| full())
}

/// The potential, kinetic and total energy.
pub(super) fn energy(w: &mut EngineAccess<'_>, heap: &mut Heap) -> Result<Value, String> {
    let [potential, kinetic] = w.energy()?;
    let numbers = [potential, kinetic, potential + kinetic];
    let entries = ENERGIES.iter().zip(numbers).map(|((name, _), x)| ((*name).into(), Value::Number(x)));
    heap.record(entries.collect()).map_err(|_| full())
}

/// The name of a geom, or of its body if the geom has none.
fn label<'w>(w: &'w EngineAccess<'_>, geom: usize) -> &'w str {
    let names = w.names();
    let geom_name = names.geom.get(geom).map_or("", String::as_str);
    let body = w.body_of(geom).unwrap_or(0);
    if geom_name.is_empty() { names.body.get(body).map_or("", String::as_str) } else { geom_name }
}

/// The six rows of the Jacobian of a site, or their first `columns` columns.
fn jacobian(w: &EngineAccess<'_>, site: usize, columns: Option<f64>) -> Result<Vec<Vec<f64>>, String> {
    let nv = w.nv();
    let width = columns.map_or(nv, |c| c.clamp(0.0, nv as f64) as usize);
    let j = w.jac_site(site)?;
    let row = |all: &[f64], i: usize| all.get(i * nv..i * nv + width).unwrap_or(&[]).to_vec();
    Ok((0..3).map(|i| row(&j.jacp, i)).chain((0..3).map(|i| row(&j.jacr, i))).collect())
}

fn matrix(heap: &mut Heap, rows: &[Vec<f64>]) -> Result<Value, String> {
    let rows: Result<Vec<Value>, _> = rows.iter().map(|row| heap.numbers(row)).collect();
    rows.and_then(|rows| heap.list(rows)).map_err(|_| full())
}

/// The square roots of the eigenvalues of J Jᵀ, largest first, by cyclic rotations (Jacobi 1846; Golub and Van Loan, "Matrix
/// Computations", section 8.5).
fn singular_values(j: &[Vec<f64>]) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |sum, (x, y)| sum + x * y);
    let a = j.iter().map(|r| j.iter().map(|s| dot(r, s)).collect()).collect();
    let mut values: Vec<f64> = eigenvalues(a, 1e-30).into_iter().map(|x| x.max(0.0).sqrt()).collect();
    order::sort_by(&mut values, |x, y| y.total_cmp(x));
    values
}

/// The eigenvalues of a symmetric matrix, unordered, by rotations (C. G. J. Jacobi 1846) until the sum of the squares above the
/// diagonal is less than `small`.
pub(super) fn eigenvalues(mut a: Vec<Vec<f64>>, small: f64) -> Vec<f64> {
    let n = a.len();
    for _sweep in 0..100 {
        let off: f64 =
            (0..n).flat_map(|p| (p + 1..n).map(move |q| (p, q))).map(|(p, q)| a[p][q] * a[p][q]).sum();
        if off < small {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, p, q);
            }
        }
    }
    (0..n).map(|i| a[i][i]).collect()
}

/// Zeroes the element (p, q) of a symmetric matrix by a rotation.
fn rotate(a: &mut [Vec<f64>], p: usize, q: usize) {
    if a[p][q].abs() < 1e-300 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = 1f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for row in a.iter_mut() {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
    for k in 0..a.len() {
        (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
    }
}
