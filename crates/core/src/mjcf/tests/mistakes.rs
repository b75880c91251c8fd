//! Invalid models and the diagnostics that an author reads.

use super::world;
use crate::mjcf::{check_xml, compile_with};
use crate::source::files::{FileProblem, Files, NoFiles};

/// Each finding with its line of the text, and its span underlined.
fn format_findings(xml: &str) -> String {
    let list = check_xml(xml, &NoFiles, None).findings;
    if list.is_empty() {
        return "no finding\n".into();
    }
    let mut out = String::new();
    for d in list {
        let position = d.position.unwrap();
        let line = xml.lines().nth(position.line - 1).unwrap_or("");
        let width =
            xml.get(d.span.clone()).map_or(1, |s| s.lines().next().unwrap_or("").chars().count().max(1));
        out += &format!("{line}\n{}{}\n{d}\n\n", " ".repeat(position.column - 1), "^".repeat(width));
    }
    out
}

macro_rules! mistakes {
    ($($name:ident: $xml:expr;)*) => { $(
        #[test]
        fn $name() {
            insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
                insta::assert_snapshot!(stringify!($name), format_findings(&$xml));
            });
        }
    )* };
}

/// Sections before the world.
fn model_with_sections(sections: &str) -> String {
    format!("<mujoco>{sections}<worldbody/></mujoco>")
}

/// A mesh with these attributes, and a geom with this mesh.
fn mesh(attributes: &str) -> String {
    format!(
        "<mujoco><asset>\n<mesh name=\"m\" {attributes}/></asset><worldbody>\n<geom type=\"mesh\" mesh=\"m\"/></worldbody></mujoco>"
    )
}

/// A model with a moving body, and these sections after the world.
fn model_with_trailing_sections(sections: &str) -> String {
    format!(
        "<mujoco><worldbody><body name=\"b\"><freejoint name=\"j\"/><geom size=\"0.1\"/></body></worldbody>\n{sections}</mujoco>"
    )
}

/// A model with two sites and two geoms, and these sections after the world.
fn model_with_sites(sections: &str) -> String {
    format!(
        "<mujoco><worldbody><site name=\"s\"/><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/><body name=\"b\"><freejoint name=\"j\"/><geom name=\"g\" size=\"0.1\"/><site name=\"t\" pos=\"1 0 0\"/></body></worldbody>\n{sections}</mujoco>"
    )
}

/// A model with a hinge, a ball joint, two sites and this actuator.
fn model_with_actuator(actuator: &str) -> String {
    format!(
        "<mujoco><worldbody><site name=\"t\"/><body name=\"b\"><joint name=\"h\"/><geom size=\"0.1\"/><site name=\"s\"/></body><body><joint name=\"f\" type=\"ball\"/><geom size=\"0.1\"/></body></worldbody>\n<actuator>{actuator}</actuator></mujoco>"
    )
}

