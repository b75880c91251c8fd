//! Requests of programs to the page: to play and to pause.

#![allow(clippy::unwrap_used)]

use crate::support::model_text;
use labspec::Player;
use labspec::bind::Playback;
use std::collections::BTreeMap;

/// Programs of every kind ask the page to play and to pause; the last request counts, and it is taken once.
#[test]
fn programs_ask_the_page_to_play_and_to_pause() {
    let lab = r#"{"model": "ball_drop", "controller": "if (data.time > 0.0099 && data.time < 0.0101) { sim.pause(); }",
      "controls": [
        {"label": "go", "min": 0, "max": 1, "value": 0, "apply": "if (value > 0.5) { sim.play(); }"},
        {"type": "button", "label": "Stop", "run": "sim.pause()"},
        {"type": "button", "label": "Either", "run": "sim.toggle()"},
        {"type": "button", "label": "Both", "run": "sim.play(); sim.toggle()"}]}"#;
    let mut player =
        Player::of_lab(lab, BTreeMap::from([("ball_drop".to_string(), model_text("ball_drop"))])).unwrap();
    assert_eq!(player.take_playback(), None);
    player.set("go", 1.0).unwrap();
    assert_eq!(player.take_playback(), Some(Playback::Play));
    assert_eq!(player.take_playback(), None);
    player.press("Stop").unwrap();
    assert_eq!(player.take_playback(), Some(Playback::Pause));
    player.press("Either").unwrap();
    player.press("Either").unwrap();
    assert_eq!(player.take_playback(), None);
    player.press("Both").unwrap();
    assert_eq!(player.take_playback(), Some(Playback::Pause));
    player.play_to(0.004).unwrap();
    assert_eq!(player.take_playback(), None);
    player.play_to(0.02).unwrap();
    assert_eq!(player.take_playback(), Some(Playback::Pause));
}
