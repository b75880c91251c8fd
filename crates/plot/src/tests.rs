//! Whole pictures: snapshots for review, and laws that hold for any data.

use super::*;
use proptest::prelude::*;

fn sampled(label: &str, dash: bool, f: impl Fn(f64) -> f64) -> Series {
    let points = (0..=750).map(|i| f64::from(i) * 0.002).map(|t| (t, f(t))).collect();
    Series { label: label.into(), dash, points }
}

/// A wave with period and amplitude 1, made of parabolas, because the platform's sine could change the
/// last digit of a snapshot.
fn wave(turns: f64) -> f64 {
    let u = turns - turns.floor();
    if u < 0.5 { 16.0 * u * (0.5 - u) } else { 16.0 * (u - 0.5) * (u - 1.0) }
}

fn chart(title: &str, ylabel: &str, series: Vec<Series>) -> Chart {
    Chart {
        title: title.into(),
        xlabel: "time (s)".into(),
        ylabel: ylabel.into(),
        width: 640.0,
        height: 300.0,
        series,
        ..Chart::default()
    }
}

fn fall() -> Chart {
    let exact = sampled("1 − ½ g t²", true, |t| (1.0 - 0.5 * 9.81 * t * t).max(0.05));
    let ball = sampled("heavy ball", false, |t| (1.0 - 0.5 * 9.81 * t * (t + 0.002)).max(0.05));
    let drag = sampled("light ball with drag", false, |t| (1.0 - 0.35 * 9.81 * t * t).max(0.05));
    Chart {
        ref_lines: vec![(0.05, Some("radius 5 cm".into())), (0.0, Some("floor".into()))],
        ..chart("Two balls fall from 1 m", "height of the centre (m)", vec![ball, drag, exact])
    }
}

fn energy() -> Chart {
    let noise = |t: f64| 2e-13 * (wave(568.0 * t) + 0.3 * wave(145.0 * t));
    chart("", "total energy (J)", vec![sampled("RK4", false, |t| 0.981 + noise(t) - 3e-13 * t)])
}

fn broken() -> Chart {
    let diverges = sampled("Euler, 20 ms", false, |t| {
        if t < 0.9 { (0..8).fold(1.0, |power, _| power * (1.0 + t)) } else { f64::NAN }
    });
    let many = (1..=9).map(|i| {
        sampled(&format!("damping {i} N·s/m"), false, move |t| {
            80.0 / (1.0 + f64::from(i) * t) * wave(0.25 + 1.4 * t)
        })
    });
    let mut lone = sampled("one sample", false, |_| f64::NAN);
    lone.points.push((1.2, 150.0));
    chart("Many curves, one of them diverges", "force (N)", many.chain([diverges, lone]).collect())
}

fn precision() -> WorkPrecision {
    let method = |label: &str, order: i32, cost: f64, scale: f64, fails: usize| Method {
        label: label.into(),
        points: [20.0, 10.0, 5.0, 2.0, 1.0, 0.5]
            .iter()
            .enumerate()
            .map(|(i, ms): (usize, &f64)| MethodPoint {
                cost: cost / ms,
                error: (0..order).fold(scale, |error, _| error * (ms / 20.0)),
                note: format!("{ms} ms"),
                failed: i < fails,
                at_most: order == 4 && i > 3,
                spread: (order == 1).then_some([0.9 * cost / ms, 1.2 * cost / ms]),
            })
            .collect(),
        echo: None,
    };
    WorkPrecision {
        title: "Pendulum: error after 10 s against run time".into(),
        xlabel: "largest error of the angle (rad)".into(),
        ylabel: "run time per simulated second (µs)".into(),
        methods: vec![
            method("Euler", 1, 900.0, 0.6, 2),
            method("implicit", 1, 1500.0, 0.2, 0),
            method("implicitfast", 1, 1250.0, 0.25, 1),
            method("RK4", 4, 3400.0, 0.02, 0),
        ],
        width: 640.0,
        height: 420.0,
    }
}

