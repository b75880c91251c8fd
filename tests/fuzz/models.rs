//! Hostile MJCF: mutated models of the zoo and of `../shared`. Each is compiled and, if it compiles, stepped: no panic, no
//! hang, bounded memory. Each case has a number, which a failure reports.

#![allow(clippy::unwrap_used, clippy::panic)]

use super::run_cases;
use crate::support::random::Random;
use crate::support::{models, unconstrained, workspace};
use labspec_core::xml::{self, FileProblem, Files};
use labspec_core::{self as core, Data};

/// The number of cases of a test run.
const CASES: u64 = 8000;
/// The maximum memory that one case may have allocated at any time, bytes.
const MOST_MEMORY: u64 = 1 << 30;

/// Values that replace numbers and names.
const VALUES: &[&str] = &[
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "3",
    "1e-300",
    "1e300",
    "-1e300",
    "nan",
    "inf",
    "-inf",
    "1e-8",
    "1e8",
    "0.5",
    "2147483647",
    "-2147483648",
    "99999999999",
    "1e999",
    "",
    " ",
    "0 0 0",
    "1 1 1",
    "0 0 0 0",
    "nan nan nan",
    "1 2 3 4 5 6 7 8 9 10 11",
    "true",
    "false",
    "auto",
    "world",
    "x",
    "a b",
    "&#0;",
    "&lt;",
    "\u{e9}\u{20ac}",
    "1,2,3",
    "1000",
    "100000",
];
const NUMBERS: &[&str] =
    &["0", "1", "-1", "2", "1e-9", "1e-15", "1e9", "-1e9", "0.3", "-0.7", "45", "1e15", "1e150", "-1e150"];
/// Characters that are inserted between any two characters.
const SIGNS: &[&str] = &["\"", "<", ">", "/", "=", "&", "\u{0}", " ", "9", "e", "."];
/// Elements that are inserted anywhere.
const ELEMENTS: &[&str] = &[
    "<include file=\"self.xml\"/>",
    "<include file=\"../up.xml\"/>",
    "<replicate count=\"1000000000\"><geom size=\"1\"/></replicate>",
    "<replicate count=\"30\"><replicate count=\"30\"><body><joint/><geom size=\"1\"/></body></replicate></replicate>",
    "<body><freejoint align=\"true\"/><geom size=\"0.1\" pos=\"1 0 0\"/></body>",
    "<body sleep=\"init\"><joint/><geom size=\"0.1\"/></body>",
    "<body mocap=\"true\"><geom size=\"0.1\"/></body>",
    "<compiler fusestatic=\"true\" discardvisual=\"true\" alignfree=\"true\" settotalmass=\"1\" balanceinertia=\"true\"/>",
    "<option><flag sleep=\"enable\" energy=\"enable\" constraint=\"disable\"/></option>",
    "<option integrator=\"discrete\" density=\"1000\" viscosity=\"1\"/>",
    "<option timestep=\"1e300\" gravity=\"1e300 0 0\"/>",
    "<attach model=\"self\" body=\"a\" prefix=\"p\"/>",
    "<frame euler=\"1 2 3\">",
    "<body>",
    "</body>",
    "<!--",
    "-->",
];

/// The texts, each with the names that it may use.
struct Corpus(Vec<(String, String)>);

impl Corpus {
    fn read() -> Corpus {
        let folders = [
            "specs/models/zoo",
            "tests/golden/models",
            "../shared/conformance/models",
            "../shared/corpus/models",
        ];
        let mut texts = Vec::new();
        for folder in folders.map(|f| workspace().join(f)) {
            for name in models(&folder) {
                let text = std::fs::read_to_string(folder.join(format!("{name}.xml"))).unwrap();
                texts.push((name, text));
            }
        }
        Corpus(texts)
    }
}

/// Any file name refers to the model itself, so that cycles are frequent.
struct SelfInclude<'a>(&'a str);

impl Files for SelfInclude<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        match path.len() % 3 {
            0 => Err(FileProblem::Missing),
            _ if self.0.len() > limit => Err(FileProblem::TooLarge),
            _ => Ok(self.0.as_bytes().to_vec()),
        }
    }
}

/// The byte ranges of the attribute values of a text, without quotes.
fn values(text: &str) -> Vec<std::ops::Range<usize>> {
    let quotes: Vec<usize> = text.match_indices('"').map(|(i, _)| i).collect();
    quotes.chunks_exact(2).map(|q| q[0] + 1..q[1]).collect()
}

