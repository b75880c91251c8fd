//! Rows of M and of its factorization: products of one vector with the motion axes of all ancestors.
//!
//! The columns of a row are the ancestors of its degree of freedom, starting at the root. Degrees of freedom are
//! numbered depth first, so one list serves all rows: the elements before the position of a degree of freedom are its
//! ancestors. Motion axes are stored in blocks of eight, component by component, for SIMD instructions.

use crate::math::Spatial;
use crate::model::Model;

/// Number of motion axes in a block.
const SIDE: usize = 8;

/// The motion axes of a degree of freedom and its ancestors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    blocks: Vec<[[f64; SIDE]; 6]>,
}

impl Path {
    /// Allocates scratch for the longest row of a model.
    pub(crate) fn new(m: &Model) -> Path {
        let longest = m.M_rownnz.iter().copied().max().unwrap_or(0) as usize;
        Path { blocks: vec![Default::default(); longest.div_ceil(SIDE)] }
    }

    /// Appends the motion axis of a degree of freedom with `depth` ancestors, after those of its ancestors.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn extend(&mut self, depth: usize, motion: &Spatial) {
        if let Some(block) = self.blocks.get_mut(depth / SIDE) {
            for (to, x) in block.iter_mut().zip(motion) {
                to[depth % SIDE] = *x;
            }
        }
    }

    /// out ← the product of each motion axis with v, starting at the root.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn product(&self, v: &Spatial, out: &mut [f64]) {
        let (whole, rest) = out.as_chunks_mut::<SIDE>();
        for (to, block) in whole.iter_mut().zip(&self.blocks) {
            products(block, v, to);
        }
        if let Some(block) = self.blocks.get(whole.len()).filter(|_| !rest.is_empty()) {
            let mut all = [0.0; SIDE];
            products(block, v, &mut all);
            for (to, x) in rest.iter_mut().zip(all) {
                *to = x;
            }
        }
    }
}

#[inline(never)] // inlined into a loop, it would be vectorized along the wrong dimension
fn products(block: &[[f64; SIDE]; 6], v: &Spatial, out: &mut [f64; SIDE]) {
    for i in 0..SIDE {
        out[i] = block[0][i] * v[0]
            + block[1][i] * v[1]
            + block[2][i] * v[2]
            + block[3][i] * v[3]
            + block[4][i] * v[4]
            + block[5][i] * v[5];
    }
}
