//! A build without the general algorithm for convex shapes (feature `convex`), compared with a full build.
//!
//! Such a build does not read MJCF: models are loaded from bytes. Therefore this test has two parts, which are run one after the
//! other:
//!
//!     cargo test -p labspec-core --test lean
//!     cargo test -p labspec-core --test lean --no-default-features
//!
//! The full build compiles the models and stores them in `target/tmp` with its results. For models that do not need the
//! algorithm, the lean build must compute the same bits. It must refuse the others with the error that names the geoms, whatever
//! flags, contact bits or sleep currently prevent their contacts.

// A panic is the report of a failed test.
#![allow(clippy::panic, clippy::unwrap_used)]

use labspec_core::{self as core, Data, Error, Model, disable};
use std::path::PathBuf;

/// A scene with rows of every kind, with these options: contacts with one, three, four and six dimensions, equalities, limits and
/// dry friction.
macro_rules! every_row {
    ($options:literal) => {
        concat!(
            $options,
            "<worldbody><geom type='plane' size='2 2 1'/>
             <body pos='0 0 .09' euler='5 0 0'><freejoint/><geom type='box' size='.2 .15 .1' condim='1'/></body>
             <body pos='1 0 .09'><freejoint/><geom type='box' size='.1 .1 .1' euler='9 5 0'/><geom size='.1' pos='0 0 .19'/></body>
             <body name='a' pos='0 1 .1'><freejoint/><geom type='capsule' size='.1 .2' euler='0 85 0' condim='4'/></body>
             <body name='b' pos='.6 1 .1'><freejoint/><geom size='.1' condim='6' friction='.5 .01 .02'/></body>
             <body name='c' pos='-1 0 1'><joint name='j' axis='0 1 0' range='-20 20' frictionloss='.1'/><geom size='.1' pos='.5 0 0'/>
              <body pos='.5 0 0'><joint name='k' axis='0 1 0'/><geom size='.1' pos='.5 0 0'/></body></body>
             <body name='d' pos='-1 1 1'><freejoint/><geom size='.1'/></body>
             <body name='e' pos='-1 1 1.3'><freejoint/><geom size='.1'/></body></worldbody>
             <tendon><fixed name='t' frictionloss='.2' range='-.1 .3'><joint joint='j' coef='1'/><joint joint='k' coef='.5'/></fixed></tendon>
             <equality><weld body1='a' body2='b'/><connect body1='d' body2='e' anchor='0 0 .15'/><joint joint1='j' joint2='k'/></equality>"
        )
    };
}

