//! Invalid models and the diagnostics that an author reads.

use super::world;
use crate::mjcf::{FileProblem, Files, NoFiles, check_xml, compile_with};

/// Each finding with its line of the text, and its span underlined.
fn explained(xml: &str) -> String {
    let list = check_xml(xml, &NoFiles, None).findings;
    if list.is_empty() {
        return "no finding\n".into();
    }
    let mut out = String::new();
    for d in list {
        let at = d.position.unwrap();
        let line = xml.lines().nth(at.line - 1).unwrap_or("");
        let width =
            xml.get(d.span.clone()).map_or(1, |s| s.lines().next().unwrap_or("").chars().count().max(1));
        out += &format!("{line}\n{}{}\n{d}\n\n", " ".repeat(at.column - 1), "^".repeat(width));
    }
    out
}

macro_rules! mistakes {
    ($($name:ident: $xml:expr;)*) => { $(
        #[test]
        fn $name() {
            insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
                insta::assert_snapshot!(stringify!($name), explained(&$xml));
            });
        }
    )* };
}

/// Sections before the world.
fn before(sections: &str) -> String {
    format!("<mujoco>{sections}<worldbody/></mujoco>")
}

/// A mesh with these attributes, and a geom with this mesh.
fn mesh(attributes: &str) -> String {
    format!(
        "<mujoco><asset>\n<mesh name=\"m\" {attributes}/></asset><worldbody>\n<geom type=\"mesh\" mesh=\"m\"/></worldbody></mujoco>"
    )
}

/// A model with a moving body, and these sections after the world.
fn after(sections: &str) -> String {
    format!(
        "<mujoco><worldbody><body name=\"b\"><freejoint name=\"j\"/><geom size=\"0.1\"/></body></worldbody>\n{sections}</mujoco>"
    )
}

/// A model with two sites and two geoms, and these sections after the world.
fn tied(sections: &str) -> String {
    format!(
        "<mujoco><worldbody><site name=\"s\"/><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/><body name=\"b\"><freejoint name=\"j\"/><geom name=\"g\" size=\"0.1\"/><site name=\"t\" pos=\"1 0 0\"/></body></worldbody>\n{sections}</mujoco>"
    )
}

/// A model with a hinge, a ball joint, two sites and this actuator.
fn driven(actuator: &str) -> String {
    format!(
        "<mujoco><worldbody><site name=\"t\"/><body name=\"b\"><joint name=\"h\"/><geom size=\"0.1\"/><site name=\"s\"/></body><body><joint name=\"f\" type=\"ball\"/><geom size=\"0.1\"/></body></worldbody>\n<actuator>{actuator}</actuator></mujoco>"
    )
}

/// A model that refers to itself, for every path.
struct Itself(&'static str);

impl Files for Itself {
    fn read(&self, _: &str, _: usize) -> Result<Vec<u8>, FileProblem> {
        Ok(self.0.as_bytes().to_vec())
    }
}

#[test]
fn hostile_include_cycle() {
    let xml = "<mujoco>\n<include file=\"other.xml\"/>\n</mujoco>";
    let list = compile_with(xml, &Itself(xml), Some("model.xml")).unwrap_err();
    let text: String = list.iter().map(|d| format!("{d}\n")).collect();
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("hostile_include_cycle", text);
    });
}

