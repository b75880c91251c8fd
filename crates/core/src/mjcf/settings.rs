//! `compiler`, `option`, `statistic` and `size`: settings of the whole model.

use super::classes::Props;
use super::spec::NumberList;
use crate::kinds::{angle, choice, disable, enable};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::{Diagnostics, shorten_name};
use crate::mjcf::text::tree::ElementTree;
use crate::mjcf::text::values::Value;
use crate::model::{Options, Statistic};
use crate::setup::lengthrange::{Mode, RangeSearch};

/// The attributes of all sections of one name. Later sections override earlier ones.
fn section(tree: &ElementTree, name: &str) -> Props {
    let mut props = Props::default();
    for (_, node) in tree.sections(name) {
        props.overlay(node);
    }
    props
}

/// A number that must satisfy a condition. Reports an error otherwise.
pub(crate) fn checked(
    props: &Props,
    name: &str,
    owner: &str,
    test: impl Fn(f64) -> bool,
    must: &str,
    report: &mut Diagnostics,
) -> Option<f64> {
    let x = props.real(name)?;
    if !test(x) {
        let span = props.span(name).unwrap_or(0..0);
        report.error(rules::VALUE, span, format!("`{name}` of {owner} is {x}, but it must be {must}"));
    }
    Some(x)
}

/// The attribute `inertiafromgeom`: whether the inertia of bodies is computed from their geoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InertiaFromGeom {
    Never,
    Always,
    /// Only if no `inertial` is given.
    Auto,
}

/// The settings of `compiler`.
#[derive(Clone, Debug)]
pub(crate) struct CompilerSettings {
    pub(crate) degrees: bool,
    pub(crate) autolimits: bool,
    /// Axes of `euler`: index of the axis, and whether it is fixed (upper case) or rotates with the frame.
    pub(crate) eulerseq: [(usize, bool); 3],
    pub(crate) inertiafromgeom: InertiaFromGeom,
    pub(crate) inertiagrouprange: [i32; 2],
    pub(crate) boundmass: f64,
    pub(crate) boundinertia: f64,
    pub(crate) balanceinertia: bool,
    /// Total mass, kg. Without effect if it is not positive.
    pub(crate) settotalmass: f64,
    pub(crate) fusestatic: bool,
    pub(crate) discardvisual: bool,
    pub(crate) alignfree: bool,
    /// Whether primitive shapes that replace a mesh are fitted to its bounding box, not to its inertia.
    pub(crate) fitaabb: bool,
    /// The folder of meshes and height fields as written; empty if there is none.
    pub(crate) meshdir: String,
    /// The folder of textures as written; empty if there is none.
    pub(crate) texturedir: String,
    /// Whether folders are removed from the paths of files.
    pub(crate) strippath: bool,
}

impl CompilerSettings {
    /// Reads the section.
    pub(crate) fn read(tree: &ElementTree, report: &mut Diagnostics) -> CompilerSettings {
        let p = section(tree, "compiler");
        let groups = p.ints("inertiagrouprange").unwrap_or(&[0, 5]);
        CompilerSettings {
            degrees: p.keyword("angle") != Some(angle::RADIAN),
            autolimits: p.flag("autolimits", true),
            eulerseq: eulerseq(&p, report),
            inertiafromgeom: match p.keyword("inertiafromgeom") {
                Some(choice::FALSE) => InertiaFromGeom::Never,
                Some(choice::TRUE) => InertiaFromGeom::Always,
                _ => InertiaFromGeom::Auto,
            },
            inertiagrouprange: [groups.first().copied().unwrap_or(0), groups.get(1).copied().unwrap_or(5)],
            boundmass: checked(&p, "boundmass", "compiler", |x| x >= 0.0, "zero or more", report)
                .unwrap_or(0.0),
            boundinertia: checked(&p, "boundinertia", "compiler", |x| x >= 0.0, "zero or more", report)
                .unwrap_or(0.0),
            balanceinertia: p.flag("balanceinertia", false),
            settotalmass: p.real("settotalmass").unwrap_or(-1.0),
            fusestatic: p.flag("fusestatic", false),
            discardvisual: p.flag("discardvisual", false),
            alignfree: p.flag("alignfree", false),
            fitaabb: p.flag("fitaabb", false),
            meshdir: p.text("meshdir").or(p.text("assetdir")).unwrap_or("").to_string(),
            texturedir: p.text("texturedir").or(p.text("assetdir")).unwrap_or("").to_string(),
            strippath: p.flag("strippath", false),
        }
    }

    /// Converts an angle of the file to radians.
    pub(crate) fn angle(&self, x: f64) -> f64 {
        if self.degrees { x * std::f64::consts::PI / 180.0 } else { x }
    }
}

