//! A run of a lab in pictures, at the times that matter: at its start, where two things first touch, and at its end; and what touches when,
//! in sentences.

use crate::text::escape;
use crate::verified::short_hash;
use labspec::Player;
use labspec::bind::Programs;
use labspec::player::touching_pairs;
use labspec::report::capital;
use labspec::run::rounded;
use labspec::source::SourceFile;
use labspec::spec::Lab;
use labspec_core::{Data, Model, Obj, Planned};
use labspec_scene::{Camera, Images, Overlays, Picture, View, draw};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::ControlFlow;

/// The width of a picture, pixels: that of the text of a page and a little more. Its height is that of the lab.
const WIDTH: usize = 800;
/// The height of a picture is not above this, pixels.
const MOST_HIGH: f64 = 600.0;
/// Contacts that are listed one by one.
const MOST_EVENTS: usize = 8;
/// The points of the path of a site.
const TRAIL_POINTS: usize = 300;

/// A run in pictures and sentences.
#[derive(Debug, Default)]
pub(crate) struct Moments {
    /// The pictures by their names in the site.
    pub(crate) files: BTreeMap<String, Vec<u8>>,
    /// The name of each picture, and what it shows.
    pictures: Vec<(String, String)>,
    /// What happens, in sentences.
    events: Vec<String>,
    /// Why not everything is drawn.
    problem: Option<String>,
}

impl Moments {
    /// The name of the picture of the start, from which the element of a page starts.
    pub(crate) fn start(&self) -> Option<&str> {
        self.pictures.first().map(|(name, _)| name.as_str())
    }

    /// The pictures and the sentences as HTML. `address` gives the address of a picture from its page.
    pub(crate) fn html(&self, title: &str, address: impl Fn(&str) -> String) -> String {
        let mut out = String::new();
        if !self.pictures.is_empty() {
            out.push_str("<div class=\"moments\">");
            for (name, caption) in &self.pictures {
                let described =
                    if title.is_empty() { caption.clone() } else { format!("{title}: {caption}") };
                let _ = write!(
                    out,
                    "<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>",
                    escape(&address(name)),
                    escape(&described),
                    escape(caption)
                );
            }
            out.push_str("</div>");
        }
        if !self.events.is_empty() {
            let sentences: String =
                self.events.iter().map(|text| format!("<li>{}</li>", escape(text))).collect();
            let _ = write!(out, "<ul class=\"events\">{sentences}</ul>");
        }
        if let Some(problem) = &self.problem {
            let _ = write!(
                out,
                "<p class=\"twin-failed\">The pictures stop early: {}.</p>",
                escape(problem.trim_end_matches('.'))
            );
        }
        out
    }

    fn add(&mut self, picture: Option<Picture>, caption: String) {
        let Some(picture) = picture else {
            return self.fail("its scene has too many shapes for a picture".into());
        };
        let Some(file) = picture.to_jpeg() else {
            return self.fail("a picture cannot be written".into());
        };
        let name = format!("pictures/{}.jpg", short_hash(&[&file]));
        // Where nothing has moved, one picture is enough.
        if self.pictures.last().is_none_or(|(last, _)| *last != name) {
            self.files.insert(name.clone(), file);
            self.pictures.push((name, caption));
        }
    }

    /// Stores the first reason why not everything is drawn.
    fn fail(&mut self, why: String) {
        self.problem.get_or_insert(why);
    }
}

/// How a lab shows its scene.
fn view_of(lab: &Lab, images: Images) -> View {
    let mut overlays = Overlays::default();
    for (name, is_visible) in &lab.overlays {
        let overlay = match name.as_str() {
            "frames" => &mut overlays.frames,
            "joints" => &mut overlays.joints,
            "contacts" => &mut overlays.contacts,
            "forces" => &mut overlays.forces,
            "com" => &mut overlays.com,
            "sites" => &mut overlays.sites,
            "cameras" => &mut overlays.cameras,
            "shadows" => &mut overlays.shadows,
            _ => continue,
        };
        *overlay = *is_visible;
    }
    let camera = &lab.camera;
    View {
        camera: Camera {
            azimuth: camera.azimuth,
            elevation: camera.elevation,
            distance: camera.distance,
            target: camera.target,
        },
        overlays,
        force_scale: lab.force_scale(),
        images,
        trail: Vec::new(),
        size: [WIDTH, lab.height().clamp(80.0, MOST_HIGH) as usize],
    }
}

/// A run that is drawn.
struct DrawnRun<'r> {
    player: Player,
    view: View,
    /// The site whose path is drawn, and the time of the last point of the path, s.
    traced: Option<usize>,
    last_point: f64,
    /// The pairs of geoms that touch.
    touching: Vec<(usize, usize)>,
    end: f64,
    moments: &'r mut Moments,
}

