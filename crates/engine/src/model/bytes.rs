//! Numbers as little-endian bytes.

/// A number or a flag with a fixed number of bytes.
pub(crate) trait FixedSize: Sized {
    fn put(&self, out: &mut Vec<u8>);
    /// Reads a value from the front of `bytes`. `None` if there are too few bytes, or if they are not a valid value.
    fn take(bytes: &mut &[u8]) -> Option<Self>;
}

fn front<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk::<N>()?;
    *bytes = rest;
    Some(*first)
}

macro_rules! numbers {
    ($($t:ty),*) => { $(
        impl FixedSize for $t {
            fn put(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
            fn take(bytes: &mut &[u8]) -> Option<Self> {
                front(bytes).map(<$t>::from_le_bytes)
            }
        }
    )* };
}
numbers!(u8, u32, u64, i32, f64);

impl FixedSize for bool {
    fn put(&self, out: &mut Vec<u8>) {
        out.push(u8::from(*self));
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        match u8::take(bytes)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl FixedSize for usize {
    fn put(&self, out: &mut Vec<u8>) {
        (*self as u64).put(out);
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        usize::try_from(u64::take(bytes)?).ok()
    }
}

impl<T: FixedSize> FixedSize for Option<T> {
    fn put(&self, out: &mut Vec<u8>) {
        self.is_some().put(out);
        if let Some(x) = self {
            x.put(out);
        }
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        if bool::take(bytes)? { Some(Some(T::take(bytes)?)) } else { Some(None) }
    }
}

impl<T: FixedSize + Copy + Default, const N: usize> FixedSize for [T; N] {
    fn put(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|x| x.put(out));
    }
    fn take(bytes: &mut &[u8]) -> Option<Self> {
        let mut out = [T::default(); N];
        for x in &mut out {
            *x = T::take(bytes)?;
        }
        Some(out)
    }
}

/// The FNV-1a hash of a list of bytes (Fowler, Noll and Vo, 64 bits). It detects accidental changes, not intentional ones.
pub(crate) fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
}
