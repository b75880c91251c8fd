//! Threads for the check of lessons. They have the same stack size on every system, and a panic in one lesson ends only the
//! check of that lesson.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::Builder;

/// The stack size of these threads, in bytes, so that the maximum recursion depth is the same on every system.
const STACK: usize = 8 << 20;

/// A builder for a thread with this stack size (8 MiB).
pub fn checking() -> Builder {
    Builder::new().stack_size(STACK)
}

/// Runs the work of a program on a thread with this stack size. If the system cannot start a thread, the work runs on the
/// current one.
pub fn run<T: Send>(work: impl Fn() -> T + Sync) -> T {
    std::thread::scope(|scope| match checking().spawn_scoped(scope, &work) {
        Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
        Err(_) => work(),
    })
}

/// Runs work, and catches a panic.
///
/// # Errors
/// The message of the panic.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    // Unfinished results are dropped, and caches contain only complete entries.
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        text.unwrap_or("it does not say why").to_string()
    })
}

#[cfg(test)]
#[allow(clippy::panic)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn the_message_of_a_panic_is_returned() {
        assert_eq!(catch_panic(|| 3), Ok(3));
        let lesson = 7;
        assert_eq!(catch_panic(|| -> u8 { panic!("lesson {lesson} is odd") }), Err("lesson 7 is odd".into()));
        assert_eq!(catch_panic(|| -> u8 { panic!("odd") }), Err("odd".into()));
    }

    #[test]
    fn the_work_has_the_stated_stack() {
        /// Needs more than 2 MB of stack, the default of a thread.
        fn deep_recursion(n: usize) -> usize {
            let space = std::hint::black_box([n as u8; 1 << 10]);
            if n == 0 { 0 } else { deep_recursion(n - 1) + usize::from(space[n % 1024] == n as u8) }
        }
        assert_eq!(run(|| deep_recursion(4_000)), 4_000);
    }
}
