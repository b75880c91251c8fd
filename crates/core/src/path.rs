//! Rows of M and of its factorization: products of one vector with the motions of all ancestors.
//!
//! The columns of a row are the ancestors of its degree of freedom from the root on. Degrees of freedom are numbered
//! depth first, so that one list serves all rows: at each degree of freedom, what stands before its own place are its
//! ancestors. Four motions stand side by side, component by component, as processors add them.

use crate::Model;
use crate::math::Spatial;

/// The motions of a degree of freedom and its ancestors.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Path {
    fours: Vec<[[f64; 4]; 6]>,
}

impl Path {
    /// Room for the longest row of a model.
    pub(crate) fn new(m: &Model) -> Path {
        let longest = m.M_rownnz.iter().copied().max().unwrap_or(0) as usize;
        Path { fours: vec![Default::default(); longest.div_ceil(4)] }
    }

    /// Puts the motion of a degree of freedom behind those of its ancestors, of which there are `depth`.
    #[inline(always)]
    pub(crate) fn extend(&mut self, depth: usize, motion: &Spatial) {
        if let Some(four) = self.fours.get_mut(depth / 4) {
            for (to, x) in four.iter_mut().zip(motion) {
                to[depth % 4] = *x;
            }
        }
    }

    /// out ← the product of each motion with v, from the root on.
    #[inline(always)]
    pub(crate) fn product(&self, v: &Spatial, out: &mut [f64]) {
        let (whole, rest) = out.as_chunks_mut::<4>();
        for (to, four) in whole.iter_mut().zip(&self.fours) {
            *to = products(four, v);
        }
        if let Some(four) = self.fours.get(whole.len()) {
            for (to, x) in rest.iter_mut().zip(products(four, v)) {
                *to = x;
            }
        }
    }
}

#[inline(always)]
fn products(four: &[[f64; 4]; 6], v: &Spatial) -> [f64; 4] {
    let mut out = [0.0; 4];
    for i in 0..4 {
        out[i] = four[0][i] * v[0];
    }
    for c in 1..6 {
        for i in 0..4 {
            out[i] += four[c][i] * v[c];
        }
    }
    out
}
