//! Replaces the panics of a module by traps, to reduce its size.
//!
//! A panic of a page module ends as a trap in any case, and its message is lost: there is no hook, and a page has no error output. Code that
//! may panic nevertheless passes the source location and the values of the message to a library function. This file replaces the bodies of
//! these functions by the trap, so that `wasm-opt` removes their arguments, and overwrites the source locations with zeros, which compress well.

use std::collections::{BTreeSet, HashSet};
use std::path::Path;
use walrus::ir::{Const, Instr, InstrLocId, Unreachable, Value, Visitor, dfs_in_order};
use walrus::{ConstExpr, DataId, DataKind, FunctionBuilder, FunctionId, FunctionKind, Module, ModuleConfig};

/// The ends of the paths of library functions that never return.
const ENDS: [&str; 10] = [
    "option::unwrap_failed",
    "option::expect_failed",
    "result::unwrap_failed",
    "slice::index::slice_index_fail",
    "str::slice_error_fail",
    "::assert_failed",
    "::len_mismatch_fail",
    "raw_vec::capacity_overflow",
    "raw_vec::handle_error",
    "alloc::handle_alloc_error",
];

const LIBRARIES: [&str; 3] = ["core::", "alloc::", "hashbrown::"];

/// Modules whose functions never return, except formatting.
const MODULES: [&str; 2] = ["core::panicking::", "core::cell::panic_already_"];

/// The path of a function, without the hashes and numbers in brackets that distinguish crate versions and copies of a function.
fn path(name: &str) -> String {
    let mut depth = 0_u32;
    let outside = name.chars().filter(|c| {
        depth += u32::from(*c == '[');
        let keep = depth == 0;
        depth -= u32::from(*c == ']' && depth > 0);
        keep
    });
    outside.collect()
}

fn never_returns(name: &str) -> bool {
    let path = path(name);
    let path = path.split_once("::<").map_or(path.as_str(), |(before, _)| before);
    let library = LIBRARIES.iter().any(|library| path.trim_start_matches('<').starts_with(library));
    MODULES.iter().any(|module| path.starts_with(module))
        || library && ENDS.iter().any(|end| path.ends_with(end))
}

/// Collects the constants that are passed as the last argument to functions that never return. Usually they are addresses of source locations.
struct LastConstants<'a> {
    stopping: &'a HashSet<FunctionId>,
    before: Option<i32>,
    found: BTreeSet<usize>,
}

impl<'i> Visitor<'i> for LastConstants<'_> {
    fn visit_instr(&mut self, instr: &'i Instr, _: &'i InstrLocId) {
        match instr {
            Instr::Call(call) if self.stopping.contains(&call.func) => {
                self.found.extend(self.before.and_then(|value| usize::try_from(value).ok()));
                self.before = None;
            }
            Instr::Const(Const { value: Value::I32(x) }) => self.before = Some(*x),
            _ => self.before = None,
        }
    }
}

/// The size of a source location: address and length of the file name, line and column.
const PLACE: usize = 16;

/// The data segment that contains an address range, and the offset of the range in it.
fn segment(module: &Module, address: usize, length: usize) -> Option<(DataId, usize)> {
    module.data.iter().find_map(|data| {
        let DataKind::Active { offset: ConstExpr::Value(Value::I32(start)), .. } = data.kind else {
            return None;
        };
        let start_in_data = address.checked_sub(usize::try_from(start).ok()?)?;
        (start_in_data.checked_add(length)? <= data.value.len()).then(|| (data.id(), start_in_data))
    })
}

fn bytes(module: &Module, address: usize, length: usize) -> Option<&[u8]> {
    let (id, offset) = segment(module, address, length)?;
    module.data.get(id).value.get(offset..offset + length)
}

/// Whether the bytes at an address are the source location of a Rust file.
fn is_place(module: &Module, address: usize) -> bool {
    let number = |k: usize| {
        let four = bytes(module, address + 4 * k, 4)?.try_into().ok()?;
        usize::try_from(u32::from_le_bytes(four)).ok()
    };
    let file = || bytes(module, number(0)?, number(1)?);
    file().is_some_and(|name| name.ends_with(b".rs"))
}

/// Overwrites the source locations that are passed to functions that never return.
fn clear_places(module: &mut Module, stopping: &HashSet<FunctionId>) {
    let mut constants = LastConstants { stopping, before: None, found: BTreeSet::new() };
    for (_, local) in module.funcs.iter_local() {
        dfs_in_order(&mut constants, local, local.entry_block());
    }
    let places: Vec<usize> =
        constants.found.into_iter().filter(|address| is_place(module, *address)).collect();
    for (id, offset) in
        places.iter().filter_map(|address| segment(module, *address, PLACE)).collect::<Vec<_>>()
    {
        module.data.get_mut(id).value[offset..offset + PLACE].fill(0);
    }
}

/// Replaces the functions of a module that never return by traps. Returns their number.
pub(crate) fn to_traps(file: &Path) -> Result<usize, String> {
    let error = |e: &dyn std::fmt::Display| format!("{}: {e:#}", file.display());
    let mut config = ModuleConfig::new();
    config.generate_name_section(crate::keeps_names()).generate_producers_section(false);
    let mut module = config.parse_file(file).map_err(|e| error(&e))?;
    let stopping: Vec<_> = module
        .funcs
        .iter_local()
        .filter(|(id, local)| {
            let name = module.funcs.get(*id).name.as_deref().unwrap_or_default();
            never_returns(name) && module.types.get(local.ty()).results().is_empty()
        })
        .map(|(id, local)| (id, local.ty(), local.args.clone()))
        .collect();
    clear_places(&mut module, &stopping.iter().map(|(id, ..)| *id).collect());
    for (id, ty, arguments) in &stopping {
        let parameters = module.types.get(*ty).params().to_vec();
        let mut builder = FunctionBuilder::new(&mut module.types, &parameters, &[]);
        builder.func_body().instr(Unreachable {});
        module.funcs.get_mut(*id).kind = FunctionKind::Local(builder.local_func(arguments.clone()));
    }
    module.emit_wasm_file(file).map_err(|e| error(&e))?;
    Ok(stopping.len())
}

#[cfg(test)]
mod tests {
    use super::never_returns;

    #[test]
    fn only_functions_that_never_return_become_traps() {
        for name in [
            "core[4a1f]::panicking::panic_bounds_check",
            "core[4a1f]::panicking::assert_failed::<usize, usize>",
            "core[4a1f]::option::unwrap_failed[1]",
            "<alloc[9]::vec::Vec<_>>::remove::assert_failed",
            "core[4a1f]::slice::copy_from_slice_impl::len_mismatch_fail",
            "core::cell::panic_already_borrowed",
        ] {
            assert!(never_returns(name), "{name}");
        }
        for name in [
            "std[1]::panicking::panic_count::is_zero_slow_path",
            "labspec_core::step::fail",
            "labspec_core::assert_failed",
            "<core[4a1f]::panicking::AssertKind as core[4a1f]::fmt::Debug>::fmt",
        ] {
            assert!(!never_returns(name), "{name}");
        }
    }
}
