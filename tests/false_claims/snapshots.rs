//! Snapshots: the stored text of labs, and copies with one change in each lab.

use super::scenes::Scene;
use crate::support::random::Random;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::ledger::State;
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::spec::Lesson;

const DEPTH: CheckLevel = CheckLevel { programs: false, labs: true, claims: false };

fn lesson(scenes: &[Scene], snapshot: Option<&str>) -> Lesson {
    let labs: String = scenes.iter().map(|s| format!("```lab simlab\n{}\n```\n\n", s.lab)).collect();
    let file = SourceFile::new("claims.md", format!("# Labs\n\n{labs}"));
    let mut lesson = load_lesson(file, &ModelFolder::unknown());
    lesson.snapshot = snapshot.map(|text| Ok(SourceFile::new("claims.md.snap", text)));
    lesson
}

/// The snapshot of these labs.
pub(super) fn stored(scenes: &[Scene]) -> String {
    let models = Models::new(ModelFolder::unknown());
    check::update_snapshot(&lesson(scenes, None), &models).text(|_| true).unwrap()
}

/// Whether each lab agrees with the snapshot.
pub(super) fn unchanged(scenes: &[Scene], snapshot: &str) -> Vec<bool> {
    let models = Models::new(ModelFolder::unknown());
    let checked = check::check_lesson(lesson(scenes, Some(snapshot)), &models, DEPTH);
    let of = |i: usize| {
        let address = format!("#{}", i + 1);
        let states: Vec<State> =
            checked.snapshots.iter().filter(|k| k.lab == address).map(|k| k.state).collect();
        !states.is_empty() && states.iter().all(|s| matches!(s, State::True(_)))
    };
    (0..scenes.len()).map(of).collect()
}

/// The snapshot with one change in every lab, and the kind of each change.
pub(super) fn changed(random: &mut Random, snapshot: &str) -> (String, Vec<&'static str>) {
    let mut variants = Vec::new();
    let mut parts = snapshot.split("\nlab \"");
    let mut whole = parts.next().unwrap_or("").to_string();
    for part in parts {
        let mut lines: Vec<String> = part.lines().map(String::from).collect();
        let variant = change(random, &mut lines);
        variants.push(variant);
        whole += "\nlab \"";
        whole += &lines.join("\n");
        whole.push('\n');
    }
    (whole, variants)
}

/// Changes one line of a lab.
fn change(random: &mut Random, lines: &mut Vec<String>) -> &'static str {
    for _ in 0..1000 {
        let i = 1 + random.below(lines.len() - 1);
        let line = lines[i].clone();
        let is_row = line.starts_with("  \"");
        if is_row {
            let end = line.rfind('"').unwrap();
            let (label, numbers) = line.split_at(end + 1);
            if numbers.contains('~') || numbers.contains("0e-9") {
                continue;
            }
            match random.below(5) {
                0 => {
                    // Changes the sign of a number other than 0.
                    let words: Vec<&str> = numbers.split_whitespace().collect();
                    let k = random.below(words.len());
                    if words[k].parse::<f64>().is_ok_and(|x| x != 0.0) {
                        let turned =
                            words[k].strip_prefix('-').map_or(format!("-{}", words[k]), String::from);
                        let mut words: Vec<String> = words.iter().map(ToString::to_string).collect();
                        words[k] = turned;
                        lines[i] = format!("{label}  {}", words.join("  "));
                        return "another sign";
                    }
                }
                1 => {
                    lines[i] = line.replacen("/", "/x", 1);
                    if lines[i] != line {
                        return "another label";
                    }
                }
                2 => {
                    lines.remove(i);
                    return "a row is gone";
                }
                _ => {
                    let digits: Vec<usize> = numbers
                        .char_indices()
                        .filter(|(_, c)| c.is_ascii_digit())
                        .map(|(at, _)| at)
                        .collect();
                    if let Some(&at) = digits.get(random.below(digits.len().max(1))) {
                        let digit = numbers.as_bytes()[at] - b'0';
                        // By at least two units of this digit, which is more than half a unit of the last digit.
                        let other = (digit + 2 + random.below(7) as u8) % 10;
                        let mut changed = numbers.to_string();
                        changed.replace_range(at..=at, &other.to_string());
                        // Digits of exponents and of zeros are not changed.
                        if !changed.contains('e')
                            && changed.split_whitespace().all(|w| w.parse::<f64>().is_ok() || w == "-")
                        {
                            lines[i] = format!("{label}{changed}");
                            return "another digit";
                        }
                    }
                }
            }
        } else if line.contains("timestep") {
            let other = match random.below(3) {
                0 => line.replace("timestep 0.00", "timestep 0.01"),
                1 => line.replace("Euler", "RK4"),
                _ => line.replace("Newton", "CG"),
            };
            if other != line {
                lines[i] = other;
                return "another setting";
            }
        }
    }
    panic!("nothing to change in:\n{}", lines.join("\n"));
}
