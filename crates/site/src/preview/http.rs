//! HTTP as far as a preview needs it: one request for each connection, read with limits; the crate `httparse` reads its head.
//!
//! A connection is closed after its answer. `tiny_http`, which keeps connections open, left some of a browser's parallel connections
//! without a thread for good.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// The time that a browser has for each part of a request.
const PATIENCE: Duration = Duration::from_secs(10);
/// The maximum size of a head in bytes, and its number of headers.
const MAX_HEAD: usize = 32 << 10;
const MAX_HEADERS: usize = 64;
/// The maximum number of bytes of a refused request that are read, so that its answer arrives.
const MAX_DRAINED: u64 = 1 << 20;

/// A request that was not fulfilled: its status and the reason.
pub(super) type Refusal = (u16, String);

/// The head of a request.
#[derive(Debug, Default)]
pub(super) struct RequestHead {
    pub(super) method: String,
    /// The path with its query, as the browser wrote it.
    pub(super) target: String,
    headers: Vec<(String, String)>,
    /// The first bytes of the body.
    rest: Vec<u8>,
}

impl RequestHead {
    /// The values of a header.
    pub(super) fn headers(&self, name: &str) -> Vec<&str> {
        let all = self.headers.iter().filter(|(header, _)| header.eq_ignore_ascii_case(name));
        all.map(|(_, value)| value.as_str()).collect()
    }

    /// The length of the body; `None` where the request does not state it once.
    pub(super) fn length(&self) -> Option<u64> {
        match self.headers("content-length")[..] {
            [length] if length.bytes().all(|b| b.is_ascii_digit()) => length.parse().ok(),
            _ => None,
        }
    }
}

/// Reads the head of a request.
///
/// # Errors
/// The connection was closed, or this is no request of HTTP 1.
pub(super) fn read_head(stream: &mut TcpStream) -> io::Result<RequestHead> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    // Answers are written at once, however small.
    stream.set_nodelay(true)?;
    let wrong = || io::Error::from(io::ErrorKind::InvalidData);
    let (mut bytes, mut part) = (Vec::new(), [0; 4096]);
    loop {
        let count = stream.read(&mut part)?;
        bytes.extend(part.iter().take(count));
        let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
        let mut request = httparse::Request::new(&mut headers);
        match request.parse(&bytes).map_err(|_| wrong())? {
            httparse::Status::Complete(end) => {
                let text = |value: &[u8]| String::from_utf8_lossy(value).trim().to_string();
                return Ok(RequestHead {
                    method: request.method.unwrap_or("").to_string(),
                    target: request.path.unwrap_or("").to_string(),
                    headers: request.headers.iter().map(|h| (h.name.to_string(), text(h.value))).collect(),
                    rest: bytes.get(end..).unwrap_or_default().to_vec(),
                });
            }
            httparse::Status::Partial if count == 0 || bytes.len() > MAX_HEAD => return Err(wrong()),
            httparse::Status::Partial => {}
        }
    }
}

/// Reads the body of a request of at most `limit` bytes; `None` where it is longer, or its length is not stated.
pub(super) fn read_body(
    stream: &mut TcpStream,
    head: &RequestHead,
    limit: u64,
) -> io::Result<Option<Vec<u8>>> {
    let Some(length) = head.length().filter(|length| *length <= limit) else { return Ok(None) };
    let mut body = head.rest.clone();
    let missing = length.saturating_sub(body.len() as u64);
    stream.take(missing).read_to_end(&mut body)?;
    Ok((body.len() as u64 == length).then_some(body))
}

/// Reads the rest of a refused request: closing a connection with unread bytes may lose the answer.
pub(super) fn drain(stream: &mut TcpStream, head: &RequestHead) {
    let missing = head.length().unwrap_or(0).saturating_sub(head.rest.len() as u64).min(MAX_DRAINED);
    // The answer matters more than the rest.
    let _ = io::copy(&mut stream.take(missing), &mut io::sink());
}

/// Writes an answer. That to `HEAD` has no body.
pub(super) fn write_answer(
    stream: &mut TcpStream,
    status: u16,
    headers: &[(&'static str, String)],
    body: &[u8],
    has_body: bool,
) -> io::Result<()> {
    let reason = match status {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        409 => "Conflict",
        413 => "Content Too Large",
        503 => "Service Unavailable",
        _ => "Internal Server Error",
    };
    let mut head =
        format!("HTTP/1.1 {status} {reason}\r\nContent-Length: {}\r\nConnection: close\r\n", body.len());
    for (name, value) in headers {
        head.push_str(&format!("{name}: {value}\r\n"));
    }
    head.push_str("\r\n");
    stream.write_all(head.as_bytes())?;
    if has_body {
        stream.write_all(body)?;
    }
    stream.flush()
}
