//! Builds for newer processors. An archive of a release for Linux on x86-64 contains two programs: `labspec`, which runs on every
//! processor, and beside it `labspec-x86-64-v3`, the same with the vector instructions of processors since 2013. The first one starts
//! the second one where the processor has them. The wheel of the Python package contains its library twice in the same way. Results are
//! the same.

/// The name of the program for newer processors.
#[cfg(all(unix, target_arch = "x86_64", not(target_feature = "avx2")))]
const FASTER: &str = "labspec-x86-64-v3";

/// Replaces this program by the one for newer processors, if the processor can run it and it is beside this one. Otherwise, this
/// program continues.
#[cfg(all(unix, target_arch = "x86_64", not(target_feature = "avx2")))]
pub fn start_faster_program() {
    use std::os::unix::process::CommandExt;
    let Ok(program) = std::env::current_exe() else { return };
    let faster = program.with_file_name(FASTER);
    if !runs_faster_build() || !faster.is_file() {
        return;
    }
    let mut arguments = std::env::args_os();
    let name = arguments.next().unwrap_or_else(|| program.into_os_string());
    // `exec` returns only if the other program cannot be started.
    let _ = std::process::Command::new(faster).arg0(name).args(arguments).exec();
}

/// Whether this build is for every processor of x86-64, and this processor has the instructions that compilers use for x86-64-v3.
#[cfg(all(unix, target_arch = "x86_64", not(target_feature = "avx2")))]
#[must_use]
pub fn runs_faster_build() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("f16c")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("movbe")
}

/// This program is the only one.
#[cfg(not(all(unix, target_arch = "x86_64", not(target_feature = "avx2"))))]
pub fn start_faster_program() {}

/// Whether this build is for every processor of x86-64, and this processor can run a faster one.
#[cfg(not(all(unix, target_arch = "x86_64", not(target_feature = "avx2"))))]
#[must_use]
pub fn runs_faster_build() -> bool {
    false
}
