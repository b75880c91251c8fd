//! The passes of the compiler, in order.

use super::actuator::{fill_actuator, read_actuator};
use super::asset::read_asset::Assets;
use super::asset::read_texture;
use super::body::{inertia, orientation, read_body, sleep_policy};
use super::classes::Classes;
use super::constraint::{read_contact, read_equality};
use super::context::Context;
use super::expand::AttachedModel;
use super::geom::reshape;
use super::names::NameTable;
use super::scene::fill_scene::SceneFields;
use super::scene::{read_key, read_scene};
use super::sensor::read_sensor;
use super::spec::{
    ActuatorSpec, BodySpec, EqualitySpec, ExcludeSpec, Inertia, NumberList, PairSpec, SensorSpec, TendonSpec,
};
use super::tendon::{fill_tendon, read_tendon};
use super::text::diagnostic::Diagnostics;
use super::text::{load, tree};
use super::{expand, fill, ids, layout, names, settings};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::model::Model;
use crate::source::files::Files;
use crate::source::model_patch::{Patch, Refusal};

/// The checked text of a model, from which the specifications are read.
struct SpecInputs<'a> {
    tree: &'a tree::ElementTree,
    classes: &'a Classes,
    names: &'a NameTable<'a>,
    /// The models that form the whole. The main model is the first.
    parts: &'a [AttachedModel],
}

/// The specification of every object.
struct Specs {
    bodies: Vec<BodySpec>,
    inertias: Vec<Inertia>,
    layout: layout::TreeLayout,
    tendons: Vec<TendonSpec>,
    actuators: Vec<ActuatorSpec>,
    equalities: Vec<EqualitySpec>,
    pairs: Vec<PairSpec>,
    excludes: Vec<ExcludeSpec>,
    scene: SceneFields,
    sensors: Vec<SensorSpec>,
    users: fill::Users,
}

/// Runs all passes. `None`, with errors in the report, if the model is invalid.
pub(super) fn build(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    (patches, refusals): (&[Patch], &mut Vec<Option<Refusal>>),
    report: &mut Diagnostics,
) -> Option<(tree::ElementTree, Model)> {
    let mut loader = load::Loader::new(files, patches);
    let written = loader.model(xml.into(), path, report);
    *refusals = loader.refusals();
    let written = written?;
    let expand::Expanded { tree, parts } = expand::model(written, report);
    let classes = Classes::read(&tree, report);
    let names = NameTable::read(&tree, report);
    names::check_references(&tree, &names, &classes, report);
    orientation::check_forms(&tree, report);

    let options = settings::options(&tree, report);
    let statistic = settings::StatisticOverride::read(&tree, report);
    let min_keys = settings::min_keys(&tree);
    let mut assets = Assets::read(&tree, &classes, &parts, files, report);
    let source = SpecInputs { tree: &tree, classes: &classes, names: &names, parts: &parts };
    let specs = read_specs(&source, &mut assets, report)?;
    if !report.is_clean() {
        return None;
    }

    // The following passes require that every object has been read.
    let mut m = Model::default();
    m.names.model = settings::model_name(&tree);
    m.opt = options;
    fill_model(&mut m, &tree, &specs, &assets, min_keys, report)?;
    compute_constants(&mut m, &source, &specs, report)?;
    statistic.apply(&mut m.stat);
    Some((tree, m))
}

/// Reads every object, each kind after the kinds that it refers to. `None` if there is no model.
fn read_specs(source: &SpecInputs, assets: &mut Assets, report: &mut Diagnostics) -> Option<Specs> {
    let &SpecInputs { tree, classes, names, parts } = source;
    let compiler = &parts.first()?.compiler;
    let mut bodies =
        read_body::bodies(&mut Context { tree, classes, parts, assets, compiler, report: &mut *report });
    layout::check_sizes(&bodies, &layout::number(&bodies), report);
    let mut inertias = Vec::new();
    // A refused geom would cause a second error, a missing mass.
    if report.is_clean() {
        inertias = inertia::bodies(&bodies, parts, report);
        reshape::apply(&mut bodies, &mut inertias, tree, parts);
    }
    let layout = layout::number(&bodies);
    assets.check_bones(&bodies, names, report);
    sleep_policy::check_policies(&bodies, &layout, report);
    let ids = ids::Ids::number(tree, &bodies);
    let refs = ids::References { names, ids: &ids };
    let mut cx = Context { tree, classes, parts, assets, compiler, report: &mut *report };
    let tendons = read_tendon::tendons(&mut cx, refs);
    let actuators = read_actuator::actuators(&mut cx, refs, &bodies, &tendons);
    read_tendon::check_rotors(&tendons, &actuators, cx.report);
    let equalities = read_equality::equalities(&mut cx, refs);
    let (pairs, excludes) = read_contact::contacts(&mut cx, refs, &bodies);
    let scene = read_scene_fields(&mut cx, refs, &bodies, compiler.discardvisual);
    settings::memory(tree, report);
    assets.hulls(&bodies, &pairs, report);
    classes.report_exceeded_budget(report);
    let sensors = read_sensor::sensors(tree, refs, &tendons, report);
    let users = user_widths(tree, &bodies, &tendons, &actuators, &sensors, report);
    Some(Specs {
        bodies,
        inertias,
        layout,
        tendons,
        actuators,
        equalities,
        pairs,
        excludes,
        scene,
        sensors,
        users,
    })
}

