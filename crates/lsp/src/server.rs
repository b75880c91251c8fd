//! The main loop: receives messages and handles them. All state belongs to this thread; runs are performed on another one.

use super::state::{CourseConfig, Phase, ServerEvent, ServerState};
use super::wire::{self, Incoming};
use super::{notifications, requests};
use labspec::threads;
use lsp_server::{ErrorCode, Message, ResponseError};
use lsp_types::notification::{Exit, Notification};
use serde::Serialize;
use std::io::{self, BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, channel};

/// The response to an invalid message: the id of its request is unknown.
#[derive(Debug, Serialize)]
struct Unidentified {
    id: (),
    error: ResponseError,
}

/// Serves an editor until it sends `exit`, or the input ends. Returns `true` if the session ended according to the protocol.
///
/// # Errors
/// The responses cannot be written.
pub fn serve<'c>(
    course: CourseConfig<'c>,
    mut input: impl BufRead + Send + 'static,
    output: &'c mut dyn Write,
) -> io::Result<bool> {
    let (sender, events) = channel();
    let incoming = sender.clone();
    // The thread ends with the input, or with the program.
    threads::checking().spawn(move || {
        loop {
            let read = wire::read(&mut input).unwrap_or(Incoming::End);
            let last = matches!(read, Incoming::End);
            if incoming.send(ServerEvent::Incoming(read)).is_err() || last {
                return;
            }
        }
    })?;
    run(&mut ServerState::new(course, output, sender), &events)
}

