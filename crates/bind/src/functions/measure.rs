//! Functions for the measures of `verify`: over the samples of a run, and on the contacts of one sample.

use super::access::EngineAccess;
use super::lib::eigenvalues;
use super::{AccessedPart, Arg, Function, FunctionPlace, ROW, Unit, index, number};
use crate::handle;
use labspec_core::{self as core, Obj};
use labspec_expr::{Heap, Type, Value};
use labspec_finding::docs;
use nalgebra::DMatrix;

/// The members of the result of `mixed`.
const CONTACT: &[(&str, Type)] = &[
    ("dim", Type::Number),
    ("friction", Type::List),
    ("solref", Type::List),
    ("solimp", Type::List),
    ("margin", Type::Number),
    ("dist", Type::Number),
    ("pos", Type::List),
    ("frame", Type::List),
    ("active", Type::Number),
    ("force", Type::List),
];

/// The parameters of the deepest contact between two geoms.
fn mixed(w: &mut EngineAccess<'_>, heap: &mut Heap, args: &[Value]) -> Result<Value, String> {
    let (a, b) = (index(args)?, args.get(1).map(|v| handle::index_of(v.to_number())));
    let between =
        |c: &&core::Contact| [(c.geom1, c.geom2), (c.geom2, c.geom1)].contains(&(a, b.unwrap_or(a)));
    let contacts = w.contacts().iter().filter(between);
    let deepest = contacts.min_by(|c, d| c.dist.total_cmp(&d.dist));
    let force = match deepest {
        Some(c) => w.contact_force(c)?,
        None => [f64::NAN; 6],
    };
    let number = |get: fn(&core::Contact) -> f64| Value::Number(deepest.map_or(f64::NAN, get));
    let mut list = |numbers: Option<&[f64]>, n: usize| {
        let none = vec![f64::NAN; n];
        heap.numbers(numbers.unwrap_or(&none))
            .map_err(|_| "the lists of this lab take too much memory".to_owned())
    };
    let members = [
        number(|c| c.dim as f64),
        list(deepest.map(|c| c.friction.as_slice()), 5)?,
        list(deepest.map(|c| c.solref.as_slice()), 2)?,
        list(deepest.map(|c| c.solimp.as_slice()), 5)?,
        number(|c| c.includemargin),
        number(|c| c.dist),
        list(deepest.map(|c| c.pos.as_slice()), 3)?,
        list(deepest.map(|c| c.frame.as_slice()), 9)?,
        number(|c| f64::from(c.efc_address.is_some())),
        list(Some(force.as_slice()), 6)?,
    ];
    let names = CONTACT.iter().map(|(name, _)| (*name).into());
    heap.record(names.zip(members).collect())
        .map_err(|_| "the lists of this lab take too much memory".to_owned())
}

/// A symmetric matrix from a list of its rows or of its numbers, or `None` if it is not a symmetric matrix.
fn symmetric(heap: &Heap, value: &Value) -> Option<DMatrix<f64>> {
    let n = heap.len(value)?;
    let rows: Option<Vec<Vec<f64>>> = (0..n).map(|i| heap.to_numbers(&heap.item(value, i)?)).collect();
    let rows = match rows {
        Some(rows) => rows,
        None => {
            let numbers = heap.to_numbers(value)?;
            let n = numbers.len().isqrt().max(1);
            numbers.chunks(n).map(<[f64]>::to_vec).collect()
        }
    };
    let n = rows.len();
    let size = rows.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let entry = |i: usize, j: usize| rows.get(i).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN);
    let same = |i: usize, j: usize| (entry(i, j) - entry(j, i)).abs() <= 1e-9 * size;
    let good =
        n > 0 && n <= 64 && rows.iter().all(|r| r.len() == n) && (0..n).all(|i| (0..=i).all(|j| same(i, j)));
    good.then(|| DMatrix::from_fn(n, n, entry))
}

/// A function over all samples of a run; the owner of the run computes the result.
const OVER_RUN: Function =
    Function { args: &[Arg::Lazy], place: FunctionPlace::Measures, aggregate: true, ..ROW };

