//! Whole pictures.

use crate::{Camera, Images, Overlays, Picture, View, draw};
use labspec_core::{Data, Model, forward};

fn picture(xml: &str, view: &View) -> Picture {
    let m = Model::from_xml(xml).unwrap();
    let mut d = Data::new(&m);
    forward(&m, &mut d).unwrap();
    draw(&m, &d, view).unwrap()
}

/// A view from above the origin, 2 m away.
fn from_above() -> View {
    let camera = Camera { azimuth: -90.0, elevation: 90.0, distance: Some(2.0), target: Some([0.0; 3]) };
    View { camera, size: [60, 60], ..View::default() }
}

fn at(picture: &Picture, x: usize, y: usize) -> [i32; 3] {
    picture.rgb.as_chunks::<3>().0[y * picture.width + x].map(i32::from)
}

fn brightness(rgb: [i32; 3]) -> i32 {
    rgb.iter().sum()
}

const BALL: &str = "<geom size='.3' rgba='1 0 0 1'/>";

fn scene(bodies: &str) -> String {
    format!("<mujoco><worldbody>{bodies}</worldbody></mujoco>")
}

#[test]
fn a_ball_is_in_the_middle_and_the_page_around_it() {
    let p = picture(&scene(BALL), &from_above());
    let [r, g, b] = at(&p, 30, 30);
    assert!(r > 120 && g < 90 && b < 90, "{r} {g} {b}");
    assert_eq!(at(&p, 2, 2), [0xf4, 0xf6, 0xf9]);
    // Its radius is 0.3 m of the 1.66 m that the picture shows at its depth, a little more because it is nearer.
    let wide = (0..60).filter(|x| at(&p, *x, 30)[1] < 150).count();
    assert!((21..=24).contains(&wide), "{wide}");
}

#[test]
fn equal_scenes_have_equal_bytes() {
    let xml = scene(&format!("{BALL}<geom type='plane' size='1 1 .1' pos='0 0 -.5'/>"));
    let [a, b] = [(); 2].map(|()| picture(&xml, &from_above()));
    assert_eq!(a, b);
    assert_eq!(a.to_jpeg(), b.to_jpeg());
    assert!(a.to_jpeg().is_some_and(|file| file.starts_with(&[0xff, 0xd8])));
}

#[test]
fn what_is_between_a_floor_and_its_light_casts_a_shadow() {
    let light = "<light directional='true' dir='0 0 -1'/>";
    let floor = "<geom type='plane' size='2 2 .1'/>";
    let plate = "<geom type='box' size='.2 .2 .02' pos='.5 0 1' rgba='0 0 1 1'/>";
    // From the side, below the plate.
    let camera =
        Camera { azimuth: 180.0, elevation: 30.0, distance: Some(2.0), target: Some([0.5, 0.0, 0.0]) };
    let view = View { camera, size: [60, 60], ..View::default() };
    let with = picture(&scene(&format!("{light}{floor}{plate}")), &view);
    let without = View { overlays: Overlays { shadows: false, ..Overlays::default() }, ..view };
    let lit = picture(&scene(&format!("{light}{floor}{plate}")), &without);
    assert!(brightness(at(&with, 30, 30)) + 60 < brightness(at(&lit, 30, 30)));
    assert_eq!(at(&with, 30, 57), at(&lit, 30, 57));
}

#[test]
fn one_sees_through_what_is_transparent() {
    let glass = "<geom type='box' size='.4 .4 .02' pos='0 0 .6' rgba='0 0 1 .3'/>";
    let plain = at(&picture(&scene(BALL), &from_above()), 30, 30);
    let through = at(&picture(&scene(&format!("{BALL}{glass}")), &from_above()), 30, 30);
    assert!(through[0] < plain[0] && through[0] > 60 && through[2] > plain[2], "{plain:?} {through:?}");
}

#[test]
fn overlays_are_plain_in_front_and_faint_behind() {
    let sites = |height: f64| {
        let site = format!("<site size='.1' pos='0 0 {height}' rgba='0 1 0 1'/>");
        let overlays = Overlays { sites: true, ..Overlays::default() };
        at(&picture(&scene(&format!("{BALL}{site}")), &View { overlays, ..from_above() }), 30, 30)
    };
    let (front, behind) = (sites(0.5), sites(-0.5));
    assert!(front[1] > 200 && front[0] < 120, "{front:?}");
    assert!(behind[0] > 100 && behind[1] > 60 && behind[1] < 170, "{behind:?}");
}

#[test]
fn a_floor_mirrors_what_is_above_it() {
    let floor = |reflectance: f64| {
        format!(
            "<mujoco><asset><material name='m' reflectance='{reflectance}'/></asset><worldbody>\
             <geom type='plane' size='2 2 .1' material='m' rgba='.2 .2 .2 1'/>\
             <geom size='.2' pos='0 0 .5' rgba='1 0 0 1'/></worldbody></mujoco>"
        )
    };
    let camera = Camera { azimuth: 180.0, elevation: 30.0, distance: Some(3.0), target: Some([0.0; 3]) };
    let view = View {
        camera,
        size: [90, 90],
        overlays: Overlays { shadows: false, ..Overlays::default() },
        ..View::default()
    };
    // The mirror image is as far below the floor as the ball is above it.
    let [rough, bright] = [0.0, 0.5].map(|r| at(&picture(&floor(r), &view), 45, 60));
    assert!(bright[0] > rough[0] + 30 && bright[1] <= rough[1] + 12, "{rough:?} {bright:?}");
}

