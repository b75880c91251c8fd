//! The interpreter of listings.

use super::process::watch;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// An interpreter.
#[derive(Clone, Debug)]
pub(super) struct Interpreter {
    /// Its path.
    pub(super) program: PathBuf,
    /// Its path, version and packages, which identify results.
    pub(super) identity: String,
}

/// Prints the path, the version and the packages of the interpreter.
const DESCRIBE: &str = "import sys
from importlib.metadata import distributions
print(sys.executable)
print(' '.join(sys.version.split()))
print(*sorted({f\"{d.metadata['Name']}=={d.version}\" for d in distributions()}), sep='\\n')";

/// The time limit for the description of an interpreter.
const DESCRIBE_TIME: Duration = Duration::from_secs(60);

impl Interpreter {
    /// Runs an interpreter to learn what it is.
    pub(super) fn describe(program: &Path) -> Result<Interpreter, String> {
        let mut command = Command::new(program);
        command.args(["-I", "-c", DESCRIBE]);
        let identity = watch(command, DESCRIBE_TIME, 1 << 20).map_err(|e| e.to_string())?.success()?;
        let program = identity.lines().next().filter(|line| !line.is_empty()).ok_or("it has no path")?;
        Ok(Interpreter { program: PathBuf::from(program), identity: identity.clone() })
    }
}
