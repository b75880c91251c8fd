//! The passes of a forward pass: the rows of the pipeline that run in each of its parts, of which a plan keeps some, a bit each.

use super::clocked::{self, CLOCKED, Run};
use super::pipeline::{PassPart, STAGES};
use crate::math::broken_invariant;
use crate::model::stage::Stage;
use crate::model::{Fields, Model};
use crate::step::workspace::Scratch;

/// What runs in a part of a forward pass, in order; a plan keeps some of it, a bit each.
pub(crate) struct Sequence {
    run: [Run; 32],
    stage: [Option<Stage>; 32],
}

impl Sequence {
    const fn new(part: PassPart) -> Sequence {
        let mut all = Sequence { run: [clocked::nothing as Run; 32], stage: [None; 32] };
        let (mut n, mut row) = (0, 0);
        while row < STAGES.len() {
            let mut k = 0;
            while k < STAGES[row].run.len() {
                if STAGES[row].run[k].0 as u8 == part as u8 {
                    all.run[n] = STAGES[row].run[k].1;
                    all.stage[n] = Some(STAGES[row].stage);
                    n += 1;
                }
                k += 1;
            }
            row += 1;
        }
        assert!(n < 32, "the last bit is that of the clock");
        all
    }

    /// The bits of what belongs to some stages.
    fn bits(&self, of: impl Fn(Stage) -> bool) -> u32 {
        self.stage.iter().enumerate().filter(|(_, s)| s.is_some_and(&of)).map(|(i, _)| 1 << i).sum()
    }

    /// The bits of the stages before one.
    pub(crate) fn before(&self, stage: Stage) -> u32 {
        let n = self.stage.iter().position(|s| *s == Some(stage));
        let n = n.unwrap_or_else(|| broken_invariant("a stage runs in this part of a pass"));
        (1 << n) - 1
    }

    /// The bits of one stage.
    pub(crate) fn stage_bits(&self, stage: Stage) -> u32 {
        self.bits(|s| s == stage)
    }

    /// Runs what the bits say.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn run(&self, m: &Model, d: &mut Fields, s: &mut Scratch, mut bits: u32) {
        if bits & CLOCKED != 0 {
            return clocked::walk(&self.run, &self.stage, m, d, s, bits);
        }
        while bits != 0 {
            let run = self.run[bits.trailing_zeros() as usize % 32];
            bits &= bits - 1;
            run(m, d, s);
        }
    }
}

pub(crate) static POSITIONS: Sequence = Sequence::new(PassPart::Positions);
pub(crate) static VELOCITIES: Sequence = Sequence::new(PassPart::Velocities);
pub(crate) static INPUTS: Sequence = Sequence::new(PassPart::Inputs);

/// The same passes by the clock.
pub(crate) fn by_the_clock(passes: [[u32; 3]; 2]) -> [[u32; 3]; 2] {
    passes.map(|pass| pass.map(|bits| bits | CLOCKED))
}

/// What a forward pass runs of each part, for the stages that are kept.
pub(crate) fn passes(keeps: impl Fn(Stage) -> bool) -> [u32; 3] {
    [POSITIONS.bits(&keeps), VELOCITIES.bits(&keeps), INPUTS.bits(&keeps)]
}
