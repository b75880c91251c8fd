//! The parts of a forward pass: the rows of the pipeline that run in each part. A plan selects rows with one bit each.

use super::clocked::{self, CLOCKED, Run};
use super::pipeline::{PassPart, STAGES};
use crate::model::stage::Stage;
use crate::model::{Fields, Model};
use crate::step::workspace::StepScratch;

/// The functions of a part of a forward pass, in order. A plan selects functions with one bit each.
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

    /// The bits of all functions whose stage satisfies a condition.
    fn bits(&self, predicate: impl Fn(Stage) -> bool) -> u32 {
        self.stage.iter().enumerate().filter(|(_, s)| s.is_some_and(&predicate)).map(|(i, _)| 1 << i).sum()
    }

    /// The bits of the functions of some stages.
    const fn stage_bits(&self, stages: &[Stage]) -> u32 {
        let (mut bits, mut n) = (0, 0);
        while n < 32 {
            let mut k = 0;
            while k < stages.len() {
                if let Some(stage) = self.stage[n]
                    && stage as u32 == stages[k] as u32
                {
                    bits |= 1 << n;
                }
                k += 1;
            }
            n += 1;
        }
        bits
    }

    /// The bits of the functions before a stage of this part.
    const fn bits_before(&self, stage: Stage) -> u32 {
        let bits = self.stage_bits(&[stage]);
        assert!(bits.is_power_of_two(), "the stage runs once in this part");
        bits - 1
    }

    /// Runs the functions that the bits select.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn run(&self, m: &Model, d: &mut Fields, s: &mut StepScratch, mut bits: u32) {
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

const OF_POSITIONS: Sequence = Sequence::new(PassPart::Positions);
pub(crate) static POSITIONS: Sequence = OF_POSITIONS;
pub(crate) static VELOCITIES: Sequence = Sequence::new(PassPart::Velocities);
pub(crate) static INPUTS: Sequence = Sequence::new(PassPart::Inputs);

/// In the part of positions: collision; the stages that the mass matrix and lengths depend on; those of them that only tendons and
/// transmissions need, without the mass matrix.
pub(crate) const COLLISION: u32 = OF_POSITIONS.stage_bits(&[Stage::Collision]);
pub(crate) const BEFORE_MASS: u32 =
    OF_POSITIONS.bits_before(Stage::MassMatrix) & !OF_POSITIONS.stage_bits(&[Stage::CameraPoses]);
pub(crate) const FOR_LENGTHS: u32 =
    OF_POSITIONS.stage_bits(&[Stage::Orientations, Stage::GeomPoses, Stage::SitePoses, Stage::ComPos]);

/// The same passes, with time measurement.
pub(crate) fn with_clock(passes: [[u32; 3]; 2]) -> [[u32; 3]; 2] {
    passes.map(|pass| pass.map(|bits| bits | CLOCKED))
}

/// The functions that run in each part of a forward pass, for the stages that are kept.
pub(crate) fn passes(keeps: impl Fn(Stage) -> bool) -> [u32; 3] {
    [POSITIONS.bits(&keeps), VELOCITIES.bits(&keeps), INPUTS.bits(&keeps)]
}