/// The byte ranges of the tags of a text.
fn tags(text: &str) -> Vec<std::ops::Range<usize>> {
    let starts = text.match_indices('<').map(|(i, _)| i);
    starts.filter_map(|i| text[i..].find('>').map(|n| i..i + n + 1)).collect()
}

fn mutate(random: &mut Random, corpus: &Corpus, text: &mut String) {
    let (values, tags) = (values(text), tags(text));
    if values.is_empty() || tags.is_empty() {
        return;
    }
    let tag = random.pick(&tags).clone();
    let value = random.pick(&values).clone();
    match random.below(18) {
        12.. => {
            // Replaces numbers by numbers that are often allowed.
            let words: Vec<&str> = text[value.clone()].split(' ').collect();
            if words.iter().all(|w| w.parse::<f64>().is_ok()) {
                let new: Vec<&str> = words
                    .iter()
                    .map(|w| if random.below(2) == 0 { random.word(NUMBERS) } else { *w })
                    .collect();
                let new = new.join(" ");
                text.replace_range(value, &new);
            }
        }
        0..=2 => text.replace_range(value, random.word(VALUES)),
        3 => {
            let other = text[random.pick(&values).clone()].to_string();
            text.replace_range(value, &other);
        }
        4 => {
            // Replaces one number of a list.
            let words: Vec<&str> = text[value.clone()].split(' ').collect();
            let at = random.below(words.len());
            let new: Vec<&str> = words
                .iter()
                .enumerate()
                .map(|(i, w)| if i == at { random.word(VALUES) } else { *w })
                .collect();
            let new = new.join(" ");
            text.replace_range(value, &new);
        }
        5 => text.replace_range(tag, ""),
        6 => {
            let copy = text[tag.clone()].to_string();
            text.insert_str(tag.end, &copy);
        }
        7 => text.insert_str(tag.end, random.word(ELEMENTS)),
        8 => {
            let (_, other) = random.pick(&corpus.0);
            let other_tags = self::tags(other);
            let other =
                other_tags.get(random.below(other_tags.len().max(1))).map_or("", |t| &other[t.clone()]);
            text.insert_str(tag.end, other);
        }
        9 => {
            // Copies a part of the text.
            let other = random.pick(&tags).clone();
            let (a, b) = (tag.start.min(other.start), tag.start.max(other.start));
            let piece = text[a..b].to_string();
            if piece.len() < 20_000 {
                text.insert_str(b, &piece);
            }
        }
        10 => {
            let at = (random.below(text.len() + 1)..).find(|&i| text.is_char_boundary(i)).unwrap();
            text.truncate(at);
        }
        _ => {
            let at = (random.below(text.len() + 1)..).find(|&i| text.is_char_boundary(i)).unwrap();
            text.insert_str(at, random.word(SIGNS));
        }
    }
}

/// The text of a case.
fn case(corpus: &Corpus, number: u64) -> String {
    let mut random = Random(number);
    let (_, text) = random.pick(&corpus.0);
    // Without constraints, more models can be simulated.
    let mut text = if random.below(3) == 0 { text.clone() } else { unconstrained(text) };
    for _ in 0..1 + random.below(4) {
        mutate(&mut random, corpus, &mut text);
    }
    text
}

/// Compiles the text and, if that succeeds, performs three steps. Returns whether it compiled.
fn run(text: &str) -> bool {
    let Ok(m) = xml::compile_with(text, &SelfInclude(text), Some("self.xml")) else { return false };
    let mut d = Data::new(&m);
    (0..3).for_each(|_| core::step(&m, &mut d).unwrap());
    true
}

#[test]
fn mutated_models_neither_panic_nor_hang_nor_fill_memory() {
    let corpus = Corpus::read();
    let mut compiled = 0;
    run_cases(CASES, |n| {
        let text = case(&corpus, n);
        let mut works = false;
        let memory = allocation_counter::measure(|| works = run(&text));
        assert!(memory.bytes_max < MOST_MEMORY, "{} MB", memory.bytes_max >> 20);
        compiled += u64::from(works);
        text
    });
    println!("{compiled} compile");
    assert!(compiled > 0, "no case compiles: nothing was tried");
}
