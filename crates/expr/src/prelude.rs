//! The methods that call a function for every element, written in the language itself. A call of one is bound as
//! if its text stood in the place of the call, so that the types of that place decide how it is computed: a sum
//! over the coordinates of a model never leaves the number registers.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::ast::{ExprKind, Function};
use crate::parse::parse_expression;

/// Name, number of arguments, and the function of what stands before the point and of the arguments; `result`: the
/// first argument's use. Of one name the row with the right number of arguments is taken.
const SOURCES: &[(&str, usize, &str)] = &[
    (
        "map",
        1,
        "(v, f) => { const n = v.length, r = _like(v, n); for (let i = 0; i < n; i++) r[i] = f(v[i], i, v); return r }",
    ),
    ("forEach", 1, "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) f(v[i], i, v) }"),
    (
        "filter",
        1,
        "(v, f) => { const n = v.length, r = []; for (let i = 0; i < n; i++) { const x = v[i]; if (f(x, i, v)) r.push(x) } return _kind(v, r) }",
    ),
    (
        "some",
        1,
        "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) if (f(v[i], i, v)) return true; return false }",
    ),
    (
        "every",
        1,
        "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) if (!f(v[i], i, v)) return false; return true }",
    ),
    (
        "find",
        1,
        "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) { const x = v[i]; if (f(x, i, v)) return x } }",
    ),
    (
        "findIndex",
        1,
        "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) if (f(v[i], i, v)) return i; return -1 }",
    ),
    (
        "findLast",
        1,
        "(v, f) => { for (let i = v.length - 1; i >= 0; i--) { const x = v[i]; if (f(x, i, v)) return x } }",
    ),
    (
        "findLastIndex",
        1,
        "(v, f) => { for (let i = v.length - 1; i >= 0; i--) if (f(v[i], i, v)) return i; return -1 }",
    ),
    (
        "reduce",
        2,
        "(v, f, start) => { const n = v.length; let a = start; for (let i = 0; i < n; i++) a = f(a, v[i], i, v); return a }",
    ),
    (
        "reduce",
        1,
        "(v, f) => { const n = v.length; if (n === 0) _empty(); let a = v[0]; for (let i = 1; i < n; i++) a = f(a, v[i], i, v); return a }",
    ),
    (
        "reduceRight",
        2,
        "(v, f, start) => { let a = start; for (let i = v.length - 1; i >= 0; i--) a = f(a, v[i], i, v); return a }",
    ),
    (
        "reduceRight",
        1,
        "(v, f) => { const n = v.length; if (n === 0) _empty(); let a = v[n - 1]; for (let i = n - 2; i >= 0; i--) a = f(a, v[i], i, v); return a }",
    ),
    (
        "flatMap",
        1,
        "(v, f) => { const n = v.length, r = []; for (let i = 0; i < n; i++) { const x = f(v[i], i, v); if (Array.isArray(x)) { for (const y of x) r.push(y) } else r.push(x) } return r }",
    ),
    (
        "sort",
        1,
        "(v, f) => { const n = v.length; let a = _copy(v), b = _copy(v); for (let w = 1; w < n; w *= 2) { for (let s = 0; s < n; s += 2 * w) { const m = Math.min(s + w, n), e = Math.min(s + 2 * w, n); let i = s, j = m; for (let k = s; k < e; k++) { if (i < m && (j >= e || !(f(a[i], a[j]) > 0))) { b[k] = a[i]; i++ } else { b[k] = a[j]; j++ } } } const t = a; a = b; b = t } for (let i = 0; i < n; i++) v[i] = a[i]; return v }",
    ),
    (
        "toSorted",
        1,
        "(v, f) => { const n = v.length; let a = _copy(v), b = _copy(v); for (let w = 1; w < n; w *= 2) { for (let s = 0; s < n; s += 2 * w) { const m = Math.min(s + w, n), e = Math.min(s + 2 * w, n); let i = s, j = m; for (let k = s; k < e; k++) { if (i < m && (j >= e || !(f(a[i], a[j]) > 0))) { b[k] = a[i]; i++ } else { b[k] = a[j]; j++ } } } const t = a; a = b; b = t } return a }",
    ),
    (
        "Array.from",
        1,
        "(v, f) => { const l = Array.from(v), n = l.length, r = []; for (let i = 0; i < n; i++) r.push(f(l[i], i)); return r }",
    ),
];

