//! Claims for numbers of the text, found by `trace` on a separate thread. A proposal is applied only if its claim holds.

use labspec::bind::scene::Models;
use labspec::interrupt;
use labspec::lint::reload_lesson;
use labspec::source::Sources;
use labspec::spec::Lesson;
use labspec::threads;
use labspec::verify::{QuoteState, Stated};
use labspec_assist::fixes::{comment_place, line_end};
use labspec_assist::{DocumentText, Edit, check_claims_of};
use labspec_proposals::trace::{Origin, ProposedVerify, Traces, comments_of, format_verify, trace};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The result for a version of a document.
#[derive(Debug)]
pub(super) struct FinishedProof {
    /// The number of the job.
    pub(super) job: u64,
    pub(super) uri: String,
    pub(super) version: i32,
    /// The edit that adds the claims, or why there is none.
    pub(super) found: Result<Edit, String>,
}

/// A search in progress.
#[derive(Debug)]
pub(super) struct RunningProof {
    /// A consecutive number, assigned by the caller.
    pub(super) number: u64,
    pub(super) uri: String,
    stop: Arc<AtomicBool>,
}

/// The text in which claims are searched, and its numbers.
pub(super) struct ProofRequest {
    pub(super) job: u64,
    pub(super) uri: String,
    pub(super) version: i32,
    pub(super) text: DocumentText,
    pub(super) numbers: Vec<Range<usize>>,
}

impl RunningProof {
    /// Starts a search. `done` is called at its end, unless it was cancelled.
    pub(super) fn start(
        request: ProofRequest,
        (models, sources): (Arc<Models>, Sources),
        done: impl FnOnce(FinishedProof) + Send + 'static,
    ) -> Option<RunningProof> {
        let stop = Arc::new(AtomicBool::new(false));
        let (number, uri, asked) = (request.job, request.uri.clone(), stop.clone());
        let work = move || {
            let ProofRequest { job, uri, version, text, numbers } = request;
            let search = || {
                let lesson = text.load(&sources, models.folder());
                prove(&lesson, &models, &numbers)
            };
            let found = threads::catch_panic(|| interrupt::until(asked.clone(), search));
            let found = found.unwrap_or_else(|_| Err("the search failed; please report this lesson".into()));
            if !asked.load(Ordering::Relaxed) {
                done(FinishedProof { job, uri, version, found });
            }
        };
        threads::checking().spawn(work).ok()?;
        Some(RunningProof { number, uri, stop })
    }

    /// Cancels the search.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// The comments that claim numbers of a lesson, before the block that contains them.
///
/// # Errors
/// A sentence for the author: `trace` finds no origin, or the proposed claim does not hold.
fn prove(lesson: &Lesson, models: &Models, numbers: &[Range<usize>]) -> Result<Edit, String> {
    let found = trace(lesson, models, &mut |_| {});
    let is_chosen = |s: &Stated| numbers.contains(&s.span);
    let proposals = comments_of(&found, &is_chosen);
    let place = numbers.first().and_then(|span| comment_place(lesson, span.start));
    let (Some(offset), false) = (place, proposals.is_empty()) else {
        return Err(describe_origins(&found, numbers));
    };
    let text: String = proposals.iter().map(|verify| comment(lesson, verify)).collect();
    let edit = Edit { span: offset..offset, text };
    check_edit(lesson, models, &edit)?;
    Ok(edit)
}

/// A comment with a claim. JSON in the text of a comment must not end it.
fn comment(lesson: &Lesson, verify: &ProposedVerify) -> String {
    let end = line_end(&lesson.file);
    let json = format_verify(verify).replace("-->", "--\\u003e").replace('\n', end);
    format!("<!-- labspec verify {json} -->{end}")
}

/// Checks the new claims with their runs.
fn check_edit(lesson: &Lesson, models: &Models, edit: &Edit) -> Result<(), String> {
    let mut text = lesson.file.text().to_string();
    text.insert_str(edit.span.start, &edit.text);
    let new = reload_lesson(lesson, &text, models.folder());
    let inserted = edit.span.start..edit.span.start + edit.text.len();
    let claim_comments =
        new.claim_comments.iter().filter(|r| inserted.start <= r.span.start && r.span.end <= inserted.end);
    let mut quotes = Vec::new();
    for comment in claim_comments {
        let claims = check_claims_of(&new, &comment.span, models);
        quotes.extend(claims.into_iter().flat_map(|claim| claim.judgement.quotes));
    }
    match quotes.iter().find(|quote| quote.state != QuoteState::Right) {
        Some(quote) => Err(format!("the proposed claim of {} does not hold: {}", quote.text, quote.reason)),
        None if quotes.is_empty() => Err("the proposed claim cannot be checked".to_string()),
        None => Ok(()),
    }
}

/// Why numbers have no proposal.
fn describe_origins(found: &Traces<'_>, numbers: &[Range<usize>]) -> String {
    let here = found.numbers.iter().filter(|n| numbers.contains(&n.stated.span));
    let reasons = here.map(|n| {
        let quote = &n.stated.quote;
        match &n.origin {
            Origin::Setting(words) => format!("{quote} is a setting: {words}"),
            Origin::Unsteady(_) => format!("{quote} changes if the start moves slightly"),
            Origin::Chance(_) => format!("{quote} may be equal to a measure by chance"),
            Origin::Claimed => format!("{quote} has a claim"),
            Origin::Listed(line) => format!("{quote} is printed by a listing, in line {line}"),
            Origin::From(hit) if hit.fragile => {
                format!("{quote} has other digits at half the timestep: state the timestep beside it")
            }
            Origin::From(_) | Origin::Unknown => format!("no run of a lab gives {quote}"),
        }
    });
    let reasons: Vec<String> = reasons.collect();
    if reasons.is_empty() { "the number is not found".to_string() } else { reasons.join("; ") }
}