fn run(state: &mut ServerState<'_>, events: &Receiver<ServerEvent>) -> io::Result<bool> {
    loop {
        // Pending messages are handled first, so that only the last of several consecutive changes is checked.
        let event = match events.try_recv() {
            Ok(event) => event,
            Err(_) => {
                state.check_documents()?;
                match events.recv() {
                    Ok(event) => event,
                    Err(_) => return Ok(false),
                }
            }
        };
        match event {
            ServerEvent::Finished(job) => state.finish_runs(job)?,
            ServerEvent::Proved(proof) => state.finish_proof(proof)?,
            ServerEvent::Incoming(Incoming::End) => return Ok(state.phase == Phase::ShutDown),
            ServerEvent::Incoming(Incoming::Bad(message)) => {
                let error = ResponseError { code: ErrorCode::ParseError as i32, message, data: None };
                state.send(&Unidentified { id: (), error })?;
            }
            ServerEvent::Incoming(Incoming::Message(Message::Request(request))) => {
                let response = requests::answer(state, request);
                state.send(&response)?;
            }
            ServerEvent::Incoming(Incoming::Message(Message::Notification(n)))
                if n.method == Exit::METHOD =>
            {
                return Ok(state.phase == Phase::ShutDown);
            }
            ServerEvent::Incoming(Incoming::Message(Message::Notification(n))) => {
                // Notifications before initialization or after shutdown are dropped, as the protocol requires.
                if state.phase == Phase::Running {
                    let handled = catch_unwind(AssertUnwindSafe(|| notifications::handle(state, n)));
                    handled.unwrap_or(Ok(()))?;
                }
            }
            // Nothing depends on the responses of the editor.
            ServerEvent::Incoming(Incoming::Message(Message::Response(_))) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::ModelFolder;
    use labspec::spec::Conventions;
    use serde_json::{Value, json};

    /// The responses of the server to requests, in order, and whether the session ended according to the protocol.
    fn answers(requests: &[(&str, Value)]) -> (Vec<Value>, bool) {
        let mut input = Vec::new();
        for (id, (method, params)) in requests.iter().enumerate() {
            let mut message = json!({"id": id, "method": method, "params": params});
            // A notification has no id.
            if method.contains("/did") {
                message.as_object_mut().unwrap().remove("id");
            }
            wire::write(&mut input, &message).unwrap();
        }
        wire::write(&mut input, &json!({"method": "exit"})).unwrap();
        let (models, mut policy) = (|_: &_| ModelFolder::unknown(), |_: &_, _: &mut _| {});
        let course = CourseConfig {
            models: &models,
            policy: &mut policy,
            conventions: &|_| Conventions::default(),
            refresh: &|| {},
        };
        let mut output = Vec::new();
        let ended = serve(course, io::Cursor::new(input), &mut output).unwrap();
        let bodies = String::from_utf8(output).unwrap();
        let bodies = bodies.split("Content-Length: ").filter_map(|message| message.split_once("\r\n\r\n"));
        (bodies.map(|(_, body)| serde_json::from_str(body).unwrap()).collect(), ended)
    }

    #[test]
    fn invalid_parameters_are_answered_with_a_sentence() {
        let position = json!({"line": 0, "character": 0});
        let (hover, rename) = ("textDocument/hover", "textDocument/rename");
        let about = |uri: &str| json!({"textDocument": {"uri": uri}, "position": position});
        let cases = [
            ("initialize", json!(null), "the parameters of `initialize` are invalid"),
            ("initialize", json!({"rootUri": "file:///%zz"}), "the parameters of `initialize` are invalid"),
            ("initialize", json!({}), ""),
            (hover, json!(null), "the parameters of `textDocument/hover` are invalid"),
            (hover, json!({}), "missing field `textDocument`"),
            (hover, about("not a URI"), "this document is not open"),
            (hover, about("file:///%zz"), "the parameters of `textDocument/hover` are invalid"),
            (hover, about("file:///a.md"), "this document is not open"),
            (rename, about("file:///a.md"), "missing field `newName`"),
            ("textDocument/references", about("untitled:1"), "this document is not open"),
            ("textDocument/inlayHint", about("untitled:1"), "missing field `range`"),
            ("shutdown", json!({"ignored": 1}), ""),
        ];
        let requests = cases.clone().map(|(method, params, _)| (method, params));
        let (answers, ended) = answers(&requests);
        assert!(ended);
        assert_eq!(answers.len(), cases.len());
        for ((method, params, why), answer) in cases.iter().zip(&answers) {
            assert_eq!(answer["jsonrpc"], "2.0");
            match answer.get("error") {
                None => {
                    assert!(why.is_empty() && answer.get("result").is_some(), "{method} {params}: {answer}")
                }
                Some(error) => {
                    assert_eq!(error["code"], ErrorCode::InvalidParams as i32, "{method} {params}");
                    let message = error["message"].as_str().unwrap();
                    assert!(!why.is_empty() && message.contains(why), "{method} {params}: {message}");
                }
            }
        }
    }

    #[test]
    fn paths_as_they_are_and_changes_that_cannot_be_read() {
        let uri = "file:///no where/ä [1].md";
        let about = json!({"textDocument": {"uri": uri}, "position": {"line": 0, "character": 0}});
        let opened = json!({"uri": uri, "languageId": "markdown", "version": 1, "text": "# A"});
        let changes = json!([{"text": "# B"}, {"text": 3}]);
        let (found, ended) = answers(&[
            ("initialize", json!({"rootUri": "file:///no where", "initializationOptions": {"runOnSave": 1}})),
            ("textDocument/didOpen", json!({"textDocument": opened})),
            ("textDocument/hover", about.clone()),
            (
                "textDocument/didChange",
                json!({"textDocument": {"uri": uri, "version": 2}, "contentChanges": changes}),
            ),
            ("textDocument/hover", about),
            ("textDocument/didSave", json!({"textDocument": {}})),
            ("workspace/didChangeConfiguration", json!({"settings": {"labspec": {"runOnSave": "no"}}})),
            ("shutdown", json!(null)),
        ]);
        assert!(ended);
        let logged = found.iter().filter(|message| message["method"] == "window/logMessage");
        let logged: Vec<&str> =
            logged.map(|message| message["params"]["message"].as_str().unwrap()).collect();
        let expected = [
            "settings of labspec are invalid",
            "cannot be read",
            "missing field `uri`",
            "settings of labspec",
        ];
        assert_eq!(logged.len(), expected.len(), "{logged:?}");
        assert!(logged.iter().zip(expected).all(|(text, part)| text.contains(part)), "{logged:?}");
        let answer = |id: usize| found.iter().find(|message| message["id"] == id).unwrap();
        assert!(answer(0).get("result").is_some() && answer(2).get("result").is_some(), "{found:?}");
        assert_eq!(answer(4)["error"]["message"], "this document is not open");
    }
}
