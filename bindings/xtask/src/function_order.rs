//! The order of the functions of a module, to reduce its compressed size.
//!
//! Compressors of pages look for repetitions in the last 32 kB (gzip). Functions that share code are therefore put next to each other: the
//! next function is the one of those that remain that shares the largest part of its code with the functions of the last [`WINDOW`]
//! bytes. Code is compared by the hashes of its sequences of [`SEQUENCE`] bytes, of which one in eight is kept.
//!
//! `wasm-opt` can sort functions by their names, so that this file only names them by their place.

use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};
use std::path::Path;
use wasm_encoder::{NameMap, NameSection, Section};
use wasmparser::{Parser, Payload, TypeRef};

/// Bytes whose code is compared with the next function: the window of gzip, without the next function itself.
const WINDOW: usize = 28_000;

/// The length of the compared sequences, in bytes.
const SEQUENCE: usize = 7;

/// A sequence that occurs in more functions is no reason to put two of them together.
const COMMON: usize = 60;

/// A function that shares a small part of few sequences does not precede one that shares many.
const FEW: f64 = 6.0;

/// The hashes of the sampled sequences of a function.
fn sequences(body: &[u8]) -> BTreeSet<u32> {
    let hash = |bytes: &[u8]| {
        bytes.iter().fold(0x811c_9dc5_u32, |h, b| (h ^ u32::from(*b)).wrapping_mul(0x0100_0193))
    };
    body.windows(SEQUENCE).map(hash).filter(|h| (h >> 7) % 8 == 0).collect()
}

/// Returns the functions in an order in which neighbours share code, as indexes in `bodies`.
pub(crate) fn by_shared_code(bodies: &[&[u8]]) -> Vec<usize> {
    let mut shared: HashMap<u32, Vec<usize>> = HashMap::new();
    let all: Vec<BTreeSet<u32>> = bodies.iter().map(|body| sequences(body)).collect();
    for (function, found) in all.iter().enumerate() {
        found.iter().for_each(|hash| shared.entry(*hash).or_default().push(function));
    }
    shared.retain(|_, functions| (2..=COMMON).contains(&functions.len()));
    let mut by_size: Vec<usize> = (0..bodies.len()).collect();
    by_size.sort_by_key(|f| std::cmp::Reverse(bodies[*f].len()));
    let mut by_size = by_size.into_iter();
    let mut remaining: BTreeSet<usize> = (0..bodies.len()).collect();
    // For each remaining function, how often its sequences occur in the window.
    let mut occurrences: BTreeMap<usize, usize> = BTreeMap::new();
    let (mut window, mut bytes) = (VecDeque::new(), 0);
    let mut order = Vec::with_capacity(bodies.len());
    while !remaining.is_empty() {
        let share = |(function, count): (&usize, &usize)| *count as f64 / (all[*function].len() as f64 + FEW);
        let best =
            occurrences.iter().max_by(|a, b| share(*a).total_cmp(&share(*b))).map(|(function, _)| *function);
        let Some(next) = best.or_else(|| by_size.find(|f| remaining.contains(f))) else { break };
        remaining.remove(&next);
        occurrences.remove(&next);
        order.push(next);
        window.push_back(next);
        bytes += bodies[next].len();
        for other in all[next].iter().filter_map(|hash| shared.get(hash)).flatten() {
            if remaining.contains(other) {
                *occurrences.entry(*other).or_default() += 1;
            }
        }
        while bytes > WINDOW && window.len() > 1 {
            let Some(left) = window.pop_front() else { break };
            bytes -= bodies[left].len();
            for other in all[left].iter().filter_map(|hash| shared.get(hash)).flatten() {
                if let Some(count) = occurrences.get_mut(other) {
                    *count -= 1;
                    if *count == 0 {
                        occurrences.remove(other);
                    }
                }
            }
        }
    }
    order
}

/// Names the functions of a module without names by their places in the order.
pub(crate) fn name_by_place(file: &Path) -> Result<(), String> {
    let error = |e: &dyn std::fmt::Display| format!("{}: {e}", file.display());
    let mut module = std::fs::read(file).map_err(|e| error(&e))?;
    let (mut imported, mut bodies) = (0, Vec::new());
    for payload in Parser::new(0).parse_all(&module) {
        match payload.map_err(|e| error(&e))? {
            Payload::ImportSection(imports) => {
                for import in imports.into_imports() {
                    imported += usize::from(matches!(import.map_err(|e| error(&e))?.ty, TypeRef::Func(_)));
                }
            }
            Payload::CodeSectionEntry(body) => bodies.push(&module[body.range()]),
            _ => {}
        }
    }
    let order = by_shared_code(&bodies);
    let mut places = vec![0; order.len()];
    order.iter().enumerate().for_each(|(place, function)| places[*function] = place);
    let mut names = NameMap::new();
    for (function, place) in places.iter().enumerate() {
        names.append(u32::try_from(imported + function).map_err(|e| error(&e))?, &format!("{place:06}"));
    }
    let mut section = NameSection::new();
    section.functions(&names);
    section.append_to(&mut module);
    std::fs::write(file, module).map_err(|e| error(&e))
}

#[cfg(test)]
mod tests {
    use super::by_shared_code;

    #[test]
    fn functions_that_share_code_are_neighbours() {
        let bytes = |seed: u32| {
            let next = |x: &u32| Some(x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
            std::iter::successors(Some(seed), next).map(|x| (x >> 24) as u8).take(400).collect::<Vec<u8>>()
        };
        let (a, b) = (bytes(1), bytes(2));
        let (mut a2, mut b2) = (a.clone(), b.clone());
        (a2[200], b2[100]) = (0, 0);
        let order = by_shared_code(&[&a, &b, &a2, &b2]);
        let place = |function| order.iter().position(|f| *f == function).unwrap();
        assert_eq!(place(0).abs_diff(place(2)), 1, "{order:?}");
        assert_eq!(place(1).abs_diff(place(3)), 1, "{order:?}");
        assert_eq!(order, by_shared_code(&[&a, &b, &a2, &b2]));
    }
}