fn eulerseq(p: &Props, report: &mut Diagnostics) -> [(usize, bool); 3] {
    let text = match p.has("eulerseq") {
        true => p.text("eulerseq").unwrap_or(""),
        false => "xyz",
    };
    let axes: Vec<_> = listed(
        text.chars().filter_map(|c| Some(("xyz".find(c.to_ascii_lowercase())?, c.is_ascii_uppercase()))),
    );
    match <[_; 3]>::try_from(axes) {
        Ok(axes) if text.chars().count() == 3 => axes,
        _ => {
            report
                .error(
                    rules::VALUE,
                    p.span("eulerseq").unwrap_or(0..0),
                    format!("`eulerseq` is {}", shorten_name(text)),
                )
                .help(
                    "write three letters of x, y, z (axes that turn with the frame) or X, Y, Z (fixed axes)",
                );
            [(0, false), (1, false), (2, false)]
        }
    }
}

/// Reads `option`. Missing values are MuJoCo's defaults.
pub(crate) fn options(tree: &ElementTree, report: &mut Diagnostics) -> Options {
    let p = section(tree, "option");
    let d = Options::default();
    let mut positive = |name: &str, default: f64| {
        checked(&p, name, "option", |x| x > 0.0, "larger than zero", report).unwrap_or(default)
    };
    let (timestep, impratio) = (positive("timestep", d.timestep), positive("impratio", d.impratio));
    let mut from_zero = |name: &str, default: f64| {
        checked(&p, name, "option", |x| x >= 0.0, "zero or more", report).unwrap_or(default)
    };
    let (density, viscosity) = (from_zero("density", 0.0), from_zero("viscosity", 0.0));
    let (disableflags, enableflags) = flags(tree);
    Options {
        timestep,
        impratio,
        density,
        viscosity,
        ls_tolerance: tolerance(&p, "ls_tolerance", d.ls_tolerance, report),
        noslip_tolerance: tolerance(&p, "noslip_tolerance", d.noslip_tolerance, report),
        ccd_tolerance: tolerance(&p, "ccd_tolerance", d.ccd_tolerance, report),
        sleep_tolerance: tolerance(&p, "sleep_tolerance", d.sleep_tolerance, report),
        tolerance: tolerance(&p, "tolerance", d.tolerance, report),
        iterations: count(&p, "iterations", d.iterations, report),
        ls_iterations: count(&p, "ls_iterations", d.ls_iterations, report),
        noslip_iterations: count(&p, "noslip_iterations", d.noslip_iterations, report),
        ccd_iterations: count(&p, "ccd_iterations", d.ccd_iterations, report),
        sdf_iterations: count(&p, "sdf_iterations", d.sdf_iterations, report),
        sdf_initpoints: count(&p, "sdf_initpoints", d.sdf_initpoints, report),
        gravity: p.reals("gravity", d.gravity),
        wind: p.reals("wind", d.wind),
        magnetic: p.reals("magnetic", d.magnetic),
        o_margin: p.real("o_margin").unwrap_or(d.o_margin),
        o_solref: p.reals("o_solref", d.o_solref),
        o_solimp: p.reals("o_solimp", d.o_solimp),
        o_friction: p.reals("o_friction", d.o_friction),
        integrator: p.keyword("integrator").unwrap_or(d.integrator),
        cone: p.keyword("cone").unwrap_or(d.cone),
        jacobian: p.keyword("jacobian").unwrap_or(d.jacobian),
        solver: p.keyword("solver").unwrap_or(d.solver),
        disableflags,
        enableflags,
        disableactuator: disabled_groups(&p, report),
    }
}

/// A tolerance. A negative one has the effect of zero: the solver does not stop early.
fn tolerance(p: &Props, name: &str, default: f64, report: &mut Diagnostics) -> f64 {
    let x = p.real(name).unwrap_or(default);
    if x < 0.0 {
        acts_as_zero(p, name, x.to_string(), report);
    }
    x
}

/// A number of iterations or points. A negative one has the effect of zero.
fn count(p: &Props, name: &str, default: i32, report: &mut Diagnostics) -> i32 {
    let n = p.int(name).unwrap_or(default);
    if n < 0 {
        acts_as_zero(p, name, n.to_string(), report);
    }
    n
}

fn acts_as_zero(p: &Props, name: &str, written: String, report: &mut Diagnostics) {
    let span = p.span(name).unwrap_or(0..0);
    let message = format!("`{name}` of option is {written}, which has the effect of 0");
    report.warning(rules::NO_EFFECT, span, message).help("write 0, or remove it for the default");
}

