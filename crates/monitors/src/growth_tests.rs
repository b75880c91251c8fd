use super::*;
use labspec_core::{reset_data, step, xml};

/// The growth found in a run of `steps` steps from the state that `start` sets.
fn run(text: &str, steps: usize, start: impl Fn(&mut Data)) -> Option<Growth> {
    let m = xml::compile(text).unwrap();
    let mut d = Data::new(&m);
    start(&mut d);
    let mut w = watch(&m, &d);
    for _ in 0..steps {
        step(&m, &mut d).unwrap();
        observe(&mut w, &m, &d);
    }
    assert!(d.warning.iter().all(|w| w.number == 0), "a run that breaks is not what is tested");
    w.found
}

fn cart(option: &str, joint: &str, actuator: &str) -> String {
    format!(
        "<mujoco><option gravity=\"0 0 0\" {option}/><worldbody><body><joint name=\"j\" type=\"slide\" {joint}/>\
         <geom size=\".1\" mass=\"1\"/></body></worldbody><actuator>{actuator}</actuator></mujoco>"
    )
}

/// A double pendulum with links of 1 kg that starts in horizontal position.
fn pendulum(option: &str, joint: &str) -> String {
    let link = |inner: &str| {
        format!(
            "<body pos=\".5 0 0\"><joint axis=\"0 1 0\" {joint}/><geom type=\"capsule\" fromto=\"0 0 0 .5 0 0\" \
             size=\".02\" mass=\"1\" contype=\"0\" conaffinity=\"0\"/>{inner}</body>"
        )
    };
    format!("<mujoco><option {option}/><worldbody>{}</worldbody></mujoco>", link(&link("")))
}

#[test]
fn a_spring_just_beyond_its_limit_grows_and_below_it_does_not() {
    for integrator in ["Euler", "implicit", "implicitfast"] {
        // The longest stable step for k = 1e4 N/m and 1 kg is 2/ω = 0.02 s. With s = hω/2 < 1 the energy oscillates by the
        // factor (1 + s)/(1 - s): 39 at 0.019 s, 667 at 0.01994 s. The spring stores as much of it as the motion, and the
        // energy returns within some steps. Within 0.1 % of the limit an oscillation takes longer than LASTS; the monitor
        // may report it or not.
        for (h, grows) in [(0.0201, true), (0.01994, false), (0.019, false), (0.015, false), (0.002, false)] {
            let text =
                cart(&format!("integrator=\"{integrator}\" timestep=\"{h}\""), "stiffness=\"1e4\"", "");
            for steps in [72, 120, 480] {
                let found = run(&text, if grows { 72 } else { steps }, |d| d.edit().qpos[0] = 1e-3);
                assert_eq!(found.is_some(), grows, "{integrator} {h} {steps}: {found:?}");
            }
        }
    }
}

#[test]
fn a_servo_whose_amplitude_doubles_with_each_step_grows() {
    for servo in ["<position joint=\"j\" kp=\"4.5\"/>", "<pid joint=\"j\" kp=\"4.5\"/>"] {
        let text = cart("integrator=\"implicitfast\" timestep=\"1\"", "", servo);
        let found = run(&text, 24, |d| (d.edit().qpos[0], d.edit().ctrl[0]) = (0.01, 0.02)).unwrap();
        assert!(
            found.dof == 0 && found.time < 8.0 && found.gain > 100.0 * found.available_energy,
            "{found:?}"
        );
        let discrete = text.replace("implicitfast", "discrete");
        assert_eq!(run(&discrete, 24, |d| d.edit().qpos[0] = 0.01), None);
    }
}

#[test]
fn physical_energy_input_is_not_reported() {
    // Falls, topples, swings and spins up: gravity or a constant force supplies the energy of the motion.
    for integrator in ["Euler", "RK4", "implicit", "implicitfast", "discrete"] {
        let option = format!("integrator=\"{integrator}\"");
        assert_eq!(run(&pendulum(&option, ""), 4800, |_| ()), None, "{integrator}");
        // With `implicit`, the integrator itself accelerates a whirling free double pendulum, in MuJoCo as here: by 608 J
        // in 8 s.
        let upright = run(&pendulum(&option, ""), 4800, |d| d.edit().qpos[0] = -1.56);
        assert_eq!(upright.is_some(), integrator == "implicit", "{integrator}: {upright:?}");
        let motor = cart(&option, "", "<motor joint=\"j\"/>");
        assert_eq!(run(&motor, 4800, |d| d.edit().ctrl[0] = 50.0), None, "{integrator}");
        let available_energy = cart(&option, "", "<position joint=\"j\" kp=\"500\" forcerange=\"-2 2\"/>");
        assert_eq!(run(&available_energy, 4800, |d| d.edit().ctrl[0] = 50.0), None, "{integrator}");
    }
}

