//! Local variables and edges between blocks. During the walk through the tree, the current value of every variable is
//! known. Where edges join, variables with different values become block parameters. A loop is the only place where not all
//! edges are known when the block begins: a variable that is read in the loop gets a parameter at the loop's start, which
//! is removed at the end if the loop did not store the variable (Braun et al., "Simple and efficient construction of static
//! single assignment form", 2013).

use labspec_finding::order;
use std::collections::BTreeMap;

use super::builder::{EarlyExits, FunctionBuilder, LoopContext, PendingEdge, Variables};
use crate::ir::LocalId;
use crate::operation::truthy;
use crate::ssa::{BasicBlock, BlockEdge, BlockId, Num, Op, Operand, Terminator, Val};
use crate::value::Value;
use labspec_finding::Span;

/// The variables that are stored along edges.
fn stored_on<'w>(edges: impl IntoIterator<Item = &'w PendingEdge>) -> Vec<LocalId> {
    let mut locals: Vec<LocalId> =
        edges.into_iter().flat_map(|w| &w.stored).map(|(local, _)| *local).collect();
    order::sort_by(&mut locals, Ord::cmp);
    locals.dedup();
    locals
}

/// Up to this number of operations, evaluating both branches costs no more than a branch.
const MAX_CHEAP_OPERATIONS: usize = 4;

/// The condition of a branch on a number, and the outcome for which it jumps.
fn question(end: &Terminator) -> Option<(bool, Num)> {
    if let Terminator::If(when, test, _) = end { Some((*when, *test)) } else { None }
}