/// What the methods do, an example and its value, for the reference.
pub(crate) const DOCS: &[(&str, &str, (&str, &str))] = &[
    ("every", "whether a condition holds for all elements", ("[1, 2].every(x => x > 0)", "true")),
    ("filter", "a list of the elements for which a condition holds", ("[1, 2, 3].filter(x => x > 1)", "2,3")),
    ("find", "the first element for which a condition holds", ("[1, 2, 3].find(x => x > 1)", "2")),
    (
        "findIndex",
        "index of the first element for which a condition holds, or -1",
        ("[1, 2, 3].findIndex(x => x > 1)", "1"),
    ),
    ("findLast", "the last element for which a condition holds", ("[1, 2, 3].findLast(x => x > 1)", "3")),
    (
        "findLastIndex",
        "index of the last element for which a condition holds, or -1",
        ("[1, 2, 3].findLastIndex(x => x > 1)", "2"),
    ),
    (
        "flatMap",
        "a list of what a function makes of each element; lists that it makes are taken apart",
        ("[1, 2].flatMap(x => [x, x])", "1,1,2,2"),
    ),
    ("forEach", "calls a function for each element", ("[1, 2].forEach(x => x)", "undefined")),
    ("map", "a list of what a function makes of each element", ("[1, 2].map(x => 2 * x)", "2,4")),
    (
        "reduce",
        "one value from all elements: a function of the value so far and the element, from a first value on",
        ("[1, 2, 3].reduce((a, x) => a + x, 0)", "6"),
    ),
    (
        "reduceRight",
        "as `reduce`, from the last element to the first",
        ("['a', 'b'].reduceRight((a, x) => a + x, '')", "ba"),
    ),
    ("some", "whether a condition holds for at least one element", ("[1, 2].some(x => x > 1)", "true")),
    (
        "sort",
        "sorts the elements by a function that gives a positive number when its first argument belongs behind its second",
        ("[3, 10, 2].sort((a, b) => a - b)", "2,3,10"),
    ),
    ("toSorted", "a sorted copy, see `sort`", ("[3, 10, 2].toSorted((a, b) => b - a)", "10,3,2")),
];

/// A method, read.
type Methods = BTreeMap<(&'static str, usize), Function>;

/// The method of this name with this number of arguments.
pub(crate) fn method(name: &str, arguments: usize) -> Option<&'static Function> {
    static METHODS: OnceLock<Methods> = OnceLock::new();
    let methods = METHODS.get_or_init(|| {
        let read = |source: &str| match parse_expression(source).tree.kind {
            ExprKind::Function(function) => Some(*function),
            _ => None,
        };
        SOURCES.iter().filter_map(|(name, n, source)| Some(((*name, *n), read(source)?))).collect()
    });
    let (name, ..) = SOURCES.iter().find(|(n, ..)| *n == name)?;
    methods.get(&(*name, arguments))
}

/// Numbers of arguments with which a method of this name calls a function; empty when there is none.
pub(crate) fn arities(name: &str) -> Vec<usize> {
    SOURCES.iter().filter(|(n, ..)| *n == name).map(|(_, arguments, _)| *arguments).collect()
}

/// The names of all of them.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    DOCS.iter().map(|(name, ..)| *name)
}

/// Whether a method changes the elements of what it is called on.
pub(crate) fn changes(name: &str) -> bool {
    name == "sort"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_read_without_a_mistake() {
        for (name, n, source) in SOURCES {
            assert!(parse_expression(source).diagnostics.is_empty(), "{name}");
            assert!(method(name, *n).is_some(), "{name}");
        }
        assert!(names().all(|name| !arities(name).is_empty()));
    }
}
