//! Variables and the ways between blocks. While the tree is walked it is known what every variable holds; where ways
//! come together, variables that differ become parameters. A loop is the only place whose ways are not all known when
//! it begins: a variable that is read in it gets a parameter at its start, which is taken back at the end when nothing
//! was stored (Braun et al., "Simple and efficient construction of static single assignment form", 2013).

use std::collections::BTreeMap;

use super::build::{Build, Exits};
use super::{At, Block, BlockId, Edge, End, Num, Slot, Val};
use crate::Span;
use crate::ir::LocalId;
use crate::operation::truthy;
use crate::value::Value;

/// What variables hold now.
#[derive(Default)]
pub(super) struct Variables {
    /// What it holds, and in how many loops that was found.
    now: Vec<Option<(At, u32)>>,
    /// What was held before each change.
    log: Vec<(LocalId, Option<(At, u32)>)>,
}

/// A way whose end is not known yet: the block that it leaves, and what was stored since a place in the log.
pub(super) struct Way {
    from: BlockId,
    stored: Vec<(LocalId, At)>,
}

/// A loop around the place of the work.
pub(super) struct Level {
    header: BlockId,
    /// What leads in.
    entry: Option<Way>,
    mark: usize,
    /// Variables that are read or stored in it: the parameter, and what was held before.
    params: BTreeMap<LocalId, (At, At)>,
    pub(super) breaks: Vec<Way>,
    pub(super) continues: Vec<Way>,
    /// Ways out of what is around it, when it began.
    returns: (usize, usize),
}

