//! The dimensions of the numbers in claims, as far as they follow from the units of the inputs.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, BoundScene};
use super::compiled_claim::{ClaimInputs, CompiledClaim};
use super::layout::name_of_axis;
use super::measure_units::MeasureUnits;
use super::outcome::MeasuredRuns;
use super::outcome_names::OutcomeNames;
use super::run_cache::BoundLab;
use crate::bind::Scope;
use crate::bind::{given, given_by};
use crate::source::Text;
use crate::spec::SweepAxis;
use labspec_bind::units;
use labspec_expr::Compiler;
use labspec_expr::dimension::{BASES, Dimension, Measure};

impl BoundVerify<'_> {
    /// The known dimensions of the measures.
    pub(super) fn units(&self) -> Option<&MeasureUnits> {
        self.units.get_or_init(|| units_of_measures(self)).as_ref()
    }
}

fn units_of_measures(bound: &BoundVerify<'_>) -> Option<MeasureUnits> {
    let BoundLab { lab, model, programs, .. } = bound.lab()?;
    let runs = bound
        .runs_with_scenes()
        .map(|(run, scene)| of_scene(scene).into_iter().chain(swept(run, scene)).collect());
    let runs = runs.collect();
    Some(MeasureUnits { given: given(lab, model, programs), runs })
}

/// The dimension of a claim; `None` where it is not certain.
pub(super) fn of_claim(bound: &BoundVerify<'_>, outcome: &MeasuredRuns, text: &Text) -> Option<Dimension> {
    let (base, units, claim) = (bound.base()?, bound.units()?, bound.claim(text)?);
    let names = OutcomeNames::new(bound.layout(), base.names(Scope::Measure)).measuring(&units.runs);
    let nothing = |d: &Dimension| d.is_number() && d.factor.is_nan();
    match claim.program.as_ref()?.measured(&names, &units.given).value {
        Measure::Dimension(dimension) if !nothing(&dimension) => Some(dimension),
        Measure::Dimension(dimension) => by_scale(bound, outcome, &claim, units).or(Some(dimension)),
        _ => by_scale(bound, outcome, &claim, units),
    }
}

/// The unit of a measure of a run; `None` where it has none, or is not certain.
pub(super) fn of_measure(bound: &BoundVerify<'_>, run: usize, measure: usize) -> Option<String> {
    let (_, measure) = bound.units()?.runs.get(run)?.get(measure)?;
    match measure {
        Measure::Dimension(d) if !d.is_number() && !d.factor.is_nan() => Some(units::written(d)),
        _ => None,
    }
}

/// Factors by which base units are divided.
const SCALES: [f64; 2] = [2.0, 3.0];

/// The dimension of a claim, determined by evaluating it in other units: if all inputs are in half seconds instead of
/// seconds, a time is twice as large, whatever the text computes. Applies only to texts without number literals that could
/// be quantities themselves.
fn by_scale(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    claim: &CompiledClaim,
    units: &MeasureUnits,
) -> Option<Dimension> {
    let on_the_spot = !claim.program.as_ref()?.aggregates().is_empty();
    if on_the_spot || claim.reads.is_empty() || claim.constants.iter().any(|x| ![0.0, 1.0].contains(x)) {
        return None;
    }
    let inputs = claim.inputs(bound, outcome, Vec::new());
    let value = |inputs: &ClaimInputs| {
        let traced = claim.evaluate(bound, inputs, None)?.ok().filter(|t| t.lost.is_none())?;
        Some(traced.value.to_number()).filter(|x| x.is_finite() && *x != 0.0)
    };
    let measure = |place: &usize| match bound.layout().unit_of(*place, &units.runs) {
        Measure::Dimension(d) if d.is_exact() => Some((*place, d)),
        _ => None,
    };
    let measures: Vec<(usize, Dimension)> = claim.reads.iter().map(measure).collect::<Option<_>>()?;
    let current = value(&inputs)?;
    let mut all = Dimension::NUMBER;
    for base in 0..BASES {
        let mut powers = SCALES.iter().map(|scale| {
            let mut other = inputs.clone();
            for (place, d) in &measures {
                other.set_value(*place, inputs.at(*place)? * scale.powf(d.power_of(base)));
            }
            let ratio = value(&other)? / current;
            (ratio > 0.0).then(|| ratio.ln() / scale.ln())
        });
        let (first, second) = (powers.next()??, powers.next()??);
        let sixths = (6.0 * first).round();
        if (6.0 * first - sixths).abs() > 1e-3 || (first - second).abs() > 1e-4 {
            return None;
        }
        all = all.product(Dimension::base(base).power(sixths / 6.0)?)?;
    }
    Some(all)
}

/// The dimensions of the values of a sweep, with the names by which conditions read them.
fn swept(run: &BoundRun<'_>, scene: &BoundScene<'_>) -> Vec<(String, Measure)> {
    let axes = run
        .spec
        .and_then(|spec| spec.sweep.as_ref())
        .filter(|sweep| sweep.is_list())
        .map_or(&[][..], |sweep| &sweep.axes);
    let of_axis = |(i, axis): (usize, &SweepAxis)| Some((name_of_axis(i), of_axis(run, scene, &axis.what)?));
    axes.iter().enumerate().filter_map(of_axis).collect()
}

/// The dimension of the values of one axis of a sweep.
fn of_axis(run: &BoundRun<'_>, scene: &BoundScene<'_>, what: &Text) -> Option<Measure> {
    let lab = &scene.scene.lab;
    let is_control = run.controls.iter().any(|(label, _)| label.as_str() == what.as_str());
    let measure = match lab.controls.iter().find(|c| is_control && c.label.as_str() == what.as_str()) {
        Some(control) => match given_by(control) {
            Measure::Unknown => {
                let names = scene.names(Scope::Measure);
                let mut globals = scene.globals.clone();
                let set = control.action()?.set.as_ref()?;
                let given = given(lab, &scene.scene.model, &scene.scene.programs);
                let field = Compiler::new(&names, &mut globals).expression(&set.value).program?;
                field.measured(&names, &given).value
            }
            measure => measure,
        },
        None => Measure::Dimension(units::parse(match what.as_str().rsplit(' ').next()? {
            "timestep" => "s",
            "mass" => "kg",
            "size" | "pos" => "m",
            "density" => "kg/m^3",
            _ => return None,
        })?),
    };
    Some(measure)
}

fn of_scene(scene: &BoundScene<'_>) -> Vec<(String, Measure)> {
    let given = given(&scene.scene.lab, &scene.scene.model, &scene.scene.programs);
    let names = scene.names(Scope::Measure);
    let measures = scene.measures.iter();
    measures.map(|(name, m)| (name.to_string(), m.program.measured(&names, &given).value)).collect()
}
