//! The MJCF compiler: XML text to a [`Model`], with MuJoCo 3.14.0's names, defaults and conventions.
//!
//! The passes, one file each: `load` (`files`, `scan` for limits, `xml`, `tree` checked against the one `schema`) →
//! `expand` (copies) → `defaults`, `names` → `settings`, `read_*` (specifications in our own terms, `spec`) → `inertia`, `layout` → `fill`.
//! A pass reports what it finds and goes on, so that one run shows all mistakes; passes that would only
//! repeat an earlier finding in other words wait until that is corrected.
//!
//! The meaning of elements and attributes follows MuJoCo's XML reference; the file's own places are in
//! [`MjcfDiagnostic`].

mod check_actuator;
mod defaults;
mod diagnostic;
mod expand;
mod files;
mod fill;
mod fill_actuator;
mod fill_asset;
mod fill_constraint;
mod fill_scene;
mod fill_tendon;
mod frame;
mod hfield;
mod ids;
mod inertia;
mod layout;
mod limits;
mod load;
mod mesh;
mod names;
mod nearest;
mod orientation;
mod read_actuator;
mod read_asset;
mod read_body;
mod read_contact;
mod read_equality;
mod read_form;
mod read_geom;
mod read_joint;
mod read_key;
mod read_scene;
mod read_sensor;
mod read_tendon;
mod reshape;
mod scan;
mod schema;
#[cfg(test)]
mod seen;
mod settings;
mod shapes;
mod shortcut;
mod shortcut_motor;
mod skin;
mod sleep;
mod spec;
#[cfg(test)]
mod tests;
mod tree;
mod unsimulated;
mod values;
mod xml;

use std::io::Read;
use std::path::Path;

use crate::Model;
use diagnostic::Report;

pub use diagnostic::{MjcfDiagnostic, MjcfFileError, Severity, code};
pub use files::{FileProblem, Files, Folder, MAX_FILE, NoFiles};
pub use schema::{Attr, Element, Kind, SchemaRow, Status, Word, schema_rows};

/// Largest text that is read, bytes.
pub const MAX_TEXT: usize = 16 << 20;
/// Deepest nesting of elements.
pub const MAX_DEPTH: usize = 1000;
/// Largest number of elements.
pub const MAX_ELEMENTS: usize = 200_000;
/// Largest number of degrees of freedom.
pub const MAX_DOFS: usize = 12_000;
/// Largest number of entries of the mass matrix: a chain of 1500 degrees of freedom, or many trees.
pub const MAX_MASS: usize = 1_200_000;
/// Largest number of geoms.
pub const MAX_GEOMS: usize = 5000;
/// Largest number of attributes of an element.
pub const MAX_ATTRIBUTES: usize = 200;
/// Largest number of attributes of all elements.
pub const MAX_ALL_ATTRIBUTES: usize = 1_000_000;

/// Compiles a model from its text. It can name no files: [`compile_with`] and [`compile_file`] let it.
///
/// # Errors
///
/// All mistakes that were found, in the order of the text.
pub fn compile(xml: &str) -> Result<Model, Vec<MjcfDiagnostic>> {
    compile_with(xml, &NoFiles, None)
}

/// Compiles a model from its text and the files that it names, which come from `files`. `path` is where `files` has
/// the text itself, if it has it: what it names is looked for in that folder.
///
/// # Errors
///
/// All mistakes that were found, in the order of the texts. [`examine`] tells warnings, too.
pub fn compile_with(xml: &str, files: &dyn Files, path: Option<&str>) -> Result<Model, Vec<MjcfDiagnostic>> {
    let Examined { model, mut findings } = examine(xml, files, path);
    findings.retain(|d| d.severity == Severity::Error);
    model.ok_or(findings)
}

/// What came of a model's text.
#[derive(Clone, Debug)]
pub struct Examined {
    /// The model; `None` when there are errors.
    pub model: Option<Model>,
    /// Errors and warnings in the order of the texts.
    pub findings: Vec<MjcfDiagnostic>,
}

