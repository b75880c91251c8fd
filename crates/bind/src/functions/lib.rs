//! The functions of `lib`: shortcuts for what lessons need most often.

use super::access::EngineAccess;
use super::{AccessedPart, Arg, Function, ROW, Unit, index, number};
use labspec_core::reflect::data;
use labspec_core::{self as core, Obj};
use labspec_expr::{Heap, Type, Value};
use labspec_finding::docs;
use labspec_finding::order;
use nalgebra::{DMatrix, SVD, SymmetricEigen};

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
        doc: docs("index of a body"),
        example: (docs("lib.bodyId('bob')"), docs("1")),
        run: |_, _, args| index(args).map(|i| Value::Number(i as f64)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "jointId",
        args: &[Arg::Name(Obj::Joint)],
        unit: Unit::Of("1"),
        doc: docs("index of a joint"),
        example: (docs("lib.jointId('swing')"), docs("0")),
        run: |_, _, args| index(args).map(|i| Value::Number(i as f64)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "qpos",
        args: &[Arg::Name(Obj::Joint)],
        reads: AccessedPart::State,
        doc: docs("first coordinate of a joint"),
        example: (docs("data.qpos[0] = 0.1; lib.qpos('swing')"), docs("0.1")),
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
        doc: docs("normal force in N, summed over all contacts or over those of one geom"),
        example: (docs("lib.normalForce()"), docs("0")),
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
        doc: docs("radians to degrees"),
        example: (docs("lib.deg(Math.PI)"), docs("180")),
        run: |_, _, args| number(args).map(|x| Value::Number(x * 180.0 / std::f64::consts::PI)),
        ..ROW
    },
    Function {
        object: "lib",
        name: "rad",
        args: &[Arg::Number],
        unit: Unit::Argument(std::f64::consts::PI / 180.0),
        doc: docs("degrees to radians"),
        example: (docs("lib.rad(180)"), docs("3.141592653589793")),
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
        doc: docs("world position of a site, m"),
        example: (docs("lib.sitePos('tip')[2]"), docs("0.5")),
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
        doc: docs("world position of a body, m"),
        example: (docs("lib.bodyPos('bob')[2]"), docs("1")),
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
        doc: docs("potential, kinetic and total energy, J; the first use turns the energy computation on"),
        example: (docs("lib.energy().total"), docs("4.905")),
        run: |w, heap, _| energy(w, heap),
        ..ROW
    },
    Function {
        name: "contactPairs",
        reads: AccessedPart::Contacts,
        doc: docs("pairs of geoms in contact, each as text; a geom without a name is shown by its body"),
        example: (docs("lib.contactPairs().length"), docs("0")),
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
        doc: docs(
            "Jacobian of a site: three rows of linear and three of angular velocity per degree of freedom; the second argument keeps only the first columns",
        ),
        example: (docs("lib.jacobian('tip')[0][0]"), docs("-0.5")),
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
        doc: docs(
            "singular values of the Jacobian of a site, largest first; the second argument is {cols, rows: \"full\" or \"pos\"}",
        ),
        example: (docs("lib.jacobianSV('tip', {rows: 'pos'})[0]"), docs("0.5")),
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
        doc: docs("the mass matrix, nv rows of nv numbers; computes all derived fields first"),
        example: (docs("lib.massMatrix()[0][0].toFixed(5)"), docs("0.25036")),
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
        doc: docs("length of a vector: the root of the sum of its squares"),
        example: (docs("lib.norm([3, 4])"), docs("5")),
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

/// The singular values of a matrix with these rows, as many as there are rows, largest first; NaN if an element is not finite.
fn singular_values(j: &[Vec<f64>]) -> Vec<f64> {
    let (rows, columns) = (j.len(), j.first().map_or(0, Vec::len));
    if columns == 0 {
        return vec![0.0; rows];
    }
    let element = |row: usize, column: usize| j.get(row).and_then(|r| r.get(column)).copied();
    let matrix = DMatrix::from_fn(rows, columns, |row, column| element(row, column).unwrap_or(f64::NAN));
    let finite = matrix.iter().all(|x| x.is_finite());
    let decompose = || SVD::try_new(matrix, false, false, f64::EPSILON, MAX_ITERATIONS_PER_ROW * rows);
    let Some(found) = finite.then(decompose).flatten() else { return vec![f64::NAN; rows] };
    let mut values = found.singular_values.as_slice().to_vec();
    // With fewer columns than rows, the others are zero.
    values.resize(rows, 0.0);
    values
}

/// The number of iterations per row after which an eigenvalue counts as not found. Two or three are usual.
const MAX_ITERATIONS_PER_ROW: usize = 100;

/// The eigenvalues of a symmetric matrix, smallest first; NaN if an element is not finite.
pub(super) fn eigenvalues(matrix: DMatrix<f64>) -> Vec<f64> {
    let n = matrix.nrows();
    let finite = matrix.iter().all(|x| x.is_finite());
    let found =
        finite.then(|| SymmetricEigen::try_new(matrix, f64::EPSILON, MAX_ITERATIONS_PER_ROW * n)).flatten();
    let mut values = found.map_or(vec![f64::NAN; n], |found| found.eigenvalues.as_slice().to_vec());
    order::sort_by(&mut values, f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small singular values keep their digits: those of a matrix and its inverse are reciprocal.
    #[test]
    fn small_singular_values_are_accurate() {
        let rotated = |s: f64| vec![vec![0.6, -0.8 * s, 0.0], vec![0.8, 0.6 * s, 0.0]];
        for s in [0.5, 1e-3, 1e-9, 1e-14] {
            let values = singular_values(&rotated(s));
            assert!(
                (values[0] - 1.0).abs() < 1e-15 && (values[1] / s - 1.0).abs() < 1e-15 / s,
                "{s}: {values:?}"
            );
        }
        assert_eq!(singular_values(&[vec![3.0], vec![4.0], vec![0.0]]), [5.0, 0.0, 0.0]);
        assert_eq!(singular_values(&[vec![], vec![]]), [0.0, 0.0]);
        assert!(singular_values(&[vec![1.0], vec![f64::INFINITY]]).iter().all(|x| x.is_nan()));
    }

    #[test]
    fn eigenvalues_do_not_depend_on_the_unit() {
        for unit in [1e-200, 1.0, 1e200] {
            let values = eigenvalues(
                DMatrix::from_row_slice(3, 3, &[2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, -5.0]) * unit,
            );
            for (value, expected) in values.iter().zip([-5.0, 1.0, 3.0]) {
                assert!((value / unit - expected).abs() < 1e-14, "{values:?}");
            }
        }
        assert!(eigenvalues(DMatrix::from_element(2, 2, f64::NAN)).iter().all(|x| x.is_nan()));
    }
}
