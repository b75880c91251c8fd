//! What a traceback of Python states.

/// The last line of a text that is not empty: in a traceback, the exception.
pub fn last_line(text: &str) -> &str {
    text.lines().rev().map(str::trim).find(|line| !line.is_empty()).unwrap_or("")
}

/// The last line of this file that a traceback names, from 1.
pub(super) fn line_in_file(traceback: &str, file: &str) -> Option<usize> {
    let number = |line: &str| {
        let (path, rest) = line.trim_start().strip_prefix("File \"")?.split_once("\", line ")?;
        let before = path.strip_suffix(file)?;
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        (before.is_empty() || before.ends_with('/')).then(|| rest.get(..digits)?.parse().ok())?
    };
    traceback.lines().rev().find_map(number)
}