/// Compiles a model as [`compile_with`] does, and tells what it may not be meant to be, besides what is wrong.
pub fn examine(xml: &str, files: &dyn Files, path: Option<&str>) -> Examined {
    let mut report = Report::new();
    let model = build(xml, files, path, &mut report).and_then(|(tree, model)| {
        unsimulated::check(&tree, &model, &mut report);
        report.is_clean().then_some(model)
    });
    Examined { model, findings: report.finish() }
}

/// Compiles a model that may hold what is not simulated yet.
#[cfg(test)]
pub(crate) fn compile_only(xml: &str, files: &dyn Files) -> Result<Model, Vec<MjcfDiagnostic>> {
    let mut report = Report::new();
    match build(xml, files, None, &mut report) {
        Some((_, model)) if report.is_clean() => Ok(model),
        _ => Err(report.finish()),
    }
}

/// Compiles a model from a file, with what it names in the folder of that file and below.
///
/// # Errors
///
/// The file cannot be read, is too large, is not UTF-8, or the model has mistakes.
pub fn compile_file(path: &Path) -> Result<Model, MjcfFileError> {
    let owned = || path.to_path_buf();
    let io = |error| MjcfFileError::Io { path: owned(), error };
    let mut bytes = Vec::new();
    // One byte more than the limit tells a file that is too large, whatever its metadata say.
    std::fs::File::open(path).map_err(io)?.take(MAX_TEXT as u64 + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() > MAX_TEXT {
        return Err(MjcfFileError::TooLarge { path: owned() });
    }
    let text = String::from_utf8(bytes)
        .map_err(|e| MjcfFileError::NotUtf8 { path: owned(), offset: e.utf8_error().valid_up_to() })?;
    let folder = Folder::new(path.parent().unwrap_or(Path::new(""))).map_err(io)?;
    compile_with(&text, &folder, path.file_name().and_then(|name| name.to_str()))
        .map_err(|diagnostics| MjcfFileError::Model { path: owned(), diagnostics })
}

/// All passes. `None` when something is wrong; then the report says what.
fn build(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    report: &mut Report,
) -> Option<(tree::Tree, Model)> {
    let written = load::Loader::new(files).model(xml.into(), path, report)?;
    let expand::Expanded { tree, parts } = expand::model(written, report);
    let classes = defaults::Classes::read(&tree, report);
    let names = names::NameTable::read(&tree, report);
    names::check_references(&tree, &names, &classes, report);
    orientation::check_forms(&tree, report);

    let options = settings::options(&tree, report);
    let statistic = settings::StatisticOverride::read(&tree, report);
    let min_keys = settings::min_keys(&tree);
    let compiler = &parts.first()?.compiler;
    let mut assets = read_asset::Assets::read(&tree, &classes, &parts, files, report);
    let mut cx = read_body::Context {
        tree: &tree,
        classes: &classes,
        parts: &parts,
        assets: &assets,
        compiler,
        report,
    };
    let mut bodies = read_body::bodies(&mut cx);
    layout::check(&bodies, &layout::number(&bodies), report);
    let mut inertias = Vec::new();
    // A refused geom would also be a missing mass.
    if report.is_clean() {
        inertias = inertia::bodies(&bodies, &parts, report);
        reshape::apply(&mut bodies, &mut inertias, &tree, &parts);
    }
    let layout = layout::number(&bodies);
    assets.check_bones(&bodies, &names, report);
    sleep::check(&bodies, &layout, report);
    let ids = ids::Ids::number(&tree, &bodies);
    let refs = ids::References { names: &names, ids: &ids };
    let mut cx = read_body::Context {
        tree: &tree,
        classes: &classes,
        parts: &parts,
        assets: &assets,
        compiler,
        report,
    };
    let tendons = read_tendon::tendons(&mut cx, refs);
    let actuators = read_actuator::actuators(&mut cx, refs, &bodies, &tendons);
    let equalities = read_equality::equalities(&mut cx, refs);
    let (pairs, excludes) = read_contact::contacts(&mut cx, refs, &bodies);
    let mut scene = fill_scene::Scene {
        materials: read_scene::materials(&cx),
        textures: read_scene::textures(&tree),
        numerics: read_scene::numerics(&mut cx),
        texts: read_scene::texts(&tree, cx.report),
        tuples: read_scene::tuples(&mut cx, refs),
    };
    if compiler.discardvisual {
        for light in bodies.iter().flat_map(|b| &b.lights).filter(|l| l.texture.is_some()) {
            let message =
                format!("light `{}` has a texture, and `discardvisual` removes all textures", light.name);
            cx.report.error(code::CONFLICT, light.span.clone(), message).help("remove the one or the other");
        }
        for skin in &assets.skins {
            if skin.value.as_ref().is_some_and(|s| s.material.is_some()) {
                let message =
                    format!("skin `{}` has a material, and `discardvisual` removes all materials", skin.name);
                cx.report
                    .error(code::CONFLICT, skin.span.clone(), message)
                    .help("remove the one or the other");
            }
        }
        (scene.materials, scene.textures) = Default::default();
    }
    settings::memory(&tree, report);
    assets.hulls(&bodies, &pairs, report);
    classes.check_room(report);
    let sensors = read_sensor::sensors(&tree, refs, &tendons, report);
    let actuator_users: Vec<_> = actuators.iter().map(fill_actuator::user).collect();
    let users = fill::Users {
        body: settings::user_width(&tree, "nuser_body", bodies.iter().map(|b| &b.user), report),
        joint: settings::user_width(
            &tree,
            "nuser_jnt",
            bodies.iter().flat_map(|b| &b.joints).map(|j| &j.user),
            report,
        ),
        geom: settings::user_width(
            &tree,
            "nuser_geom",
            bodies.iter().flat_map(|b| &b.geoms).map(|g| &g.user),
            report,
        ),
        site: settings::user_width(
            &tree,
            "nuser_site",
            bodies.iter().flat_map(|b| &b.sites).map(|s| &s.user),
            report,
        ),
        camera: settings::user_width(
            &tree,
            "nuser_cam",
            bodies.iter().flat_map(|b| &b.cameras).map(|c| &c.user),
            report,
        ),
        tendon: settings::user_width(&tree, "nuser_tendon", tendons.iter().map(|t| &t.user), report),
        sensor: settings::user_width(&tree, "nuser_sensor", sensors.iter().map(|s| &s.user), report),
        data: settings::userdata(&tree, report),
        actuator: settings::user_width(&tree, "nuser_actuator", actuator_users.iter(), report),
    };
    if !report.is_clean() {
        return None;
    }

    // What follows depends on everything being read.
    let counts = fill_actuator::count(&actuators, report);
    let sizes = fill::Sizes {
        nq: layout.nq,
        nv: layout.dofs.len(),
        nmocap: layout.nmocap,
        na: counts.na,
        nu: counts.nu,
    };
    let keys = read_key::keys(&tree, &sizes, min_keys, report);
    inertia::check_moving(&bodies, &layout.weld, &inertias, report);
    if !report.is_clean() {
        return None;
    }
    let mut simple = layout::simple(&bodies, &inertias);
    fill_tendon::demote_simple(&mut simple, &bodies, &tendons, &actuators);
    let pattern = layout::pattern(&layout, &simple, report)?;
    let whole = layout::whole_pattern(&layout, report)?;

    let mut m = Model { opt: options, ..Model::default() };
    m.names.model = settings::model_name(&tree);
    let parts = fill::Parts {
        bodies: &bodies,
        inertias: &inertias,
        layout: &layout,
        simple: &simple,
        pattern,
        whole,
        tendons: &tendons,
        actuators: &actuators,
        counts,
        equalities: &equalities,
        pairs: &pairs,
        excludes: &excludes,
        users,
        scene: &scene,
        assets: &assets,
        sensors: &sensors,
        keys: &keys,
    };
    fill::model(&mut m, parts);
    fill_tendon::pattern(&mut m, &tendons, report)?;
    fill_actuator::pattern(&mut m, &actuators, report)?;
    sleep::policies(&mut m, &bodies);
    reshape::total_mass(&mut m, compiler);
    crate::setup::setconst::set_const0(&mut m);
    fill::spring_dampers(&mut m, &bodies);
    fill_actuator::length_ranges(&mut m, &actuators, &settings::length_range(&tree), report);
    statistic.apply(&mut m.stat);
    Some((tree, m))
}