#[test]
fn systems_with_energy_sources_are_not_monitored() {
    // Negative damping at small speeds and positive damping at large speeds, an external force, and a servo with a delay.
    let keeps = cart("", "damping=\"-2 0 1\" stiffness=\"10\"", "");
    assert_eq!(run(&keeps, 2400, |d| d.edit().qpos[0] = 1e-3), None);
    assert_eq!(run(&cart("", "", ""), 2400, |d| d.edit().qfrc_applied[0] = 50.0), None);
    let late = "<position joint=\"j\" kp=\"100\" delay=\".1\" nsample=\"60\"/>";
    assert_eq!(run(&cart("", "", late), 2400, |d| d.edit().qpos[0] = 0.1), None);
}

#[test]
fn a_negative_damper_supplies_energy() {
    for integrator in ["Euler", "implicitfast"] {
        let with = |damping: f64| {
            let text =
                pendulum(&format!("integrator=\"{integrator}\""), "").replacen("axis", "DAMPED axis", 1);
            run(&text.replace("DAMPED", &format!("damping=\"{damping}\"")), 1500, |_| ())
        };
        let found = with(-0.2).unwrap();
        assert_eq!(found.source, Source::Damper(0), "{integrator}: {found:?}");
        assert!(found.gain > 1.0 && found.time > 0.1, "{integrator}: {found:?}");
        assert_eq!(with(0.0).or(with(0.2)), None, "{integrator}");
    }
}

#[test]
fn a_timestep_that_is_too_long_for_an_oscillation_is_reported() {
    let one = |h: f64, integrator: &str| {
        let text = format!(
            "<mujoco><option timestep=\"{h}\" integrator=\"{integrator}\"/><worldbody><body><joint axis=\"0 1 0\"/>\
             <geom type=\"capsule\" fromto=\"0 0 0 .4 0 0\" size=\".03\" mass=\".5\"/></body></worldbody></mujoco>"
        );
        run(&text, (60.0 / h) as usize, |_| ())
    };
    for integrator in ["Euler", "RK4", "implicit", "implicitfast", "discrete"] {
        let found = one(1.0, integrator).unwrap();
        assert!(matches!(found.source, Source::LongSteps(turn) if turn > 3.1), "{integrator}: {found:?}");
        for h in [0.01, 0.1] {
            assert_eq!(one(h, integrator), None, "{integrator} {h} s");
        }
    }
}

#[test]
fn a_compressed_start_may_expand() {
    let text = "<mujoco><worldbody><geom type=\"plane\" size=\"1 1 1\" solref=\"-1e6 -10\"/><body pos=\"0 0 .05\">\
                <freejoint/><geom size=\".1\" mass=\"1\" solref=\"-1e6 -10\"/></body></worldbody><option timestep=\"1e-4\"/></mujoco>";
    assert_eq!(run(text, 9600, |_| ()), None);
    // The same from a height: the integrator throws it up.
    let text = text.replace("0 0 .05", "0 0 .3").replace("-1e6 -10", "-1e8 -1").replace("1e-4", ".002");
    let found = run(&text, 960, |_| ()).unwrap();
    assert!(found.dof == 2 && found.time > 0.2 && found.time < 0.4, "{found:?}");
}

#[test]
fn a_change_from_outside_is_a_new_start() {
    let m = xml::compile(&cart("", "", "<motor joint=\"j\"/>")).unwrap();
    let mut d = Data::new(&m);
    d.edit().qvel[0] = 1e-3;
    let mut w = watch(&m, &d);
    d.edit().qvel[0] = 1e5;
    // Each step computes the poses of the state from which it starts, so the energy of that state is known one step later.
    assert_eq!(observe(&mut w, &m, &d), None);
    assert!(evaluate_last(&w, &m).is_some(), "a run that ends here has grown");
    step(&m, &mut d).unwrap();
    assert!(observe(&mut w, &m, &d).is_some());
    let mut w = watch(&m, &d);
    (d.edit().qvel[0], d.edit().ctrl[0]) = (1e9, 1.0);
    assert_eq!(observe(&mut w, &m, &d), None);
    reset_data(&m, &mut d).unwrap();
    restart(&mut w, &m, &d);
    assert_eq!(observe(&mut w, &m, &d), None);
}
