//! The last test of a binary. Tests start in the order of their names, and check their prerequisites before anything else.

#[test]
fn zz_skipped_tests_are_listed() {
    std::thread::sleep(std::time::Duration::from_millis(500));
    crate::needs::summary();
}
