//! Reading and writing of messages: a header with the length of the body, then JSON.
//!
//! The sender is not trusted: a message of excessive length is skipped without allocating memory for it, and an invalid message
//! is reported to the sender, who may continue.

use lsp_server::Message;
use serde::Serialize;
use std::io::{self, BufRead, Read, Write};

/// The maximum size of a message in bytes. Lessons have at most 16 MB.
const MOST: u64 = 64 << 20;
/// The maximum size of a header line in bytes.
const MOST_LINE: u64 = 8 << 10;

/// The result of reading.
#[derive(Debug)]
pub(super) enum Incoming {
    /// A valid message.
    Message(Message),
    /// An invalid message, and the reason.
    Bad(String),
    /// The end of the input.
    End,
}

/// Reads a message.
///
/// # Errors
/// Returns the error of the input.
pub(super) fn read(input: &mut impl BufRead) -> io::Result<Incoming> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        input.by_ref().take(MOST_LINE).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(Incoming::End);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim_end_matches(['\r', '\n']);
        if line.is_empty() {
            break;
        }
        match line.split_once(':') {
            Some((name, value)) if name.trim().eq_ignore_ascii_case("content-length") => {
                length = value.trim().parse::<u64>().ok();
            }
            Some(_) => {}
            None => return Ok(Incoming::Bad("a line of a header has no colon".into())),
        }
    }
    let Some(length) = length else { return Ok(Incoming::Bad("a message has no Content-Length".into())) };
    if length > MOST {
        io::copy(&mut input.by_ref().take(length), &mut io::sink())?;
        return Ok(Incoming::Bad(format!("a message of {length} bytes is too long; the limit is {MOST}")));
    }
    let mut body = Vec::new();
    input.by_ref().take(length).read_to_end(&mut body)?;
    if (body.len() as u64) < length {
        return Ok(Incoming::End);
    }
    Ok(match serde_json::from_slice::<Message>(&body) {
        Ok(message) => Incoming::Message(message),
        Err(e) => Incoming::Bad(format!("the message is invalid: {e}")),
    })
}

/// The message as it is written.
#[derive(Serialize)]
struct Envelope<'m, M> {
    jsonrpc: &'static str,
    #[serde(flatten)]
    message: &'m M,
}

/// Writes a message with its header.
///
/// # Errors
/// Returns the error of the output.
pub(super) fn write(out: &mut dyn Write, message: &impl Serialize) -> io::Result<()> {
    let text = serde_json::to_string(&Envelope { jsonrpc: "2.0", message })?;
    write!(out, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8]) -> Vec<String> {
        let mut input = io::BufReader::new(bytes);
        let mut seen = Vec::new();
        loop {
            seen.push(match read(&mut input).unwrap() {
                Incoming::Message(Message::Request(r)) => r.method,
                Incoming::Message(Message::Notification(n)) => n.method,
                Incoming::Message(Message::Response(_)) => "response".into(),
                Incoming::Bad(why) => why,
                Incoming::End => return seen,
            });
        }
    }

    #[test]
    fn what_is_no_message_is_reported_and_what_follows_is_read() {
        let message = |text: &str| format!("content-length:{}\r\nX: y\r\n\r\n{text}", text.len());
        let good = message(r#"{"jsonrpc":"2.0","method":"exit"}"#);
        for (bad, why) in [
            (message("{"), "the message is invalid: EOF"),
            (message("[]"), "the message is invalid"),
            (message("\u{0}"), "the message is invalid"),
            ("Content-Length: x\r\n\r\n".into(), "a message has no Content-Length"),
            ("\r\n".into(), "a message has no Content-Length"),
            ("hello\n".into(), "a line of a header has no colon"),
        ] {
            let seen = all(format!("{bad}{good}").as_bytes());
            assert!(seen[0].starts_with(why), "{seen:?}");
            assert_eq!(seen[1..], ["exit"], "{bad}");
        }
    }

    #[test]
    fn no_length_takes_memory() {
        let seen = all(b"Content-Length: 18446744073709551615\r\n\r\n{}");
        assert!(seen[0].contains("too long"), "{seen:?}");
        assert!(all(b"Content-Length: 60000000\r\n\r\n{}").is_empty());
        assert!(all(&vec![b'a'; 100_000]).iter().all(|why| why.contains("no colon")));
    }
}
