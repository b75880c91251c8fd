//! Compares every field of the compiled model with that of MuJoCo 3.14.0, recorded by `golden/record.py`.

use crate::mjcf;
use crate::model::reflect::{self, Object, View};
use crate::model::{Fields, Model, Obj};

/// Fields that are not filled yet.
const NOT_YET: &[&str] = &["nD", "D_rownnz", "D_rowadr", "D_diag", "D_colind"];

/// Checks every recorded field and name of a model. Quaternions, and fields that depend on them, are compared to rounding
/// accuracy.
fn check_golden(name: &str, xml: &str, recorded: &str) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/mjcf/golden");
    let files = mjcf::Folder::new(&folder).unwrap();
    let m = mjcf::compile_only(xml, &files).unwrap_or_else(|list| {
        panic!("{name}: {}", list.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    });
    let d = Fields::default();
    let mut wrong = Vec::new();
    for line in recorded.lines() {
        if let Some(names) = line.strip_prefix("names.") {
            let (kind, names) = names.split_once(' ').unwrap();
            let expected: Vec<&str> = names.split('|').collect();
            let got = m.names.of_kind(object(kind));
            if got != expected {
                wrong.push(format!("names.{kind}\n   want {expected:?}\n   got  {got:?}"));
            }
            continue;
        }
        let mut words = line.split(' ');
        let path = words.next().unwrap_or("");
        let expected: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
        let (object, field) = path.split_once('.').unwrap();
        // Statistics that the model does not specify are computed by `mj_setConst` and tested there.
        if object == "stat" && !xml.contains(&format!("{field}=")) {
            continue;
        }
        let object = match object {
            "model" => Object::Model,
            "opt" => Object::Option,
            _ => Object::Statistic,
        };
        let Some(id) = reflect::field(object, field).filter(|_| !NOT_YET.contains(&field)) else { continue };
        let got = view(&m, &d, id);
        let scale = expected.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let tolerance = match field {
            // MuJoCo stores colours in single precision.
            name if name.ends_with("_rgba") => 1e-7,
            // Computed in single precision there, and in double precision and then rounded here: they differ by a unit in the
            // last place.
            "skin_bonebindquat" | "skin_bonevertweight" => 1.2e-7,
            // The library finds the tangent point of a tendon inside a ring only to 1e-6 of its own equation.
            "tendon_invweight0" if xml.contains("sidesite") => 1e-7 * scale,
            _ => 1e-11 * scale,
        };
        let same =
            got.len() == expected.len() && got.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= tolerance);
        if !same {
            wrong.push(format!("{path}\n   want {expected:?}\n   got  {got:?}"));
        }
    }
    assert!(wrong.is_empty(), "{name}:\n{}", wrong.join("\n"));
}

/// The kind of object of a recorded list of names.
fn object(kind: &str) -> Obj {
    match kind {
        "body" => Obj::Body,
        "joint" => Obj::Joint,
        "geom" => Obj::Geom,
        "site" => Obj::Site,
        "camera" => Obj::Camera,
        "light" => Obj::Light,
        "mesh" => Obj::Mesh,
        "skin" => Obj::Skin,
        "hfield" => Obj::HField,
        "texture" => Obj::Texture,
        "material" => Obj::Material,
        "pair" => Obj::Pair,
        "exclude" => Obj::Exclude,
        "equality" => Obj::Equality,
        "tendon" => Obj::Tendon,
        "actuator" => Obj::Actuator,
        "sensor" => Obj::Sensor,
        "numeric" => Obj::Numeric,
        "text" => Obj::Text,
        "tuple" => Obj::Tuple,
        "key" => Obj::Key,
        other => panic!("{other}"),
    }
}

fn view(m: &Model, d: &Fields, id: reflect::FieldId) -> Vec<f64> {
    let view: View = reflect::view(m, d, id);
    (0..view.len()).filter_map(|i| view.get(i)).collect()
}

macro_rules! golden {
    ($($name:ident)*) => { $(
        #[test]
        fn $name() {
            check_golden(
                stringify!($name),
                include_str!(concat!("../golden/", stringify!($name), ".xml")),
                include_str!(concat!("../golden/", stringify!($name), ".txt")),
            );
        }
    )* };
}
golden! {
    chain classes defaults_of_everything extrinsic free_bodies inertia inertia_options near_frames orientations sections
    sensors_and_keys simple_bodies trees tendons constraints passive frames
    replicas attached included hfields skins
}

/// The schema has exactly the elements and attributes that the library prints.
#[test]
fn schema_names() {
    use std::collections::BTreeMap;
    // Elements that the library expands before it checks the schema.
    const EXPANDED: [&str; 3] = ["include", "frame", "replicate"];
    let mut declared: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for row in mjcf::schema_rows() {
        if row.path.split('/').any(|e| EXPANDED.contains(&e))
            || row.path.starts_with("mujoco/worldbody/body/")
        {
            continue;
        }
        let names = declared.entry(row.path).or_default();
        names.extend(row.attribute.map(|a| a.name));
    }
    let mut wrong = Vec::new();
    let mut library = BTreeMap::new();
    for line in include_str!("../golden/schema.txt").lines() {
        let mut words = line.split(' ');
        // Their schema has one entry for the world and for bodies; ours has two.
        let path = words.next().unwrap_or("").replace("(world)body", "worldbody");
        let mut names: Vec<&str> = words.filter(|w| !w.is_empty()).collect();
        let in_body = path.strip_prefix("mujoco/worldbody/").is_some_and(|rest| {
            matches!(rest.split('/').next(), Some("inertial" | "joint" | "freejoint" | "plugin"))
        });
        if path == "mujoco/worldbody" {
            library.insert("mujoco/worldbody/body".to_string(), std::mem::take(&mut names));
        }
        if !in_body {
            library.insert(path, names);
        }
    }
    for (path, names) in &mut declared {
        names.sort_unstable();
        match library.remove(path) {
            Some(expected) if expected == *names => {}
            Some(expected) => wrong.push(format!(
                "{path}: missing {:?}, extra {:?}",
                expected.iter().filter(|w| !names.contains(w)).collect::<Vec<_>>(),
                names.iter().filter(|n| !expected.contains(n)).collect::<Vec<_>>()
            )),
            None => wrong.push(format!("{path}: not in MuJoCo's schema")),
        }
    }
    wrong.extend(library.keys().map(|path| format!("{path}: not in our schema")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