/// The run of a lab as it loads, up to a time, s. `images` are the pictures of textures.
pub(crate) fn draw_run(
    lab: &Lab,
    file: &SourceFile,
    (model, images): (&Model, Images),
    programs: Programs,
    end: f64,
) -> Moments {
    let mut moments = Moments::default();
    let mut run = DrawnRun {
        player: Player::of_compiled(lab, file, model, programs),
        view: view_of(lab, images),
        traced: lab.trail.as_ref().and_then(|site| model.names.id(Obj::Site, site.as_str())),
        last_point: f64::NEG_INFINITY,
        touching: Vec::new(),
        end,
        moments: &mut moments,
    };
    run.add_to_trail();
    run.draw("at the start".into());
    run.play();
    moments
}

impl DrawnRun<'_> {
    fn draw(&mut self, caption: String) {
        match self.player.model_and_scene() {
            Ok((model, data)) => self.moments.add(draw(model, data, &self.view), caption),
            Err(why) => self.moments.fail(why.to_string()),
        }
    }

    /// Plays to the end: draws where two things first touch, and the end.
    fn play(&mut self) {
        let mut is_first = true;
        let mut further = 0;
        // What touches in the first step does so at the start.
        let step = self.player.timestep();
        let start = self.player.time() + 1.5 * step;
        loop {
            let contacts = match self.next_contacts() {
                Ok(contacts) if contacts.is_empty() => break,
                Ok(contacts) => contacts,
                // A lab that breaks is drawn as it is then.
                Err(why) => {
                    self.moments.fail(why.to_string());
                    break;
                }
            };
            let time = self.player.time();
            if time <= start {
                continue;
            }
            let at = seconds(time);
            let names = |geom| name_of(self.player.model(), geom);
            let pairs: Vec<[String; 2]> =
                contacts.into_iter().map(|(a, b)| ordered([names(a), names(b)])).collect();
            if let Some([a, b]) = pairs.first()
                && std::mem::take(&mut is_first)
                && time < self.end - step
            {
                self.draw(format!("at {at} s, when {a} touches {b}"));
            }
            let sentences = pairs.iter().map(|[a, b]| capital(&format!("{a} touches {b} at {at} s.")));
            let available = MOST_EVENTS - self.moments.events.len();
            further += pairs.len().saturating_sub(available);
            self.moments.events.extend(sentences.take(available));
        }
        match further {
            0 => {}
            1 => self.moments.events.push("1 more contact follows.".into()),
            n => self.moments.events.push(format!("{n} more contacts follow.")),
        }
        if self.player.time() > start {
            self.draw(format!("after {} s", seconds(self.player.time())));
        }
    }

    /// Plays to the next step in which geoms touch that did not touch before, and returns their pairs. None: there are none up to the end, or
    /// the time went back, because the lab broke down or started again.
    fn next_contacts(&mut self) -> Result<Vec<(usize, usize)>, labspec::Error> {
        let most = self.traced.map_or(usize::MAX, |_| self.steps_between_points());
        let mut last = self.player.time();
        while last < self.end && !self.player.is_over() {
            let before = last;
            let mut new = Vec::new();
            let touching = &mut self.touching;
            let mut each = |data: &Data<Planned>| {
                if data.time() <= last {
                    last = f64::INFINITY;
                    return ControlFlow::Break(());
                }
                last = data.time();
                let now = touching_pairs(data.fields());
                new = now.iter().copied().filter(|pair| touching.binary_search(pair).is_err()).collect();
                *touching = now;
                if new.is_empty() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            };
            self.player.play_while(self.end, most, |data, _| each(data))?;
            self.add_to_trail();
            if !new.is_empty() || last <= before {
                return Ok(new);
            }
        }
        Ok(Vec::new())
    }

    fn steps_between_points(&self) -> usize {
        (self.end / self.player.timestep() / TRAIL_POINTS as f64).clamp(1.0, 1e6) as usize
    }

    fn add_to_trail(&mut self) {
        let Some(site) = self.traced else { return };
        let time = self.player.time();
        // A run with many contacts stops more often than points are drawn.
        if time < self.last_point + 0.999 * self.end / TRAIL_POINTS as f64 {
            return;
        }
        self.last_point = time;
        let Ok((_, data)) = self.player.model_and_scene() else { return };
        let point = data.site_xpos.as_chunks::<3>().0.get(site).copied();
        self.view.trail.extend(point.filter(|p| p.iter().all(|x| x.is_finite())));
    }
}

/// The name of a geom for readers: its own, that of its body, or its number.
fn name_of(model: &Model, geom: usize) -> String {
    let named = model.names.of_kind(Obj::Geom).get(geom).filter(|name| !name.is_empty());
    let body =
        model.geom_bodyid.get(geom).and_then(|body| usize::try_from(*body).ok()).filter(|body| *body > 0);
    let of_body = || model.names.of_kind(Obj::Body).get(body?).filter(|name| !name.is_empty());
    named.or_else(of_body).map_or_else(|| format!("geom {geom}"), |name| name.replace('_', " "))
}

/// Words of what stays where it is: the second name of a sentence.
const GROUND: [&str; 9] = ["floor", "ground", "plane", "table", "wall", "ramp", "slope", "boden", "tisch"];

/// Orders two names: the floor, a wall or a table is the second one.
fn ordered([first, second]: [String; 2]) -> [String; 2] {
    let is_ground = |name: &str| GROUND.iter().any(|word| name.to_lowercase().contains(word));
    if is_ground(&first) && !is_ground(&second) { [second, first] } else { [first, second] }
}