fn strips() -> WorkPrecision {
    let point = |cost, error, note: &str, failed| MethodPoint {
        cost,
        error,
        note: note.into(),
        failed,
        ..MethodPoint::default()
    };
    let closed = vec![point(500.0, 0.0, "2 ms", false), point(90.0, 1e-16, "10 ms", false)];
    let wild = vec![point(300.0, f64::INFINITY, "2 ms", false), point(60.0, -1.0, "10 ms", true)];
    WorkPrecision {
        xlabel: "error (m)".into(),
        ylabel: "steps per second".into(),
        methods: vec![
            Method { label: "exact".into(), points: closed, echo: None },
            Method {
                label: "a method with a name that is too long for the right side".into(),
                points: wild,
                echo: Some(0),
            },
            Method {
                label: "cost unknown".into(),
                points: vec![point(f64::NAN, 1e-3, "", false)],
                echo: None,
            },
        ],
        width: 480.0,
        height: 260.0,
        ..WorkPrecision::default()
    }
}

fn hostile() -> Chart {
    let label = "</title><script>alert(1)</script> & \"quotes\" '\u{0}\u{202e}\n";
    Chart {
        xlabel: label.into(),
        ylabel: label.repeat(400),
        ref_lines: vec![(1.0, Some(label.into())), (f64::NAN, None)],
        width: f64::NAN,
        height: -5.0,
        ymin: Some(7.0),
        ymax: Some(f64::INFINITY),
        ..chart(
            label,
            "",
            vec![Series { label: label.into(), dash: true, points: vec![(0.0, 5.0), (1.0, 8.0)] }],
        )
    }
}

fn zoom() -> Chart {
    let wave = sampled("x", false, |t| wave(1.4 * t));
    Chart {
        ymin: Some(-0.5),
        ymax: Some(0.5),
        xmin: Some(0.25),
        xmax: Some(1.0),
        width: 320.0,
        height: 180.0,
        ..chart("Cut at the frame", "x (m)", vec![wave])
    }
}

/// All pictures of this module, which can be written to a folder for review.
fn gallery() -> Vec<(&'static str, String)> {
    vec![
        ("fall", line_chart(&fall())),
        ("energy", line_chart(&energy())),
        ("broken", line_chart(&broken())),
        ("hostile", line_chart(&hostile())),
        ("zoom", line_chart(&zoom())),
        ("empty", line_chart(&Chart { width: 640.0, height: 180.0, ..Chart::default() })),
        ("precision", work_precision(&precision())),
        ("strips", work_precision(&strips())),
        ("cells", cells(&region())),
        (
            "no_methods",
            work_precision(&WorkPrecision { width: 400.0, height: 200.0, ..WorkPrecision::default() }),
        ),
    ]
}

/// A stable triangular region, the region beyond it, and a corner that was not run.
fn region() -> Cells {
    let kind = |i: usize, j: usize| match i + j {
        0..=9 => Some(0),
        10..=12 => Some(1),
        13..=17 => Some(2),
        _ => None,
    };
    Cells {
        title: "Where the arm holds".into(),
        xlabel: "kp".into(),
        ylabel: "timestep h".into(),
        columns: (0..11).map(|i| format!("{}", 100 * i)).collect(),
        rows: (0..9).map(|j| format!("0.00{j}")).collect(),
        kinds: ["fine", "energy grows", "diverges"].map(String::from).to_vec(),
        cells: (0..9).map(|j| (0..11).map(|i| kind(i, j)).collect()).collect(),
        width: 560.0,
        height: 320.0,
    }
}

#[test]
fn pictures() {
    for (name, picture) in gallery() {
        assert_eq!(check_picture(&picture), Ok(()), "{name}");
        insta::assert_snapshot!(name, picture);
    }
}

#[test]
fn hostile_labels_stay_text() {
    let picture = line_chart(&hostile());
    assert!(!picture.contains("<script") && !picture.contains('\u{202e}'));
    assert_eq!(picture.matches("<title>").count(), picture.matches("</title>").count());
}

#[test]
fn a_million_samples_are_a_small_file() {
    let points = (0..1_000_000).map(|i| f64::from(i) * 1e-5).map(|t| (t, wave(1260.0 * t) * t)).collect();
    let picture = line_chart(&chart("", "", vec![Series { label: "noise".into(), dash: false, points }]));
    assert!(picture.len() < 25_000, "{}", picture.len());
    let smooth = (0..1_000_000).map(|i| f64::from(i) * 1e-5).map(|t| (t, t * t)).collect();
    let picture =
        line_chart(&chart("", "", vec![Series { label: "parabola".into(), dash: false, points: smooth }]));
    assert!(picture.len() < 6_000, "{}", picture.len());
}