/// Models that both builds simulate: name and text. Geoms that would need the algorithm touch only the plane, or are permanently
/// excluded.
const SHARED: [(&str, &str); 12] = [
    ("pyramids by Newton's method", every_row!("<option solver='Newton'/>")),
    ("cones by Newton's method", every_row!("<option solver='Newton' cone='elliptic' impratio='3'/>")),
    ("cones by conjugate gradients", every_row!("<option solver='CG' cone='elliptic'/>")),
    ("pyramids by projected sweeps", every_row!("<option solver='PGS' noslip_iterations='4'/>")),
    ("cones by projected sweeps", every_row!("<option solver='PGS' cone='elliptic' noslip_iterations='4'/>")),
    (
        "rows at the end of the step",
        every_row!("<option integrator='discrete' cone='elliptic'><flag diagexact='enable'/></option>"),
    ),
    (
        "pile",
        "<worldbody><geom type='plane' size='2 2 1'/>
         <body pos='0 0 .1'><freejoint/><geom size='.1'/></body>
         <body pos='.02 0 .35'><freejoint/><geom type='capsule' size='.08 .1' euler='0 80 0'/></body>
         <body pos='0 .03 .6'><freejoint/><geom type='box' size='.1 .12 .08'/></body>
         <body pos='.05 0 .8'><freejoint/><geom type='box' size='.07 .07 .07' euler='5 9 0'/></body></worldbody>",
    ),
    (
        "round on a plane",
        "<worldbody><geom type='plane' size='2 2 1'/>
         <body name='a' pos='0 0 .3'><freejoint/><geom type='cylinder' size='.1 .2' euler='20 0 0'/></body>
         <body name='b' pos='1 0 .3'><freejoint/><geom type='ellipsoid' size='.1 .2 .15'/></body></worldbody>
         <contact><exclude body1='a' body2='b'/></contact>",
    ),
    (
        "mesh on a plane",
        "<asset><mesh name='m' vertex='0 0 0  .2 0 0  0 .2 0  0 0 .2'/></asset>
         <worldbody><geom type='plane' size='2 2 1'/>
         <body pos='0 0 .2'><freejoint/><geom type='mesh' mesh='m'/></body></worldbody>",
    ),
    (
        "legs",
        "<worldbody><geom type='plane' size='2 2 1'/>
         <body pos='0 0 1'><freejoint/><geom type='box' size='.1 .15 .2'/>
          <body pos='0 .1 -.2'><joint axis='0 1 0' damping='1'/><joint axis='1 0 0' damping='1'/>
           <geom type='capsule' fromto='0 0 0 0 .05 -.4' size='.05'/>
           <body pos='0 .05 -.4'><joint axis='0 1 0' range='-120 10'/><geom type='capsule' fromto='0 0 0 .02 0 -.4' size='.04'/></body></body>
          <body pos='0 -.1 -.2'><joint axis='0 1 0' damping='1'/><geom type='sphere' pos='0 0 -.3' size='.1'/></body></body></worldbody>",
    ),
    (
        "distances",
        "<worldbody><body name='a'><joint axis='0 1 0'/><geom name='a' type='capsule' fromto='0 0 0 .5 0 0' size='.05'/></body>
         <body name='b' pos='0 .3 -.4'><joint axis='1 0 0'/><geom name='b' size='.1' pos='.2 0 0'/></body></worldbody>
         <sensor><distance geom1='a' geom2='b' cutoff='3'/><fromto body1='b' body2='a' cutoff='3'/></sensor>",
    ),
    (
        "parts of one body",
        "<worldbody><body><joint axis='0 1 0'/><geom type='cylinder' size='.1 .2'/><geom type='ellipsoid' size='.1 .2 .3' pos='.4 0 0'/>
         <geom type='box' size='.1 .1 .1' pos='.8 0 0'/><geom type='capsule' size='.1 .1' pos='1.2 0 0'/></body></worldbody>",
    ),
];

