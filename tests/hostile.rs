//! Hostile MJCF: models of the zoo and of `../shared`, mutated. Each is compiled and, where it compiles, stepped: no
//! panic, no hang, bounded memory. A case is a number; a failure says which.
//!
//!     LABSPEC_FUZZ_SECONDS=600 cargo test -p labspec --test all -- hostile --nocapture
//!     LABSPEC_FUZZ_CASE=1234 cargo test -p labspec --test all -- hostile --nocapture

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{models, unconstrained, workspace};
use labspec_core::mjcf::{self, FileProblem, Files};
use labspec_core::{self as core, Data};
use std::path::Path;
use std::time::{Duration, Instant};

/// What a test run affords.
const SHORT: Duration = Duration::from_secs(5);
/// The longest case, in a build that is hardly optimized: time of the processor where that is known, because the
/// machine may be busy with something else.
const LONGEST: Duration = Duration::from_secs(20);
/// What one case may allocate at a time, bytes.
const MOST_MEMORY: u64 = 1 << 30;

/// A sequence of numbers that looks random (Steele, Lea and Flood 2014, SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `n`, which is not zero.
    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    fn word(&mut self, list: &[&'static str]) -> &'static str {
        list[self.below(list.len())]
    }
}

/// Values that numbers and names are replaced by.
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
/// What is put between any two characters.
const SIGNS: &[&str] = &["\"", "<", ">", "/", "=", "&", "\u{0}", " ", "9", "e", "."];
/// Elements that are put anywhere.
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

/// Every text and what it may name.
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

/// Whatever a model names is the model itself: cycles are the rule.
struct Itself<'a>(&'a str);

impl Files for Itself<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        match path.len() % 3 {
            0 => Err(FileProblem::Missing),
            _ if self.0.len() > limit => Err(FileProblem::TooLarge),
            _ => Ok(self.0.as_bytes().to_vec()),
        }
    }
}

/// Places of the attribute values of a text, without quotes.
fn values(text: &str) -> Vec<std::ops::Range<usize>> {
    let quotes: Vec<usize> = text.match_indices('"').map(|(i, _)| i).collect();
    quotes.chunks_exact(2).map(|q| q[0] + 1..q[1]).collect()
}

/// Places of the tags of a text.
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
            // Another number, of those that are often allowed.
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
            // One number of a list.
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
            // A part moves.
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
    // Without constraints more models can be simulated.
    let mut text = if random.below(3) == 0 { text.clone() } else { unconstrained(text) };
    for _ in 0..1 + random.below(4) {
        mutate(&mut random, corpus, &mut text);
    }
    text
}

/// How long this thread has run.
fn running() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse().ok().map(Duration::from_nanos)
}

/// Compiles and, where that works, steps; how far it came.
fn run(text: &str) -> bool {
    let Ok(m) = mjcf::compile_with(text, &Itself(text), Some("self.xml")) else { return false };
    let mut d = Data::new(&m);
    (0..3).for_each(|_| core::step(&m, &mut d));
    true
}

#[test]
fn mutated_models_neither_panic_nor_hang_nor_fill_memory() {
    let corpus = Corpus::read();
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u64>().ok());
    if let Some(n) = number("LABSPEC_FUZZ_CASE") {
        let text = case(&corpus, n);
        std::fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join("case.xml"), &text).unwrap();
        println!("{text}\ncompiles: {}", run(&text));
        return;
    }
    let limit = number("LABSPEC_FUZZ_SECONDS").map_or(SHORT, Duration::from_secs);
    let first = number("LABSPEC_SEED").unwrap_or(1) << 32;
    let start = Instant::now();
    let (mut n, mut compiled) = (first, 0);
    while start.elapsed() < limit {
        let text = case(&corpus, n);
        let (begin, ran) = (Instant::now(), running());
        let mut works = Err(());
        let memory = allocation_counter::measure(|| {
            works = std::panic::catch_unwind(|| run(&text)).map_err(drop);
        });
        let Ok(works) = works else { panic!("case {n} panics") };
        let taken = running().zip(ran).map_or(begin.elapsed(), |(now, ran)| now - ran);
        assert!(taken < LONGEST, "case {n} takes {taken:?}");
        assert!(memory.bytes_max < MOST_MEMORY, "case {n} takes {} MB", memory.bytes_max >> 20);
        compiled += u64::from(works);
        n += 1;
    }
    println!("{} cases, {compiled} compile", n - first);
    assert!(compiled > 0, "no case compiles: nothing was tried");
}