/// A model that refers to itself, for every path.
struct SelfReference(&'static str);

impl Files for SelfReference {
    fn read(&self, _: &str, _: usize) -> Result<Vec<u8>, FileProblem> {
        Ok(self.0.as_bytes().to_vec())
    }
}

#[test]
fn hostile_include_cycle() {
    let xml = "<mujoco>\n<include file=\"other.xml\"/>\n</mujoco>";
    let list = compile_with(xml, &SelfReference(xml), Some("model.xml")).unwrap_err();
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
    xml_ampersand: model_with_sections("<custom><text name=\"a\" data=\"x & y\"/></custom>");
    xml_doctype: "<!DOCTYPE mujoco [<!ENTITY a \"b\">]>\n<mujoco/>";
    xml_empty: "";
    xml_not_a_model: "<robot name=\"urdf\"/>";
    // Elements and attributes
    element_misspelt: world("\n<boddy/>");
    element_misplaced: "<mujoco>\n<worldbody/>\n<geom size=\"1\"/>\n</mujoco>";
    element_not_supported: model_with_trailing_sections("<deformable><flex name=\"cloth\"/></deformable>");
    element_twice: model_with_sections("<option><flag/><flag/></option>");
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
    hfield_without_rows: model_with_sections("<asset><hfield name=\"h\" size=\"1 1 1 1\"/></asset>");
    hfield_elevations_missing: model_with_sections("<asset><hfield name=\"h\" nrow=\"2\" ncol=\"3\" size=\"1 1 1 1\" elevation=\"1 2 3\"/></asset>");
    hfield_without_height: model_with_sections("<asset><hfield name=\"h\" nrow=\"2\" ncol=\"3\" size=\"1 1 0 1\"/></asset>");
    geom_type_not_supported: world("<geom type=\"sdf\" size=\"1 1\"/>");
    keyword_misspelt: model_with_sections("<option integrator=\"euler\"/>");
    integrator_unknown: model_with_sections("<option integrator=\"midpoint\"/>");
    sleep_start_touches: model_with_sections("<option><flag sleep=\"enable\"/></option>\n<worldbody><body name=\"ball\" sleep=\"init\"><freejoint/><geom size=\"1\"/></body><body pos=\"1.9 0 0\"><freejoint/><geom size=\"1\"/></body></worldbody>");
    sleep_without_islands: model_with_sections("<option integrator=\"discrete\">\n<flag sleep=\"enable\" island=\"disable\"/></option>");
    sleep_of_tendons: model_with_sites("<option><flag sleep=\"enable\"/></option>\n<tendon><spatial name=\"rope\"><site site=\"s\"/><site site=\"t\"/></spatial></tendon><equality><tendon tendon1=\"rope\"/></equality>");
    boolean: world("<body mocap=\"True\"/>");
    stray_text: world("\n  geom size=\"1\"/>");
    // Warnings
    default_of_nothing: "<mujoco><default>\n<default class=\"u\"><geom material=\"steel\"/></default></default><worldbody/></mujoco>";
    hfield_one_row: "<mujoco><asset>\n<hfield name=\"h\" nrow=\"1\" ncol=\"5\" size=\"1 1 1 1\"/></asset><worldbody><geom type=\"hfield\" hfield=\"h\"/></worldbody></mujoco>";
    // Sizes
    user_size_negative: model_with_sections("<size nuser_geom=\"-2\"/>");
    numeric_too_long: model_with_sections("<custom>\n<numeric name=\"n\" size=\"1000000\"/></custom>");
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
    timestep_zero: model_with_sections("<option timestep=\"0\"/>");
    iterations_negative: model_with_sections("<option iterations=\"-1\"/>");
    statistic_negative: model_with_sections("<statistic extent=\"-1\"/>");
    eulerseq: model_with_sections("<compiler eulerseq=\"xyw\"/>");
    // Names
    name_twice: world("\n<geom name=\"a\" size=\"1\"/>\n<geom name=\"a\" size=\"1\"/>");
    name_world: world("<body name=\"world\"/>");
    material_unknown: "<mujoco><asset><material name=\"wood\"/></asset>\n<worldbody><geom size=\"1\" material=\"wod\"/></worldbody></mujoco>";
    class_unknown: "<mujoco><default><default class=\"visual\"/></default>\n<worldbody><geom size=\"1\" class=\"visaul\"/></worldbody></mujoco>";
    class_without_name: model_with_sections("<default><default/></default>");
    class_twice: model_with_sections("<default><default class=\"a\"/><default class=\"a\"/></default>");
    class_outer_renamed: model_with_sections("<default class=\"a\"/>");
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
    sensor_unknown_joint: model_with_trailing_sections("<sensor><jointpos joint=\"jj\"/></sensor>");
    sensor_wrong_joint: model_with_trailing_sections("<sensor><jointpos joint=\"j\"/></sensor>");
    sensor_without_object: model_with_trailing_sections("<sensor><framepos objtype=\"body\"/></sensor>");
    sensor_unknown_body: model_with_trailing_sections("<sensor><framepos objtype=\"body\" objname=\"c\"/></sensor>");
    sensor_reference: model_with_trailing_sections("<sensor><framepos objtype=\"body\" objname=\"b\" reftype=\"body\"/></sensor>");
    sensor_kind_of_object: model_with_trailing_sections("<sensor><framepos objtype=\"joint\" objname=\"j\"/></sensor>");
    sensor_no_limits: model_with_trailing_sections("<sensor><jointlimitpos joint=\"j\"/></sensor>");
    sensor_two_objects: model_with_trailing_sections("<sensor><distance geom1=\"g\" body1=\"b\" body2=\"world\"/></sensor>");
    sensor_same_objects: model_with_trailing_sections("<sensor><distance body1=\"b\" body2=\"b\"/></sensor>");
    sensor_missing_side: model_with_trailing_sections("<sensor><distance body1=\"b\"/></sensor>");
    sensor_data: model_with_trailing_sections("<sensor><contact data=\"found normal pos\"/>\n<contact data=\"found depth\"/></sensor>");
    sensor_num: model_with_trailing_sections("<sensor><contact num=\"0\"/>\n<contact num=\"1000000000\"/></sensor>");
    sensor_too_many: model_with_trailing_sections(&format!("<sensor>{}</sensor>", "<contact num=\"4000000\"/>".repeat(3)));
    sensor_delay: model_with_trailing_sections("<sensor><clock delay=\"0.1\"/>\n<clock nsample=\"-1\"/></sensor>");
    sensor_interval: model_with_trailing_sections("<sensor><clock interval=\"0.1 0.05\"/></sensor>");
    sensor_user: model_with_trailing_sections("<sensor><user/>\n<user dim=\"2\" datatype=\"axis\"/></sensor>");
    sensor_plugin: model_with_trailing_sections("<sensor><plugin plugin=\"touch_grid\"/>\n<tactile geom=\"g\" mesh=\"m\"/></sensor>");
    sensor_cutoff: model_with_trailing_sections("<sensor><framequat objtype=\"body\" objname=\"b\" cutoff=\"1\"/></sensor>");
    key_short: model_with_trailing_sections("<keyframe><key name=\"k\" qpos=\"0 0 1\"/></keyframe>");
    key_long: model_with_trailing_sections("<keyframe><key qvel=\"0 0 0 0 0 0 1\"/></keyframe>");
    key_control: model_with_trailing_sections("<keyframe><key ctrl=\"1\"/></keyframe>");
    // Actuators
    actuator_without_target: model_with_actuator("<motor name=\"m\"/>");
    actuator_two_targets: model_with_actuator("<motor joint=\"h\" site=\"s\"/>");
    actuator_unknown_joint: model_with_actuator("<motor joint=\"hh\"/>");
    actuator_range_reversed: model_with_actuator("<motor joint=\"h\" ctrlrange=\"1 -1\"/>");
    actuator_range_missing: model_with_actuator("<motor joint=\"h\" forcelimited=\"true\"/>");
    actuator_kv_and_dampratio: model_with_actuator("<position joint=\"h\" kv=\"1\" dampratio=\"1\"/>");
    actuator_kv_negative: model_with_actuator("<position joint=\"h\" kv=\"-1\"/>");
    actuator_inherit_nothing: model_with_actuator("<position joint=\"f\" inheritrange=\"1\"/>");
    actuator_inherit_and_range: model_with_actuator("<position joint=\"h\" inheritrange=\"1\" ctrlrange=\"0 1\"/>");
    actuator_act_without_state: model_with_actuator("<general joint=\"h\" actrange=\"0 1\"/>");
    actuator_actdim: model_with_actuator("<general joint=\"h\" dyntype=\"filter\" actdim=\"2\"/>");
    actuator_user_dynamics: model_with_actuator("<general joint=\"h\" dyntype=\"user\"/>");
    actuator_delay_without_samples: model_with_actuator("<motor joint=\"h\" delay=\"0.1\"/>");
    actuator_damper_backwards: model_with_actuator("<damper joint=\"h\" kv=\"1\" ctrlrange=\"-1 1\"/>");
    actuator_adhesion_unlimited: model_with_actuator("<adhesion body=\"b\"/>");
    actuator_crank_without_slider: model_with_actuator("<motor cranksite=\"s\" cranklength=\"1\"/>");
    actuator_crank_without_length: model_with_actuator("<motor cranksite=\"s\" slidersite=\"t\"/>");
    actuator_refsite_of_joint: model_with_actuator("<motor joint=\"h\" refsite=\"s\"/>");
    actuator_armature_of_site: model_with_actuator("<motor site=\"s\" armature=\"1\"/>");
    orientation_of_hinge: model_with_actuator("<orientation joint=\"h\"/>");
    orientation_without_reference: model_with_actuator("<orientation site=\"s\"/>");
    orientation_input: model_with_actuator("<orientation joint=\"f\" input=\"pos\"/>");
    pid_input: model_with_actuator("<pid joint=\"h\" input=\"vel pos\"/>");
    pid_two_states: model_with_actuator("<pid joint=\"h\" ki=\"1\" slewmax=\"1\"/>");
    pid_integral_of_velocity: model_with_actuator("<pid joint=\"h\" ki=\"1\" input=\"vel\"/>");
    dcmotor_without_constants: model_with_actuator("<dcmotor joint=\"h\"/>");
    dcmotor_gains_without_setpoint: model_with_actuator("<dcmotor joint=\"h\" motorconst=\"0.1\" resistance=\"1\" controller=\"1\"/>");
    dcmotor_thermal: model_with_actuator("<dcmotor joint=\"h\" motorconst=\"0.1\" resistance=\"1\" thermal=\"1\"/>");
    muscle_range: model_with_actuator("<muscle joint=\"h\" range=\"1 0.5\" lengthrange=\"0 1\"/>");
    muscle_lengths: model_with_actuator("<muscle joint=\"h\" lmin=\"1.1\" lengthrange=\"0 1\"/>");
    muscle_without_end: model_with_actuator("<muscle joint=\"h\"/>");
    actuator_group_disabled: model_with_sections("<option actuatorgroupdisable=\"31\"/>");
        key_activation: model_with_actuator("<general joint=\"h\" dyntype=\"filter\"/></actuator><keyframe><key act=\"1 2\"/></keyframe><actuator>");
    // Tendons
    tendon_empty: model_with_sites("<tendon><spatial name=\"rope\"/></tendon>");
    tendon_one_site: model_with_sites("<tendon>\n<spatial><site site=\"s\"/></spatial></tendon>");
    tendon_repeated_site: model_with_sites("<tendon>\n<spatial><site site=\"s\"/><site site=\"s\"/></spatial></tendon>");
    tendon_geom_last: model_with_sites("<tendon>\n<spatial><site site=\"s\"/><geom geom=\"g\"/></spatial></tendon>");
    tendon_two_geoms: model_with_sites("<tendon>\n<spatial><site site=\"s\"/><geom geom=\"g\"/><geom geom=\"g\"/><site site=\"t\"/></spatial></tendon>");
    tendon_wraps_plane: model_with_sites("<tendon>\n<spatial><site site=\"s\"/><geom geom=\"floor\"/><site site=\"t\"/></spatial></tendon>");
    tendon_pulley_last: model_with_sites("<tendon>\n<spatial><site site=\"s\"/><site site=\"t\"/><pulley divisor=\"2\"/></spatial></tendon>");
    tendon_pulley_twice: model_with_sites("<tendon>\n<spatial><pulley divisor=\"2\"/><pulley divisor=\"2\"/><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_pulley_zero: model_with_sites("<tendon>\n<spatial><pulley divisor=\"0\"/><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_pulley_alone: model_with_sites("<tendon>\n<spatial><pulley/><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_without_joint: model_with_sites("<tendon>\n<fixed><joint coef=\"1\"/></fixed></tendon>");
    tendon_unknown_site: model_with_sites("<tendon>\n<spatial><site site=\"s\"/><site site=\"tt\"/></spatial></tendon>");
    tendon_range: model_with_sites("<tendon>\n<spatial range=\"2 1\" springlength=\"2 1\" actuatorfrcrange=\"1 2\" width=\"0\"><site site=\"s\"/><site site=\"t\"/></spatial></tendon>");
    tendon_armature_wrapped: model_with_sites("<tendon>\n<spatial armature=\"1\"><site site=\"s\"/><geom geom=\"g\"/><site site=\"t\"/></spatial></tendon>");
    tendon_rotor_wrapped: model_with_sites("<tendon>\n<spatial name=\"rope\"><site site=\"s\"/><geom geom=\"g\"/><site site=\"t\"/></spatial></tendon>\n<actuator><motor tendon=\"rope\" armature=\"1\"/></actuator>");
    // Equality constraints, contact pairs
    connect_without_anchor: model_with_sites("<equality>\n<connect body1=\"b\"/></equality>");
    connect_to_itself: model_with_sites("<equality>\n<connect body1=\"b\" body2=\"b\" anchor=\"0 0 0\"/></equality>");
    connect_sites_and_bodies: model_with_sites("<equality>\n<connect site1=\"s\" site2=\"t\" anchor=\"0 0 0\"/></equality>");
    weld_one_site: model_with_sites("<equality>\n<weld site1=\"s\"/></equality>");
    weld_nothing: model_with_sites("<equality>\n<weld/></equality>");
    equality_free_joint: model_with_sites("<equality>\n<joint joint1=\"j\"/></equality>");
    equality_flex: model_with_sites("<equality>\n<flex flex=\"f\"/></equality>");
    pair_one_geom: model_with_sites("<contact>\n<pair geom1=\"g\"/></contact>");
    pair_condim: model_with_sites("<contact>\n<pair geom1=\"g\" geom2=\"floor\" condim=\"2\"/></contact>");
    exclude_one_body: model_with_sites("<contact>\n<exclude body1=\"b\"/></contact>");
    // Malicious models
    hostile_nesting: world(&format!("\n{}", "<body>".repeat(1001)));
    hostile_many_keys: "<mujoco><size nkey=\"2147483647\"/><worldbody><body><freejoint/><geom size=\"1\"/></body></worldbody></mujoco>";
    hostile_many_copies: world("<replicate count=\"2147483647\"><geom size=\"1\"/></replicate>");
    hostile_copies_of_copies: world(&format!("{}<geom size=\"1\"/>{}", "<replicate count=\"99\">".repeat(9), "</replicate>".repeat(9)));
    hostile_infinite: world("<body pos=\"inf 0 0\"><joint damping=\"-inf\"/><geom size=\"1\" mass=\"nan\"/></body>");
    hostile_attached_to_itself: world("<body name=\"a\"><attach body=\"a\" prefix=\"b\"/></body>");
    hostile_names_of_nothing: model_with_sites("<contact><pair geom1=\"gg\" geom2=\"nothing\"/></contact>\n<sensor><jointpos joint=\"k\"/></sensor>\n<actuator><motor tendon=\"rope\"/></actuator>");
    global_coordinates: model_with_sections("<compiler coordinate=\"global\"/>");
    // Several findings at once, in the order of the text
    many: "<mujoco>\n  <option timestep=\"0.002s\" gravitiy=\"0 0 -1\"/>\n  <worldbody>\n    <body name=\"a\">\n      <joint type=\"hing\"/>\n      <geom size=\"-1\"/>\n    </body>\n    <body name=\"a\"/>\n  </worldbody>\n</mujoco>";
}
