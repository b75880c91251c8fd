//! Functions for claims of `verify` about several runs: they combine the values of a measure in the members of a sweep.

use super::access::EngineAccess;
use super::{Arg, Function, FunctionPlace, ROW, Unit};
use crate::world::NUMBERS;
use labspec_expr::{Heap, Value};
use labspec_finding::docs;

const OVER: Function = Function { args: &[Arg::Any], place: FunctionPlace::Claims, ..ROW };

pub(super) const ROWS: &[Function] = &[
    Function {
        name: "slope",
        args: &[Arg::Any, Arg::Any],
        optional: 1,
        doc: docs(
            "slope(run.measure): how fast a measure of a sweep grows with the swept value, as the slope of the least-squares line; slope(y, x) for two lists",
        ),
        example: (docs("slope(run.h) + slope([1, 3, 5], [0, 1, 2])"), docs("3")),
        run: |w, heap, args| {
            let (y, x) = pairs(w, heap, args.first(), args.get(1))?;
            Ok(Value::Number(slope(&x, &y)))
        },
        ..OVER
    },
    Function {
        name: "fit",
        args: &[Arg::Any, Arg::Text, Arg::Any],
        optional: 1,
        doc: docs(
            "fit(run.measure, law): the parameter of a least-squares fit, in the logarithms that make the law a straight line: 'power' the exponent n of a xⁿ, 'exponential' the rate k of a exp(k x), 'logarithm' the factor b of a + b ln x; NaN if a logarithm needs a number that is not positive; fit(y, law, x) for two lists",
        ),
        example: (docs("fit(run.h, 'power') + fit([1, 4, 9], 'power', [1, 2, 3])"), docs("3")),
        run: |w, heap, args| {
            let law = match args.get(1) {
                Some(Value::String(law)) => LAWS.iter().find(|(name, ..)| *name == &**law),
                _ => None,
            };
            let &(_, of_x, of_y) =
                law.ok_or("the laws of `fit` are 'power', 'exponential' and 'logarithm'")?;
            let (y, x) = pairs(w, heap, args.first(), args.get(2))?;
            let line =
                |list: Vec<f64>, bent: bool| list.into_iter().map(|x| if bent { ln(x) } else { x }).collect();
            let [x, y]: [Vec<f64>; 2] = [line(x, of_x), line(y, of_y)];
            Ok(Value::Number(slope(&x, &y)))
        },
        ..OVER
    },
    Function {
        name: "min",
        unit: Unit::Argument(1.0),
        doc: docs("smallest value of a measure over a sweep"),
        example: (docs("min(run.h)"), docs("0.001")),
        run: |w, heap, args| fold(w, heap, args, f64::min),
        ..OVER
    },
    Function {
        name: "max",
        unit: Unit::Argument(1.0),
        doc: docs("largest value of a measure over a sweep"),
        example: (docs("max(run.h)"), docs("0.004")),
        run: |w, heap, args| fold(w, heap, args, f64::max),
        ..OVER
    },
    Function {
        name: "mean",
        unit: Unit::Argument(1.0),
        doc: docs("mean of a measure over a sweep"),
        example: (docs("3000 * mean(run.h)"), docs("7")),
        run: |w, heap, args| {
            let (list, _) = numbers(w, heap, args.first())?;
            Ok(Value::Number(list.iter().sum::<f64>() / list.len() as f64))
        },
        ..OVER
    },
];

/// Laws that become linear in logarithms: whether the logarithm of x is used, and that of y.
const LAWS: [(&str, bool, bool); 3] =
    [("power", true, true), ("exponential", false, true), ("logarithm", true, false)];

/// The natural logarithm of a positive number, NaN for others.
fn ln(x: f64) -> f64 {
    if x > 0.0 { x.ln() } else { f64::NAN }
}

/// The numbers in the argument, and the index of the first one among the numbers of the sweeps.
fn numbers(
    w: &EngineAccess<'_>,
    heap: &Heap,
    arg: Option<&Value>,
) -> Result<(Vec<f64>, Option<usize>), String> {
    match arg {
        Some(Value::View(view)) if view.field == NUMBERS => {
            let first = view.first as usize;
            let all = (first..first + view.count().unwrap_or(0)).map_while(|i| w.number(i));
            Ok((all.collect(), Some(first)))
        }
        Some(list) => heap.to_numbers(list).map(|list| (list, None)).ok_or_else(|| {
            "this is a single number: pass the measure of a run with a `sweep`, or a list".to_string()
        }),
        None => Err("a list is missing".into()),
    }
}

/// The values of a measure, and the values of x to which they belong, which are stored directly before them.
fn pairs(
    w: &EngineAccess<'_>,
    heap: &Heap,
    y: Option<&Value>,
    x: Option<&Value>,
) -> Result<(Vec<f64>, Vec<f64>), String> {
    let (y, first) = numbers(w, heap, y)?;
    let x = match (x, first) {
        (Some(Value::Undefined) | None, Some(first)) => {
            let before = first.checked_sub(y.len()).ok_or("these numbers have no swept values")?;
            (before..first).map_while(|i| w.number(i)).collect()
        }
        (Some(Value::Undefined) | None, None) => {
            return Err(
                "a computed list has no swept values: pass them as the last argument, as `run.value`".into(),
            );
        }
        (x, _) => numbers(w, heap, x)?.0,
    };
    if x.len() == y.len() { Ok((y, x)) } else { Err("the two lists have different lengths".into()) }
}

fn fold(
    w: &EngineAccess<'_>,
    heap: &Heap,
    args: &[Value],
    combine: fn(f64, f64) -> f64,
) -> Result<Value, String> {
    let (list, _) = numbers(w, heap, args.first())?;
    // If the value of one member is NaN, the result is NaN.
    let all =
        list.iter().copied().reduce(|a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { combine(a, b) });
    Ok(Value::Number(all.unwrap_or(f64::NAN)))
}

/// The slope of the least-squares line through the points.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len() as f64;
    let [mx, my] = [x, y].map(|list| list.iter().sum::<f64>() / n);
    let products: f64 = x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum();
    let squares: f64 = x.iter().map(|x| (x - mx) * (x - mx)).sum();
    if squares > 0.0 { products / squares } else { f64::NAN }
}
