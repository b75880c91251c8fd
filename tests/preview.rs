//! `labspec preview`: which requests the server answers, what it writes, and that it follows the files.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::program::program;
use crate::site::course;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A lesson with a number without a claim, and a misspelt key that has a fix.
const LESSON: &str = "# A\r\n\r\nFirst words, 3.7 m.\r\n\r\n```lab simlab\r\n{\"xml\": \"<mujoco/>\", \"titel\": \"T\"}\r\n```\r\n";

/// A running preview of a course with one lesson.
struct Preview {
    folder: tempfile::TempDir,
    child: Child,
    host: String,
}

impl Drop for Preview {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An answer: its status, its head and its body.
struct Answer {
    status: u16,
    head: String,
    body: String,
}

impl Preview {
    fn start() -> Preview {
        let folder = course(&[
            ("a.md", LESSON),
            ("p.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>"),
            ("secret.env", "s"),
        ]);
        let mut command = program(folder.path(), &["preview", "course", "--page", "page"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let host = line.split_once("http://").unwrap().1.split_once('/').unwrap().0.to_string();
        assert!(host.starts_with("127.0.0.1:"), "{line}");
        Preview { folder, child, host }
    }

    fn lesson(&self) -> PathBuf {
        self.folder.path().join("course/a.md")
    }

    fn text(&self) -> String {
        std::fs::read_to_string(self.lesson()).unwrap()
    }

    fn send(&self, request: &str) -> Answer {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let _ = stream.write_all(request.as_bytes());
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
        Answer { status, head: head.to_string(), body: body.to_string() }
    }

    /// A request with these lines after the host.
    fn get(&self, path: &str, more: &str) -> Answer {
        self.send(&format!("GET {path} HTTP/1.1\r\nHost: {}\r\n{more}\r\n", self.host))
    }

    fn post(&self, action: &str, token: &str, body: &serde_json::Value) -> Answer {
        let body = body.to_string();
        let head = format!(
            "POST /_labspec/{action} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nX-Labspec-Token: {token}\r\nContent-Length: {}\r\n\r\n",
            body.len(),
            host = self.host
        );
        self.send(&(head + &body))
    }

    /// The page once it shows the checked text of the file: its token, the hash of the text, and the page itself.
    fn page(&self) -> (String, String, String) {
        let begin = Instant::now();
        let hash = || sha256(&self.text());
        loop {
            let html = self.get("/a.html", "").body;
            let value =
                |key: &str| html.split_once(key).map(|(_, rest)| rest.split('"').next().unwrap().to_string());
            let displayed = value("data-hash=\"").unwrap_or_default();
            if value("data-checked=\"").as_deref() == Some("true") && displayed == hash() {
                return (value("labspec-token\" content=\"").unwrap(), displayed, html);
            }
            assert!(begin.elapsed() < Duration::from_secs(60), "the page does not follow the file: {html}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

/// As the server computes it: with the length before the text.
fn sha256(text: &str) -> String {
    use sha2::{Digest, Sha256};
    let mut hash = Sha256::new();
    hash.update((text.len() as u64).to_be_bytes());
    hash.update(text);
    format!("{:x}", hash.finalize())
}

/// The bytes of the block of a kind, as the page names them.
fn block(html: &str, kind: &str) -> (usize, usize) {
    let part = html.split_once(&format!("class=\"block {kind}\"")).unwrap().1;
    let number = |key: &str| part.split_once(key).unwrap().1.split('"').next().unwrap().parse().unwrap();
    (number("data-start=\""), number("data-end=\""))
}

#[test]
fn only_requests_of_the_own_page_are_answered() {
    let preview = Preview::start();
    let (token, hash, html) = preview.page();
    let host = &preview.host;
    let home = preview.get("/", "");
    assert_eq!(home.status, 200);
    for header in [
        "Content-Security-Policy: default-src 'none'",
        "frame-ancestors 'none'",
        "X-Content-Type-Options: nosniff",
        "Connection: close",
    ] {
        assert!(home.head.contains(header), "{header}: {}", home.head);
    }
    assert!(preview.send(&format!("HEAD / HTTP/1.1\r\nHost: {host}\r\n\r\n")).body.is_empty());
    // Another host, none, two; another origin.
    for request in [
        "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n".to_string(),
        "GET / HTTP/1.1\r\n\r\n".to_string(),
        format!("GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil.example\r\n\r\n"),
        format!("GET / HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example\r\n\r\n"),
        format!("GET / HTTP/1.1\r\nHost: {host}\r\nOrigin: null\r\n\r\n"),
    ] {
        assert_eq!(preview.send(&request).status, 403, "{request}");
    }
    for path in [
        "/../secret.env",
        "/secret.env",
        "/%2e%2e/secret.env",
        "/a.md",
        "//etc/passwd",
        "/..%5csecret.env",
        "/page/../a.html",
        "/\u{0}",
    ] {
        assert!([404, 0].contains(&preview.get(path, "").status), "{path}");
    }
    for method in ["PUT", "DELETE", "OPTIONS", "PATCH"] {
        assert_eq!(
            preview.send(&format!("{method} / HTTP/1.1\r\nHost: {host}\r\n\r\n")).status,
            405,
            "{method}"
        );
    }
    assert_eq!(preview.get("/_labspec/edit", "").status, 405);
    // Without the token of the page, or without its origin, nothing is done.
    let (start, end) = block(&html, "text");
    let ask =
        serde_json::json!({"page": "a.html", "hash": hash, "start": start, "end": end, "text": "changed"});
    for wrong in ["", "0", &token[..token.len() - 1]] {
        assert_eq!(preview.post("edit", wrong, &ask).status, 403, "{wrong}");
    }
    let body = ask.to_string();
    let plain = format!(
        "POST /_labspec/edit HTTP/1.1\r\nHost: {host}\r\nX-Labspec-Token: {token}\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    );
    assert_eq!(preview.send(&plain).status, 403);
    assert_eq!(preview.text(), LESSON);
}

#[test]
fn damaged_requests_end_nothing() {
    let preview = Preview::start();
    let (token, hash, html) = preview.page();
    let host = &preview.host;
    for request in [
        String::new(),
        "\r\n\r\n".into(),
        "nonsense\r\n\r\n".into(),
        format!("GET / HTTP/1.1\r\nHost: {host}\r\n{}\r\n", "X: y\r\n".repeat(500)),
        format!("GET /{} HTTP/1.1\r\nHost: {host}\r\n\r\n", "a".repeat(100_000)),
        format!(
            "POST /_labspec/edit HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nX-Labspec-Token: {token}\r\nContent-Length: 99999999999\r\n\r\n"
        ),
        format!(
            "POST /_labspec/edit HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nX-Labspec-Token: {token}\r\nContent-Length: -1\r\n\r\n"
        ),
        format!(
            "POST /_labspec/edit HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nX-Labspec-Token: {token}\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"
        ),
    ] {
        // A connection without a request is closed by its own end.
        let mut stream = TcpStream::connect(host).unwrap();
        let _ = stream.write_all(request.as_bytes());
        let _ = stream.shutdown(std::net::Shutdown::Write);
        let mut answer = String::new();
        let _ = stream.read_to_string(&mut answer);
        assert!(!answer.contains(" 200 "), "{answer}");
    }
    let (start, end) = block(&html, "text");
    for (action, ask, status) in [
        ("edit", serde_json::json!({"page": "a.html"}), 400),
        ("edit", serde_json::json!([]), 400),
        (
            "edit",
            serde_json::json!({"page": "a.html", "hash": hash, "start": start + 1, "end": end, "text": "x"}),
            400,
        ),
        (
            "edit",
            serde_json::json!({"page": "a.html", "hash": hash, "start": 0, "end": 99999, "text": "x"}),
            400,
        ),
        (
            "edit",
            serde_json::json!({"page": "../a.html", "hash": hash, "start": start, "end": end, "text": "x"}),
            404,
        ),
        ("fix", serde_json::json!({"page": "a.html", "hash": hash, "finding": 999}), 400),
        ("accept", serde_json::json!({"page": "a.html", "hash": hash, "proposal": 0}), 409),
        ("other", serde_json::json!({"page": "a.html", "hash": hash}), 404),
    ] {
        assert_eq!(preview.post(action, &token, &ask).status, status, "{action} {ask}");
    }
    assert_eq!((preview.get("/", "").status, preview.text()), (200, LESSON.to_string()));
}

#[test]
fn an_author_edits_and_fixes_only_what_the_page_shows() {
    let preview = Preview::start();
    let (token, hash, html) = preview.page();
    assert!(html.contains("claim-none") && html.contains("unknown-key"), "{html}");
    let finding =
        html.split_once("data-finding=\"").unwrap().1.split('"').next().unwrap().parse::<usize>().unwrap();
    // The file changes: what was asked for the old text is refused, and nothing is lost.
    let other = LESSON.replace("First", "Other");
    std::fs::write(preview.lesson(), &other).unwrap();
    let fix = serde_json::json!({"page": "a.html", "hash": hash, "finding": finding});
    assert_eq!(preview.post("fix", &token, &fix).status, 409);
    assert_eq!(preview.text(), other);
    let (token, hash, html) = preview.page();
    let fix = serde_json::json!({"page": "a.html", "hash": hash, "finding": finding});
    let done = preview.post("fix", &token, &fix);
    assert_eq!((done.status, preview.text()), (200, other.replace("titel", "title")), "{}", done.body);
    assert!(html.contains("Other words"));
    // An edit keeps the line ends of the file, and every other byte.
    let (token, hash, html) = preview.page();
    let (start, end) =
        block(html.split_once("Other words").unwrap().0.rsplit_once("<section").unwrap().1, "text");
    let source = serde_json::json!({"page": "a.html", "hash": hash, "start": start, "end": end});
    assert!(preview.post("source", &token, &source).body.contains("Other words, 3.7 m."));
    let edit = serde_json::json!({"page": "a.html", "hash": hash, "start": start, "end": end, "text": "Two\nlines."});
    assert_eq!(preview.post("edit", &token, &edit).status, 200);
    assert_eq!(
        preview.text(),
        other.replace("titel", "title").replace("Other words, 3.7 m.", "Two\r\nlines.")
    );
    // The same request again is for a text that is no more.
    assert_eq!(preview.post("edit", &token, &edit).status, 409);
}

/// An editor gets the findings, completions and hover texts of its block in the lesson, at offsets of the block in UTF-16.
#[test]
fn an_open_editor_is_assisted_as_the_lesson_is_checked() {
    let preview = Preview::start();
    let (token, hash, html) = preview.page();
    let (start, end) = block(&html, "lab");
    let ask = |question: &str, text: &str, offset: usize| {
        let body = serde_json::json!({"page": "a.html", "hash": hash, "start": start, "end": end, "text": text, "offset": offset});
        let answer = preview.post(question, &token, &body);
        assert_eq!(answer.status, 200, "{question}: {}", answer.body);
        serde_json::from_str::<serde_json::Value>(&answer.body).unwrap()
    };
    let text = "```lab simlab\n{\"xml\": \"<mujoco/>\", \"title\": \"𝄞 é\", \"setup\": \"data.qposs[0] = 1\", \"titel\": 1}\n```\n";
    let units: Vec<u16> = text.encode_utf16().collect();
    let part = |from: &serde_json::Value, to: &serde_json::Value| {
        let at = |x: &serde_json::Value| x.as_u64().unwrap() as usize;
        String::from_utf16(&units[at(from)..at(to)]).unwrap()
    };
    let findings = ask("findings", text, 0);
    let found: Vec<(String, String)> = findings["findings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| (f["code"].as_str().unwrap().to_string(), part(&f["start"], &f["end"])))
        .collect();
    assert!(found.contains(&("unknown-key".into(), "titel".into())), "{found:?}");
    assert!(found.iter().any(|(_, text)| text.contains("qposs")), "{found:?}");
    let fixes = |f: &serde_json::Value| f["fixes"].as_array().unwrap().len();
    assert!(findings["findings"].as_array().unwrap().iter().any(|f| fixes(f) > 0), "{findings}");
    // Behind `data.q`.
    let place = text.encode_utf16().count() - "poss[0] = 1\", \"titel\": 1}\n```\n".encode_utf16().count();
    let offered = ask("complete", text, place);
    let labels: Vec<&str> =
        offered["completions"].as_array().unwrap().iter().map(|c| c["label"].as_str().unwrap()).collect();
    assert!(labels.contains(&"qpos"), "{labels:?}");
    let hover = ask("hover", &text.replace("qposs", "qpos"), place);
    assert!(hover["hover"]["text"].as_str().unwrap().contains("qpos"), "{hover}");
    // Offsets beyond the block, and a text that the page does not show.
    assert!(ask("hover", text, usize::MAX)["hover"].is_null());
    let body = serde_json::json!({"page": "a.html", "hash": "0", "start": start, "end": end, "text": "x"});
    assert_eq!(preview.post("findings", &token, &body).status, 409);
    let body = serde_json::json!({"page": "a.html", "hash": hash, "start": 1, "end": end, "text": "x"});
    assert_eq!(preview.post("findings", &token, &body).status, 400);
    let body = serde_json::json!({"page": "a.html", "hash": hash, "start": start, "end": end});
    assert_eq!(preview.post("findings", &token, &body).status, 400, "a request without a text");
    assert_eq!(preview.text(), LESSON);
}

#[test]
fn a_page_hears_of_every_change() {
    let preview = Preview::start();
    preview.page();
    let mut stream = TcpStream::connect(&preview.host).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    stream
        .write_all(format!("GET /_labspec/events HTTP/1.1\r\nHost: {}\r\n\r\n", preview.host).as_bytes())
        .unwrap();
    let mut lines = BufReader::new(stream).lines().map(|line| line.unwrap());
    let mut next =
        || lines.find_map(|line| line.strip_prefix("data: ").map(|n| n.parse::<u64>().unwrap())).unwrap();
    let first = next();
    std::fs::write(preview.lesson(), "# Other\n").unwrap();
    assert!(next() > first);
    assert!(preview.page().2.contains("<h1 id=\"other\">Other</h1>"));
    // A picture that the lesson names now is served, and may run nothing.
    std::fs::write(preview.lesson(), "# Other\n\n![p](p.svg)\n").unwrap();
    preview.page();
    let picture = preview.get("/files/p.svg", "");
    assert!(
        picture.status == 200 && picture.head.contains("sandbox") && picture.head.contains("image/svg+xml"),
        "{}",
        picture.head
    );
    // No lesson at all: the last pages stay, with the reason.
    std::fs::remove_file(preview.lesson()).unwrap();
    std::thread::sleep(Duration::from_millis(900));
    let html = preview.get("/a.html", "").body;
    assert!(html.contains("The last check failed"), "{html}");
    std::fs::write(preview.lesson(), "# Back\n").unwrap();
    assert!(preview.page().2.contains("Back"));
}

#[test]
fn what_pages_lack_is_on_them_and_on_the_index() {
    let preview = Preview::start();
    let models = preview.folder.path().join("course/models");
    std::fs::create_dir_all(&models).unwrap();
    std::fs::write(preview.folder.path().join("course/t.png"), "a picture").unwrap();
    let xml = "<mujoco><asset><texture name='t' type='2d' file='../t.png'/></asset></mujoco>";
    std::fs::write(models.join("tiles.xml"), xml).unwrap();
    std::fs::write(preview.lesson(), "# A\n\n```lab simlab\n{\"model\": \"tiles\"}\n```\n").unwrap();
    let problem = "the model `tiles` reads `../t.png`, which is not in its folder";
    let start = Instant::now();
    while !preview.get("/a.html", "").body.contains(problem) {
        assert!(start.elapsed() < Duration::from_secs(60), "{}", preview.get("/a.html", "").body);
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(preview.get("/", "").body.contains(problem));
}