/// Reads materials, textures and custom data. `discardvisual` removes materials and textures; remaining references to them are
/// reported.
fn read_scene_fields(
    cx: &mut Context,
    refs: ids::References,
    bodies: &[BodySpec],
    discardvisual: bool,
) -> SceneFields {
    let mut scene = SceneFields {
        materials: read_scene::materials(cx),
        textures: read_texture::textures(cx),
        numerics: read_scene::numerics(cx),
        texts: read_scene::texts(cx.tree, cx.report),
        tuples: read_scene::tuples(cx, refs),
    };
    if discardvisual {
        for light in bodies.iter().flat_map(|b| &b.lights).filter(|l| l.texture.is_some()) {
            let message =
                format!("light `{}` has a texture, and `discardvisual` removes all textures", light.name);
            cx.report.error(rules::CONFLICT, light.span.clone(), message).help("remove one of them");
        }
        for skin in &cx.assets.skins {
            if skin.value.as_ref().is_some_and(|s| s.material.is_some()) {
                let message =
                    format!("skin `{}` has a material, and `discardvisual` removes all materials", skin.name);
                cx.report.error(rules::CONFLICT, skin.span.clone(), message).help("remove one of them");
            }
        }
        (scene.materials, scene.textures) = Default::default();
    }
    scene
}

/// The number of user values for each kind of object.
fn user_widths(
    tree: &tree::ElementTree,
    bodies: &[BodySpec],
    tendons: &[TendonSpec],
    actuators: &[ActuatorSpec],
    sensors: &[SensorSpec],
    report: &mut Diagnostics,
) -> fill::Users {
    let actuator_users: Vec<_> = listed(actuators.iter().map(fill_actuator::user));
    let mut width = |name: &str, lists: &mut dyn Iterator<Item = &NumberList>| {
        settings::user_width(tree, name, lists, report)
    };
    let body = width("nuser_body", &mut bodies.iter().map(|b| &b.user));
    let joint = width("nuser_jnt", &mut bodies.iter().flat_map(|b| &b.joints).map(|j| &j.user));
    let geom = width("nuser_geom", &mut bodies.iter().flat_map(|b| &b.geoms).map(|g| &g.user));
    let site = width("nuser_site", &mut bodies.iter().flat_map(|b| &b.sites).map(|s| &s.user));
    let camera = width("nuser_cam", &mut bodies.iter().flat_map(|b| &b.cameras).map(|c| &c.user));
    let tendon = width("nuser_tendon", &mut tendons.iter().map(|t| &t.user));
    let sensor = width("nuser_sensor", &mut sensors.iter().map(|s| &s.user));
    let data = settings::userdata(tree, report);
    let actuator = settings::user_width(tree, "nuser_actuator", &mut actuator_users.iter(), report);
    fill::Users { body, joint, tendon, sensor, geom, site, camera, actuator, data }
}

/// Fills the arrays of a model. `None`, with an error in the report, if it is invalid.
fn fill_model(
    m: &mut Model,
    tree: &tree::ElementTree,
    specs: &Specs,
    assets: &Assets,
    min_keys: usize,
    report: &mut Diagnostics,
) -> Option<()> {
    let Specs { bodies, inertias, layout, tendons, actuators, .. } = specs;
    let counts = fill_actuator::count(actuators, report);
    let sizes = fill::Sizes {
        nq: layout.nq,
        nv: layout.dofs.len(),
        nmocap: layout.nmocap,
        na: counts.na,
        nu: counts.nu,
    };
    let keys = read_key::keys(tree, &sizes, min_keys, report);
    inertia::check_moving(bodies, &layout.weld, inertias, report);
    if !report.is_clean() {
        return None;
    }
    let mut simple = layout::find_simple_bodies(bodies, inertias);
    fill_tendon::clear_simple_flags(&mut simple, bodies, tendons);
    let pattern = layout::pattern(layout, &simple, report)?;
    let whole = layout::whole_pattern(layout, report)?;
    let parts = fill::Parts {
        bodies,
        inertias,
        layout,
        simple: &simple,
        pattern,
        whole,
        tendons,
        actuators,
        counts,
        equalities: &specs.equalities,
        pairs: &specs.pairs,
        excludes: &specs.excludes,
        users: specs.users,
        scene: &specs.scene,
        assets,
        sensors: &specs.sensors,
        keys: &keys,
    };
    fill::fill_arrays(m, parts);
    fill_tendon::pattern(m, tendons, report)?;
    fill_actuator::pattern(m, actuators, report)
}

/// Computes the fields that depend on the arrays: sleep policies, the total mass, constants, springs and length ranges. `None` if
/// there is no model.
fn compute_constants(
    m: &mut Model,
    source: &SpecInputs,
    specs: &Specs,
    report: &mut Diagnostics,
) -> Option<()> {
    sleep_policy::policies(m, &specs.bodies);
    reshape::total_mass(m, &source.parts.first()?.compiler);
    crate::setup::setconst::set_const0(m);
    m.planar_trees = crate::dynamics::tree_algorithms::planar_trees(m);
    fill::spring_dampers(m, &specs.bodies);
    fill_actuator::length_ranges(m, &specs.actuators, &settings::length_range(source.tree), report);
    Some(())
}
