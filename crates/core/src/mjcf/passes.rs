//! The order of the passes.

use super::actuator::{fill_actuator, read_actuator};
use super::asset::read_asset;
use super::body::{inertia, orientation, read_body, sleep_policy};
use super::classes::Classes;
use super::constraint::{read_contact, read_equality};
use super::geom::reshape;
use super::scene::{fill_scene, read_key, read_scene};
use super::sensor::read_sensor;
use super::tendon::{fill_tendon, read_tendon};
use super::text::diagnostic::Report;
use super::text::files::Files;
use super::text::patch::{Patch, Refusal};
use super::text::{load, tree};
use super::{context, expand, fill, ids, layout, names, settings};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::model::Model;

/// All passes. `None` when something is wrong; then the report says what.
pub(super) fn build(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    (patches, refusals): (&[Patch], &mut Vec<Option<Refusal>>),
    report: &mut Report,
) -> Option<(tree::Tree, Model)> {
    let mut loader = load::Loader::new(files, patches);
    let written = loader.model(xml.into(), path, report);
    *refusals = loader.refusals();
    let written = written?;
    let expand::Expanded { tree, parts } = expand::model(written, report);
    let classes = Classes::read(&tree, report);
    let names = names::NameTable::read(&tree, report);
    names::check_references(&tree, &names, &classes, report);
    orientation::check_forms(&tree, report);

    let options = settings::options(&tree, report);
    let statistic = settings::StatisticOverride::read(&tree, report);
    let min_keys = settings::min_keys(&tree);
    let compiler = &parts.first()?.compiler;
    let mut assets = read_asset::Assets::read(&tree, &classes, &parts, files, report);
    let mut cx =
        context::Context { tree: &tree, classes: &classes, parts: &parts, assets: &assets, compiler, report };
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
    sleep_policy::check(&bodies, &layout, report);
    let ids = ids::Ids::number(&tree, &bodies);
    let refs = ids::References { names: &names, ids: &ids };
    let mut cx =
        context::Context { tree: &tree, classes: &classes, parts: &parts, assets: &assets, compiler, report };
    let tendons = read_tendon::tendons(&mut cx, refs);
    let actuators = read_actuator::actuators(&mut cx, refs, &bodies, &tendons);
    read_tendon::check_rotors(&tendons, &actuators, cx.report);
    let equalities = read_equality::equalities(&mut cx, refs);
    let (pairs, excludes) = read_contact::contacts(&mut cx, refs, &bodies);
    let mut scene = fill_scene::SceneFields {
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
            cx.report.error(rules::CONFLICT, light.span.clone(), message).help("remove one of them");
        }
        for skin in &assets.skins {
            if skin.value.as_ref().is_some_and(|s| s.material.is_some()) {
                let message =
                    format!("skin `{}` has a material, and `discardvisual` removes all materials", skin.name);
                cx.report.error(rules::CONFLICT, skin.span.clone(), message).help("remove one of them");
            }
        }
        (scene.materials, scene.textures) = Default::default();
    }
    settings::memory(&tree, report);
    assets.hulls(&bodies, &pairs, report);
    classes.check_room(report);
    let sensors = read_sensor::sensors(&tree, refs, &tendons, report);
    let actuator_users: Vec<_> = listed(actuators.iter().map(fill_actuator::user));
    let users = fill::Users {
        body: settings::user_width(&tree, "nuser_body", &mut bodies.iter().map(|b| &b.user), report),
        joint: settings::user_width(
            &tree,
            "nuser_jnt",
            &mut bodies.iter().flat_map(|b| &b.joints).map(|j| &j.user),
            report,
        ),
        geom: settings::user_width(
            &tree,
            "nuser_geom",
            &mut bodies.iter().flat_map(|b| &b.geoms).map(|g| &g.user),
            report,
        ),
        site: settings::user_width(
            &tree,
            "nuser_site",
            &mut bodies.iter().flat_map(|b| &b.sites).map(|s| &s.user),
            report,
        ),
        camera: settings::user_width(
            &tree,
            "nuser_cam",
            &mut bodies.iter().flat_map(|b| &b.cameras).map(|c| &c.user),
            report,
        ),
        tendon: settings::user_width(&tree, "nuser_tendon", &mut tendons.iter().map(|t| &t.user), report),
        sensor: settings::user_width(&tree, "nuser_sensor", &mut sensors.iter().map(|s| &s.user), report),
        data: settings::userdata(&tree, report),
        actuator: settings::user_width(&tree, "nuser_actuator", &mut actuator_users.iter(), report),
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
    fill_tendon::demote_simple(&mut simple, &bodies, &tendons);
    let pattern = layout::pattern(&layout, &simple, report)?;
    let whole = layout::whole_pattern(&layout, report)?;

    let mut m = Model::default();
    m.names.model = settings::model_name(&tree);
    m.opt = options;
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
    sleep_policy::policies(&mut m, &bodies);
    reshape::total_mass(&mut m, compiler);
    crate::setup::setconst::set_const0(&mut m);
    m.planar_trees = crate::dynamics::tree_algorithms::planar_trees(&m);
    fill::spring_dampers(&mut m, &bodies);
    fill_actuator::length_ranges(&mut m, &actuators, &settings::length_range(&tree), report);
    statistic.apply(&mut m.stat);
    Some((tree, m))
}
