//! The samples of a run. For numeric traces, the inputs are recorded as columns, each element once, and the traces are
//! evaluated after the run. All others are evaluated at every sample.

use super::{Cell, End, Session};
use crate::bind::{Bound, Programs};
use labspec_expr::{Access, Columnar, Effects, Foreign, Recording, Type};

/// How the values of a trace or a readout are computed.
#[derive(Clone, Debug)]
enum ProbeSamples<'p> {
    /// After the run, from recorded columns; `true` for a boolean.
    Columns(Columnar, bool),
    /// At every sample.
    Rows(&'p Bound, Vec<Cell>),
    /// Never: it has errors.
    Never,
}

/// The time and every probe of a lab, sample by sample.
#[derive(Clone, Debug)]
pub struct Samples<'p> {
    times: Vec<f64>,
    /// The model that the programs were compiled for.
    model: u64,
    recording: Recording,
    probes: Vec<ProbeSamples<'p>>,
    /// Bytes of all texts.
    text: usize,
}

impl<'p> Samples<'p> {
    /// No samples, with memory for `capacity` samples: sampling numbers and booleans does not allocate.
    pub fn new(programs: &'p Programs, capacity: usize) -> Samples<'p> {
        let mut recording = Recording::new();
        let all = || programs.probes.iter().filter_map(|p| p.bound.as_ref());
        let mut samples_of = |bound: &'p Bound| {
            // A value that another probe writes must be read in the order of the probes.
            let reads = &bound.program.effects().reads;
            let fixed = !all().any(|other| may_write(other.program.effects(), reads));
            match recording.columns(&bound.program).ok().flatten().filter(|_| fixed) {
                Some(columns) => ProbeSamples::Columns(columns, bound.program.result_type() == Type::Boolean),
                None => ProbeSamples::Rows(bound, Vec::with_capacity(capacity)),
            }
        };
        let probes = programs
            .probes
            .iter()
            .map(|p| p.bound.as_ref().map_or(ProbeSamples::Never, &mut samples_of))
            .collect();
        recording.reserve(capacity);
        Samples { times: Vec::with_capacity(capacity), model: programs.model, recording, probes, text: 0 }
    }

    /// Number of probes that are recorded as columns, and of the distinct elements that they read.
    pub fn columns(&self) -> (usize, usize) {
        let columns = self.probes.iter().filter(|p| matches!(p, ProbeSamples::Columns(..)));
        (columns.count(), self.recording.width())
    }

    /// Bytes of the texts among the samples so far.
    pub fn text(&self) -> usize {
        self.text
    }

    /// Takes a sample. A probe that throws has no value, as on the page.
    ///
    /// # Errors
    /// The probes were compiled for another model than that of the session: their addresses are invalid for it, and no
    /// sample is taken.
    pub fn take(&mut self, session: &mut Session<'_>) -> Result<(), Foreign> {
        if session.ended() == Some(&End::Foreign) || session.world.model.identity() != self.model {
            return Err(Foreign::Identity);
        }
        self.recording.sample(&session.world)?;
        self.times.push(session.world.data.time());
        for probe in &mut self.probes {
            if let ProbeSamples::Rows(bound, cells) = probe {
                let value = session.evaluate(&bound.program, &bound.text);
                let cell = value.map_or(Cell::Nothing, Cell::from);
                if let Cell::Text(text) = &cell {
                    self.text += text.len();
                }
                cells.push(cell);
            }
        }
        Ok(())
    }

    /// The samples as rows: time, then every probe.
    pub fn rows(self) -> Vec<Vec<Cell>> {
        let mut scratch = Vec::new();
        let columns: Vec<Vec<Cell>> = self
            .probes
            .into_iter()
            .map(|probe| match probe {
                ProbeSamples::Rows(_, cells) => cells,
                ProbeSamples::Never => vec![Cell::Nothing; self.times.len()],
                ProbeSamples::Columns(columnar, truth) => {
                    let mut numbers = vec![0.0; self.times.len()];
                    if columnar.evaluate_into(&self.recording, &mut scratch, &mut numbers).is_err() {
                        return vec![Cell::Nothing; self.times.len()];
                    }
                    let cell = |x| if truth { Cell::Bool(x != 0.0) } else { Cell::Number(x) };
                    numbers.into_iter().map(cell).collect()
                }
            })
            .collect();
        let mut columns: Vec<_> = columns.into_iter().map(Vec::into_iter).collect();
        let row = |time| {
            let probes = columns.iter_mut().map(|c| c.next().unwrap_or(Cell::Nothing));
            std::iter::once(Cell::Number(time)).chain(probes).collect()
        };
        self.times.into_iter().map(row).collect()
    }
}

/// Whether a program may change a value that another one reads.
fn may_write(effects: &Effects, reads: &[Access]) -> bool {
    let touches = |w: &Access| reads.iter().any(|r| r.field == w.field);
    effects.writes_everything || effects.calls_values || effects.writes.iter().any(touches)
}
