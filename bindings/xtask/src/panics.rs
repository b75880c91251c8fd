//! Panics of a module as plain traps.
//!
//! A panic of the module ends as a trap, and what it says reaches nobody: there is no hook, and a page has no error output. Where code may
//! panic, the place and the numbers for the message are handed over nevertheless. Here the functions that would make the message become the
//! trap itself; `wasm-opt` then removes what was handed to them.

use std::path::Path;
use walrus::ir::Unreachable;
use walrus::{FunctionBuilder, FunctionKind, ModuleConfig};

/// Functions of Rust's libraries that never return: the ends of their paths.
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

/// Where all functions but formatting never return.
const MODULES: [&str; 2] = ["core::panicking::", "core::cell::panic_already_"];

/// The path of a function, without the numbers that tell versions of a crate and copies of a function apart.
fn path(name: &str) -> String {
    let mut depth = 0_u32;
    let kept = name.chars().filter(|c| {
        depth += u32::from(*c == '[');
        let keep = depth == 0;
        depth -= u32::from(*c == ']' && depth > 0);
        keep
    });
    kept.collect()
}

fn never_returns(name: &str) -> bool {
    let path = path(name);
    let path = path.split_once("::<").map_or(path.as_str(), |(before, _)| before);
    MODULES.iter().any(|module| path.starts_with(module)) || ENDS.iter().any(|end| path.ends_with(end))
}

/// Makes traps of the functions of a module that only say why it stops; their number.
pub(crate) fn to_traps(file: &Path) -> Result<usize, String> {
    let error = |e: &dyn std::fmt::Display| format!("{}: {e:#}", file.display());
    let mut config = ModuleConfig::new();
    config.generate_name_section(false).generate_producers_section(false);
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
            "<core[4a1f]::panicking::AssertKind as core[4a1f]::fmt::Debug>::fmt",
        ] {
            assert!(!never_returns(name), "{name}");
        }
    }
}
