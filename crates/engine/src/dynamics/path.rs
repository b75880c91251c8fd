//! Rows of M and of its factorization: products of one vector with the motions of all ancestors.
//!
//! The columns of a row are the ancestors of its degree of freedom from the root on. Degrees of freedom are numbered
//! depth first, so that one list serves all rows: at each degree of freedom, what stands before its own place are its
//! ancestors. Eight motions stand side by side, component by component, as processors add them.

use crate::math::Spatial;
use crate::model::Model;

/// Motions that stand side by side.
const SIDE: usize = 8;

/// The motions of a degree of freedom and its ancestors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    blocks: Vec<[[f64; SIDE]; 6]>,
}

impl Path {
    /// Scratch for the longest row of a model.
    pub(crate) fn new(m: &Model) -> Path {
        let longest = m.M_rownnz.iter().copied().max().unwrap_or(0) as usize;
        Path { blocks: vec![Default::default(); longest.div_ceil(SIDE)] }
    }

    /// Puts the motion of a degree of freedom behind those of its ancestors, of which there are `depth`.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn extend(&mut self, depth: usize, motion: &Spatial) {
        if let Some(block) = self.blocks.get_mut(depth / SIDE) {
            for (to, x) in block.iter_mut().zip(motion) {
                to[depth % SIDE] = *x;
            }
        }
    }

    /// out ← the product of each motion with v, from the root on.
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

#[inline(never)] // inlined into a loop, the compiler would add along the wrong direction
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