/// Checks that every element is closed, that attributes are quoted, and that all numbers are valid.
fn check_picture(picture: &str) -> Result<(), String> {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = picture;
    while let Some((text, after)) = rest.split_once('<') {
        if text.contains('>') {
            return Err(format!("stray > in {text}"));
        }
        let (tag, after) = after.split_once('>').ok_or("tag without end")?;
        if tag.matches('"').count() % 2 == 1 || tag.contains('&') {
            return Err(format!("attributes of {tag}"));
        }
        let name = tag.trim_matches('/').split(' ').next().unwrap_or("");
        if tag.starts_with('/') {
            if open.pop() != Some(name) {
                return Err(format!("{name} closed, but not open"));
            }
        } else {
            if let Some(bad) = ["NaN", "inf", "e-", "e+", "e1"].into_iter().find(|b| digits(tag).contains(b))
            {
                return Err(format!("{bad} in {tag}"));
            }
            if !tag.ends_with('/') {
                open.push(name);
            }
        }
        rest = after;
    }
    if open.is_empty() { Ok(()) } else { Err(format!("open at the end: {open:?}")) }
}

/// The numeric attributes of a tag, joined.
fn digits(tag: &str) -> String {
    let values = tag.split('"').collect::<Vec<_>>();
    let pairs =
        values.chunks(2).filter_map(|c| if let [name, value] = c { Some((name, value)) } else { None });
    let numeric =
        ["x", "y", "x1", "x2", "y1", "y2", "d", "cx", "cy", "r", "width", "height", "viewBox", "font-size"];
    pairs
        .filter(|(name, _)| numeric.contains(&name.trim_end_matches('=').rsplit(' ').next().unwrap_or("")))
        .map(|(_, value)| *value)
        .collect::<Vec<_>>()
        .join(" ")
}

/// Numbers of all kinds, with special values often.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -10.0..10.0f64,
        Just(0.0),
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(-f64::MAX),
        Just(5e-324),
        Just(1e300),
    ]
}

fn series() -> impl Strategy<Value = Series> {
    (any::<String>(), any::<bool>(), prop::collection::vec((number(), number()), 0..20))
        .prop_map(|(label, dash, points)| Series { label, dash, points })
}

fn method() -> impl Strategy<Value = Method> {
    let spread = prop::option::of([number(), number()]);
    let point = (number(), number(), any::<String>(), any::<[bool; 2]>(), spread).prop_map(
        |(cost, error, note, [failed, at_most], spread)| MethodPoint {
            cost,
            error,
            note,
            failed,
            at_most,
            spread,
        },
    );
    (any::<String>(), prop::collection::vec(point, 0..12)).prop_map(|(label, points)| Method {
        label,
        points,
        echo: None,
    })
}

proptest! {
    #[test]
    fn any_chart_is_a_valid_picture(
        words in (any::<String>(), any::<String>(), any::<String>()),
        size in (number(), number()),
        ends in prop::array::uniform4(prop::option::of(number())),
        ref_lines in prop::collection::vec((number(), prop::option::of(any::<String>())), 0..4),
        series in prop::collection::vec(series(), 0..40),
    ) {
        let [ymin, ymax, xmin, xmax] = ends;
        let (title, xlabel, ylabel) = words;
        let (width, height) = size;
        let picture =
            line_chart(&Chart { title, xlabel, ylabel, width, height, ymin, ymax, xmin, xmax, ref_lines, series });
        prop_assert_eq!(check_picture(&picture), Ok(()));
    }

    #[test]
    fn any_map_is_a_valid_picture(
        words in (any::<String>(), any::<String>(), any::<String>()),
        size in (number(), number()),
        columns in prop::collection::vec(any::<String>(), 0..30),
        rows in prop::collection::vec(any::<String>(), 0..30),
        kinds in prop::collection::vec(any::<String>(), 0..12),
        grid in prop::collection::vec(prop::collection::vec(prop::option::of(0..14usize), 0..30), 0..30),
    ) {
        let (title, xlabel, ylabel) = words;
        let (width, height) = size;
        let picture = cells(&Cells { title, xlabel, ylabel, columns, rows, kinds, cells: grid, width, height });
        prop_assert_eq!(check_picture(&picture), Ok(()));
    }

    #[test]
    fn any_work_precision_chart_is_a_valid_picture(
        words in (any::<String>(), any::<String>(), any::<String>()),
        size in (number(), number()),
        methods in prop::collection::vec(method(), 0..10),
    ) {
        let (title, xlabel, ylabel) = words;
        let (width, height) = size;
        let picture = work_precision(&WorkPrecision { title, xlabel, ylabel, methods, width, height });
        prop_assert_eq!(check_picture(&picture), Ok(()));
    }
}