#[test]
fn nothing_that_a_view_or_a_scene_may_say_breaks_the_picture() {
    let strange = [0.0, -1.0, 1e300, f64::NAN, f64::INFINITY, 1e-300];
    let bodies = format!(
        "{BALL}<geom type='plane' size='0 0 .1'/><body pos='.4 0 .3'><freejoint/><geom type='capsule' size='.1 .2'/>\
         <site name='s' size='.05'/></body><camera pos='0 0 1'/><light pos='0 0 2' type='spot'/>"
    );
    let all = Overlays {
        frames: true,
        joints: true,
        contacts: true,
        forces: true,
        com: true,
        sites: true,
        cameras: true,
        shadows: true,
    };
    for x in strange {
        for camera in [
            Camera { azimuth: x, ..Camera::default() },
            Camera { elevation: x, ..Camera::default() },
            Camera { distance: Some(x), ..Camera::default() },
            Camera { target: Some([x, 0.0, x]), ..Camera::default() },
        ] {
            let view = View {
                camera,
                overlays: all,
                force_scale: x,
                trail: vec![[x, 0.0, 0.0], [0.0; 3], [x; 3]],
                size: [33, 17],
                ..View::default()
            };
            let p = picture(&scene(&bodies), &view);
            assert_eq!(p.rgb.len(), 3 * 33 * 17);
        }
    }
    for size in [[0, 0], [0, 5], [5, 0], [1, 1]] {
        let p = picture(&scene(&bodies), &View { size, ..View::default() });
        assert_eq!(p.rgb.len(), 3 * size[0] * size[1]);
        assert_eq!(p.to_jpeg().is_some(), size == [1, 1]);
    }
    // A state that has broken down.
    let m = Model::from_xml(&scene(&bodies)).unwrap();
    let mut d = Data::new(&m);
    d.edit().qpos.fill(f64::NAN);
    let _ = forward(&m, &mut d);
    assert_eq!(draw(&m, &d, &from_above()).unwrap().rgb.len(), 3 * 60 * 60);
}

/// Whether a scene is drawn, in a picture of 800 × 600 pixels.
fn is_drawn(xml: &str) -> bool {
    let m = Model::from_xml(xml).unwrap();
    let mut d = Data::new(&m);
    forward(&m, &mut d).unwrap();
    draw(&m, &d, &View { size: [800, 600], ..View::default() }).is_some()
}

#[test]
fn a_scene_of_too_many_shapes_is_not_drawn() {
    let balls = |count: usize, rest: &str| {
        let ball = |i: usize| format!("<geom size='.1' pos='{} 0 0' {rest}/>", 0.0001 * i as f64);
        scene(&(0..count).map(ball).collect::<String>())
    };
    assert!(!is_drawn(&balls(4000, "")));
    // Each ray meets many of them.
    assert!(!is_drawn(&balls(1500, "rgba='1 0 0 .02'")));
    assert!(is_drawn(&balls(50, "rgba='1 0 0 .02'")));
}

#[test]
fn geoms_of_one_height_field_share_its_surface() {
    let fields = |fields: usize, geoms: usize| {
        let field = |i: usize| format!("<hfield name='h{i}' nrow='400' ncol='400' size='1 1 .1 .1'/>");
        let geom = |i: usize| format!("<geom type='hfield' hfield='h{}' pos='{i} 0 0'/>", i % fields);
        let assets: String = (0..fields).map(field).collect();
        let geoms: String = (0..geoms).map(geom).collect();
        format!("<mujoco><asset>{assets}</asset><worldbody>{geoms}</worldbody></mujoco>")
    };
    assert!(is_drawn(&fields(1, 12)));
    // 320,000 triangles each.
    assert!(!is_drawn(&fields(4, 4)));
}

/// A PNG file of one row.
fn png_of(pixels: &[[u8; 3]]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixels.len() as u32, 1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
    file
}

#[test]
fn a_texture_from_a_file_has_its_colours_on_the_floor_and_their_mean_far_away() {
    let floor = "<geom type='plane' size='0 0 1' material='m'/>";
    let assets = "<asset><texture type='2d' name='t' file='t.png'/><material name='m' texture='t' texrepeat='1 1'/></asset>";
    let m = Model::from_xml(&format!("<mujoco>{assets}<worldbody>{floor}</worldbody></mujoco>")).unwrap();
    let mut d = Data::new(&m);
    forward(&m, &mut d).unwrap();
    let picture = |file: &[u8], distance: f64| {
        let images = Images::read(&m, |path| (path == "t.png").then(|| file.to_vec()));
        let camera = Camera { distance: Some(distance), ..from_above().camera };
        draw(&m, &d, &View { camera, images, ..from_above() }).unwrap()
    };
    // Red on the left of the origin, blue on its right.
    let file = png_of(&[[255, 0, 0], [0, 0, 255]]);
    let near = picture(&file, 1.0);
    let [left, right] = [10, 50].map(|x| at(&near, x, 30));
    assert!(left[0] > 2 * left[2] && right[2] > 2 * right[0], "{left:?} {right:?}");
    let far = picture(&file, 1000.0);
    let [a, b] = [10, 50].map(|x| at(&far, x, 30));
    assert!([a, b].iter().all(|[red, _, blue]| (red - blue).abs() < 4), "{a:?} {b:?}");
    // A texture without its picture is white.
    let [r, g, b] = at(&picture(b"no picture", 1.0), 30, 30);
    assert!(r == g && g == b, "{r} {g} {b}");
}
