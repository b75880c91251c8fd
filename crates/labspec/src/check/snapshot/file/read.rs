//! Reads the text of a snapshot.

use super::super::digits;
use super::{
    FIRST_LINE, NO_CERTAIN_DIGIT, NO_VALUE, SAME_AS_FIRST_RUN, SnapshotFault, StoredLab, StoredRow, StoredRun,
};
use crate::printable::printable;
use crate::source::SourceFile;
use std::collections::BTreeSet;

/// Reads the labs of a snapshot.
///
/// # Errors
/// The first deviation from the written form.
pub(in crate::check::snapshot) fn read(file: &SourceFile) -> Result<Vec<StoredLab>, SnapshotFault> {
    let mut reader = SnapshotReader { lines: file.text().lines().collect(), next_line: 0 };
    reader.head()?;
    let mut labs: Vec<StoredLab> = Vec::new();
    let mut addresses = BTreeSet::new();
    loop {
        let Some(line) = reader.next() else {
            return Err(reader.fault(0, "the file is incomplete: the line `end of … labs` is missing"));
        };
        if let Some(rest) = line.strip_prefix("lab ") {
            let start = reader.next_line - 1;
            let [address, _] = reader.names(rest, 4)?;
            if !addresses.insert(address.clone()) {
                return Err(reader.fault(4, &format!("the lab {address} appears a second time")));
            }
            let runs = reader.runs()?;
            let lines = reader.lines.get(start..reader.next_line).unwrap_or_default();
            let text = lines.iter().filter(|l| !is_empty(l)).map(|l| format!("{l}\n")).collect();
            labs.push(StoredLab { address, runs, text });
        } else if let Some(rest) = line.strip_prefix("end of ") {
            if rest != format!("{} labs", labs.len()) {
                return Err(reader
                    .fault(7, &format!("the file has {} labs, but this line says `{rest}`", labs.len())));
            }
            return match reader.next() {
                None => Ok(labs),
                Some(_) => Err(reader.fault(0, "there is text after the end")),
            };
        } else {
            return Err(reader.fault(0, "a lab (`lab \"#1\" \"title\"`) or the end must follow here"));
        }
    }
}

fn is_empty(line: &str) -> bool {
    line.trim().is_empty() || line.starts_with('#')
}

struct SnapshotReader<'t> {
    lines: Vec<&'t str>,
    /// The index of the next line.
    next_line: usize,
}

impl<'t> SnapshotReader<'t> {
    /// An error in the line that was read last, after `before` characters.
    fn fault(&self, before: usize, message: &str) -> SnapshotFault {
        SnapshotFault { line: self.next_line.max(1), column: before + 1, message: message.to_string() }
    }

    fn head(&mut self) -> Result<(), SnapshotFault> {
        self.next_line = 1;
        match self.lines.first() {
            Some(line) if *line == FIRST_LINE => Ok(()),
            Some(line) if line.starts_with("labspec snapshot ") => Err(self.fault(
                17,
                "the snapshot has another version; run `labspec snapshot --accept` to write it again",
            )),
            _ => {
                Err(self
                    .fault(0, &format!("the file is not a snapshot: a snapshot begins with `{FIRST_LINE}`")))
            }
        }
    }

