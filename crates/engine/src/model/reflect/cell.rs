//! The values of fields: their types, and the operations on every field: reading, writing, allocation, saving.

use crate::model::bytes::FixedSize;

/// Element type of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Elem {
    /// 64-bit float.
    F64,
    /// 32-bit integer.
    I32,
    /// Boolean, 0 or 1 in the language.
    Bool,
    /// Size or count.
    Size,
}

/// The numbers of a field.
#[derive(Clone, Copy, Debug)]
pub enum View<'a> {
    /// Floats.
    F64(&'a [f64]),
    /// Integers.
    I32(&'a [i32]),
    /// Booleans.
    Bool(&'a [bool]),
    /// A size or count.
    Size(usize),
}

impl View<'_> {
    /// Number of elements.
    pub fn len(&self) -> usize {
        match self {
            View::F64(v) => v.len(),
            View::I32(v) => v.len(),
            View::Bool(v) => v.len(),
            View::Size(_) => 1,
        }
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Element `i` as a number, `None` past the end.
    pub fn get(&self, i: usize) -> Option<f64> {
        match self {
            View::F64(v) => v.get(i).copied(),
            View::I32(v) => v.get(i).map(|&x| f64::from(x)),
            View::Bool(v) => v.get(i).map(|&x| f64::from(u8::from(x))),
            View::Size(n) => (i == 0).then_some(*n as f64),
        }
    }

    /// Copies the elements as numbers, as far as `out` reaches.
    pub fn copy_to(&self, out: &mut [f64]) {
        match self {
            View::F64(v) => out.iter_mut().zip(*v).for_each(|(out, x)| *out = *x),
            View::I32(v) => out.iter_mut().zip(*v).for_each(|(out, x)| *out = f64::from(*x)),
            View::Bool(v) => out.iter_mut().zip(*v).for_each(|(out, x)| *out = f64::from(u8::from(*x))),
            View::Size(n) => out.iter_mut().take(1).for_each(|out| *out = *n as f64),
        }
    }
}

/// The numbers of a field, for writing. Sizes cannot be written.
#[derive(Debug)]
pub enum ViewMut<'a> {
    /// Floats.
    F64(&'a mut [f64]),
    /// Integers.
    I32(&'a mut [i32]),
    /// Booleans.
    Bool(&'a mut [bool]),
    /// A size or count, which is not writable.
    Fixed,
}

impl ViewMut<'_> {
    /// Stores `value` at index `i`, converted as by a typed array of JavaScript (integers are truncated). Returns `false` if
    /// there is no such element.
    pub fn set(&mut self, i: usize, value: f64) -> bool {
        match self {
            ViewMut::F64(v) => v.get_mut(i).map(|x| *x = value).is_some(),
            ViewMut::I32(v) => v.get_mut(i).map(|x| *x = to_int32(value)).is_some(),
            ViewMut::Bool(v) => v.get_mut(i).map(|x| *x = to_int32(value) & 0xff != 0).is_some(),
            ViewMut::Fixed => false,
        }
    }
}

/// ECMAScript's ToInt32: truncate, then wrap modulo 2^32.
fn to_int32(x: f64) -> i32 {
    if !x.is_finite() {
        return 0;
    }
    x.trunc().rem_euclid(4_294_967_296.0) as u32 as i32
}

/// The element type of a Rust type that may occur in the field table.
pub(super) trait Typed {
    const ELEM: Elem;
}

/// A value of such a type. Operations on fields use this trait, so that their code is compiled once per type and not once per
/// field.
pub(crate) trait Cell {
    fn view(&self) -> View<'_>;
    /// Element `i` as a number, `None` past the end.
    fn get(&self, i: usize) -> Option<f64> {
        self.view().get(i)
    }
    fn view_mut(&mut self) -> ViewMut<'_>;
    /// Resizes an array to `n` zeros, and sets numbers of fixed shape to zero. Sizes do not change.
    fn allocate(&mut self, n: usize);
    /// Appends the elements as bytes.
    fn write(&self, out: &mut Vec<u8>);
    /// Reads `n` elements, or as many as a fixed shape has, from the front of `bytes`. Returns `false` if there are too few
    /// bytes.
    fn read(&mut self, n: usize, bytes: &mut &[u8]) -> bool;
}

macro_rules! cells {
    ($($t:ty => $variant:ident),*) => { $(
        impl Typed for $t {
            const ELEM: Elem = Elem::$variant;
        }
        impl Typed for Vec<$t> {
            const ELEM: Elem = Elem::$variant;
        }
        impl<const N: usize> Typed for [$t; N] {
            const ELEM: Elem = Elem::$variant;
        }
        impl Cell for $t {
            fn view(&self) -> View<'_> { View::$variant(std::slice::from_ref(self)) }
            fn view_mut(&mut self) -> ViewMut<'_> { ViewMut::$variant(std::slice::from_mut(self)) }
            fn allocate(&mut self, _: usize) { *self = <$t>::default(); }
            fn write(&self, out: &mut Vec<u8>) { self.put(out); }
            fn read(&mut self, _: usize, bytes: &mut &[u8]) -> bool {
                FixedSize::take(bytes).map(|x| *self = x).is_some()
            }
        }
        impl Cell for Vec<$t> {
            fn view(&self) -> View<'_> { View::$variant(self) }
            fn view_mut(&mut self) -> ViewMut<'_> { ViewMut::$variant(self) }
            fn allocate(&mut self, n: usize) {
                self.clear();
                self.resize(n, <$t>::default());
            }
            fn write(&self, out: &mut Vec<u8>) { self.iter().for_each(|x| x.put(out)); }
            fn read(&mut self, n: usize, bytes: &mut &[u8]) -> bool {
                // Every element has at least one byte. The check prevents an allocation that is larger than the input.
                if n > bytes.len() {
                    return false;
                }
                self.allocate(n);
                self.iter_mut().all(|x| FixedSize::take(bytes).map(|y| *x = y).is_some())
            }
        }
        impl<const N: usize> Cell for [$t; N] {
            fn view(&self) -> View<'_> { View::$variant(self) }
            fn view_mut(&mut self) -> ViewMut<'_> { ViewMut::$variant(self) }
            fn allocate(&mut self, _: usize) { *self = [<$t>::default(); N]; }
            fn write(&self, out: &mut Vec<u8>) { self.iter().for_each(|x| x.put(out)); }
            fn read(&mut self, _: usize, bytes: &mut &[u8]) -> bool {
                self.iter_mut().all(|x| FixedSize::take(bytes).map(|y| *x = y).is_some())
            }
        }
    )* };
}
cells!(f64 => F64, i32 => I32, bool => Bool);

impl Typed for usize {
    const ELEM: Elem = Elem::Size;
}

impl Cell for usize {
    fn view(&self) -> View<'_> {
        View::Size(*self)
    }
    fn view_mut(&mut self) -> ViewMut<'_> {
        ViewMut::Fixed
    }
    fn allocate(&mut self, _: usize) {}
    fn write(&self, out: &mut Vec<u8>) {
        self.put(out);
    }
    fn read(&mut self, _: usize, bytes: &mut &[u8]) -> bool {
        FixedSize::take(bytes).map(|x| *self = x).is_some()
    }
}