/// Models that the lean build refuses: name, text, and the geoms in the error.
const REFUSED: [(&str, &str, [usize; 2]); 9] = [
    (
        "cylinder and box",
        "<worldbody><geom type='plane' size='2 2 1'/><body pos='0 0 1'><freejoint/><geom type='cylinder' size='.1 .1'/></body>
         <body pos='1 0 1'><freejoint/><geom type='box' size='.1 .1 .1'/></body></worldbody>",
        [1, 2],
    ),
    (
        "kept apart by bits, which can be written",
        "<worldbody><body><freejoint/><geom type='ellipsoid' size='.1 .1 .2' contype='0' conaffinity='0'/></body>
         <body pos='1 0 0'><freejoint/><geom type='capsule' size='.1 .1'/></body></worldbody>",
        [0, 1],
    ),
    (
        "kept apart by the parent filter, which can be switched off",
        "<worldbody><body><freejoint/><geom type='cylinder' size='.1 .1'/>
         <body pos='0 0 .1'><joint/><geom type='cylinder' size='.1 .1'/></body></body></worldbody>",
        [0, 1],
    ),
    (
        "contacts switched off",
        "<option><flag contact='disable'/></option><worldbody><body><freejoint/><geom type='cylinder' size='.1 .1'/></body>
         <body pos='1 0 0'><freejoint/><geom size='.1'/><geom type='box' size='.1 .1 .1'/></body></worldbody>",
        [0, 2],
    ),
    (
        "asleep",
        "<option><flag sleep='enable'/></option><worldbody><geom type='plane' size='2 2 1'/>
         <body sleep='init' pos='0 0 .1'><freejoint/><geom type='box' size='.1 .1 .1'/></body>
         <body sleep='init' pos='1 0 .1'><freejoint/><geom type='ellipsoid' size='.1 .1 .1'/></body></worldbody>",
        [1, 2],
    ),
    (
        "an explicit pair of a body with its child",
        "<worldbody><body name='a'><freejoint/><geom name='a' type='cylinder' size='.1 .1'/>
         <body name='b' pos='0 0 .5'><joint/><geom name='b' type='box' size='.1 .1 .1'/></body></body></worldbody>
         <contact><pair geom1='a' geom2='b'/><exclude body1='a' body2='b'/></contact>",
        [0, 1],
    ),
    (
        "a height field",
        "<asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1' elevation='0 0 1 1'/></asset>
         <worldbody><geom type='hfield' hfield='h'/><body pos='0 0 2'><freejoint/><geom size='.1'/></body></worldbody>",
        [0, 1],
    ),
    (
        "the distance of boxes that never touch",
        "<worldbody><body name='a'><freejoint/><geom name='a' type='box' size='.1 .1 .1'/></body>
         <body name='b' pos='1 0 0'><freejoint/><geom name='b' type='box' size='.1 .1 .1'/></body></worldbody>
         <contact><exclude body1='a' body2='b'/></contact><sensor><distance geom1='a' geom2='b'/></sensor>",
        [0, 1],
    ),
    (
        "the distance of bodies",
        "<worldbody><geom name='p' size='.1'/><body name='a' pos='1 0 0'><geom type='capsule' size='.1 .1'/></body>
         <body name='b' pos='2 0 0'><geom size='.1'/><geom type='cylinder' size='.1 .1'/></body></worldbody>
         <sensor><normal body1='a' body2='b'/></sensor>",
        [1, 3],
    ),
];

/// The path at which the full build stores results for the lean build.
fn left(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("lean").join(name.replace(' ', "_"))
}

/// The results of 300 steps of a model: the numbers of each step as bits, and the number of contacts. After half of the steps,
/// the parent filter is disabled and all contact bits are set.
fn history(m: &mut Model) -> (Vec<u64>, usize) {
    let (mut d, mut out, mut contacts) = (Data::new(m), Vec::new(), 0);
    for step in 0..300 {
        if step == 150 {
            m.set_disabled(disable::FILTERPARENT, true);
            let edit = m.edit();
            edit.geom_contype.fill(1);
            edit.geom_conaffinity.fill(1);
        }
        core::step(m, &mut d).unwrap();
        let numbers = [&d.qpos, &d.qvel, &d.sensordata, &d.qfrc_constraint];
        out.extend(numbers.into_iter().flatten().map(|x| x.to_bits()));
        contacts += d.ncon;
    }
    (out, contacts)
}

/// The distances of all pairs of geoms in the initial configuration: the numbers as bits, or the error.
fn distances(m: &Model) -> Vec<Result<[u64; 7], Error>> {
    let mut d = Data::new(m);
    core::forward(m, &mut d).unwrap();
    let pairs = (0..m.ngeom).flat_map(|a| (0..m.ngeom).map(move |b| (a, b))).filter(|(a, b)| a != b);
    let of = |(a, b)| {
        let found = core::geom_distance(m, &mut d, a, b, 100.0)?;
        let [p, q] = found.fromto;
        Ok([found.dist, p[0], p[1], p[2], q[0], q[1], q[2]].map(f64::to_bits))
    };
    pairs.map(of).collect()
}

