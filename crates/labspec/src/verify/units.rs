//! What the numbers of claims measure, as far as the units of what they are computed from say it.

use super::bound::{BoundScene, BoundVerify};
use super::outcome::{OutcomeNames, Units};
use crate::bind::Scope;
use crate::bind::given;
use crate::source::Text;
use crate::verify::Scene;
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
        let runs = bound.cast().map(|(_, scene)| of_scene(scene)).collect();
        Some(Known { given: given(lab, model, programs), runs })
    }
}

/// What a claim measures; `None` where that is not certain.
pub(super) fn of_claim(bound: &BoundVerify<'_>, text: &Text) -> Option<Dimension> {
    let (base, known) = (bound.base()?, bound.units()?);
    let names = OutcomeNames::new(bound.layout(), base.names(Scope::Measure)).measuring(&known.runs);
    let mut globals = base.globals.clone();
    let compiled = Compiler::new(&names, &mut globals).measuring(&known.given).expression(&text.value);
    match compiled.measured?.value {
        Measure::Known(dimension) => Some(dimension),
        _ => None,
    }
}

fn of_scene(scene: &BoundScene<'_>) -> Vec<(String, Measure)> {
    let given = given(&scene.scene.lab, &scene.scene.model, &scene.scene.programs);
    let names = scene.names(Scope::Measure);
    let one = |text: &Text| {
        let mut globals = scene.globals.clone();
        Compiler::new(&names, &mut globals).measuring(&given).expression(&text.value).measured
    };
    let measures = scene.measures.iter();
    measures.map(|(name, m)| (name.to_string(), one(m.text).unwrap_or_default().value)).collect()
}
