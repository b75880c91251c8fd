//! The runs that a text names: the unchanged lab, a control at a named value, a button, a timestep.

use super::names::{digits, named_value, slug};
use super::units::{LONGEST_TIMESTEP, round, second, si};
use super::words::text;
use labspec::bind::{given_by, scalar};
use labspec::json::{Number, Scalar};
use labspec::run::settings;
use labspec::spec::format::RUN_LENGTH;
use labspec::spec::{BreakExpectation, Control, ControlKind, Lab, Run};
use labspec::verify::Stated;
use labspec_expr::Value;
use labspec_expr::dimension::{Dimension, Measure};

/// A run.
#[derive(Clone, Debug)]
pub(crate) struct TraceRun {
    /// A description: "as it stands", "\"mass\" at 5".
    pub(crate) words: String,
    /// A name: `plain`, `mass_5`.
    pub(crate) name: String,
    /// The labels of controls, and their values.
    pub(crate) set: Vec<(String, Scalar)>,
    /// The buttons that are pressed at the start.
    pub(crate) press: Vec<String>,
    /// The timestep, s, if no control sets it.
    pub(crate) timestep: Option<f64>,
    /// Statements that undo the changes of the lab's setup to the model.
    pub(crate) restored: Option<String>,
    /// The length, s, if it is not the lab's own.
    pub(crate) until: Option<f64>,
    /// The value that is set, in SI units, to find it in the text.
    pub(crate) named: Option<(f64, Dimension)>,
    /// The value in the unchanged lab, in SI units.
    pub(crate) nominal: Option<f64>,
    /// The words of an option or a button, to find them in the text.
    pub(crate) label: String,
}

/// The maximum number of values of one control, and of runs of one lab.
const VALUES: usize = 8;
pub(super) const MOST: usize = 40;
/// A run is as long as the longest plot, up to this limit, s.
const LENGTH: f64 = 10.0;

/// The runs of a lab.
pub(crate) fn trials(lab: &Lab, numbers: &[Stated]) -> Vec<TraceRun> {
    let windows = lab.plots.iter().filter_map(|plot| plot.window.as_ref()).map(|w| w.value);
    let length = windows.fold(RUN_LENGTH, f64::max).min(LENGTH);
    let base = TraceRun {
        words: "as it stands".into(),
        name: "plain".into(),
        set: Vec::new(),
        press: Vec::new(),
        timestep: None,
        restored: None,
        until: (lab.stop_at.is_none() && length > RUN_LENGTH).then_some(length),
        named: None,
        nominal: None,
        label: String::new(),
    };
    let mut all = vec![base.clone()];
    for control in &lab.controls {
        add_control_trials(control, numbers, &base, &mut all);
    }
    let sets_timestep =
        lab.controls.iter().filter_map(Control::action).any(|a| {
            [&a.set, &a.apply].into_iter().flatten().any(|text| text.value.contains("opt.timestep"))
        });
    if !sets_timestep {
        let mut timesteps = Vec::new();
        for s in numbers.iter().filter(|s| s.context.contains("step") || s.context.contains("$h$")) {
            let value = si(s);
            let is_time = s.dimension == second().times(s.dimension.factor);
            if is_time
                && value > 0.0
                && value <= LONGEST_TIMESTEP
                && !timesteps.contains(&value)
                && timesteps.len() < VALUES
            {
                timesteps.push(value);
                let words = format!("with a timestep of {value} s");
                let named = Some((value, second()));
                let name = format!("timestep_{}", digits(value));
                all.push(TraceRun { words, name, timestep: Some(value), named, ..base.clone() });
            }
        }
    }
    all.truncate(MOST);
    all
}

/// Adds the runs in which a control has a value that the text names.
fn add_control_trials(control: &Control, numbers: &[Stated], base: &TraceRun, all: &mut Vec<TraceRun>) {
    let label = control.label.as_str();
    match &control.kind {
        ControlKind::Slider { value: start, .. } => {
            let Measure::Dimension(unit) = given_by(control) else { return };
            let mut values: Vec<f64> = Vec::new();
            for s in numbers.iter().filter(|s| s.dimension.agrees(&unit)) {
                let x = round(si(s) * unit.factor);
                let reached = settings::value(control, &Value::Number(x)).is_ok();
                if reached && x != start.value && !values.contains(&x) && values.len() < VALUES {
                    values.push(x);
                    let scalar = Scalar::Number(Number { value: x, span: 0..0 });
                    all.push(TraceRun {
                        words: format!("with \"{label}\" at {x}"),
                        name: named_value(control, &scalar),
                        set: vec![(label.to_string(), scalar)],
                        named: Some((x / unit.factor, unit.times(1.0 / unit.factor))),
                        nominal: Some(start.value / unit.factor),
                        ..base.clone()
                    });
                }
            }
        }
        ControlKind::Select { options, value, .. } => {
            let start = scalar(value);
            for choice in options.iter().filter(|c| scalar(&c.value) != start).take(VALUES) {
                all.push(TraceRun {
                    words: format!("with \"{label}\" at \"{}\"", choice.text.as_str()),
                    name: named_value(control, &choice.value),
                    set: vec![(label.to_string(), choice.value.clone())],
                    label: choice.text.value.clone(),
                    ..base.clone()
                });
            }
        }
        ControlKind::Button { .. } => all.push(TraceRun {
            words: format!("after \"{label}\" is pressed"),
            name: slug(label),
            press: vec![label.to_string()],
            label: label.to_string(),
            ..base.clone()
        }),
    }
}

impl TraceRun {
    /// Whether both runs set the same controls.
    pub(super) fn sets_same_controls(&self, other: &TraceRun) -> bool {
        let labels = |t: &TraceRun| t.set.iter().map(|(label, _)| label.clone()).collect::<Vec<_>>();
        self.timestep.is_some() == other.timestep.is_some() && labels(self) == labels(other)
    }

    /// The statements that run after the setup of the lab.
    pub(crate) fn setup(&self) -> Option<String> {
        let timestep = self.timestep.map(|h| format!("model.opt.timestep = {h}"));
        let all: Vec<String> = self.restored.iter().cloned().chain(timestep).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }

    /// The run in the form of a `verify` object.
    pub(super) fn run(&self, name: &str) -> Run {
        let number = |value: f64| Number { value, span: 0..0 };
        Run {
            name: text(name),
            lab: None,
            model: Vec::new(),
            key: None,
            controller: None,
            set: self.set.iter().map(|(label, value)| (text(label), value.clone())).collect(),
            press: self.press.iter().map(|label| (text(label), number(0.0))).collect(),
            setup: self.setup().map(|statements| text(&statements)),
            until: self.until.map(number),
            steps: None,
            stop: None,
            sweep: None,
            expect: BreakExpectation::None,
            unread_key: None,
        }
    }
}
