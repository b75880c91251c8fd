//! Small texts, compared with the answers of MuJoCo 3.14.0, recorded by `golden/cases.py`.

use crate::mjcf::{NoFiles, Severity, check_xml, compile, rules};
use crate::step::forward::forward;
use crate::step::workspace::Workspace;

/// The recorded lines: the answer of MuJoCo, and the text.
fn cases(recorded: &'static str) -> impl Iterator<Item = (&'static str, String)> {
    recorded.lines().map(|line| {
        let (answer, text) = line.split_once('|').unwrap();
        (answer, text.replace("\\n", "\n"))
    })
}

/// A model with text between elements loads if and only if it loads in MuJoCo. The text itself causes a warning, never an error.
#[test]
fn text_between_elements_loads_where_mujoco_loads_it() {
    let (mut wrong, mut warned) = (Vec::new(), 0);
    for (answer, text) in cases(include_str!("../golden/texts.txt")) {
        let checked = check_xml(&text, &NoFiles, None);
        let outcome = if checked.model.is_some() { "loads" } else { "refused" };
        let texts: Vec<_> = checked.findings.iter().filter(|d| d.code == rules::TEXT).collect();
        if outcome != answer || texts.iter().any(|d| d.severity == Severity::Error) {
            wrong.push(format!("{answer} there, {outcome} here: {text:?}: {:?}", checked.findings.first()));
        }
        for d in texts {
            assert!(text.get(d.span.clone()).is_some_and(|s| !s.trim().is_empty()), "{text:?}: {:?}", d.span);
            warned += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(warned > 150, "{warned}");
}

/// Sizes and references at the limits of their valid range.
#[test]
fn sizes_are_refused_where_mujoco_refuses_them() {
    let mut wrong = Vec::new();
    for (answer, text) in cases(include_str!("../golden/sizes.txt")) {
        let outcome = if compile(&text).is_ok() { "loads" } else { "refused" };
        if outcome != answer {
            wrong.push(format!("{answer} there, {outcome} here: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Shapes with a negative margin have the same contacts and constraint rows as in MuJoCo.
#[test]
fn negative_margins_are_those_of_mujoco() {
    let mut wrong = Vec::new();
    for (recorded, text) in cases(include_str!("../golden/margins.txt")) {
        let m = compile(&text).unwrap();
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        forward(&m, &mut d, &mut s);
        let expected: Vec<f64> = recorded.split(' ').map(|x| x.parse().unwrap()).collect();
        let mut contents = vec![d.ncon as f64, d.nefc as f64];
        contents.extend(d.contact.iter().map(|c| c.dist));
        let same = expected.len() == contents.len()
            && expected.iter().zip(&contents).all(|(a, b)| (a - b).abs() < 1e-9);
        if !same {
            wrong.push(format!("want {expected:?}, got {contents:?}: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The principal axes of meshes with equal or nearly equal moments are those of MuJoCo.
#[test]
fn axes_of_nearly_symmetric_meshes_are_those_of_mujoco() {
    let mut wrong = Vec::new();
    for (recorded, text) in cases(include_str!("../golden/ties.txt")) {
        let expected: Vec<f64> = recorded.split(' ').map(|x| x.parse().unwrap()).collect();
        let computed = compile(&text).unwrap().geom_quat;
        let product: f64 = expected.iter().zip(&computed).map(|(a, b)| a * b).sum();
        if 1.0 - product.abs() > 1e-12 {
            wrong.push(format!("want {expected:?}, got {computed:?}: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Exclusions apply only to the bodies that they name, for any number of bodies. MuJoCo's signature of two bodies, 65,536 times
/// the first id plus the second, is ambiguous with more than 65,535 bodies.
#[test]
fn exclusions_of_many_bodies_keep_only_theirs_apart() {
    // The ids of the two excluded bodies are 1 and 65,540 = 65,536 + 4, so that (1, 65,540) and (2, 4) have the same signature.
    let filler = "<body/>".repeat(65_535);
    let ball = |name: &str| format!("<body name='{name}'><joint type='slide'/><geom size='1'/></body>");
    let text = format!(
        "<mujoco><worldbody>{}{}<body/>{}{filler}{}</worldbody><contact><exclude body1='a' body2='z'/></contact></mujoco>",
        ball("a"),
        ball("b"),
        ball("c"),
        ball("z"),
    );
    let m = compile(&text).unwrap();
    assert_eq!(m.exclude_bodies, [[1, 65_540]]);
    assert_eq!(m.exclude_signature, [(2 << 16) + 4]);
    let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
    forward(&m, &mut d, &mut s);
    // Four balls at the same position: all six pairs except the excluded one.
    assert_eq!(d.ncon, 5);
}