impl FunctionBuilder<'_> {
    pub(super) fn mark(&self) -> usize {
        self.variables.log.len()
    }

    /// Undoes all stores since a mark.
    pub(super) fn undo_stores(&mut self, mark: usize) {
        for (local, before) in self.variables.log.drain(mark..).rev() {
            if let Some(current) = self.variables.current.get_mut(local as usize) {
                *current = before;
            }
        }
    }

    /// A new variable of the compiler.
    pub(super) fn temporary(&mut self) -> LocalId {
        self.temporaries += 1;
        self.tree.locals.len() as u32 + self.temporaries
    }

    pub(super) fn write(&mut self, local: LocalId, value: Operand) {
        let Variables { current, log } = &mut self.variables;
        if current.len() <= local as usize {
            current.resize(local as usize + 1, None);
        }
        if let Some(place) = current.get_mut(local as usize) {
            log.push((local, place.replace((value, self.loops.len() as u32))));
        }
    }

    /// The current value of a variable, or `None` if nothing was stored.
    fn find(&mut self, local: LocalId) -> Option<Operand> {
        let (mut value, level) = self.variables.current.get(local as usize).copied().flatten()?;
        if (level as usize) < self.loops.len() {
            for i in level as usize..self.loops.len() {
                let param = self.loops.get(i).and_then(|l| l.params.get(&local)).map(|(param, _)| *param);
                value = match param {
                    Some(param) => param,
                    None => {
                        let param = self.new_like(value);
                        if let Some(level) = self.loops.get_mut(i) {
                            level.params.insert(local, (param, value));
                        }
                        param
                    }
                };
            }
            self.write(local, value);
        }
        Some(value)
    }

    pub(super) fn read_number(&mut self, local: LocalId) -> Num {
        match self.find(local) {
            Some(Operand::Number(n)) => n,
            _ => self.constant(f64::NAN),
        }
    }

    pub(super) fn read_value(&mut self, local: LocalId) -> Val {
        match self.find(local) {
            Some(Operand::Value(v)) => v,
            _ => self.constant_value(&Value::Undefined),
        }
    }

    /// Whether a value was stored.
    pub(super) fn has(&self, local: LocalId) -> bool {
        self.variables.current.get(local as usize).is_some_and(Option::is_some)
    }

    /// A new name with the same representation.
    fn new_like(&mut self, model: Operand) -> Operand {
        match model {
            Operand::Number(_) => Operand::Number(self.new_number()),
            Operand::Value(_) => Operand::Value(self.new_value()),
        }
    }

    /// The current block.
    fn current_block(&self) -> BlockId {
        (self.unit.blocks.len() as u32).saturating_sub(1)
    }

    /// Begins a block.
    pub(super) fn begin(&mut self, after: BlockId) {
        let first = self.unit.ops.len() as u32;
        let end = Terminator::Return(None);
        self.unit.blocks.push(BasicBlock { first, params: Vec::new(), after, end, span: Span::default() });
        self.dead = false;
    }

    fn stored_since(&self, mark: usize) -> Vec<(LocalId, Operand)> {
        let log = self.variables.log.get(mark..).unwrap_or(&[]);
        let mut locals: Vec<LocalId> = log.iter().map(|(local, _)| *local).collect();
        order::sort_by(&mut locals, Ord::cmp);
        locals.dedup();
        let current = |l: LocalId| {
            self.variables.current.get(l as usize).copied().flatten().map(|(value, _)| (l, value))
        };
        locals.into_iter().filter_map(current).collect()
    }

    /// Ends the block; the code after it is unreachable.
    pub(super) fn end(&mut self, end: Terminator, span: Span) {
        let span = self.site.unwrap_or(span);
        if let Some(block) = self.unit.blocks.last_mut().filter(|_| !self.dead) {
            (block.end, block.span) = (end, span);
        }
        self.dead = true;
    }

    /// Ends the block with a jump to a target that is not known yet. The edge contains the variables stored since `mark`.
    pub(super) fn jump(&mut self, mark: usize, span: Span) -> Option<PendingEdge> {
        let pending =
            (!self.dead).then(|| PendingEdge { from: self.current_block(), stored: self.stored_since(mark) });
        self.end(Terminator::Jump(BlockEdge::default()), span);
        pending
    }

    /// Ends the block with a conditional jump, and continues in the block for the other outcome.
    pub(super) fn jump_if(&mut self, end: Terminator, mark: usize, span: Span) -> Option<PendingEdge> {
        if self.dead {
            return None;
        }
        if let Terminator::If(when, test, _) = end
            && let Some(x) = self.unit.constant(test)
            && !x.is_nan()
        {
            // The condition is constant, so only one edge exists.
            return if truthy(x) == when { self.jump(mark, span) } else { None };
        }
        let pending = PendingEdge { from: self.current_block(), stored: self.stored_since(mark) };
        let after = pending.from;
        self.end(end, span);
        self.begin(after);
        Some(pending)
    }

    fn edge(&mut self, from: BlockId) -> Option<&mut BlockEdge> {
        match &mut self.unit.blocks.get_mut(from as usize)?.end {
            Terminator::Jump(edge)
            | Terminator::If(_, _, edge)
            | Terminator::IfNothing(_, _, edge)
            | Terminator::Again(edge) => Some(edge),
            Terminator::Return(_) => None,
        }
    }

    /// Joins edges in a new block. `after` is the last block that all of them passed. The current values of the variables are
    /// those at the end of `after`; the values in the new block follow from the edges.
    fn join_edges(&mut self, after: BlockId, edges: impl IntoIterator<Item = Option<PendingEdge>>) {
        let edges: Vec<PendingEdge> = edges.into_iter().flatten().collect();
        if edges.is_empty() {
            self.dead = true;
            return;
        }
        self.begin(after);
        let to = self.current_block();
        for pending in &edges {
            if let Some(edge) = self.edge(pending.from) {
                edge.to = to;
            }
        }
        for local in stored_on(&edges) {
            let held: Vec<Option<Operand>> =
                edges.iter().map(|pending| pending.stored_value(local)).collect();
            let before = if held.contains(&None) { self.find(local) } else { None };
            let held: Option<Vec<Operand>> = held.into_iter().map(|value| value.or(before)).collect();
            // A variable without a value on one of the edges is not used any more.
            let Some(held) = held else { continue };
            let Some(&first) = held.first() else { continue };
            let same = |operand: &Operand| self.unit.same.at(*operand) == self.unit.same.at(first);
            if held.iter().all(same) {
                self.write(local, first);
                continue;
            }
            let param = self.new_like(first);
            for (pending, value) in edges.iter().zip(held) {
                if let Some(edge) = self.edge(pending.from) {
                    edge.args.push(value);
                }
            }
            if let Some(block) = self.unit.blocks.last_mut() {
                block.params.push(param);
            }
            self.write(local, param);
        }
    }

    /// Builds two branches that join again.
    pub(super) fn build_branches(
        &mut self,
        test: Terminator,
        span: Span,
        next: impl FnOnce(&mut Self),
        there: impl FnOnce(&mut Self),
    ) {
        let (mark, from, question) = (self.mark(), self.current_block(), question(&test));
        let pending = self.jump_if(test, mark, span);
        next(self);
        let end = self.jump(mark, span);
        self.undo_stores(mark);
        self.join_edges(from, [pending]);
        there(self);
        let other = self.jump(mark, span);
        self.undo_stores(mark);
        self.join_branches(from, question, other, end);
    }

    /// The same with an empty second branch.
    pub(super) fn skip(&mut self, test: Terminator, span: Span, next: impl FnOnce(&mut Self)) {
        let (mark, from, question) = (self.mark(), self.current_block(), question(&test));
        let pending = self.jump_if(test, mark, span);
        next(self);
        let end = self.jump(mark, span);
        self.undo_stores(mark);
        self.join_branches(from, question, pending, end);
    }

    /// Joins the two branches of a conditional. If both contain only a few numeric operations, the branch is removed: both
    /// values are evaluated, and one is selected.
    fn join_branches(
        &mut self,
        from: BlockId,
        question: Option<(bool, Num)>,
        there: Option<PendingEdge>,
        next: Option<PendingEdge>,
    ) {
        if let (Some((when, test)), Some(there), Some(next)) = (question, &there, &next)
            && self.is_cheap(from)
            && let Some(held) = self.numbers_of(there, next)
        {
            self.unit.blocks.truncate(from as usize + 1);
            self.dead = false;
            let span = self.unit.blocks.last().map(|b| b.span).unwrap_or_default();
            for (local, there, next) in held {
                let (yes, no) = if when { (there, next) } else { (next, there) };
                let same = self.unit.same.number(yes) == self.unit.same.number(no);
                let one = if same { yes } else { self.number_by(span, |dst| Op::Select(dst, test, yes, no)) };
                self.write(local, Operand::Number(one));
            }
            return;
        }
        self.join_edges(from, [there, next]);
    }

    /// Whether the blocks since a branch are only its two branches, with few numeric operations.
    fn is_cheap(&self, from: BlockId) -> bool {
        let branches = self.unit.blocks.get(from as usize + 1..).unwrap_or(&[]);
        let first = branches.first().map_or(self.unit.ops.len(), |b| b.first as usize);
        let ops = self.unit.ops.get(first..).unwrap_or(&[]);
        let plain = branches.iter().all(|b| matches!(b.end, Terminator::Jump(_)) && b.params.is_empty());
        branches.len() <= 2 && plain && ops.len() <= MAX_CHEAP_OPERATIONS && ops.iter().all(Op::is_numeric)
    }

    /// The different values of variables at the end of two branches, or `None` if one of them is not a number.
    fn numbers_of(&mut self, there: &PendingEdge, next: &PendingEdge) -> Option<Vec<(LocalId, Num, Num)>> {
        let mut all = Vec::new();
        for local in stored_on([there, next]) {
            let (there, next) = (there.stored_value(local), next.stored_value(local));
            let before = if there.is_none() || next.is_none() { self.find(local) } else { None };
            match (there.or(before), next.or(before)) {
                (Some(Operand::Number(there)), Some(Operand::Number(next))) => all.push((local, there, next)),
                // A variable without a value on one of the edges is not used any more.
                (None, _) | (_, None) => {}
                _ => return None,
            }
        }
        Some(all)
    }

    /// Builds a region with early exits. `work` adds these to the list that `exits` returns.
    pub(super) fn region(
        &mut self,
        span: Span,
        work: impl FnOnce(&mut Self, usize),
        exits: impl FnOnce(&mut Self) -> Vec<PendingEdge>,
    ) {
        let (mark, from) = (self.mark(), self.current_block());
        work(self, mark);
        let end = self.jump(mark, span);
        let exits = exits(self);
        self.undo_stores(mark);
        self.join_edges(from, exits.into_iter().map(Some).chain([end]));
    }

    /// Begins a loop.
    pub(super) fn enter_loop(&mut self, span: Span) {
        let mark = self.mark();
        let from = self.current_block();
        let entry = self.jump(mark, span);
        let dead = entry.is_none();
        self.begin(from);
        self.dead = dead;
        let exit_count = |all: &[EarlyExits]| all.last().map_or(0, |e| e.exits.len());
        let returns = (exit_count(&self.inlines), exit_count(&self.chains));
        let (header, params) = (self.current_block(), BTreeMap::new());
        let (breaks, continues) = (Vec::new(), Vec::new());
        if let Some(pending) = &entry
            && let Some(edge) = self.edge(pending.from)
        {
            edge.to = header;
        }
        self.loops.push(LoopContext { header, entry, mark, params, breaks, continues, returns });
    }

    /// Leaves the innermost loop, or continues with its next iteration.
    pub(super) fn leave_iteration(&mut self, leaves: bool) {
        let Some(mark) = self.loops.last().map(|l| l.mark) else { return };
        let pending = self.jump(mark, Span::default());
        if let Some(level) = self.loops.last_mut() {
            if leaves { level.breaks.extend(pending) } else { level.continues.extend(pending) }
        }
    }

    /// Joins the edges of `continue`.
    pub(super) fn join_continues(&mut self) {
        let Some(level) = self.loops.last_mut() else { return };
        let (mark, header, continues) = (level.mark, level.header, std::mem::take(&mut level.continues));
        if !continues.is_empty() {
            let end = self.jump(mark, Span::default());
            self.undo_stores(mark);
            self.join_edges(header, continues.into_iter().map(Some).chain([end]));
        }
    }

    /// Leaves the loop unless the condition holds.
    pub(super) fn loop_test(&mut self, holds: Num, span: Span) {
        let Some(mark) = self.loops.last().map(|l| l.mark) else { return };
        let pending = self.jump_if(Terminator::If(false, holds, BlockEdge::default()), mark, span);
        if let Some(level) = self.loops.last_mut() {
            level.breaks.extend(pending);
        }
    }

    /// Ends a loop: values stored in it become the arguments of the parameters of the loop for the next iteration.
    pub(super) fn leave_loop(&mut self, span: Span) {
        let Some(mark) = self.loops.last().map(|l| l.mark) else { return };
        let back = self.jump(mark, span);
        self.undo_stores(mark);
        let Some(mut level) = self.loops.pop() else { return };
        for (local, value) in back.iter().chain(&level.breaks).flat_map(|pending| &pending.stored) {
            if !level.params.contains_key(local)
                && let Some(before) = self.find(*local)
            {
                let param = self.new_like(*value);
                level.params.insert(*local, (param, before));
            }
        }
        let mut changed = Vec::new();
        for (local, (param, before)) in &level.params {
            let stored = back.as_ref().and_then(|pending| pending.stored_value(*local));
            let next = stored.map_or(*param, |operand| self.unit.same.at(operand));
            if next == *param || next == self.unit.same.at(*before) {
                self.unit.same.join(*param, *before);
            } else {
                changed.push((*local, *param, *before, next));
            }
        }
        if let Some(block) = self.unit.blocks.get_mut(level.header as usize) {
            block.params = changed.iter().map(|k| k.1).collect();
        }
        let from = level.entry.as_ref().map(|e| e.from);
        if let Some(edge) = from.and_then(|from| self.edge(from)) {
            edge.args = changed.iter().map(|k| k.2).collect();
        }
        if let Some(block) = back.and_then(|pending| self.unit.blocks.get_mut(pending.from as usize)) {
            let args = changed.iter().map(|k| k.3).collect();
            block.end = Terminator::Again(BlockEdge { to: level.header, args });
        }
        for (local, param, ..) in &changed {
            self.write(*local, *param);
            // Edges that leave enclosing regions pass the start of this loop as well.
            let returns =
                self.inlines.last_mut().into_iter().flat_map(|e| e.exits.iter_mut().skip(level.returns.0));
            let chains =
                self.chains.last_mut().into_iter().flat_map(|e| e.exits.iter_mut().skip(level.returns.1));
            for pending in returns.chain(chains) {
                if let Err(index) = pending.stored.binary_search_by_key(local, |s| s.0) {
                    pending.stored.insert(index, (*local, *param));
                }
            }
        }
        let exits = level.breaks.into_iter().map(Some);
        self.join_edges(level.header, exits);
    }
}
