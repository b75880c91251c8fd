//! Tests of the ledger.

use super::*;

fn entry(subject: Subject, state: State) -> Entry {
    Entry {
        subject,
        owner: String::new(),
        path: Arc::from("a.md"),
        span: 0..0,
        state,
        word: "",
        what: String::new(),
        remark: String::new(),
    }
}

#[test]
fn the_outcome_is_that_of_the_worst_claim() {
    let outcome = |states: &[(Subject, State)]| {
        let mut ledger = Ledger::default();
        states.iter().for_each(|&(subject, state)| ledger.add(entry(subject, state)));
        ledger.outcome()
    };
    let file = (Subject::File, State::True(Evidence::Computed));
    let answer = |state| (Subject::Answer, state);
    assert_eq!(outcome(&[]), Outcome::Nothing);
    assert_eq!(outcome(&[file]), Outcome::Nothing);
    assert_eq!(outcome(&[file, (Subject::Widget, State::NotClaimed)]), Outcome::Nothing);
    assert_eq!(outcome(&[file, (Subject::Widget, State::Skipped)]), Outcome::Partial);
    assert_eq!(outcome(&[file, (Subject::Widget, State::True(Evidence::Computed))]), Outcome::Clean);
    assert_eq!(outcome(&[file, answer(State::NotClaimed)]), Outcome::Clean);
    assert_eq!(outcome(&[file, answer(State::True(Evidence::Simulated))]), Outcome::Clean);
    assert_eq!(outcome(&[file, answer(State::Unchecked)]), Outcome::Findings);
    assert_eq!(outcome(&[(Subject::File, State::Unchecked)]), Outcome::Findings);
    let left = answer(State::Skipped);
    assert_eq!(outcome(&[file, left, answer(State::True(Evidence::Simulated))]), Outcome::Partial);
    assert_eq!(outcome(&[left, answer(State::Unchecked)]), Outcome::Findings);
    assert_eq!(outcome(&[answer(State::True(Evidence::Simulated)), answer(State::False)]), Outcome::Findings);
}

/// Every combination of counts has a correct sentence: it names all existing states and no others.
#[test]
fn the_conclusion_is_true_of_every_combination() {
    let states = [
        (State::False, "is false", "are false"),
        (State::Unchecked, "1 claim could not be checked", "2 claims could not be checked"),
        (State::Skipped, "not everything was", "not everything was"),
        (State::Baselined, "the baseline", "the baseline"),
    ];
    for code in 0..3usize.pow(5) {
        let count = |digit: u32| code / 3usize.pow(digit) % 3;
        let mut ledger = Ledger::default();
        for (&(state, ..), digit) in states.iter().zip(0..) {
            (0..count(digit)).for_each(|_| ledger.add(entry(Subject::Answer, state)));
        }
        let good = State::True(Evidence::Simulated);
        (0..count(4)).for_each(|_| ledger.add(entry(Subject::Quote, good)));
        let message = ledger.conclusion("");
        for (&(_, one, more), digit) in states.iter().zip(0..) {
            assert_eq!(
                message.contains(one),
                count(digit) == 1 || one == more && count(digit) > 0,
                "{message}"
            );
            assert_eq!(
                message.contains(more),
                count(digit) == 2 || one == more && count(digit) > 0,
                "{message}"
            );
        }
        let bad = count(0) + count(1) > 0;
        assert_eq!(message.contains("the checked part has no problems"), !bad && count(2) > 0, "{message}");
        let clean = (0..4).all(|digit| count(digit) == 0);
        assert_eq!(message == "no problems found", clean && count(4) > 0, "{message}");
        assert_eq!(message == "nothing to check", code == 0, "{message}");
        assert_eq!(ledger.outcome() == Outcome::Findings, bad, "{message}");
    }
    let mut ledger = Ledger::default();
    ledger.add(entry(Subject::File, State::False));
    assert_eq!(ledger.conclusion(""), "a file has problems");
    assert_eq!(ledger.conclusion("1 warning"), "1 warning");
    ledger.add(entry(Subject::Answer, State::False));
    ledger.add(entry(Subject::Answer, State::Unchecked));
    ledger.add(entry(Subject::Widget, State::Skipped));
    let both =
        "1 claim is false, 1 claim could not be checked, 2 errors, 1 warning, not everything was checked";
    assert_eq!(ledger.conclusion("2 errors, 1 warning"), both);
    let mut ledger = Ledger::default();
    ledger.add(entry(Subject::Lab, State::True(Evidence::Simulated)));
    assert_eq!(ledger.conclusion("1 note"), "no problems found, 1 note");
}

#[test]
fn the_summary_distinguishes_simulated_claims() {
    let mut ledger = Ledger::default();
    for state in [
        State::True(Evidence::Simulated),
        State::True(Evidence::Simulated),
        State::True(Evidence::Computed),
        State::False,
        State::Unchecked,
        State::Skipped,
        State::NotClaimed,
    ] {
        ledger.add(entry(Subject::Answer, state));
    }
    assert_eq!(
        ledger.summary(),
        "2 answers verified, 1 answer computed, 1 answer wrong, 1 answer could not be checked, 1 answer without a check, \
         1 answer left out"
    );
}
