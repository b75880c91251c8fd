//! The last test of a binary. Tests start in the order of their names, and check their prerequisites before anything else.

#[test]
fn zz_what_was_skipped() {
    std::thread::sleep(std::time::Duration::from_millis(500));
    crate::needs::summary();
}
