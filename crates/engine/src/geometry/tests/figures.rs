//! Statistics of many pairs for `docs/measured/contacts.md`, written if `LABSPEC_GEOMETRY` names a folder of
//! recordings.

use std::collections::BTreeMap;
use std::fmt::Write;

/// Largest difference of two equal numbers: a length or position in m, or a component of a direction.
const SAME: f64 = 1e-9;

/// Statistics of the pairs of two types.
#[derive(Default)]
struct FigureRow {
    cases: usize,
    touching: usize,
    number: usize,
    same: usize,
    /// Largest difference of the deepest distance, if both found contacts, m.
    depth: f64,
    distances: usize,
    near: usize,
    /// Largest difference of the signed distance, m.
    distance: f64,
}

/// Statistics by pair of types.
#[derive(Default)]
pub(super) struct Figures(BTreeMap<String, FigureRow>);

impl Figures {
    /// Adds a case with contacts of ten numbers each: distance, position, normal, first tangent. Both lists are in
    /// the same order.
    pub(super) fn contacts(&mut self, pair: &str, recorded: &[f64], computed: &[f64]) {
        let r = self.0.entry(pair.into()).or_default();
        r.cases += 1;
        r.touching += usize::from(!recorded.is_empty());
        r.number += usize::from(recorded.len() == computed.len());
        let is_equal = |(x, y): (&f64, &f64)| (x - y).abs() <= SAME;
        r.same +=
            usize::from(recorded.len() == computed.len() && recorded.iter().zip(computed).all(is_equal));
        let deepest = |list: &[f64]| list.chunks(10).map(|c| c[0]).reduce(f64::min);
        if let (Some(x), Some(y)) = (deepest(recorded), deepest(computed)) {
            r.depth = r.depth.max((x - y).abs());
        }
    }

    /// Adds a case with signed distances.
    pub(super) fn distance(&mut self, pair: &str, recorded: f64, computed: f64) {
        let r = self.0.entry(pair.into()).or_default();
        r.distances += 1;
        r.near += usize::from((recorded - computed).abs() <= SAME);
        r.distance = r.distance.max((recorded - computed).abs());
    }

    /// The contact statistics as a Markdown table.
    pub(super) fn contact_table(&self) -> String {
        let mut text = String::from(
            "| pair | cases | that touch | same number of contacts | all within 1e-9 | deepest, largest difference, m |\n\
             |---|---:|---:|---:|---:|---:|\n",
        );
        for (pair, r) in &self.0 {
            let FigureRow { cases, touching, number, same, depth, .. } = r;
            let _ = writeln!(text, "| {pair} | {cases} | {touching} | {number} | {same} | {depth:.0e} |");
        }
        text
    }

    /// The distance statistics as a Markdown table.
    pub(super) fn distance_table(&self) -> String {
        let mut text =
            String::from("| pair | cases | within 1e-9 | largest difference, m |\n|---|---:|---:|---:|\n");
        for (pair, FigureRow { distances, near, distance, .. }) in &self.0 {
            let _ = writeln!(text, "| {pair} | {distances} | {near} | {distance:.0e} |");
        }
        text
    }
}
