//! Malicious texts: the compiler must answer with diagnostics, quickly, and never panic.

use super::world;
use crate::mjcf::{MAX_DEPTH, compile, rules};

fn first_code(xml: &str) -> Option<&'static str> {
    compile(xml).err().and_then(|list| list.first().map(|d| d.code))
}

#[test]
fn deep_nesting_is_refused_and_allowed_nesting_compiles() {
    let nested = |n: usize| {
        let open = "<body pos='0 0 1'><joint/><geom size='0.1'/>".repeat(n);
        world(&format!("{open}{}", "</body>".repeat(n)))
    };
    assert_eq!(compile(&nested(300)).map(|m| m.nv), Ok(300));
    assert_eq!(first_code(&nested(MAX_DEPTH + 1)), Some(rules::LIMIT.code));
    assert_eq!(first_code(&"<mujoco>".repeat(1_000_000)), Some(rules::LIMIT.code));
}

#[test]
fn models_cannot_request_unbounded_memory() {
    let keys = "<mujoco><size nkey='2147483647'/><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>";
    assert_eq!(first_code(keys), Some(rules::LIMIT.code));
    let classes = format!("<mujoco><default>{}</default></mujoco>", "<default class='a'/>".repeat(5000));
    assert!(compile(&classes).is_err());
    let chain = "<body><joint type='slide'/><geom size='1'/>".repeat(900);
    let leaves = "<body><joint type='slide'/><geom size='1'/></body>".repeat(40_000);
    assert_eq!(
        first_code(&world(&format!("{chain}{leaves}{}", "</body>".repeat(900)))),
        Some(rules::LIMIT.code)
    );
}

#[test]
fn extreme_numbers_do_not_pass_as_models() {
    for inside in [
        "<body><joint/><geom size='1e200'/></body>",
        "<body><joint/><geom size='1e-200'/></body>",
        "<body><joint/><inertial pos='0 0 0' mass='1' fullinertia='1e308 1e308 1e308 1e308 1e308 1e308'/></body>",
        "<body quat='1e-320 0 0 0'/>",
        "<body><joint axis='1e308 1e308 1e308'/><geom size='1'/></body>",
    ] {
        assert!(compile(&world(inside)).is_err(), "{inside}");
    }
    for inside in ["<body quat='1e300 1e300 0 0'/>", "<body zaxis='1e300 0 0'/>", "<body euler='1e300 0 0'/>"]
    {
        let m = compile(&world(inside)).unwrap();
        let norm: f64 = m.body_quat[4..8].iter().map(|x| x * x).sum();
        assert!((norm - 1.0).abs() < 1e-12, "{inside}: {norm}");
    }
}

/// Computing a suggestion costs more than finding the mistake. The compiler must not compute one for every mistake.
#[test]
fn many_mistakes_cost_no_more_than_a_hundred() {
    let name = "n".repeat(34);
    let named: String = (0..2000).map(|i| format!("<material name='{name}{i}'/>")).collect();
    let mistakes = |geoms: String| {
        let sensors = "<framepos objtype='body' objname='nobody'/>".repeat(50_000);
        let xml = format!(
            "<mujoco><asset>{named}</asset><worldbody>{geoms}</worldbody><sensor>{sensors}</sensor></mujoco>"
        );
        let list = compile(&xml).err().unwrap_or_default();
        list.iter().map(|f| f.code).collect::<Vec<_>>()
    };
    // Many uses of one name are one mistake, and many names are many.
    let head = "n".repeat(36);
    assert_eq!(
        mistakes(format!("<geom size='1' material='{head}m'/>").repeat(50_000)),
        ["mjcf-limit", "mjcf-unknown-name", "mjcf-unknown-name"]
    );
    let several = (0..50_000).map(|i| format!("<geom size='1' material='{head}{i}m'/>"));
    assert_eq!(mistakes(several.collect()).len(), 100);
    let unknown = "<geometry sizes='1'/>".repeat(100_000);
    assert_eq!(compile(&world(&unknown)).err().map(|list| list.len()), Some(100));
}

#[test]
fn spans_are_slices_of_the_text() {
    for xml in
        ["<mujoco>&#9;é€=&#9;&#9;é</mujoco>", "<mujoco><xml:éé€/></mujoco>", "<mujoco xml:éé€='1'/>", "<é€/>"]
    {
        let list = crate::mjcf::check_xml(xml, &crate::mjcf::NoFiles, None).findings;
        assert!(!list.is_empty(), "{xml}");
        assert!(list.iter().all(|d| xml.get(d.span.clone()).is_some()), "{list:?}");
    }
}

