//! Recorded runs of the same lab by another program. Its errors and times are listed next to ours, but do not influence them.

use super::agreement::ReferenceSolution;
use super::case::PrecisionCase;
use super::judge::{self, Compared, Errors};
use super::run_record::SampledRun;
use labspec::run::RunError;
use serde_json::Value;

/// The recording of another program.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherRecording {
    /// The program and its version.
    pub engine: String,
    traces: Vec<String>,
    times: Vec<f64>,
    runs: Vec<Recorded>,
}

#[derive(Clone, Debug, PartialEq)]
struct Recorded {
    integrator: String,
    timestep: f64,
    cost: f64,
    /// The values of each trace at each time that its steps meet; NaN if the value was not a number.
    values: Vec<Vec<f64>>,
}

/// The errors of a run of another program.
#[derive(Clone, Debug, PartialEq)]
pub struct BesideRow {
    /// Its integrator.
    pub integrator: String,
    /// Timestep, s.
    pub timestep: f64,
    /// The errors of each number.
    pub errors: Vec<Errors>,
    /// Microseconds per simulated second, as measured by that program.
    pub cost: f64,
}

/// All runs of another program.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The program and its version.
    pub engine: String,
    /// Its runs.
    pub rows: Vec<BesideRow>,
}

impl OtherRecording {
    /// Reads a recording: `{"engine", "traces": [labels], "times": [s], "rows": [{"integrator", "timestep",
    /// "microsecondsPerSecond", "values": [[number of each time] of each trace]}]}`. A run whose timestep exceeds the spacing
    /// of the times has only the values at times that its steps meet.
    ///
    /// # Errors
    /// States in words what is missing or has the wrong type.
    pub fn read(text: &str) -> Result<OtherRecording, String> {
        let value: Value = serde_json::from_str(text).map_err(|e| format!("it is not JSON: {e}"))?;
        let list = |value: &Value, key: &str| {
            value.get(key).and_then(Value::as_array).cloned().ok_or_else(|| format!("it has no list `{key}`"))
        };
        let words = |v: &Value| v.as_str().map(str::to_string).ok_or("a name is not a text".to_string());
        let number = |v: Option<&Value>| v.and_then(Value::as_f64).unwrap_or(f64::NAN);
        let traces = list(&value, "traces")?.iter().map(words).collect::<Result<Vec<_>, _>>()?;
        let times: Vec<f64> = list(&value, "times")?.iter().map(|v| number(Some(v))).collect();
        let run = |row: &Value| {
            let of_trace = |v: &Value| v.as_array().into_iter().flatten().map(|x| number(Some(x))).collect();
            let values: Vec<Vec<f64>> = list(row, "values")?.iter().map(of_trace).collect();
            let timestep = number(row.get("timestep"));
            // A run with longer steps meets fewer of the times.
            let stride = times.get(1).map_or(1.0, |first| (timestep / first).round().max(1.0));
            let met = times.len().saturating_sub(1) / stride as usize + 1;
            if values.len() != traces.len() || values.iter().any(|v| v.len() != met) {
                return Err("a run lacks a value of a trace at one of its times".to_string());
            }
            let integrator =
                row.get("integrator").map_or(Err("a run has no integrator".to_string()), words)?;
            Ok(Recorded { integrator, timestep, cost: number(row.get("microsecondsPerSecond")), values })
        };
        let runs = list(&value, "rows")?.iter().map(run).collect::<Result<Vec<_>, _>>()?;
        let engine = value.get("engine").map_or(Err("it has no `engine`".to_string()), words)?;
        Ok(OtherRecording { engine, traces, times, runs })
    }

    /// Compares its runs with the same reference solution as ours.
    ///
    /// # Errors
    /// It lacks a trace of the lab, or was recorded at other times.
    pub(super) fn judge(
        &self,
        case: &PrecisionCase<'_>,
        truth: &ReferenceSolution,
        targets: &[Compared],
    ) -> Result<Beside, RunError> {
        let same = |k: usize, t: f64| (t - k as f64 * case.interval).abs() <= 1e-9 * (1.0 + t);
        if self.times.len() != case.count + 1 || !self.times.iter().enumerate().all(|(k, &t)| same(k, t)) {
            return Err(RunError::new(format!(
                "the recording has other times; record it at {} times, {} s apart, starting at 0",
                case.count + 1,
                labspec::verify::significant(case.interval)
            )));
        }
        let mut places = Vec::new();
        for target in targets {
            let place = self.traces.iter().position(|t| *t == target.label);
            places.push(
                place.ok_or_else(|| RunError::new(format!("the recording has no \"{}\"", target.label)))?,
            );
        }
        let rows = self.runs.iter().map(|run| {
            let values = places.iter().map(|&i| run.values[i].clone()).collect();
            // A closed form is evaluated with the reference run, because it depends only on time.
            let stride = case.sampling_plan(run.timestep).stride;
            let met = |list: &Vec<f64>| list.iter().step_by(stride).copied().collect();
            let exact = truth.run.exact.iter().map(met).collect();
            let seen = SampledRun { values, exact, ..SampledRun::default() };
            BesideRow {
                integrator: run.integrator.clone(),
                timestep: run.timestep,
                errors: judge::errors(case, truth, targets, &seen, run.timestep),
                cost: run.cost,
            }
        });
        Ok(Beside { engine: self.engine.clone(), rows: rows.collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_parts_of_a_recording_are_reported() {
        for (text, what) in [
            ("[", "it is not JSON"),
            ("{}", "it has no list `traces`"),
            (r#"{"traces": [1], "times": [], "rows": []}"#, "a name is not a text"),
            (
                r#"{"traces": ["z"], "times": [0], "rows": [{"integrator": "Euler", "values": [[]]}]}"#,
                "lacks a value of a trace",
            ),
            (r#"{"traces": [], "times": [], "rows": []}"#, "it has no `engine`"),
        ] {
            let error = OtherRecording::read(text).unwrap_err();
            assert!(error.contains(what), "{text}: {error}");
        }
    }
}