pub(super) const ROWS: &[Function] = &[
    Function {
        name: "contact",
        args: &[Arg::Name(Obj::Geom), Arg::Name(Obj::Geom)],
        optional: 1,
        returns: Type::Boolean,
        reads: AccessedPart::Contacts,
        place: FunctionPlace::Measures,
        doc: docs("whether two geoms are in contact, or whether one geom is in any contact"),
        example: (docs("max(contact('bob'))"), docs("0")),
        run: |w, _, args| {
            let (a, b) = (index(args)?, args.get(1).map(|v| handle::index_of(v.to_number())));
            let touch = |c: &core::Contact| {
                let pair = [c.geom1, c.geom2];
                pair.contains(&a) && b.is_none_or(|b| b != a && pair.contains(&b))
            };
            Ok(Value::Boolean(w.contacts().iter().any(touch)))
        },
        ..ROW
    },
    Function {
        name: "mixed",
        args: &[Arg::Name(Obj::Geom), Arg::Name(Obj::Geom)],
        returns: Type::Record,
        members: CONTACT,
        reads: AccessedPart::Contacts,
        place: FunctionPlace::Measures,
        doc: docs(
            "the deepest contact of two geoms, as the engine mixes it from both: dim, friction (5 numbers), solref (2), solimp (5), margin (m), dist (m), pos (3, m), frame (9), active (1 if it pushes) and force (6, N and N m); NaN everywhere without a contact",
        ),
        example: (docs("final(mixed('bob', 'bob').dim)"), docs("NaN")),
        run: mixed,
        ..ROW
    },
    Function {
        name: "eigenvalues",
        args: &[Arg::Any],
        returns: Type::List,
        place: FunctionPlace::Measures,
        doc: docs(
            "eigenvalues of a symmetric matrix, given as rows or as a flat list row by row; smallest first",
        ),
        example: (docs("final(eigenvalues([[2, 1], [1, 2]])[1])"), docs("3")),
        run: |_, heap, args| {
            let matrix = args.first().and_then(|v| symmetric(heap, v)).ok_or(
                "`eigenvalues` needs a symmetric matrix: a list of n rows with n numbers each, or of n × n numbers",
            )?;
            heap.numbers(&eigenvalues(matrix))
                .map_err(|_| "the lists of this lab take too much memory".to_owned())
        },
        ..ROW
    },
    Function {
        name: "shown",
        args: &[Arg::Label],
        returns: Type::Any,
        reads: AccessedPart::DisplayedLabels,
        place: FunctionPlace::Measures,
        doc: docs(
            "the text that a student reads under the label of a readout, or the number of a trace; if both have the label, name the trace as in a table of `labspec run`: `plot/0/label`",
        ),
        example: (docs("max(shown('time (s)'))"), docs("0.1")),
        run: |w, _, args| Ok(w.displayed_value(index(args)?).cloned().unwrap_or_default()),
        ..ROW
    },
    Function {
        name: "abs",
        args: &[Arg::Number],
        place: FunctionPlace::Measures,
        unit: Unit::Argument(1.0),
        doc: docs("magnitude"),
        example: (docs("abs(-2)"), docs("2")),
        run: |_, _, args| number(args).map(|x| Value::Number(x.abs())),
        ..ROW
    },
    Function {
        name: "first",
        unit: Unit::Of("s"),
        doc: docs("time in s of the first sample where a condition holds; NaN if it never does"),
        example: (docs("first(data.time > 0.049)"), docs("0.05")),
        ..OVER_RUN
    },
    Function {
        name: "at",
        args: &[Arg::Lazy, Arg::Lazy],
        unit: Unit::Times(1, "1"),
        doc: docs("at(condition, x): x at the first sample where the condition holds; NaN if it never does"),
        example: (docs("at(data.time > 0.049, data.qpos[0])"), docs("0")),
        ..OVER_RUN
    },
    Function {
        name: "before",
        args: &[Arg::Lazy, Arg::Lazy],
        unit: Unit::Times(1, "1"),
        doc: docs(
            "before(condition, x): x at the sample just before the condition first holds; NaN if there is none",
        ),
        example: (docs("before(data.time > 0.049, data.time)"), docs("0.048")),
        ..OVER_RUN
    },
    Function {
        name: "crossing",
        args: &[Arg::Lazy, Arg::Lazy],
        optional: 1,
        unit: Unit::Of("s"),
        doc: docs(
            "crossing(x) or crossing(x, level): time in s when x first crosses zero, or a level, interpolated linearly between two samples; a sample at the level counts; NaN if it never does",
        ),
        example: (docs("crossing(0.0495 - data.time)"), docs("0.0495")),
        ..OVER_RUN
    },
    Function {
        name: "period",
        args: &[Arg::Lazy, Arg::Lazy],
        optional: 1,
        unit: Unit::Of("s"),
        doc: docs(
            "period(x) or period(x, level): mean time in s between upward crossings of zero, or of a level, each interpolated linearly between two samples; NaN with fewer than two",
        ),
        example: (docs("period(Math.abs(data.time % 0.04 - 0.02), 0.01)"), docs("0.04")),
        ..OVER_RUN
    },
    Function {
        name: "last",
        unit: Unit::Of("s"),
        doc: docs("time in s of the last sample where a condition holds; NaN if it never does"),
        example: (docs("last(data.time < 0.051)"), docs("0.05")),
        ..OVER_RUN
    },
    Function {
        name: "count",
        unit: Unit::Of("1"),
        doc: docs("how often a condition begins to hold; holding at the start counts"),
        example: (docs("count(data.time % 0.04 < 0.019)"), docs("3")),
        ..OVER_RUN
    },
    Function {
        name: "crossings",
        args: &[Arg::Lazy, Arg::Lazy],
        optional: 1,
        unit: Unit::Of("1"),
        doc: docs(
            "crossings(x) or crossings(x, level): how often x crosses zero, or a level, upwards or downwards; a touch does not count",
        ),
        example: (docs("crossings(data.time % 0.04 - 0.019)"), docs("5")),
        ..OVER_RUN
    },
    Function {
        name: "settles",
        args: &[Arg::Lazy, Arg::Lazy, Arg::Lazy],
        unit: Unit::Of("s"),
        doc: docs(
            "settles(x, target, band): time in s from which x stays within a band around its target until the end of the run; NaN if it does not",
        ),
        example: (docs("settles(data.time, 0.1, 0.0201)"), docs("0.08")),
        ..OVER_RUN
    },
    Function {
        name: "peak",
        unit: Unit::Of("s"),
        doc: docs("time in s of the first sample where x is largest; `peak(-x)` is the time of the smallest"),
        example: (docs("peak(data.time * (0.1 - data.time))"), docs("0.05")),
        ..OVER_RUN
    },
    Function {
        name: "holds",
        unit: Unit::Of("1"),
        doc: docs("1 if a condition holds at every sample, else 0"),
        example: (docs("holds(data.time < 1)"), docs("1")),
        ..OVER_RUN
    },
    Function {
        name: "rate",
        unit: Unit::Times(0, "1/s"),
        doc: docs(
            "rate of change of x per second: the slope of the least-squares line through all samples; NaN with one sample",
        ),
        example: (docs("rate(3 * data.time)"), docs("3")),
        ..OVER_RUN
    },
    Function {
        name: "integral",
        unit: Unit::Times(0, "s"),
        doc: docs("integral over time, by the trapezoid rule"),
        example: (docs("integral(2 * data.time)"), docs("0.01")),
        ..OVER_RUN
    },
    Function {
        name: "rms",
        unit: Unit::Argument(1.0),
        doc: docs("root of the mean square over time, by the trapezoid rule"),
        example: (docs("rms(data.qpos[0] - 3)"), docs("3")),
        ..OVER_RUN
    },
    Function {
        name: "mean",
        unit: Unit::Argument(1.0),
        doc: docs("mean over time, by the trapezoid rule"),
        example: (docs("mean(data.time)"), docs("0.05")),
        ..OVER_RUN
    },
    Function {
        name: "initial",
        unit: Unit::Argument(1.0),
        doc: docs("value at the first sample"),
        example: (docs("initial(data.time)"), docs("0")),
        ..OVER_RUN
    },
    Function {
        name: "final",
        unit: Unit::Argument(1.0),
        doc: docs("value at the last sample"),
        example: (docs("final(data.time)"), docs("0.1")),
        ..OVER_RUN
    },
    Function {
        name: "previous",
        unit: Unit::Argument(1.0),
        doc: docs(
            "value at the previous sample, within another measure: `first(x < previous(x))` is when x begins to fall; NaN at the first sample",
        ),
        example: (docs("max(data.time - previous(data.time))"), docs("0.002")),
        ..OVER_RUN
    },
    Function {
        name: "min",
        unit: Unit::Argument(1.0),
        doc: docs("smallest value over the run"),
        example: (docs("min(data.qpos[0])"), docs("0")),
        ..OVER_RUN
    },
    Function {
        name: "max",
        unit: Unit::Argument(1.0),
        doc: docs("largest value over the run"),
        example: (docs("max(data.time)"), docs("0.1")),
        ..OVER_RUN
    },
];