#[test]
fn files_that_cannot_be_read_say_why() {
    use crate::mjcf::{MjcfFileError, compile_file};
    let golden = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/mjcf/golden");
    assert!(compile_file(&golden.join("chain.xml")).is_ok());
    assert!(matches!(compile_file(&golden.join("none.xml")), Err(MjcfFileError::Io { .. })));
    assert!(matches!(compile_file(&golden), Err(MjcfFileError::Io { .. })));
    let text = match compile_file(&golden.join("chain.txt")) {
        Err(e @ MjcfFileError::Model { .. }) => e.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(text.contains("chain.txt:1:1: error[mjcf-xml]"), "{text}");
}

/// A valid model that is truncated, or from which a piece is removed, duplicated or replaced, at every position, causes no panic.
#[test]
fn mutations_never_panic() {
    let good = include_str!("../golden/sensors_and_keys.xml");
    let other = include_str!("../golden/classes.xml");
    for text in [good, other] {
        for i in (0..text.len()).filter(|&i| text.is_char_boundary(i)) {
            let (a, b) = text.split_at(i);
            for d in compile(a).err().unwrap_or_default() {
                assert!(a.get(d.span.clone()).is_some(), "{d}");
            }
            let skip = b.char_indices().nth(1).map_or(b.len(), |(n, _)| n);
            let _ = compile(&format!("{a}{}", &b[skip..]));
            let _ = compile(&format!("{a}\"{b}"));
            let _ = compile(&format!("{a}9{b}"));
        }
    }
}

#[test]
fn at_most_a_hundred_findings_in_the_order_of_the_text() {
    let list = compile(&world(&"<geom sise='1'/>\n".repeat(500))).unwrap_err();
    assert_eq!(list.len(), 100);
    assert!(list.windows(2).all(|w| w[0].span.start <= w[1].span.start));
}

#[test]
fn tendons_and_user_values_cannot_ask_for_memory() {
    // Each tendon depends on every joint of a long chain.
    let chain = "<body><joint type='slide'/><geom size='1'/>".repeat(900);
    let world =
        format!("<worldbody><site name='a'/>{chain}<site name='b'/>{}</worldbody>", "</body>".repeat(900));
    let tendons = "<spatial><site site='a'/><site site='b'/></spatial>".repeat(30_000);
    let xml = format!("<mujoco>{world}<tendon>{tendons}</tendon></mujoco>");
    assert_eq!(first_code(&xml), Some(rules::LIMIT.code));

    let users = "<mujoco><size nuser_body='2147483647'/><worldbody/></mujoco>";
    assert_eq!(first_code(users), Some(rules::LIMIT.code));
}

/// With any parameters of a path that a program may write, no access is outside the arrays of the model.
#[test]
fn written_paths_stay_inside_the_model() {
    let xml = "<mujoco><worldbody><site name='a'/><geom name='g' size='0.1' pos='0.5 0 0'/><body pos='1 0 0'>
        <freejoint/><geom size='0.1'/><site name='b'/></body></worldbody><tendon><spatial stiffness='1'>
        <site site='a'/><geom geom='g'/><site site='b'/><pulley divisor='2'/><site site='a'/><site site='b'/>
        </spatial></tendon></mujoco>";
    let mut m = compile(xml).unwrap();
    let crate::step::workspace::Workspace { fields: mut d, scratch: mut s } =
        crate::step::workspace::Workspace::new(&m);
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1.0, 0.0, 0.5, 1.0, 2.0] {
        m.wrap_prm.fill(x);
        m.geom_size.fill(x);
        crate::step::forward::forward(&m, &mut d, &mut s);
        crate::step::step(&m, &mut d, &mut s);
    }
}

/// Length ranges are found by simulation, whose work is limited.
#[test]
fn ranges_of_lengths_cannot_ask_for_time() {
    let bodies =
        "<replicate count='900'><body><joint name='j' range='0 1'/><geom size='1'/></body></replicate>";
    let muscles = "<muscle joint='j000'/>".repeat(6);
    let xml = format!("<mujoco><worldbody>{bodies}</worldbody><actuator>{muscles}</actuator></mujoco>");
    assert_eq!(first_code(&xml), Some(rules::LIMIT.code));
}

/// The numbers that a text requests are counted over the whole model. The error is at the element that exceeds the limit.
#[test]
fn numbers_have_one_budget() {
    let lists: String = (0..1000).map(|i| format!("<numeric name='n{i}' size='1000000'/>")).collect();
    assert_eq!(first_code(&format!("<mujoco><custom>{lists}</custom></mujoco>")), Some(rules::COUNT.code));
    let sites = "<site/>".repeat(2000);
    let each = |size: &str, n: usize| {
        format!("<mujoco><size {size}='{n}'/><worldbody><camera/>{sites}</worldbody></mujoco>")
    };
    assert_eq!(first_code(&each("nuser_site", 20_000)), Some(rules::LIMIT.code));
    assert_eq!(first_code(&each("nuserdata", 2_000_000_000)), Some(rules::LIMIT.code));
    // Each list is within the limit, their sum is not.
    let both = "<mujoco><size nuserdata='15000000' nuser_site='7500'/><worldbody>".to_string()
        + &sites
        + "</worldbody></mujoco>";
    assert_eq!(first_code(&both), Some(rules::LIMIT.code));
    let d = compile(&both).unwrap_err().remove(0);
    assert!(d.message.contains("nuserdata") || d.message.contains("user values"), "{d}");
    // A default gives its list to every element. The list is stored once, unless elements override it.
    let list = "1 ".repeat(100_000);
    let shared =
        format!("<mujoco><default><site user='{list}'/></default><worldbody>{sites}</worldbody></mujoco>");
    assert_eq!(first_code(&shared), Some(rules::LIMIT.code));
    let sites = "<site user='2'/>".repeat(2000);
    let overriding =
        format!("<mujoco><default><site user='{list}'/></default><worldbody>{sites}</worldbody></mujoco>");
    assert_eq!(first_code(&overriding), Some(rules::LIMIT.code));
    let classes = (0..1900).map(|i| format!("<default class='c{i}'/>")).collect::<String>();
    let inherited = format!("<mujoco><default><site user='{list}'/>{classes}</default></mujoco>");
    assert!(compile(&inherited).is_ok());
}

/// Names are found by lookup, not by a search through all names.
#[test]
fn many_names_are_found_quickly() {
    let materials: String = (0..40_000).map(|i| format!("<material name='m{i}'/>")).collect();
    let sites = "<site material='m39999'/>".repeat(40_000);
    let start = std::time::Instant::now();
    let m = compile(&format!("<mujoco><asset>{materials}</asset><worldbody>{sites}</worldbody></mujoco>"))
        .unwrap();
    assert_eq!(m.site_matid[39_999], 39_999);
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}
