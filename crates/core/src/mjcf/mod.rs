//! The MJCF compiler: XML text to a [`Model`], with MuJoCo 3.14.0's names, defaults and conventions.
//!
//! The passes, one file each: `scan` (limits) → `tree` (XML checked against the one `schema`) → `defaults`,
//! `names` → `settings`, `read_*` (specifications in our own terms, `spec`) → `inertia`, `layout` → `fill`.
//! A pass reports what it finds and goes on, so that one run shows all mistakes; passes that would only
//! repeat an earlier finding in other words wait until that is corrected.
//!
//! The meaning of elements and attributes follows MuJoCo's XML reference; the file's own places are in
//! [`MjcfDiagnostic`].

mod defaults;
mod diagnostic;
mod fill;
mod fill_constraint;
mod fill_tendon;
mod ids;
mod inertia;
mod layout;
mod limits;
mod names;
mod orientation;
mod read_body;
mod read_contact;
mod read_equality;
mod read_geom;
mod read_joint;
mod read_key;
mod read_sensor;
mod read_tendon;
mod scan;
mod schema;
mod settings;
mod shapes;
mod sleep;
mod spec;
#[cfg(test)]
mod tests;
mod tree;
mod values;

use std::io::Read;
use std::path::Path;

use crate::Model;
use diagnostic::Report;

pub use diagnostic::{MjcfDiagnostic, MjcfFileError, code};
pub use schema::{Attr, Element, Kind, SchemaRow, Status, Word, schema_rows};

/// Largest text that is read, bytes.
pub const MAX_TEXT: usize = 16 << 20;
/// Deepest nesting of elements.
pub const MAX_DEPTH: usize = 1000;
/// Largest number of elements.
pub const MAX_ELEMENTS: usize = 200_000;
/// Largest number of degrees of freedom.
pub const MAX_DOFS: usize = 1500;
/// Largest number of geoms.
pub const MAX_GEOMS: usize = 5000;
/// Largest number of attributes of an element.
pub const MAX_ATTRIBUTES: usize = 200;

/// Compiles a model from its text.
///
/// # Errors
///
/// All mistakes that were found, in the order of the text.
pub fn compile(xml: &str) -> Result<Model, Vec<MjcfDiagnostic>> {
    let mut report = Report::new(xml);
    match build(xml, &mut report) {
        Some(model) if report.is_clean() => Ok(model),
        _ => Err(report.finish()),
    }
}

/// Compiles a model from a file.
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
    compile(&text).map_err(|diagnostics| MjcfFileError::Model { path: owned(), diagnostics })
}

/// All passes. `None` when something is wrong; then the report says what.
fn build(xml: &str, report: &mut Report) -> Option<Model> {
    if !scan::within_limits(xml, report) {
        return None;
    }
    let tree = tree::parse(xml, report)?;
    let classes = defaults::Classes::read(&tree, report);
    let names = names::NameTable::read(&tree, report);
    names::check_references(&tree, &names, &classes, report);
    orientation::check_forms(&tree, report);

    let compiler = settings::Compiler::read(&tree, report);
    let options = settings::options(&tree, report);
    let statistic = settings::StatisticOverride::read(&tree, report);
    let min_keys = settings::min_keys(&tree, report);
    let mut cx = read_body::Context { tree: &tree, classes: &classes, compiler: &compiler, report };
    let bodies = read_body::bodies(&mut cx);
    let layout = layout::number(&bodies);
    layout::check(&bodies, &layout, report);
    sleep::check(&bodies, &layout, report);
    let ids = ids::Ids::number(&tree, &bodies);
    let refs = ids::References { names: &names, ids: &ids };
    let mut cx = read_body::Context { tree: &tree, classes: &classes, compiler: &compiler, report };
    let tendons = read_tendon::tendons(&mut cx, refs);
    let equalities = read_equality::equalities(&mut cx, refs);
    let (pairs, excludes) = read_contact::contacts(&mut cx, refs, &bodies);
    let users = fill::Users {
        body: settings::user_width(&tree, "nuser_body", bodies.iter().map(|b| &b.user), report),
        joint: settings::user_width(
            &tree,
            "nuser_jnt",
            bodies.iter().flat_map(|b| &b.joints).map(|j| &j.user),
            report,
        ),
        tendon: settings::user_width(&tree, "nuser_tendon", tendons.iter().map(|t| &t.user), report),
    };
    let sensors = read_sensor::sensors(&tree, &names, &ids, report);
    if !report.is_clean() {
        return None;
    }

    // What follows depends on everything being read: a refused geom would also be a missing mass.
    let sizes = fill::Sizes { nq: layout.nq, nv: layout.dofs.len(), nmocap: layout.nmocap };
    let keys = read_key::keys(&tree, &sizes, min_keys, report);
    let inertias = inertia::bodies(&bodies, &compiler, report);
    inertia::check_moving(&bodies, &layout.weld, &inertias, report);
    if !report.is_clean() {
        return None;
    }
    let mut simple = layout::simple(&bodies, &inertias);
    fill_tendon::demote_simple(&mut simple, &bodies, &tendons);
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
        equalities: &equalities,
        pairs: &pairs,
        excludes: &excludes,
        users,
        sensors: &sensors,
        keys: &keys,
    };
    fill::model(&mut m, parts);
    fill_tendon::pattern(&mut m, &tendons, report)?;
    sleep::policies(&mut m, &bodies);
    crate::setconst::set_const0(&mut m);
    fill::spring_dampers(&mut m, &bodies);
    statistic.apply(&mut m.stat);
    Some(m)
}