/// The groups of `actuatorgroupdisable` as bits.
fn disabled_groups(p: &Props, report: &mut Diagnostics) -> i32 {
    let mut bits = 0;
    for &group in p.ints("actuatorgroupdisable").unwrap_or(&[]) {
        if (0..=30).contains(&group) {
            bits |= 1 << group;
        } else {
            let span = p.span("actuatorgroupdisable").unwrap_or(0..0);
            report
                .error(rules::VALUE, span, format!("`actuatorgroupdisable` of option has {group}"))
                .why("only groups 0 to 30 can be switched off");
        }
    }
    bits
}

/// The parameters of the search for length ranges, `compiler/lengthrange`.
pub(crate) fn length_range(tree: &ElementTree) -> RangeSearch {
    let mut p = Props::default();
    for (i, _) in tree.sections("compiler") {
        for (_, node) in tree.children(i) {
            p.overlay(node);
        }
    }
    let d = RangeSearch::default();
    let real = |name: &str, default: f64| p.real(name).unwrap_or(default);
    RangeSearch {
        mode: match p.keyword("mode") {
            Some(0) => Mode::Nothing,
            Some(3) => Mode::All,
            // Actuators with user callbacks do not exist here.
            _ => Mode::Muscles,
        },
        useexisting: p.flag("useexisting", d.useexisting),
        uselimit: p.flag("uselimit", d.uselimit),
        accel: real("accel", d.accel),
        maxforce: real("maxforce", d.maxforce),
        timeconst: real("timeconst", d.timeconst),
        timestep: real("timestep", d.timestep),
        inttotal: real("inttotal", d.inttotal),
        interval: real("interval", d.interval),
        tolrange: real("tolrange", d.tolrange),
    }
}

/// Parts of the simulation that are on unless a flag disables them, and parts that are off unless a flag enables them.
const DISABLE: [(&str, i32); 20] = [
    ("constraint", disable::CONSTRAINT),
    ("equality", disable::EQUALITY),
    ("frictionloss", disable::FRICTIONLOSS),
    ("limit", disable::LIMIT),
    ("contact", disable::CONTACT),
    ("spring", disable::SPRING),
    ("damper", disable::DAMPER),
    ("gravity", disable::GRAVITY),
    ("clampctrl", disable::CLAMPCTRL),
    ("warmstart", disable::WARMSTART),
    ("filterparent", disable::FILTERPARENT),
    ("actuation", disable::ACTUATION),
    ("refsafe", disable::REFSAFE),
    ("sensor", disable::SENSOR),
    ("midphase", disable::MIDPHASE),
    ("eulerdamp", disable::EULERDAMP),
    ("autoreset", disable::AUTORESET),
    ("nativeccd", disable::NATIVECCD),
    ("island", disable::ISLAND),
    ("multiccd", disable::MULTICCD),
];
const ENABLE: [(&str, i32); 7] = [
    ("override", enable::OVERRIDE),
    ("energy", enable::ENERGY),
    ("fwdinv", enable::FWDINV),
    ("invdiscrete", enable::INVDISCRETE),
    ("sleep", enable::SLEEP),
    ("diagexact", enable::DIAGEXACT),
    ("ipc", enable::IPC),
];

/// The flags of `option/flag` as bits: disabled, enabled.
fn flags(tree: &ElementTree) -> (i32, i32) {
    let mut p = Props::default();
    for (i, _) in tree.sections("option") {
        for (_, flag) in tree.children(i) {
            p.overlay(flag);
        }
    }
    let bits = |table: &[(&str, i32)], set: i32| {
        table.iter().filter(|(name, _)| p.keyword(name) == Some(set)).fold(0, |all, (_, bit)| all | bit)
    };
    (bits(&DISABLE, 0), bits(&ENABLE, 1))
}

/// The values of `statistic`, which override the computed ones.
#[derive(Clone, Debug, Default)]
pub(crate) struct StatisticOverride {
    meaninertia: Option<f64>,
    meanmass: Option<f64>,
    meansize: Option<f64>,
    extent: Option<f64>,
    center: Option<[f64; 3]>,
}

impl StatisticOverride {
    /// Reads the section.
    pub(crate) fn read(tree: &ElementTree, report: &mut Diagnostics) -> StatisticOverride {
        let p = section(tree, "statistic");
        let mut positive =
            |name: &str| checked(&p, name, "statistic", |x| x > 0.0, "larger than zero", report);
        StatisticOverride {
            meaninertia: positive("meaninertia"),
            meanmass: positive("meanmass"),
            meansize: positive("meansize"),
            extent: positive("extent"),
            center: p.has("center").then(|| p.reals("center", [0.0; 3])),
        }
    }

