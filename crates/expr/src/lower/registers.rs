//! The registers of one kind that hold the names of a function, and moves between them.

use std::collections::BTreeMap;

use labspec_finding::order;

/// Registers of one kind.
pub(super) struct RegisterFile {
    /// For each name, its number of uses; `registers` is its register.
    uses: Vec<u32>,
    pub(super) registers: Vec<Option<u32>>,
    pub(super) count: u32,
}

impl RegisterFile {
    pub(super) fn for_names(names: usize) -> RegisterFile {
        RegisterFile { uses: vec![0; names], registers: vec![None; names], count: 1 }
    }

    pub(super) fn used(&mut self, name: u32) {
        if let Some(uses) = self.uses.get_mut(name as usize) {
            *uses += 1;
        }
    }

    pub(super) fn uses(&self, name: u32) -> u32 {
        self.uses.get(name as usize).copied().unwrap_or(0)
    }

    /// The register of a name, assigned at the first request.
    pub(super) fn register(&mut self, name: u32) -> u32 {
        let Some(place) = self.registers.get_mut(name as usize) else { return 0 };
        *place.get_or_insert_with(|| {
            self.count += 1;
            self.count - 1
        })
    }

    pub(super) fn set(&mut self, name: u32, register: u32) {
        if let Some(place) = self.registers.get_mut(name as usize) {
            *place = Some(register);
        }
    }
}

/// Orders moves (to, from) so that none overwrites a register that another one still reads. A cycle is broken
/// with one additional register (Boissinot et al., "Revisiting out-of-SSA translation for correctness, code
/// quality and efficiency", 2009).
pub(super) fn order_moves(mut moves: Vec<(u32, u32)>, count: &mut u32) -> Vec<(u32, u32)> {
    moves.retain(|(to, from)| to != from);
    if moves.len() < 2 {
        return moves;
    }
    let mut left = order::map(moves.iter().copied());
    let mut readers = BTreeMap::new();
    moves.iter().for_each(|(_, from)| *readers.entry(*from).or_insert(0u32) += 1);
    let mut free: Vec<u32> = moves.iter().map(|(to, _)| *to).filter(|to| !readers.contains_key(to)).collect();
    let mut done = Vec::with_capacity(moves.len());
    loop {
        while let Some(to) = free.pop() {
            let Some(from) = left.remove(&to) else { continue };
            done.push((to, from));
            if let Some(n) = readers.get_mut(&from) {
                *n -= 1;
                if *n == 0 {
                    free.push(from);
                }
            }
        }
        // Only cycles remain, in which each register is read once.
        let Some((&to, _)) = left.first_key_value() else { return done };
        let spare = *count;
        *count += 1;
        done.push((spare, to));
        left.values_mut().filter(|from| **from == to).for_each(|from| *from = spare);
        free.push(to);
    }
}
