//! The loop: a message in, what it asks for out. All state belongs to this thread; runs go on beside it.

use super::state::{Course, Event, Phase, ServerState};
use super::wire::{self, Incoming};
use super::{notifications, requests};
use crate::threads;
use lsp_server::{ErrorCode, Message, ResponseError};
use lsp_types::notification::{Exit, Notification};
use serde::Serialize;
use std::io::{self, BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, channel};

/// The answer to what cannot be read: nobody knows the id of its request.
#[derive(Debug, Serialize)]
struct Unidentified {
    id: (),
    error: ResponseError,
}

/// Serves an editor until it says `exit`, or says nothing more. `true` when it did so by the protocol.
///
/// # Errors
/// The answers cannot be written.
pub fn serve<'c>(
    course: Course<'c>,
    mut input: impl BufRead + Send + 'static,
    output: &'c mut dyn Write,
) -> io::Result<bool> {
    let (sender, events) = channel();
    let incoming = sender.clone();
    // It ends with the input, or with the program.
    threads::checking().spawn(move || {
        loop {
            let read = wire::read(&mut input).unwrap_or(Incoming::End);
            let last = matches!(read, Incoming::End);
            if incoming.send(Event::Incoming(read)).is_err() || last {
                return;
            }
        }
    })?;
    run(&mut ServerState::new(course, output, sender), &events)
}

fn run(state: &mut ServerState<'_>, events: &Receiver<Event>) -> io::Result<bool> {
    loop {
        // What waits is done first: of many changes that follow each other only the last is checked.
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
            Event::Finished(outcome) => state.finish_runs(outcome)?,
            Event::Incoming(Incoming::End) => return Ok(state.phase == Phase::ShutDown),
            Event::Incoming(Incoming::Bad(message)) => {
                let error = ResponseError { code: ErrorCode::ParseError as i32, message, data: None };
                state.send(&Unidentified { id: (), error })?;
            }
            Event::Incoming(Incoming::Message(Message::Request(request))) => {
                let response = requests::answer(state, request);
                state.send(&response)?;
            }
            Event::Incoming(Incoming::Message(Message::Notification(n))) if n.method == Exit::METHOD => {
                return Ok(state.phase == Phase::ShutDown);
            }
            Event::Incoming(Incoming::Message(Message::Notification(n))) => {
                // What is before or behind the conversation is dropped, as the protocol asks.
                if state.phase == Phase::Running {
                    let handled = catch_unwind(AssertUnwindSafe(|| notifications::handle(state, n)));
                    handled.unwrap_or(Ok(()))?;
                }
            }
            // This server sends no requests.
            Event::Incoming(Incoming::Message(Message::Response(_))) => {}
        }
    }
}