    /// Replaces computed values by given ones.
    pub(crate) fn apply(&self, stat: &mut Statistic) {
        let set = |to: &mut f64, from: Option<f64>| *to = from.unwrap_or(*to);
        set(&mut stat.meaninertia, self.meaninertia);
        set(&mut stat.meanmass, self.meanmass);
        set(&mut stat.meansize, self.meansize);
        set(&mut stat.extent, self.extent);
        stat.center = self.center.unwrap_or(stat.center);
    }
}

/// The smallest number of keyframes, `size nkey`.
pub(crate) fn min_keys(tree: &ElementTree) -> usize {
    let p = section(tree, "size");
    // As in MuJoCo, a negative number has the effect of zero.
    usize::try_from(p.int("nkey").unwrap_or(0)).unwrap_or(0)
}

/// The number of user values of each object of a kind: the value of `size`, or, if that is absent or -1, the length of the
/// longest list. `lists` contains one list per object.
pub(crate) fn user_width(
    tree: &ElementTree,
    size: &str,
    lists: &mut dyn Iterator<Item = &NumberList>,
    report: &mut Diagnostics,
) -> usize {
    let p = section(tree, "size");
    let span = p.span(size).unwrap_or(0..0);
    if let Some(n) = p.int(size).filter(|&n| n < -1) {
        report
            .error(rules::VALUE, span.clone(), format!("`{size}` of size is {n}, but it must be -1 or more"))
            .help("write the number of user values per element, or -1 for the length of the longest list");
    }
    let given = p.int(size).and_then(|n| usize::try_from(n).ok());
    let (mut longest, mut count, mut longest_at) = (0, 0, 0..0);
    for list in lists {
        let n = list.numbers.len();
        count += 1;
        if n > longest {
            (longest, longest_at) = (n, list.span.clone());
        }
        if let Some(most) = given.filter(|&most| n > most) {
            let message = format!("`user` has {n} numbers, but `{size}` of size is {most}");
            report
                .error(rules::COUNT, list.span.clone(), message)
                .help(format!("remove `{size}`, or write a larger number"));
        }
    }
    let width = given.unwrap_or(longest);
    // Without `size`, the longest list determines the length, so the error is reported at this list.
    let span = if given.is_some() { span } else { longest_at };
    if report.take(width.saturating_mul(count), span, "the user values of all objects of a kind") {
        width
    } else {
        0
    }
}

/// Checks the attributes of `size` for memory. They have no effect here, but must be valid in MuJoCo: a number of bytes with K,
/// M, G, T, P or E; other numbers at least -1.
pub(crate) fn memory(tree: &ElementTree, report: &mut Diagnostics) {
    let p = section(tree, "size");
    if p.has("memory") {
        let text = p.text("memory").unwrap_or("").trim();
        let digits =
            text.strip_suffix(['K', 'M', 'G', 'T', 'P', 'E', 'k', 'm', 'g', 't', 'p', 'e']).unwrap_or(text);
        if text != "-1" && (digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit())) {
            let span = p.span("memory").unwrap_or(0..0);
            let message = format!("`memory` of size is {}, not a number of bytes", shorten_name(text));
            report.error(rules::VALUE, span, message).help("write an integer such as `64M`, or remove it");
        }
    }
    for name in ["njmax", "nconmax", "nstack"] {
        if let Some(n) = p.int(name).filter(|&n| n < -1) {
            let span = p.span(name).unwrap_or(0..0);
            report.error(rules::VALUE, span, format!("`{name}` of size is {n}, but it must be -1 or more"));
        }
    }
}

/// The number of user values of the model, `size nuserdata`.
pub(crate) fn userdata(tree: &ElementTree, report: &mut Diagnostics) -> usize {
    let p = section(tree, "size");
    let n = p.int("nuserdata").unwrap_or(0);
    let span = p.span("nuserdata").unwrap_or(0..0);
    match usize::try_from(n) {
        Ok(n) if report.take(n, span.clone(), "`nuserdata`") => n,
        Ok(_) => 0,
        Err(_) => {
            report.error(
                rules::VALUE,
                span,
                format!("`nuserdata` of size is {n}, but it must be zero or more"),
            );
            0
        }
    }
}

/// The model's name.
pub(crate) fn model_name(tree: &ElementTree) -> String {
    let root = tree.nodes.first().and_then(|n| n.attribute("model"));
    match root.map(|a| &a.value) {
        Some(Value::Text(name)) => name.clone(),
        _ => "MuJoCo Model".to_string(),
    }
}
