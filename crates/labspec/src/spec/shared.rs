//! `verify` objects that use the runs and the measures of another one: `"use": "#1"`.

use super::verify::VerifyLab;
use super::{LabAddress, Lesson, Verify};
use crate::source::Text;

/// Longest chain of objects that use each other.
const LONGEST: usize = 8;

impl Lesson {
    /// A `verify` object with all that it uses of others.
    pub fn whole<'a>(&'a self, verify: &'a Verify) -> &'a Verify {
        match verify.uses {
            Some(_) => self.wholes.iter().find(|w| w.span == verify.span).unwrap_or(verify),
            None => verify,
        }
    }

    /// The `verify` object of a lab, or of the question at this place.
    pub fn verify_at(&self, address: &LabAddress) -> Option<&Verify> {
        match address {
            LabAddress::Lab(_) => self.lab(address)?.verify.as_ref(),
            LabAddress::Sim { quiz, question } => {
                let quiz = self.quizzes.iter().find(|q| q.id.as_ref().is_some_and(|id| id.value == *quiz))?;
                quiz.questions.get(question.checked_sub(1)?)?.as_ref()?.verify.as_ref()
            }
        }
    }
}

/// Every object that uses others, with what it uses.
pub(super) fn wholes(lesson: &Lesson) -> Vec<Verify> {
    lesson.verifies().filter(|v| v.uses.is_some()).map(|v| whole(lesson, v, LONGEST)).collect()
}

/// What an object names itself comes before what it uses.
fn whole(lesson: &Lesson, verify: &Verify, depth: usize) -> Verify {
    let mut all = verify.clone();
    let Some((text, address)) = &verify.uses else { return all };
    let Some(used) = lesson.verify_at(address).filter(|used| used.span != verify.span && depth > 0) else {
        return all;
    };
    let used = whole(lesson, used, depth - 1);
    let own = lesson.lab(address).map(|_| VerifyLab::Reference(text.clone(), address.clone()));
    all.lab = all.lab.or(used.lab).or(own);
    add(&mut all.runs, used.runs, |run| &run.name);
    add(&mut all.measure, used.measure, |(name, _)| name);
    add(&mut all.find, used.find, |find| &find.name);
    all
}

/// Puts what is used before what is there, but for what is there by its name.
fn add<T: Clone>(own: &mut Vec<T>, used: Vec<T>, name: impl Fn(&T) -> &Text) {
    let there = |one: &T| own.iter().any(|o| name(o).value == name(one).value);
    let mut all: Vec<T> = used.into_iter().filter(|one| !there(one)).collect();
    all.append(own);
    *own = all;
}
