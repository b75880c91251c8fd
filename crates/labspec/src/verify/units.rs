//! What the numbers of claims measure, as far as the units of what they are computed from say it.

use super::bound::{BoundRun, BoundScene, BoundVerify};
use super::outcome::{OutcomeNames, Units};
use crate::bind::Scope;
use crate::bind::{given, given_by};
use crate::source::Text;
use crate::verify::Scene;
use labspec_bind::units;
use labspec_expr::dimension::{Dimension, Measure};
use labspec_expr::{Compiler, Given};

/// What is known of the numbers that claims read.
#[derive(Debug)]
pub(super) struct Known {
    given: Given,
    runs: Units,
}

impl Known {
    pub(super) fn of(bound: &BoundVerify<'_>) -> Option<Known> {
        let Scene { lab, model, programs, .. } = bound.lab()?;
        let runs =
            bound.cast().map(|(run, scene)| of_scene(scene).into_iter().chain(swept(run, scene)).collect());
        let runs = runs.collect();
        Some(Known { given: given(lab, model, programs), runs })
    }
}

/// What a claim measures; `None` where that is not certain.
pub(super) fn of_claim(bound: &BoundVerify<'_>, text: &Text) -> Option<Dimension> {
    let (base, known, claim) = (bound.base()?, bound.units()?, bound.claim(text)?);
    let names = OutcomeNames::new(bound.layout(), base.names(Scope::Measure)).measuring(&known.runs);
    match claim.program.as_ref()?.measured(&names, &known.given).value {
        Measure::Known(dimension) => Some(dimension),
        _ => None,
    }
}

/// What the values of a sweep are, under the name by which conditions read them.
fn swept(run: &BoundRun<'_>, scene: &BoundScene<'_>) -> Option<(String, Measure)> {
    let what = &run.spec?.sweep.as_ref()?.what;
    let lab = &scene.scene.lab;
    let measure =
        match lab.controls.iter().find(|c| run.control.is_some() && c.label.as_str() == what.as_str()) {
            Some(control) => match given_by(control) {
                Measure::Unknown => {
                    let names = scene.names(Scope::Measure);
                    let mut globals = scene.globals.clone();
                    let set = control.action()?.set.as_ref()?;
                    let given = given(lab, &scene.scene.model, &scene.scene.programs);
                    let field = Compiler::new(&names, &mut globals).expression(&set.value).program?;
                    field.measured(&names, &given).value
                }
                known => known,
            },
            None => Measure::Known(units::parse(match what.as_str().rsplit(' ').next()? {
                "timestep" => "s",
                "mass" => "kg",
                "size" | "pos" => "m",
                "density" => "kg/m^3",
                _ => return None,
            })?),
        };
    Some(("value".to_string(), measure))
}

fn of_scene(scene: &BoundScene<'_>) -> Vec<(String, Measure)> {
    let given = given(&scene.scene.lab, &scene.scene.model, &scene.scene.programs);
    let names = scene.names(Scope::Measure);
    let measures = scene.measures.iter();
    measures.map(|(name, m)| (name.to_string(), m.program.measured(&names, &given).value)).collect()
}
