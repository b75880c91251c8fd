//! Error against run time: the standard set shows the theoretical orders, and the recommendations of `precision`
//! hold in an independent run.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::population::{minimum, sample};
use crate::support::workspace;
use labspec::bind::Programs;
use labspec::bind::scene::Models;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::run::{self, Cell, RunOptions, Table};
use labspec::run::{INTEGRATORS, Integrator};
use labspec::source::SourceFile;
use labspec::spec::Lab;
use labspec_core::{Model, integrator};
use labspec_numerics::precision::{
    AdviceKind, PrecisionOptions, PrecisionResults, PrecisionRow, RunStatus, Setting, compare,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A lab with its model.
struct LoadedLab {
    lab: Lab,
    model: Arc<Model>,
}

fn load_lab(path: &Path, models: ModelFolder) -> LoadedLab {
    load_labs(path, models).remove(0)
}

fn load_labs(path: &Path, models: ModelFolder) -> Vec<LoadedLab> {
    let lesson = load_lesson(SourceFile::read(path).unwrap(), &models);
    let models = Models::new(models);
    let one =
        |lab: &Lab| LoadedLab { lab: lab.clone(), model: models.model_of_lab(lab, &mut Vec::new()).unwrap() };
    lesson.addressed().iter().map(|(_, lab)| one(lab)).collect()
}

impl LoadedLab {
    fn compare(&self, options: &PrecisionOptions) -> PrecisionResults {
        let mut findings = Vec::new();
        let programs = Programs::compile(&self.lab, &self.model, &mut findings);
        compare(&self.lab, &self.model, &programs, options, &mut findings, &mut |_| ()).unwrap()
    }

    /// Runs the lab as `run` does, with other numerics, sampled after every `every` steps.
    fn run(&self, integrator: i32, timestep: f64, length: f64, every: usize) -> Table {
        let mut model = Model::clone(&self.model);
        (*model.edit().opt.timestep, *model.edit().opt.integrator) = (timestep, integrator);
        // A slider for the timestep would set its own value.
        let mut lab = self.lab.clone();
        lab.controls.retain(|c| !format!("{:?}", c.kind).contains("opt.timestep"));
        let programs = Programs::compile(&lab, &model, &mut Vec::new());
        let options = RunOptions { until: Some(length), every, ..RunOptions::default() };
        run::run(&lab, &model, &programs, &options).unwrap()
    }
}

fn standard() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(workspace().join("tests/precision")).unwrap();
    let mut labs: Vec<PathBuf> = folder.map(|e| e.unwrap().path()).collect();
    labs.retain(|p| p.extension().is_some_and(|e| e == "json"));
    labs.sort();
    labs
}

/// The observed order of a method at the shortest timesteps with errors above rounding.
fn order(report: &PrecisionResults, id: i32) -> f64 {
    let rows = report.rows.iter().filter(|r| r.setting.integrator.id == id && r.status == RunStatus::Good);
    rows.filter_map(|r| r.errors[0].order).next_back().unwrap()
}

#[test]
fn orders_are_those_of_theory() {
    use integrator::{DISCRETE, EULER, GAUSS, IMPLICIT, RK4, RKMK4, RKMK8};
    // The Runge–Kutta method has order two if bodies rotate in space.
    let expected: [(&str, &[(i32, f64)]); 5] = [
        ("01", &[(EULER, 1.0), (IMPLICIT, 1.0), (DISCRETE, 1.0)]),
        ("02", &[(EULER, 1.0), (IMPLICIT, 1.0), (RK4, 4.0), (RKMK4, 4.0)]),
        ("04", &[(RK4, 2.0), (RKMK4, 4.0), (GAUSS, 6.0)]),
        ("05", &[(EULER, 1.0), (RK4, 2.0), (RKMK4, 4.0)]),
        ("09", &[(RK4, 4.0), (RKMK8, 8.0), (GAUSS, 6.0)]),
    ];
    let labs = standard();
    for (name, orders) in expected {
        let path = labs.iter().find(|p| p.file_name().unwrap().to_str().unwrap().starts_with(name)).unwrap();
        let ids = |i: &Integrator| orders.iter().any(|(id, _)| *id == i.id);
        let integrators = INTEGRATORS.into_iter().filter(ids).collect();
        let report = load_lab(path, ModelFolder::unknown())
            .compare(&PrecisionOptions { integrators, ..PrecisionOptions::default() });
        for (id, theory) in orders {
            let seen = order(&report, *id);
            // At timesteps at which the error of order eight is above rounding, higher-order terms contribute: the observed
            // order is slightly larger.
            let beyond = if *id == RKMK8 { 0.3 } else { 0.1 };
            assert!(
                seen > theory - 0.1 && seen < theory + beyond,
                "{name}: integrator {id} shows {seen}, not {theory}"
            );
        }
    }
}