mistakes! {
    // XML
    xml_wrong_close: "<mujoco>\n  <worldbody>\n    <body>\n  </worldbody>\n</mujoco>";
    xml_unclosed: "<mujoco>\n  <worldbody>\n";
    xml_attribute_twice: world("<geom size=\"1\" size=\"2\"/>");
    xml_quote_missing: world("\n<geom size=\"1 name=\"a\"/>");
    xml_comment: "<mujoco><!-- a -- b --></mujoco>";
    xml_ampersand: before("<custom><text name=\"a\" data=\"x & y\"/></custom>");
    xml_doctype: "<!DOCTYPE mujoco [<!ENTITY a \"b\">]>\n<mujoco/>";
    xml_empty: "";
    xml_not_a_model: "<robot name=\"urdf\"/>";
    // Elements and attributes
    element_misspelt: world("\n<boddy/>");
    element_misplaced: "<mujoco>\n<worldbody/>\n<geom size=\"1\"/>\n</mujoco>";
    element_not_supported: after("<deformable><flex name=\"cloth\"/></deformable>");
    element_twice: before("<option><flag/><flag/></option>");
    attribute_misspelt: world("<geom size=\"1\" fricton=\"1\"/>");
    attribute_of_world: "<mujoco><worldbody name=\"w\"/></mujoco>";
    mesh_missing: world("<geom type=\"mesh\"/>");
    mesh_with_three_vertices: mesh("vertex=\"0 0 0 1 0 0 0 1 0\"");
    mesh_flat: mesh("vertex=\"0 0 0 1 0 0 0 1 0 1 1 0\"");
    mesh_face_beyond_vertices: mesh("vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\" face=\"0 1 4\"");
    mesh_half_a_vertex: mesh("vertex=\"0 0 0 1 0 0 0 1 0 0 0 1 2\"");
    mesh_inside_out: mesh("vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\" face=\"0 1 2 0 3 1 0 2 3 1 3 2\" inertia=\"exact\"");
    mesh_triangles_differ: mesh("vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\" face=\"0 1 2 0 1 3 0 3 2 1 2 3\" inertia=\"exact\"");
    mesh_too_small: mesh("vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\" scale=\"1e-6 1e-6 1e-6\"");
    mesh_two_sources: mesh("vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\" builtin=\"sphere\" params=\"1\"");
    mesh_rule_unknown: mesh("builtin=\"ball\" params=\"1\"");
    mesh_rule_parameters: mesh("builtin=\"cone\" params=\"4\"");
    mesh_file_without_folder: mesh("file=\"a.obj\"");
    mesh_with_fromto: "<mujoco><asset>\n<mesh name=\"m\" builtin=\"sphere\" params=\"1\"/></asset><worldbody>\n<geom type=\"box\" mesh=\"m\" fromto=\"0 0 0 1 1 1\"/></worldbody></mujoco>";
    hfield_without_rows: before("<asset><hfield name=\"h\" size=\"1 1 1 1\"/></asset>");
    hfield_elevations_missing: before("<asset><hfield name=\"h\" nrow=\"2\" ncol=\"3\" size=\"1 1 1 1\" elevation=\"1 2 3\"/></asset>");
    hfield_without_height: before("<asset><hfield name=\"h\" nrow=\"2\" ncol=\"3\" size=\"1 1 0 1\"/></asset>");
    geom_type_not_supported: world("<geom type=\"sdf\" size=\"1 1\"/>");
    keyword_misspelt: before("<option integrator=\"euler\"/>");
    integrator_unknown: before("<option integrator=\"midpoint\"/>");
    sleep_start_touches: before("<option><flag sleep=\"enable\"/></option>\n<worldbody><body name=\"ball\" sleep=\"init\"><freejoint/><geom size=\"1\"/></body><body pos=\"1.9 0 0\"><freejoint/><geom size=\"1\"/></body></worldbody>");
    sleep_without_islands: before("<option integrator=\"discrete\">\n<flag sleep=\"enable\" island=\"disable\"/></option>");
    sleep_of_tendons: tied("<option><flag sleep=\"enable\"/></option>\n<tendon><spatial name=\"rope\"><site site=\"s\"/><site site=\"t\"/></spatial></tendon><equality><tendon tendon1=\"rope\"/></equality>");
    boolean: world("<body mocap=\"True\"/>");
    stray_text: world("\n  geom size=\"1\"/>");
    // Warnings
    default_of_nothing: "<mujoco><default>\n<default class=\"u\"><geom material=\"steel\"/></default></default><worldbody/></mujoco>";
    hfield_one_row: "<mujoco><asset>\n<hfield name=\"h\" nrow=\"1\" ncol=\"5\" size=\"1 1 1 1\"/></asset><worldbody><geom type=\"hfield\" hfield=\"h\"/></worldbody></mujoco>";
    // Sizes
    user_size_negative: before("<size nuser_geom=\"-2\"/>");
    numeric_too_long: before("<custom>\n<numeric name=\"n\" size=\"1000000\"/></custom>");
    camera_without_pixels: world("\n<camera resolution=\"0 5\" sensorsize=\"1 1\"/>");
    name_too_long: world(&format!("\n<geom size=\"1\" name=\"{}\"/>", "n".repeat(1001)));
    // Numbers
    number_comma: world("<geom size=\"1\" pos=\"0,0,1\"/>");
    number_word: world("<geom size=\"1\" pos=\"0 0 up\"/>");
    number_nan: world("<geom size=\"nan\"/>");
    number_too_large: world("<geom size=\"1e999\"/>");
    number_missing: world("<geom size=\"1\" pos=\"0 1\"/>");
    number_extra: world("<geom size=\"1\" friction=\"1 2 3 4\"/>");
    integer_fraction: world("<geom size=\"1\" contype=\"1.5\"/>");
    integer_too_large: world("<geom size=\"1\" contype=\"4294967295\"/>");
    timestep_zero: before("<option timestep=\"0\"/>");
    iterations_negative: before("<option iterations=\"-1\"/>");
    statistic_negative: before("<statistic extent=\"-1\"/>");
    eulerseq: before("<compiler eulerseq=\"xyw\"/>");
    // Names
    name_twice: world("\n<geom name=\"a\" size=\"1\"/>\n<geom name=\"a\" size=\"1\"/>");
    name_world: world("<body name=\"world\"/>");
    material_unknown: "<mujoco><asset><material name=\"wood\"/></asset>\n<worldbody><geom size=\"1\" material=\"wod\"/></worldbody></mujoco>";
    class_unknown: "<mujoco><default><default class=\"visual\"/></default>\n<worldbody><geom size=\"1\" class=\"visaul\"/></worldbody></mujoco>";
    class_without_name: before("<default><default/></default>");
    class_twice: before("<default><default class=\"a\"/><default class=\"a\"/></default>");
    class_outer_renamed: before("<default class=\"a\"/>");
    // Frames
    orientation_twice: world("<body quat=\"1 0 0 0\" euler=\"0 0 90\"/>");
    orientation_zero: world("<body quat=\"0 0 0 0\"/>");
    orientation_parallel: world("<body xyaxes=\"1 0 0 2 0 0\"/>");
    // Joints
    joint_axis_zero: world("<body><joint axis=\"0 0 0\"/><geom size=\"1\"/></body>");
    joint_range_reversed: world("<body><joint name=\"hinge\" range=\"30 -30\"/><geom size=\"1\"/></body>");
    joint_range_missing: world("<body><joint limited=\"true\"/><geom size=\"1\"/></body>");
    joint_ball_range: world("<body><joint type=\"ball\" range=\"-30 30\"/><geom size=\"1\"/></body>");
    joint_range_unused: "<mujoco><compiler autolimits=\"false\"/><worldbody><body>\n<joint range=\"0 1\"/><geom size=\"1\"/></body></worldbody></mujoco>";
    joint_free_nested: world("<body name=\"outer\"><body name=\"inner\"><freejoint/><geom size=\"1\"/></body></body>");
    joint_after_ball: world("<body><joint type=\"ball\"/><joint/><geom size=\"1\"/></body>");
    joint_too_many: world("<body><freejoint/><joint/><geom size=\"1\"/></body>");
    joint_springdamper: world("<body><joint springdamper=\"1 -1\"/><geom size=\"1\"/></body>");
    joint_force_range: world("<body><joint actuatorfrcrange=\"1 -1\"/><geom size=\"1\"/></body>");
    sleep_misplaced: world("<body name=\"arm\"><joint/><geom size=\"1\"/><body name=\"hand\" sleep=\"never\"><joint/><geom size=\"1\"/></body></body>");
    user_too_long: "<mujoco><size nuser_jnt=\"1\"/><worldbody><body><joint user=\"1 2\"/><geom size=\"1\"/></body></worldbody></mujoco>";
    joint_in_world: world("<joint/>");
    // Bodies and geoms
    body_without_mass: world("<body name=\"ghost\">\n<joint/><geom size=\"1\" mass=\"0\"/></body>");
    body_without_inertia: world("<body><joint/><inertial pos=\"0 0 0\" mass=\"1\"/></body>");
    inertial_without_mass: world("<body><joint/><inertial pos=\"0 0 0\" diaginertia=\"1 1 1\"/></body>");
    inertial_triangle: world("<body><joint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 3\"/></body>");
    inertial_full: world("<body><joint/><inertial pos=\"0 0 0\" mass=\"1\" fullinertia=\"1 1 1 2 0 0\"/></body>");
    mocap_nested: world("<body name=\"arm\"><body name=\"hand\" mocap=\"true\"/></body>");
    mocap_joint: world("<body name=\"hand\" mocap=\"true\"><joint/><geom size=\"1\"/></body>");
    sphere_without_size: world("<geom name=\"ball\"/>");
    sphere_negative: world("<geom name=\"ball\" size=\"-0.1\"/>");
    plane_one_size: world("<geom name=\"floor\" type=\"plane\" size=\"1\"/>");
    plane_moving: world("<body name=\"raft\"><joint/><geom size=\"1\"/>\n<geom type=\"plane\" size=\"1 1 1\"/></body>");
    mass_negative: world("<body><geom size=\"1\" mass=\"-2\"/></body>");
    condim: world("<geom size=\"1\" condim=\"2\"/><geom size=\"1\" condim=\"4\"/>");
    // Sensors and keyframes
    sensor_unknown_joint: after("<sensor><jointpos joint=\"jj\"/></sensor>");
    sensor_wrong_joint: after("<sensor><jointpos joint=\"j\"/></sensor>");
    sensor_without_object: after("<sensor><framepos objtype=\"body\"/></sensor>");
    sensor_unknown_body: after("<sensor><framepos objtype=\"body\" objname=\"c\"/></sensor>");
    sensor_reference: after("<sensor><framepos objtype=\"body\" objname=\"b\" reftype=\"body\"/></sensor>");
    sensor_kind_of_object: after("<sensor><framepos objtype=\"joint\" objname=\"j\"/></sensor>");
    sensor_no_limits: after("<sensor><jointlimitpos joint=\"j\"/></sensor>");
    sensor_two_objects: after("<sensor><distance geom1=\"g\" body1=\"b\" body2=\"world\"/></sensor>");
    sensor_same_objects: after("<sensor><distance body1=\"b\" body2=\"b\"/></sensor>");
    sensor_missing_side: after("<sensor><distance body1=\"b\"/></sensor>");
    sensor_data: after("<sensor><contact data=\"found normal pos\"/>\n<contact data=\"found depth\"/></sensor>");
    sensor_num: after("<sensor><contact num=\"0\"/>\n<contact num=\"1000000000\"/></sensor>");
    sensor_too_many: after(&format!("<sensor>{}</sensor>", "<contact num=\"4000000\"/>".repeat(3)));
    sensor_delay: after("<sensor><clock delay=\"0.1\"/>\n<clock nsample=\"-1\"/></sensor>");
    sensor_interval: after("<sensor><clock interval=\"0.1 0.05\"/></sensor>");
    sensor_user: after("<sensor><user/>\n<user dim=\"2\" datatype=\"axis\"/></sensor>");
    sensor_plugin: after("<sensor><plugin plugin=\"touch_grid\"/>\n<tactile geom=\"g\" mesh=\"m\"/></sensor>");
    sensor_cutoff: after("<sensor><framequat objtype=\"body\" objname=\"b\" cutoff=\"1\"/></sensor>");
    key_short: after("<keyframe><key name=\"k\" qpos=\"0 0 1\"/></keyframe>");
    key_long: after("<keyframe><key qvel=\"0 0 0 0 0 0 1\"/></keyframe>");
    key_control: after("<keyframe><key ctrl=\"1\"/></keyframe>");
    // Actuators
    actuator_without_target: driven("<motor name=\"m\"/>");
    actuator_two_targets: driven("<motor joint=\"h\" site=\"s\"/>");
    actuator_unknown_joint: driven("<motor joint=\"hh\"/>");
    actuator_range_reversed: driven("<motor joint=\"h\" ctrlrange=\"1 -1\"/>");
    actuator_range_missing: driven("<motor joint=\"h\" forcelimited=\"true\"/>");
    actuator_kv_and_dampratio: driven("<position joint=\"h\" kv=\"1\" dampratio=\"1\"/>");
    actuator_kv_negative: driven("<position joint=\"h\" kv=\"-1\"/>");
    actuator_inherit_nothing: driven("<position joint=\"f\" inheritrange=\"1\"/>");
    actuator_inherit_and_range: driven("<position joint=\"h\" inheritrange=\"1\" ctrlrange=\"0 1\"/>");
    actuator_act_without_state: driven("<general joint=\"h\" actrange=\"0 1\"/>");
    actuator_actdim: driven("<general joint=\"h\" dyntype=\"filter\" actdim=\"2\"/>");
    actuator_user_dynamics: driven("<general joint=\"h\" dyntype=\"user\"/>");
    actuator_delay_without_samples: driven("<motor joint=\"h\" delay=\"0.1\"/>");
    actuator_damper_backwards: driven("<damper joint=\"h\" kv=\"1\" ctrlrange=\"-1 1\"/>");
    actuator_adhesion_unlimited: driven("<adhesion body=\"b\"/>");
    actuator_crank_without_slider: driven("<motor cranksite=\"s\" cranklength=\"1\"/>");
    actuator_crank_without_length: driven("<motor cranksite=\"s\" slidersite=\"t\"/>");
    actuator_refsite_of_joint: driven("<motor joint=\"h\" refsite=\"s\"/>");
    actuator_armature_of_site: driven("<motor site=\"s\" armature=\"1\"/>");
    orientation_of_hinge: driven("<orientation joint=\"h\"/>");
    orientation_without_reference: driven("<orientation site=\"s\"/>");
    orientation_input: driven("<orientation joint=\"f\" input=\"pos\"/>");
    pid_input: driven("<pid joint=\"h\" input=\"vel pos\"/>");
    pid_two_states: driven("<pid joint=\"h\" ki=\"1\" slewmax=\"1\"/>");
    pid_integral_of_velocity: driven("<pid joint=\"h\" ki=\"1\" input=\"vel\"/>");
    dcmotor_without_constants: driven("<dcmotor joint=\"h\"/>");
    dcmotor_gains_without_setpoint: driven("<dcmotor joint=\"h\" motorconst=\"0.1\" resistance=\"1\" controller=\"1\"/>");
    dcmotor_thermal: driven("<dcmotor joint=\"h\" motorconst=\"0.1\" resistance=\"1\" thermal=\"1\"/>");
    muscle_range: driven("<muscle joint=\"h\" range=\"1 0.5\" lengthrange=\"0 1\"/>");
    muscle_lengths: driven("<muscle joint=\"h\" lmin=\"1.1\" lengthrange=\"0 1\"/>");
    muscle_without_end: driven("<muscle joint=\"h\"/>");
    actuator_group_disabled: before("<option actuatorgroupdisable=\"31\"/>");
        key_activation: driven("<general joint=\"h\" dyntype=\"filter\"/></actuator><keyframe><key act=\"1 2\"/></keyframe><actuator>");
    // Tendons
    tendon_empty: tied("<tendon><spatial name=\"rope\"/></tendon>");
    tendon_one_site: tied("<tendon>\n<spatial><site site=\"s\"/></spatial></tendon>");
    tendon_repeated_site: tied("<tendon>\n<spatial><site site=\"s\"/><site site=\"s\"/></spatial></tendon>");
    tendon_geom_last: tied("<tendon>\n<spatial><site site=\"s\"/><geom geom=\"g\"/></spatial></tendon>");
    tendon_two_geoms: tied("<tendon>\n<spatial><site site=\"s\"/><geom geom=\"g\"/><geom geom=\"g\"/><site site=\"t\"/></spatial></tendon>");
    tendon_wraps_plane: tied("<tendon>\n<spatial><site site=\"s\"/><geom geom=\"floor\"/><site site=\"t\"/></spatial></tendon>");
    tendon_pulley_last: tied("<tendon>\n<spatial><site site=\"s\"/><site site=\"t\"/><pulley divisor=\"2\"/></spatial></tendon>");
    tendon_pulley_twice: tied("<tendon>\n<spatial><pulley divisor=\"2\"/><pulley divisor=\"2\"/><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_pulley_zero: tied("<tendon>\n<spatial><pulley divisor=\"0\"/><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_pulley_alone: tied("<tendon>\n<spatial><pulley/><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_without_joint: tied("<tendon>\n<fixed><joint coef=\"1\"/></fixed></tendon>");
    tendon_unknown_site: tied("<tendon>\n<spatial><site site=\"s\"/><site site=\"tt\"/></spatial></tendon>");
    tendon_range: tied("<tendon>\n<spatial range=\"2 1\" springlength=\"2 1\" actuatorfrcrange=\"1 2\" width=\"0\"><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_armature_wrapped: tied("<tendon>\n<spatial armature=\"1\"><site site=\"s\"/><geom geom=\"g\"/><site site=\"t\"/></spatial></tendon>");
    tendon_rotor_wrapped: tied("<tendon>\n<spatial name=\"rope\"><site site=\"s\"/><geom geom=\"g\"/><site site=\"t\"/></spatial></tendon>\n<actuator><motor tendon=\"rope\" armature=\"1\"/></actuator>");
    // Equality constraints, contact pairs
    connect_without_anchor: tied("<equality>\n<connect body1=\"b\"/></equality>");
    connect_to_itself: tied("<equality>\n<connect body1=\"b\" body2=\"b\" anchor=\"0 0 0\"/></equality>");
    connect_sites_and_bodies: tied("<equality>\n<connect site1=\"s\" site2=\"t\" anchor=\"0 0 0\"/></equality>");
    weld_one_site: tied("<equality>\n<weld site1=\"s\"/></equality>");
    weld_nothing: tied("<equality>\n<weld/></equality>");
    equality_free_joint: tied("<equality>\n<joint joint1=\"j\"/></equality>");
    equality_flex: tied("<equality>\n<flex flex=\"f\"/></equality>");
    pair_one_geom: tied("<contact>\n<pair geom1=\"g\"/></contact>");
    pair_condim: tied("<contact>\n<pair geom1=\"g\" geom2=\"floor\" condim=\"2\"/></contact>");
    exclude_one_body: tied("<contact>\n<exclude body1=\"b\"/></contact>");
    // Malicious models
    hostile_nesting: world(&format!("\n{}", "<body>".repeat(1001)));
    hostile_many_keys: "<mujoco><size nkey=\"2147483647\"/><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>";
    hostile_many_copies: world("<replicate count=\"2147483647\"><geom size=\"1\"/></replicate>");
    hostile_copies_of_copies: world(&format!("{}<geom size=\"1\"/>{}", "<replicate count=\"99\">".repeat(9), "</replicate>".repeat(9)));
    hostile_infinite: world("<body pos=\"inf 0 0\"><joint damping=\"-inf\"/><geom size=\"1\" mass=\"nan\"/></body>");
    hostile_attached_to_itself: world("<body name=\"a\"><attach body=\"a\" prefix=\"b\"/></body>");
    hostile_names_of_nothing: tied("<contact><pair geom1=\"gg\" geom2=\"nothing\"/></contact>\n<sensor><jointpos joint=\"k\"/></sensor>\n<actuator><motor tendon=\"rope\"/></actuator>");
    global_coordinates: before("<compiler coordinate=\"global\"/>");
    // Several findings at once, in the order of the text
    many: "<mujoco>\n  <option timestep=\"0.002s\" gravitiy=\"0 0 -1\"/>\n  <worldbody>\n    <body name=\"a\">\n      <joint type=\"hing\"/>\n      <geom size=\"-1\"/>\n    </body>\n    <body name=\"a\"/>\n  </worldbody>\n</mujoco>";
}