/// A time as the page writes it (`formatTime` of the elements).
fn seconds(time: f64) -> String {
    let decimals = if time >= 100.0 {
        1
    } else if time >= 10.0 {
        2
    } else {
        3
    };
    rounded(time, decimals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::bind::scene::Models;
    use labspec::check;
    use labspec::lint::{ModelFolder, load_lesson};

    fn run_of(lab: &str, end: f64) -> Moments {
        let lesson = load_lesson(SourceFile::new("lab.json", lab), &ModelFolder::unknown());
        let lab = lesson.all_labs()[0];
        let (model, programs, errors) =
            check::bind(lab, &Models::new(ModelFolder::unknown()), &mut Vec::new()).unwrap();
        assert_eq!(errors, 0);
        draw_run(lab, &lesson.file, (&model, Images::default()), programs, end)
    }

    fn captions(moments: &Moments) -> Vec<&str> {
        moments.pictures.iter().map(|(_, caption)| caption.as_str()).collect()
    }

    const BALL: &str = "<body name='the_ball' pos='0 0 1'><freejoint/><geom size='.1'/></body>";
    const FLOOR: &str = "<geom name='floor' type='plane' size='2 2 .1'/>";

    fn lab(bodies: &str, rest: &str) -> String {
        format!("{{\"xml\": \"<mujoco><worldbody>{bodies}</worldbody></mujoco>\", \"height\": 200{rest}}}")
    }

    #[test]
    fn a_fall_has_its_start_its_impact_and_its_end() {
        let run = run_of(&lab(&format!("{FLOOR}{BALL}"), ""), 1.0);
        // 0.9 m: √(2 · 0.9 / 9.81) s.
        assert_eq!(
            captions(&run),
            ["at the start", "at 0.430 s, when the ball touches floor", "after 1.000 s"]
        );
        assert_eq!(run.events[0], "The ball touches floor at 0.430 s.");
        assert_eq!(run.files.len(), 3);
        let html = run.html("Fall", |name| format!("../{name}"));
        assert!(
            html.contains("<img src=\"../pictures/") && html.contains("alt=\"Fall: at the start\""),
            "{html}"
        );
    }

    #[test]
    fn what_rests_from_the_start_is_no_event_and_needs_one_picture() {
        let run = run_of(&lab(&format!("{FLOOR}<geom size='.1' pos='0 0 .1'/>"), ""), 0.5);
        assert_eq!((captions(&run), run.events.len()), (vec!["at the start"], 0));
        let run = run_of(&lab(&format!("{FLOOR}{}", BALL.replace("0 0 1", "0 0 .0995")), ""), 0.2);
        assert_eq!(run.events.len(), 0, "{:?}", run.events);
    }

    #[test]
    fn many_contacts_are_counted() {
        let balls: String = (0..12)
            .map(|i| {
                format!(
                    "<body pos='{i} 0 {}'><freejoint/><geom size='.1'/></body>",
                    0.3 + 0.05 * f64::from(i)
                )
            })
            .collect();
        let run = run_of(&lab(&format!("{}{balls}", FLOOR.replace("2 2 .1", "0 0 .1")), ""), 1.0);
        assert!(run.events.len() == MOST_EVENTS + 1, "{:?}", run.events);
        assert!(run.events[MOST_EVENTS].ends_with(" more contacts follow."), "{:?}", run.events);
    }

    #[test]
    fn what_touches_in_one_step_is_listed_together() {
        let balls = ["-.5", ".5"]
            .map(|x| BALL.replace("the_ball", &format!("ball{x}")).replace("0 0 1", &format!("{x} 0 1")));
        let run = run_of(&lab(&format!("{FLOOR}{}", balls.concat()), ""), 1.0);
        assert_eq!(run.events, ["Ball-.5 touches floor at 0.430 s.", "Ball.5 touches floor at 0.430 s."]);
    }

    #[test]
    fn a_lab_that_starts_again_ends() {
        // The position becomes NaN, and the engine resets the data, again and again.
        let breaks = ", \"controller\": \"if (data.time > 0.5) data.qpos[2] = 0 / 0\"";
        let run = run_of(&lab(&format!("{FLOOR}{BALL}"), breaks), 3.0);
        assert_eq!(run.events, ["The ball touches floor at 0.430 s."]);
    }

    #[test]
    fn the_path_of_a_site_is_drawn() {
        let ball = BALL.replace("<geom", "<site name='s'/><geom");
        let [plain, traced] = ["", ", \"trail\": \"s\""].map(|trail| run_of(&lab(&ball, trail), 0.3));
        assert_eq!(plain.pictures[0], traced.pictures[0]);
        assert_ne!(plain.pictures[1], traced.pictures[1]);
    }

    #[test]
    fn a_lab_that_breaks_shows_its_start() {
        let run = run_of(&lab(BALL, ", \"controller\": \"ctx.nothing.x = 1\""), 0.3);
        assert_eq!(captions(&run)[0], "at the start");
        assert!(run.html("", |name| name.to_string()).contains("The pictures stop early: "), "{run:?}");
    }
}
