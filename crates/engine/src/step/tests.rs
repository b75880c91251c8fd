//! Bad numbers: which warnings MuJoCo 3.14.0 counts, when it resets, and from which state it continues, measured step by step.

use super::*;
use crate::step::workspace::Workspace;
use crate::tests::compile;

/// A model with a slide and a hinge, each with a motor, after three steps.
fn started(flag: &str) -> (Model, Workspace) {
    let text = format!(
        "<mujoco><option>{flag}</option><worldbody><body><joint type='slide'/><joint/><geom size='.1'/></body></worldbody>\
         <actuator><motor joint='a'/><motor joint='b'/></actuator></mujoco>"
    );
    let named =
        text.replace("type='slide'", "name='a' type='slide'").replace("<joint/>", "<joint name='b'/>");
    let m = compile(&named).unwrap();
    let mut w = Workspace::new(&m);
    (0..3).for_each(|_| step(&m, &mut w.fields, &mut w.scratch));
    (m, w)
}

/// The number and the index of each warning that was raised.
fn raised(d: &Fields) -> Vec<(Warning, usize, usize)> {
    let all = Warning::ALL.into_iter().zip(&d.warning);
    all.filter(|(_, s)| s.number > 0).map(|(w, s)| (w, s.number, s.lastinfo)).collect()
}

const NO_AUTORESET: &str = "<flag autoreset='disable'/>";

#[test]
fn a_bad_number_resets_the_data_and_the_step_continues() {
    type Fault = (Warning, fn(&mut Fields));
    let breaks: [Fault; 5] = [
        (Warning::BadQpos, |d| d.qpos[1] = f64::NAN),
        (Warning::BadQvel, |d| d.qvel[1] = 1e11),
        (Warning::BadQvel, |d| d.qvel[1] = f64::NEG_INFINITY),
        (Warning::BadQacc, |d| d.qfrc_applied[1] = 1e12),
        (Warning::BadQacc, |d| d.qfrc_applied[1] = f64::INFINITY),
    ];
    for (warning, act) in breaks {
        let (m, Workspace { fields: mut d, scratch: mut s }) = started("");
        act(&mut d);
        for k in 1..=3 {
            step(&m, &mut d, &mut s);
            assert!((d.time - 0.002 * f64::from(k)).abs() < 1e-15);
            assert_eq!(raised(&d), [(warning, 1, 1)]);
            assert_eq!(d.warning[warning as usize].first_time, 0.006);
        }
        assert!((d.qpos[0] + 0.00023544).abs() < 1e-15 && d.qpos[1] == 0.0);
    }
}

#[test]
fn without_a_reset_every_step_counts_twice() {
    let (m, Workspace { fields: mut d, scratch: mut s }) = started(NO_AUTORESET);
    d.qpos[1] = f64::NAN;
    for n in [2, 4, 6] {
        step(&m, &mut d, &mut s);
        assert_eq!(raised(&d).first(), Some(&(Warning::BadQpos, n, 1)));
    }
    let (m, Workspace { fields: mut d, scratch: mut s }) = started(NO_AUTORESET);
    d.qfrc_applied[1] = 1e12;
    (0..3).for_each(|_| step(&m, &mut d, &mut s));
    assert_eq!(raised(&d), [(Warning::BadQvel, 4, 1), (Warning::BadQacc, 6, 1)]);
}

#[test]
fn a_bad_control_acts_as_zero() {
    for flag in ["", NO_AUTORESET] {
        let (m, Workspace { fields: mut d, scratch: mut s }) = started(flag);
        d.ctrl[0] = 1.0;
        d.ctrl[1] = f64::NAN;
        (0..3).for_each(|_| step(&m, &mut d, &mut s));
        assert_eq!(raised(&d), [(Warning::BadCtrl, 3, 1)]);
        assert!((d.qpos[0] + 0.00082404).abs() < 1e-15 && d.qpos[1] == 0.0);
    }
}