#[cfg(feature = "mjcf")]
#[test]
fn a_full_build_records_models_and_their_results() {
    std::fs::create_dir_all(left("")).unwrap();
    let compile = |text: &str| Model::from_xml(&format!("<mujoco>{text}</mujoco>")).unwrap();
    let bytes = |bits: &[u64]| bits.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    for (name, text) in SHARED {
        let mut m = compile(text);
        std::fs::write(left(name).with_extension("model"), m.to_bytes()).unwrap();
        let measured: Vec<[u64; 7]> = distances(&m).into_iter().map(Result::unwrap).collect();
        std::fs::write(left(name).with_extension("distances"), bytes(measured.as_flattened())).unwrap();
        let (history, contacts) = history(&mut m);
        assert_eq!(contacts > 0, name != "distances" && name != "parts of one body", "{name}");
        std::fs::write(left(name).with_extension("history"), bytes(&history)).unwrap();
    }
    for (name, text, _) in REFUSED {
        let m = compile(text);
        assert!(Model::from_bytes(&m.to_bytes()).is_ok(), "{name}");
        std::fs::write(left(name).with_extension("model"), m.to_bytes()).unwrap();
    }
}

#[cfg(not(feature = "convex"))]
mod lean {
    use super::*;

    fn read(name: &str, kind: &str) -> Vec<u8> {
        let path = left(name).with_extension(kind);
        std::fs::read(&path).unwrap_or_else(|e| {
            panic!("{}: {e}; first: cargo test -p labspec-core --test lean", path.display())
        })
    }

    fn bits(name: &str, kind: &str) -> Vec<u64> {
        read(name, kind).as_chunks().0.iter().map(|x| u64::from_le_bytes(*x)).collect()
    }

    #[test]
    fn models_that_need_no_search_step_to_the_same_bits() {
        for (name, _) in SHARED {
            let mut m = Model::from_bytes(&read(name, "model")).unwrap();
            assert!(history(&mut m).0 == bits(name, "history"), "{name}");
        }
    }

    /// A distance equals that of the full build, or is an error.
    #[test]
    fn no_distance_is_omitted_silently() {
        let (mut same, mut refused) = (0, 0);
        for (name, _) in SHARED {
            let m = Model::from_bytes(&read(name, "model")).unwrap();
            let full = bits(name, "distances");
            let full = full.as_chunks::<7>().0;
            let lean = distances(&m);
            assert_eq!(lean.len(), full.len(), "{name}");
            for (lean, full) in lean.into_iter().zip(full) {
                match lean {
                    Ok(found) => {
                        assert_eq!(found, *full, "{name}");
                        same += 1;
                    }
                    Err(Error::NoConvex { geom1, geom2 }) => {
                        let kinds = [geom1, geom2].map(|g| m.geom_type[g]);
                        // Two boxes, or a pair of an ellipsoid, a cylinder or a mesh with a round or flat shape.
                        assert!(kinds.iter().any(|k| matches!(k, 4..=7)), "{name}: {kinds:?}");
                        refused += 1;
                    }
                    Err(other) => panic!("{name}: {other}"),
                }
            }
        }
        assert!(same >= 20 && refused >= 10, "{same} {refused}");
    }

    /// The functions for MJCF are there, and say what is missing.
    #[cfg(not(feature = "mjcf"))]
    #[test]
    fn every_text_is_refused_with_the_next_step() {
        let Err(Error::Model(findings)) = Model::from_xml(" <mujoco/>") else { panic!("it is compiled") };
        assert_eq!(findings.len(), 1);
        assert_eq!((findings[0].code, findings[0].span.clone()), ("mjcf-not-supported", 1..2));
        assert!(findings[0].help.as_ref().unwrap().contains("store its bytes"));
        assert!(core::xml::check_xml("", &core::xml::NoFiles, None).model.is_none());
    }

    #[test]
    fn models_that_may_ever_need_a_search_are_refused() {
        for (name, _, [a, b]) in REFUSED {
            match Model::from_bytes(&read(name, "model")) {
                Err(Error::NoConvex { geom1, geom2 }) => assert_eq!([geom1, geom2], [a, b], "{name}"),
                other => panic!("{name}: {:?}", other.map(|m| m.ngeom)),
            }
        }
    }
}
