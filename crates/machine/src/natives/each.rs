//! The methods that call a function for every element, written in the language itself. `v` is the receiver and `f` the
//! function. Names with an underscore are functions of the virtual machine that only these definitions use (`list.rs`).

use super::native::{Native, table};

/// Merge sort with `undefined` last, on two copies `a` and `b`: runs of `w` elements in one become runs of `2
/// w` elements in the other.
macro_rules! merge_sort {
    ($end:literal) => {
        concat!(
            "(v, f) => { const n = v.length; let a = _copy(v), b = _copy(v); ",
            "for (let w = 1; w < n; w *= 2) { for (let s = 0; s < n; s += 2 * w) { ",
            "const m = Math.min(s + w, n), e = Math.min(s + 2 * w, n); let i = s, j = m; for (let k = s; k < e; k++) { ",
            "if (i < m && (j >= e || a[j] === undefined || a[i] !== undefined && !(f(a[i], a[j]) > 0))) ",
            "{ b[k] = a[i]; i++ } else { b[k] = a[j]; j++ } } } ",
            "const t = a; a = b; b = t } ",
            $end,
            " }"
        )
    };
}

pub(super) static ROWS: &[Native] = table! {
    "every" List: "[1, 2].every(x => x > 0)" => "true",
        "whether a condition holds for all elements",
        1 => "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) if (!f(v[i], i, v)) return false; return true }";
    "filter" List: "[1, 2, 3].filter(x => x > 1)" => "2,3",
        "a list of the elements for which a condition holds",
        1 => "(v, f) => { const n = v.length, r = []; for (let i = 0; i < n; i++) { const x = v[i]; if (f(x, i, v)) r.push(x) } return _kind(v, r) }";
    "find" List: "[1, 2, 3].find(x => x > 1)" => "2",
        "the first element for which a condition holds",
        1 => "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) { const x = v[i]; if (f(x, i, v)) return x } }";
    "findIndex" List: "[1, 2, 3].findIndex(x => x > 1)" => "1",
        "index of the first element for which a condition holds, or -1",
        1 => "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) if (f(v[i], i, v)) return i; return -1 }";
    "findLast" List: "[1, 2, 3].findLast(x => x > 1)" => "3",
        "the last element for which a condition holds",
        1 => "(v, f) => { for (let i = v.length - 1; i >= 0; i--) { const x = v[i]; if (f(x, i, v)) return x } }";
    "findLastIndex" List: "[1, 2, 3].findLastIndex(x => x > 1)" => "2",
        "index of the last element for which a condition holds, or -1",
        1 => "(v, f) => { for (let i = v.length - 1; i >= 0; i--) if (f(v[i], i, v)) return i; return -1 }";
    "flatMap" Untyped: "[1, 2].flatMap(x => [x, x])" => "1,1,2,2",
        "a list of the results of a function for each element, with lists among them flattened",
        1 => "(v, f) => { const n = _untyped(v).length, r = []; for (let i = 0; i < n; i++) { const x = f(v[i], i, v); if (Array.isArray(x)) { for (const y of x) r.push(y) } else r.push(x) } return r }";
    "forEach" List: "[1, 2].forEach(x => x)" => "undefined",
        "calls a function for each element",
        1 => "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) f(v[i], i, v) }";
    "map" List: "[1, 2].map(x => 2 * x)" => "2,4",
        "a list of the results of a function for each element",
        1 => "(v, f) => { const n = v.length, r = _like(v, n); for (let i = 0; i < n; i++) r[i] = f(v[i], i, v); return r }";
    "reduce" List: "[1, 2, 3].reduce((sum, x) => sum + x, 0)" => "6",
        "one value from all elements: a function combines the value so far with the next element, from an initial value on",
        1 => "(v, f) => { const n = v.length; if (n === 0) _empty(); let a = v[0]; for (let i = 1; i < n; i++) a = f(a, v[i], i, v); return a }",
        2 => "(v, f, start) => { const n = v.length; let a = start; for (let i = 0; i < n; i++) a = f(a, v[i], i, v); return a }";
    "reduceRight" List: "['a', 'b'].reduceRight((text, x) => text + x, '')" => "ba",
        "like `reduce`, from the last element to the first",
        1 => "(v, f) => { const n = v.length; if (n === 0) _empty(); let a = v[n - 1]; for (let i = n - 2; i >= 0; i--) a = f(a, v[i], i, v); return a }",
        2 => "(v, f, start) => { let a = start; for (let i = v.length - 1; i >= 0; i--) a = f(a, v[i], i, v); return a }";
    "some" List: "[1, 2].some(x => x > 1)" => "true",
        "whether a condition holds for at least one element",
        1 => "(v, f) => { const n = v.length; for (let i = 0; i < n; i++) if (f(v[i], i, v)) return true; return false }";
    "sort" List changes: "[3, 10, 2].sort((a, b) => a - b)" => "2,3,10",
        "sorts the elements by a function that returns a positive number if its first argument belongs after its second",
        1 => merge_sort!("for (let i = 0; i < n; i++) v[i] = a[i]; return v");
    "toSorted" List: "[3, 10, 2].toSorted((a, b) => b - a)" => "10,3,2",
        "a sorted copy, see `sort`",
        1 => merge_sort!("return a");
};