    /// The next line that is not empty.
    fn next(&mut self) -> Option<&'t str> {
        while let Some(line) = self.lines.get(self.next_line) {
            self.next_line += 1;
            if !is_empty(line) {
                return Some(line);
            }
        }
        self.next_line = self.lines.len();
        None
    }

    /// The rest of the next line after `start`, if it begins with it.
    fn next_with(&mut self, start: &str) -> Option<&'t str> {
        let before = self.next_line;
        let rest = self.next().and_then(|line| line.strip_prefix(start));
        if rest.is_none() {
            self.next_line = before;
        }
        rest
    }

    /// Two texts between quotes.
    fn names(&self, rest: &str, before: usize) -> Result<[String; 2], SnapshotFault> {
        let words = self.split_words(rest, before)?;
        let text = |i: usize| words.get(i).and_then(|(_, w)| serde_json::from_str::<String>(w).ok());
        match (text(0), text(1), words.len()) {
            (Some(a), Some(b), 2) => Ok([a, b]),
            _ => {
                Err(self.fault(before, "the address and the title of a lab must follow here, both in quotes"))
            }
        }
    }

    /// The words of a line, each with the number of characters before it. A quoted text is one word.
    fn split_words(&self, line: &'_ str, before: usize) -> Result<Vec<(usize, String)>, SnapshotFault> {
        let mut words: Vec<(usize, String)> = Vec::new();
        let mut letters = line.chars().enumerate().peekable();
        while let Some((i, c)) = letters.next() {
            if c.is_whitespace() {
                continue;
            }
            let mut word = String::from(c);
            if c == '"' {
                let mut escaped = false;
                let mut closed = false;
                for (_, c) in letters.by_ref() {
                    word.push(c);
                    if c == '"' && !escaped {
                        closed = true;
                        break;
                    }
                    escaped = c == '\\' && !escaped;
                }
                if !closed || serde_json::from_str::<String>(&word).is_err() {
                    return Err(self.fault(before + i, "this quoted text is incomplete"));
                }
            } else {
                while let Some((_, c)) = letters.next_if(|(_, c)| !c.is_whitespace()) {
                    word.push(c);
                }
            }
            words.push((before + i, word));
        }
        Ok(words)
    }

    fn runs(&mut self) -> Result<Vec<StoredRun>, SnapshotFault> {
        let mut runs: Vec<StoredRun> = Vec::new();
        while let Some(name) = self.next_with("run ") {
            if runs.iter().any(|run| run.name == name) {
                return Err(self.fault(4, "this run appears a second time"));
            }
            let about = self.next_with("  ");
            let about = about
                .ok_or_else(|| self.fault(0, "the length and the timestep of a run must follow its name"))?;
            let about = about.split(", ").map(str::to_string).collect();
            if let (Some(first), Some(_)) = (runs.first(), self.next_with(&format!("  {SAME_AS_FIRST_RUN}")))
            {
                let run = StoredRun { name: name.to_string(), about, ..first.clone() };
                runs.push(run);
                continue;
            }
            let times =
                self.next_with("  ").map(|line| self.split_words(line, 2)).transpose()?.unwrap_or_default();
            if times.first().is_none_or(|(_, word)| word != "time") || times.len() < 2 {
                return Err(self.fault(0, "the times of a run must follow here, after the word `time`"));
            }
            let time = |(column, word): &(usize, String)| {
                let t = word.parse::<f64>().ok().filter(|t| t.is_finite());
                t.ok_or_else(|| self.fault(*column, &format!("`{}` is not a time", shortened(word))))
            };
            let times: Vec<f64> = times.iter().skip(1).map(time).collect::<Result<_, _>>()?;
            let mut rows = Vec::new();
            while let Some(line) = self.next_with("  ") {
                rows.push(self.row(line, times.len())?);
            }
            runs.push(StoredRun { name: name.to_string(), about, times, rows });
        }
        Ok(runs)
    }

    fn row(&self, line: &str, columns: usize) -> Result<StoredRow, SnapshotFault> {
        let mut words = self.split_words(line, 2)?.into_iter();
        let name = words.next().and_then(|(_, w)| serde_json::from_str(&w).ok());
        let Some(name) = name else {
            return Err(self.fault(2, "the name of a trace or a readout must follow here, in quotes"));
        };
        let words: Vec<(usize, String)> = words.collect();
        if words.len() != columns {
            let end = line.chars().count() + 2;
            return Err(self.fault(end, &format!("there are {} values for {columns} times", words.len())));
        }
        for (column, word) in &words {
            let fixed = [NO_CERTAIN_DIGIT, NO_VALUE, "true", "false", "nan", "inf", "-inf"];
            if !fixed.contains(&word.as_str()) && !word.starts_with('"') && digits::read(word).is_none() {
                return Err(self.fault(*column, &format!("`{}` is not a value", shortened(word))));
            }
        }
        Ok(StoredRow { name, cells: words.into_iter().map(|(_, w)| w).collect(), line: self.next_line })
    }
}

/// The beginning of a word of the file, for messages.
fn shortened(word: &str) -> String {
    let short: String = word.chars().take(24).collect();
    let more = if short.len() < word.len() { "…" } else { "" };
    format!("{}{more}", printable(&short))
}