#[test]
fn measures_of_lessons_are_ten_times_more_accurate() {
    let labs = standard();
    let all = PrecisionOptions { integrators: INTEGRATORS.to_vec(), ..PrecisionOptions::default() };
    for name in ["03_double_pendulum", "05_tumbling_box"] {
        let path = labs.iter().find(|p| p.file_stem().is_some_and(|s| s == name)).unwrap();
        let report = load_lab(path, ModelFolder::unknown()).compare(&all);
        // In the engine's count of work, which is the same on every machine.
        let good = |shared: bool| {
            report
                .rows
                .iter()
                .filter(move |r| r.setting.integrator.shared == shared && r.status == RunStatus::Good)
        };
        let mut compared = 0;
        for runge_kutta in good(true).filter(|r| r.setting.integrator.id == integrator::RK4) {
            let affordable = good(false).filter(|r| r.cost.work <= 1.1 * runge_kutta.cost.work);
            let best = affordable.map(|r| r.errors[0].largest).fold(f64::INFINITY, f64::min);
            if best.is_finite() && runge_kutta.setting.timestep <= 2e-3 {
                let error = runge_kutta.errors[0].largest;
                assert!(10.0 * best <= error, "{name}: {:?}: {best} for {error}", runge_kutta.setting);
                compared += 1;
            }
        }
        assert!(compared >= 4, "{name}: {compared}");
    }
}

/// Compares the recommended setting with a Runge–Kutta run with much shorter steps, both performed as on a page. Returns
/// `false` if the lab's own code sets the timestep at the start, so that it cannot be changed.
fn advice_holds(name: &str, lab: &LoadedLab, report: &PrecisionResults, setting: &Setting) -> bool {
    let timestep = lab.model.opt.timestep;
    let fine = timestep.min(setting.timestep) / 8.0;
    let every = (setting.timestep / fine).round() as usize;
    // Long steps may not divide the run: compared up to the last whole one.
    let length = setting.timestep * (report.length / setting.timestep + 1e-9).floor();
    let coarse = lab.run(setting.integrator.id, setting.timestep, length, 1);
    let time = |k: usize| if let Cell::Number(t) = coarse.rows[k][0] { t } else { f64::NAN };
    if (time(1) - time(0) - setting.timestep).abs() > 1e-9 {
        return false;
    }
    let truth = lab.run(integrator::RK4, fine, length, every);
    for target in report.targets.iter().filter(|t| t.is_compared()) {
        let start = if target.readout { "readout/" } else { "plot/" };
        let is = |c: &String| c.starts_with(start) && c.ends_with(&format!("/{}", target.label));
        let column = coarse.columns.iter().position(is).unwrap();
        let number = |row: &Vec<Cell>| if let Cell::Number(x) = row[column] { x } else { f64::NAN };
        let pairs = coarse.rows.iter().zip(&truth.rows).map(|(a, b)| (number(a) - number(b)).abs());
        // Every sample counts. Equal digits differ by less than one unit, which is twice the invisible error.
        let error = pairs.fold(0.0, f64::max);
        let most = if target.readout { 2.0 } else { 1.5 } * target.invisible_error;
        assert!(error <= most, "{name}: {}: {error} for {}", target.label, target.invisible_error);
    }
    true
}

/// One of this many labs is in a sample.
const STEP: usize = 8;

#[test]
fn advice_holds_in_an_independent_run() {
    if !needs("../shared/corpus") {
        return;
    }
    let corpus = workspace().join("../shared/corpus");
    let models = || ModelFolder::open(&corpus.join("models")).unwrap();
    let mut labs: Vec<PathBuf> =
        std::fs::read_dir(corpus.join("labs")).unwrap().map(|e| e.unwrap().path()).collect();
    labs.retain(|p| p.extension().is_some_and(|e| e == "json"));
    labs.sort();
    let (mut held, mut tried) = (0, 0);
    // The chain and the stack take long, and are not labs.
    let mut all: Vec<(PathBuf, LoadedLab)> = labs
        .into_iter()
        .chain(standard().into_iter().take(9))
        .map(|p| (p.clone(), load_lab(&p, models())))
        .collect();
    for lesson in ["01-what-a-step-computes", "02-bounce-and-swing"] {
        let path = workspace().join(format!("specs/lessons/{lesson}.md"));
        let models = ModelFolder::open(&workspace().join("specs/models")).unwrap();
        all.extend(load_labs(&path, models).into_iter().map(|lab| (path.clone(), lab)));
    }
    for (path, lab) in sample(all, STEP) {
        let name = path.file_stem().unwrap().to_str().unwrap().to_string();
        let report = lab.compare(&PrecisionOptions { until: Some(1.0), ..PrecisionOptions::default() });
        if !report.advice.iter().any(|a| a.kind == AdviceKind::Right) {
            continue;
        }
        // The recommended setting is the cheapest by run time, which on a busy machine may be any of the correct ones.
        let shorter = |r: &PrecisionRow, than: &PrecisionRow| {
            r.setting.integrator.id == than.setting.integrator.id
                && r.setting.timestep <= than.setting.timestep
        };
        let right = |r: &PrecisionRow| r.status == RunStatus::Good && r.score <= 1.0;
        let shared = report.rows.iter().filter(|r| r.setting.integrator.shared);
        let good: Vec<&PrecisionRow> =
            shared.filter(|r| report.rows.iter().filter(|s| shorter(s, r)).all(right)).collect();
        let holding = good.iter().filter(|r| advice_holds(&name, &lab, &report, &r.setting)).count();
        tried += holding;
        held += usize::from(holding == good.len());
    }
    println!("{tried} settings of {held} labs");
    assert!(held >= minimum(20, STEP) && tried >= minimum(200, STEP), "{held}, {tried}");
}
