//! Access to one element of a field gives the same value as the view of the field.

use super::*;
use crate::step::workspace::Workspace;

#[test]
fn elements_are_those_of_views() {
    let model = crate::tests::compile(
        "<mujoco><option timestep='0.003'/><statistic extent='4'/>
         <worldbody><body pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>",
    );
    let m = model.unwrap();
    let mut d = Workspace::new(&m).fields;
    d.time = 0.25;
    for f in fields() {
        let whole = view(&m, &d, f);
        for i in 0..=whole.len() {
            let bits = |x: Option<f64>| x.map(f64::to_bits);
            assert_eq!(bits(element(&m, &d, f, i)), bits(whole.get(i)), "{}[{i}]", f.info().name);
        }
    }
    let time = field(Object::Data, "time").unwrap();
    assert_eq!(element(&m, &d, time, 0), Some(0.25));
    assert_eq!(element(&m, &d, FieldId(NFIELD as u16), 0), None);
}
