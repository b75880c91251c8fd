//! Which requests are answered. The server listens on this machine only, but pages of other sites, which the same browser has open,
//! can send requests to it: a request must name this address (a name of another site may lead here), come from a page of this
//! address, and carry the token of the page where it changes something.

use super::http::{Refusal, RequestHead};
use crate::page::POLICY;

/// The prefix of addresses that are not files of the site.
pub(super) const ACTIONS: &str = "/_labspec/";
/// The header with the token.
const TOKEN: &str = "x-labspec-token";

/// What the server knows of itself.
#[derive(Debug)]
pub(super) struct ServerIdentity {
    /// `127.0.0.1:8000`.
    pub(super) host: String,
    /// What a page proves that it was served from here.
    pub(super) token: String,
}

impl ServerIdentity {
    /// An identity with a new token.
    ///
    /// # Errors
    /// The system has no random numbers.
    pub(super) fn new(port: u16) -> Result<ServerIdentity, String> {
        let mut bytes = [0; 24];
        getrandom::fill(&mut bytes)
            .map_err(|e| format!("no random numbers for the token of the page: {e}"))?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(ServerIdentity { host: format!("127.0.0.1:{port}"), token })
    }

    /// Tests a request before anything else is done with it.
    pub(super) fn check(&self, request: &RequestHead) -> Result<(), Refusal> {
        if request.headers("host") != [self.host.as_str()] {
            return refuse(
                403,
                "the request names another host; open the address that the preview has printed",
            );
        }
        let origin_of_page = format!("http://{}", self.host);
        if request.headers("origin").iter().any(|origin| *origin != origin_of_page) {
            return refuse(403, "the request comes from another page");
        }
        match request.method.as_str() {
            "GET" | "HEAD" => Ok(()),
            "POST" if request.target.starts_with(ACTIONS) => {
                let has_token = matches!(request.headers(TOKEN)[..], [token] if is_same(token, &self.token));
                match has_token && request.headers("origin") == [origin_of_page.as_str()] {
                    true => Ok(()),
                    false => {
                        refuse(403, "the request does not have the token of the page; load the page again")
                    }
                }
            }
            _ => refuse(405, "the preview answers GET and HEAD"),
        }
    }
}

fn refuse(status: u16, why: &str) -> Result<(), Refusal> {
    Err((status, why.to_string()))
}

/// Compares two texts in a time that does not depend on where they differ.
fn is_same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

/// The headers of every answer. A file of the course is shown, but runs nothing.
pub(super) fn headers(kind: &str, is_copied: bool) -> Vec<(&'static str, String)> {
    let policy = match is_copied {
        true => "default-src 'none'; style-src 'unsafe-inline'; sandbox".to_string(),
        false => format!("{POLICY}; frame-ancestors 'none'"),
    };
    vec![
        ("Content-Type", kind.to_string()),
        ("Content-Security-Policy", policy),
        ("X-Content-Type-Options", "nosniff".into()),
        ("X-Frame-Options", "DENY".into()),
        ("Referrer-Policy", "no-referrer".into()),
        ("Cross-Origin-Resource-Policy", "same-origin".into()),
        ("Cross-Origin-Opener-Policy", "same-origin".into()),
        ("Cache-Control", "no-store".into()),
    ]
}