impl Build<'_> {
    pub(super) fn mark(&self) -> usize {
        self.variables.log.len()
    }

    /// Forgets what was stored since.
    pub(super) fn back_to(&mut self, mark: usize) {
        for (local, before) in self.variables.log.drain(mark..).rev() {
            if let Some(now) = self.variables.now.get_mut(local as usize) {
                *now = before;
            }
        }
    }

    /// A variable of the work itself.
    pub(super) fn temporary(&mut self) -> LocalId {
        self.temporaries += 1;
        self.tree.locals.len() as u32 + self.temporaries
    }

    pub(super) fn write(&mut self, local: LocalId, at: At) {
        let Variables { now, log } = &mut self.variables;
        if now.len() <= local as usize {
            now.resize(local as usize + 1, None);
        }
        if let Some(place) = now.get_mut(local as usize) {
            log.push((local, place.replace((at, self.loops.len() as u32))));
        }
    }

    /// What a variable holds; `None` when nothing was stored.
    fn find(&mut self, local: LocalId) -> Option<At> {
        let (mut at, level) = self.variables.now.get(local as usize).copied().flatten()?;
        if (level as usize) < self.loops.len() {
            for i in level as usize..self.loops.len() {
                let known = self.loops.get(i).and_then(|l| l.params.get(&local)).map(|(param, _)| *param);
                at = match known {
                    Some(param) => param,
                    None => {
                        let param = self.like(at);
                        if let Some(level) = self.loops.get_mut(i) {
                            level.params.insert(local, (param, at));
                        }
                        param
                    }
                };
            }
            self.write(local, at);
        }
        Some(at)
    }

    pub(super) fn read_number(&mut self, local: LocalId) -> Num {
        match self.find(local) {
            Some(At::Number(n)) => n,
            _ => self.constant(f64::NAN),
        }
    }

    pub(super) fn read_value(&mut self, local: LocalId) -> Val {
        match self.find(local) {
            Some(At::Value(v)) => v,
            _ => self.constant_value(&Value::Undefined),
        }
    }

    /// Whether something was stored.
    pub(super) fn has(&self, local: LocalId) -> bool {
        self.variables.now.get(local as usize).is_some_and(Option::is_some)
    }

    /// A new name of the same kind.
    fn like(&mut self, at: At) -> At {
        match at {
            At::Number(_) => At::Number(self.new_number()),
            At::Value(_) => At::Value(self.new_value()),
        }
    }

    /// The block of the work.
    fn here(&self) -> BlockId {
        (self.unit.blocks.len() as u32).saturating_sub(1)
    }

    /// Begins a block.
    pub(super) fn begin(&mut self, after: BlockId) {
        let first = self.unit.ops.len() as u32;
        let end = End::Return(None);
        self.unit.blocks.push(Block { first, params: Vec::new(), after, end, span: Span::default() });
        self.dead = false;
    }

    fn stored_since(&self, mark: usize) -> Vec<(LocalId, At)> {
        let log = self.variables.log.get(mark..).unwrap_or(&[]);
        let mut locals: Vec<LocalId> = log.iter().map(|(local, _)| *local).collect();
        locals.sort_unstable();
        locals.dedup();
        let now = |l: LocalId| self.variables.now.get(l as usize).copied().flatten().map(|(at, _)| (l, at));
        locals.into_iter().filter_map(now).collect()
    }

    /// Ends the block; nothing follows.
    pub(super) fn end(&mut self, end: End, span: Span) {
        let span = self.site.unwrap_or(span);
        if let Some(block) = self.unit.blocks.last_mut().filter(|_| !self.dead) {
            (block.end, block.span) = (end, span);
        }
        self.dead = true;
    }

    /// Ends the block; on to a place that is not known yet. `mark`: what was stored since goes along.
    pub(super) fn jump(&mut self, mark: usize, span: Span) -> Option<Way> {
        let way = (!self.dead).then(|| Way { from: self.here(), stored: self.stored_since(mark) });
        self.end(End::Jump(Edge::default()), span);
        way
    }

    /// Ends the block with a question; the work goes on where the answer is the other one.
    pub(super) fn jump_if(&mut self, end: End, mark: usize, span: Span) -> Option<Way> {
        if self.dead {
            return None;
        }
        if let End::If(when, test, _) = end
            && let Some(x) = self.unit.known(test)
        {
            // The answer is known: there is one way.
            return if truthy(x) == when { self.jump(mark, span) } else { None };
        }
        let way = Way { from: self.here(), stored: self.stored_since(mark) };
        let after = way.from;
        self.end(end, span);
        self.begin(after);
        Some(way)
    }

    fn edge(&mut self, from: BlockId) -> Option<&mut Edge> {
        match &mut self.unit.blocks.get_mut(from as usize)?.end {
            End::Jump(edge) | End::If(_, _, edge) | End::IfNothing(_, _, edge) | End::Again(edge) => {
                Some(edge)
            }
            End::Return(_) => None,
        }
    }

    /// The ways come together here. `after`: the block that all of them passed last. Variables hold what they held
    /// there; what they hold now follows from the ways.
    pub(super) fn land(&mut self, after: BlockId, ways: impl IntoIterator<Item = Option<Way>>) {
        let ways: Vec<Way> = ways.into_iter().flatten().collect();
        if ways.is_empty() {
            self.dead = true;
            return;
        }
        self.begin(after);
        let to = self.here();
        for way in &ways {
            if let Some(edge) = self.edge(way.from) {
                edge.to = to;
            }
        }
        let mut locals: Vec<LocalId> = ways.iter().flat_map(|w| &w.stored).map(|(local, _)| *local).collect();
        locals.sort_unstable();
        locals.dedup();
        for local in locals {
            let held =
                |way: &Way| way.stored.binary_search_by_key(&local, |s| s.0).ok().map(|i| way.stored[i].1);
            let held: Vec<Option<At>> = ways.iter().map(held).collect();
            let before = if held.contains(&None) { self.find(local) } else { None };
            let held: Option<Vec<At>> = held.into_iter().map(|at| at.or(before)).collect();
            // What one of the ways does not know is not used any more.
            let Some(held) = held else { continue };
            let Some(&first) = held.first() else { continue };
            let same = |at: &At| self.unit.same.at(*at) == self.unit.same.at(first);
            if held.iter().all(same) {
                self.write(local, first);
                continue;
            }
            let param = self.like(first);
            for (way, at) in ways.iter().zip(held) {
                if let Some(edge) = self.edge(way.from) {
                    edge.args.push(at);
                }
            }
            if let Some(block) = self.unit.blocks.last_mut() {
                block.params.push(param);
            }
            self.write(local, param);
        }
    }

    /// Where a question leads two ways that come together again.
    pub(super) fn fork(
        &mut self,
        test: End,
        span: Span,
        next: impl FnOnce(&mut Self),
        there: impl FnOnce(&mut Self),
    ) {
        let (mark, from) = (self.mark(), self.here());
        let way = self.jump_if(test, mark, span);
        next(self);
        let end = self.jump(mark, span);
        self.back_to(mark);
        self.land(from, [way]);
        there(self);
        let other = self.jump(mark, span);
        self.back_to(mark);
        self.land(from, [end, other]);
    }

    /// The same where the second way has nothing on it.
    pub(super) fn skip(&mut self, test: End, span: Span, next: impl FnOnce(&mut Self)) {
        let (mark, from) = (self.mark(), self.here());
        let way = self.jump_if(test, mark, span);
        next(self);
        let end = self.jump(mark, span);
        self.back_to(mark);
        self.land(from, [way, end]);
    }

    /// Statements that other ways than their end may leave. The work adds these to the list that `exits` finds.
    pub(super) fn region(
        &mut self,
        span: Span,
        work: impl FnOnce(&mut Self, usize),
        exits: impl FnOnce(&mut Self) -> Vec<Way>,
    ) {
        let (mark, from) = (self.mark(), self.here());
        work(self, mark);
        let end = self.jump(mark, span);
        let exits = exits(self);
        self.back_to(mark);
        self.land(from, exits.into_iter().map(Some).chain([end]));
    }

    /// A loop begins.
    pub(super) fn enter_loop(&mut self, span: Span) {
        let mark = self.mark();
        let from = self.here();
        let entry = self.jump(mark, span);
        let dead = entry.is_none();
        self.begin(from);
        self.dead = dead;
        let ways = |all: &[Exits]| all.last().map_or(0, |e| e.exits.len());
        let returns = (ways(&self.inlines), ways(&self.chains));
        let (header, params) = (self.here(), BTreeMap::new());
        let (breaks, continues) = (Vec::new(), Vec::new());
        if let Some(way) = &entry
            && let Some(edge) = self.edge(way.from)
        {
            edge.to = header;
        }
        self.loops.push(Level { header, entry, mark, params, breaks, continues, returns });
    }

    /// Leaves the innermost loop, or goes on to its next turn.
    pub(super) fn leave_turn(&mut self, leaves: bool) {
        let Some(mark) = self.loops.last().map(|l| l.mark) else { return };
        let way = self.jump(mark, Span::default());
        if let Some(level) = self.loops.last_mut() {
            if leaves { level.breaks.extend(way) } else { level.continues.extend(way) }
        }
    }

    /// What `continue` leads to.
    pub(super) fn land_continues(&mut self) {
        let Some(level) = self.loops.last_mut() else { return };
        let (mark, header, continues) = (level.mark, level.header, std::mem::take(&mut level.continues));
        if !continues.is_empty() {
            let end = self.jump(mark, Span::default());
            self.back_to(mark);
            self.land(header, continues.into_iter().map(Some).chain([end]));
        }
    }

    /// The question whether a loop goes on.
    pub(super) fn loop_test(&mut self, holds: Num, span: Span) {
        let Some(mark) = self.loops.last().map(|l| l.mark) else { return };
        let way = self.jump_if(End::If(false, holds, Edge::default()), mark, span);
        if let Some(level) = self.loops.last_mut() {
            level.breaks.extend(way);
        }
    }

    /// A loop ends: what was stored in it is what its parameters are in the next turn.
    pub(super) fn leave_loop(&mut self, span: Span) {
        let Some(mark) = self.loops.last().map(|l| l.mark) else { return };
        let back = self.jump(mark, span);
        self.back_to(mark);
        let Some(mut level) = self.loops.pop() else { return };
        for (local, at) in back.iter().chain(&level.breaks).flat_map(|way| &way.stored) {
            if !level.params.contains_key(local)
                && let Some(before) = self.find(*local)
            {
                let param = self.like(*at);
                level.params.insert(*local, (param, before));
            }
        }
        let mut kept = Vec::new();
        for (local, (param, before)) in &level.params {
            let stored = |way: &Way| way.stored.iter().find(|(l, _)| l == local).map(|(_, at)| *at);
            let next = back.as_ref().and_then(stored).map_or(*param, |at| self.unit.same.at(at));
            if next == *param || next == self.unit.same.at(*before) {
                self.unit.same.join(*param, *before);
            } else {
                kept.push((*local, *param, *before, next));
            }
        }
        if let Some(block) = self.unit.blocks.get_mut(level.header as usize) {
            block.params = kept.iter().map(|k| k.1).collect();
        }
        let from = level.entry.as_ref().map(|e| e.from);
        if let Some(edge) = from.and_then(|from| self.edge(from)) {
            edge.args = kept.iter().map(|k| k.2).collect();
        }
        if let Some(block) = back.and_then(|way| self.unit.blocks.get_mut(way.from as usize)) {
            let args = kept.iter().map(|k| k.3).collect();
            block.end = End::Again(Edge { to: level.header, args });
        }
        for (local, param, ..) in &kept {
            self.write(*local, *param);
            // Ways that lead further out pass its start too.
            let returns =
                self.inlines.last_mut().into_iter().flat_map(|e| e.exits.iter_mut().skip(level.returns.0));
            let chains =
                self.chains.last_mut().into_iter().flat_map(|e| e.exits.iter_mut().skip(level.returns.1));
            for way in returns.chain(chains) {
                if let Err(at) = way.stored.binary_search_by_key(local, |s| s.0) {
                    way.stored.insert(at, (*local, *param));
                }
            }
        }
        let exits = level.breaks.into_iter().map(Some);
        self.land(level.header, exits);
    }

    /// How a local of a type is handed over.
    pub(super) fn slot(&self, local: LocalId) -> Slot {
        match self.tree.locals.get(local as usize) {
            Some(local) if local.shared => Slot::Value,
            Some(local) => Slot::of(local.ty),
            None => Slot::Value,
        }
    }
}

impl super::Names {
    /// A name turned out to be another one.
    fn join(&mut self, name: At, other: At) {
        match (name, other) {
            (At::Number(n), At::Number(other)) => {
                let other = self.number(other).0;
                if let Some(place) = self.numbers.get_mut(n.0 as usize) {
                    *place = other;
                }
            }
            (At::Value(v), At::Value(other)) => {
                let other = self.value(other).0;
                if let Some(place) = self.values.get_mut(v.0 as usize) {
                    *place = other;
                }
            }
            // A variable holds numbers or values, never both.
            _ => {}
        }
    }
}
