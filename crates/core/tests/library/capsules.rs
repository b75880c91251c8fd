//! A capsule that lies on the end of a cylinder. All points of its axis have the same depth, and it has several contacts.

use crate::departures::at;
use labspec_core::xml::compile;
use std::collections::BTreeMap;

/// There are at least as many contacts as in MuJoCo, and each has the depth of the capsule's axis.
///
/// The reference depth is known from the construction of a case: the depth of the capsule's axis below the end. If the axis
/// almost touches the rim, the search for further contacts, which rotates the capsule slightly about its own axis, finds a point
/// on the axis that rounding selects, in both engines. It may coincide with a known point, so that one case in a hundred may have
/// one contact fewer. (Of 1,500 cases, `capsule_on_cylinder.py 1500`: 4 have.)
#[test]
fn capsules_on_ends_of_cylinders() {
    let text = include_str!("../../../../tests/golden/capsule_on_cylinder.txt");
    let (mut counts, mut cases, mut fewer) = (BTreeMap::new(), 0, 0);
    for line in text.lines() {
        let parts: Vec<&str> = line.split('|').collect();
        let [recorded, numbers @ .., xml] = parts.as_slice() else { unreachable!("{line}") };
        let recorded: usize = recorded.parse().unwrap();
        let numbers: Vec<f64> = numbers.iter().map(|x| x.parse().unwrap()).collect();
        let [depth, tilt, rim] = numbers[..] else { unreachable!("{line}") };
        let m = compile(xml).unwrap();
        let d = at(&m, &m.qpos0.clone(), &[0.0; 6]);
        *counts.entry((recorded, d.ncon)).or_insert(0) += 1;
        cases += 1;
        if d.ncon < recorded {
            assert!(
                d.ncon + 1 == recorded && rim < 0.1 * m.geom_size[0],
                "{} contacts, not {recorded}: {xml}",
                d.ncon
            );
            fewer += 1;
        }
        for c in &d.contact {
            // The capsule extends 0.25 m to either side, so that a tilt lowers its ends.
            assert!((c.dist + depth).abs() <= 0.5 * tilt + 1e-9, "{} m deep, not {depth}: {xml}", -c.dist);
        }
    }
    println!("contacts (theirs, ours): cases {counts:?}");
    assert!(
        100 * fewer <= cases,
        "{fewer} of {cases} cases have fewer contacts than the library gives: {counts:?}"
    );
}
