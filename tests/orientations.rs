//! Functions of the engine as callbacks of methods, and the elements of fields that are not angles.

#![allow(clippy::unwrap_used)]

use labspec_bind::{ModelNames, Scope};
use labspec_core::xml;
use labspec_expr::{Compiler, Globals};

/// A free ball and a hinge, with a site, a mocap body, a keyframe and two sensors.
const MODEL: &str = "<mujoco><worldbody><site name='tip'/>\
    <body name='b' pos='0 0 1'><freejoint/><geom name='g' size='.1'/></body>\
    <body name='rod' pos='1 0 1'><joint name='hinge'/><geom size='.1'/></body>\
    <body name='hand' mocap='true'/></worldbody><keyframe><key/></keyframe>\
    <sensor><framequat objtype='body' objname='b'/><jointpos joint='hinge'/></sensor></mujoco>";

/// The codes of the findings of some expressions.
fn codes(sources: &[String]) -> Vec<Vec<&'static str>> {
    let model = xml::compile(MODEL).unwrap();
    let names = ModelNames::new(&model, Scope::Lab);
    let found = |source: &String| {
        let compiled = Compiler::new(&names, &mut Globals::new()).linting().expression(source);
        compiled.diagnostics.iter().map(|d| d.code).collect()
    };
    sources.iter().map(found).collect()
}

fn found(source: &str) -> Vec<&'static str> {
    codes(&[source.to_string()]).concat()
}

/// A function of `lib` is called for every element. The index, which `map` passes too, must not become an optional argument.
#[test]
fn functions_of_the_engine_are_callbacks() {
    for source in [
        "data.qvel.slice(3, 6).map(lib.deg).join(' ')",
        "Array.from(data.qpos, lib.deg)[0]",
        "['tip'].map(lib.sitePos)[0][2]",
        "['tip'].map(s => lib.jacobian(s))[0][0]",
        "(() => { const d = lib.deg; return d(data.qvel[3]) })()",
    ] {
        assert!(found(source).is_empty(), "{source}: {:?}", found(source));
    }
    assert_eq!(found("['tip'].map(lib.jacobian)[0][0]"), ["argument-type"]);
}

/// Parts of a quaternion or of a rotation matrix are not angles.
#[test]
fn parts_of_orientations_are_not_angles() {
    for quantity in [
        "data.qpos[4]",
        "model.qpos0[4]",
        "model.key_qpos[4]",
        "data.xquat[5]",
        "data.body('b').xquat[1]",
        "model.body_quat[6]",
        "model.geom_quat[1]",
        "model.site_quat[1]",
        "data.mocap_quat[1]",
        "data.sensordata[3]",
        "data.xmat[9]",
        "data.ximat[9]",
        "data.geom_xmat[2]",
        "data.site_xmat[2]",
    ] {
        let found = codes(&[format!("lib.deg({quantity})"), format!("{quantity} * 180 / Math.PI")]);
        assert!(found.iter().all(|f| f == &["quaternion-as-angle"]), "{quantity}: {found:?}");
    }
    for angle in [
        "data.qpos[7]",
        "model.qpos0[7]",
        "model.key_qpos[7]",
        "data.sensordata[4]",
        "Math.acos(data.xmat[17])",
        "2 * Math.acos(data.xquat[4])",
    ] {
        assert!(found(&format!("lib.deg({angle})")).is_empty(), "{angle}");
    }
}
