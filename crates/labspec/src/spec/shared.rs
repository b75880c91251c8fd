//! `verify` objects that use the runs and the measures of another one, `"use": "#1"`, or of a definition, `"use": "falls"`.

use super::address::LabAddress;
use super::lab::{UsedObject, Verify, VerifyLab};
use super::lesson::Lesson;
use crate::source::Text;
use labspec_finding::order;

/// The maximum length of a chain of objects that use each other.
const LONGEST: usize = 8;
/// The maximum total size of the used objects, in bytes. An object that is used several times counts each time.
const MOST: usize = 8 << 20;

impl Lesson {
    /// A `verify` object, merged with the objects that it uses.
    pub fn whole<'a>(&'a self, verify: &'a Verify) -> &'a Verify {
        match verify.uses {
            Some(_) => {
                let index = self.wholes.binary_search_by_key(&verify.span.start, |w| w.span.start);
                index.ok().and_then(|index| self.wholes.get(index)).unwrap_or(verify)
            }
            None => verify,
        }
    }

    /// The chain of objects that a `verify` object uses.
    pub fn used_by<'a>(&'a self, verify: &'a Verify) -> impl Iterator<Item = &'a Verify> {
        let next = |verify: &&'a Verify| self.used_object(&verify.uses.as_ref()?.1);
        std::iter::successors(next(&verify), next).take(LONGEST)
    }

    /// The object that another one uses.
    pub fn used_object(&self, used: &UsedObject) -> Option<&Verify> {
        match used {
            UsedObject::Owner(address) => self.verify_at(address),
            UsedObject::Defined(name) => {
                self.definitions.iter().find(|one| one.name == *name).map(|one| &one.verify)
            }
        }
    }

    /// The `verify` object of the lab, or of the question, with this address.
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

/// All objects with a `use`, merged with the objects that they use, up to the maximum size.
pub(super) fn resolve_uses(lesson: &Lesson) -> Vec<Verify> {
    let mut left = MOST;
    let users = lesson.verifies().filter(|v| v.uses.is_some());
    let mut all: Vec<Verify> = users.map_while(|v| whole(lesson, v, LONGEST, &mut left)).collect();
    all.sort_by_key(|verify| verify.span.start);
    all
}

/// The definitions of the object itself take precedence over those of the used object. `None` if the maximum size is
/// exceeded.
fn whole(lesson: &Lesson, verify: &Verify, depth: usize, left: &mut usize) -> Option<Verify> {
    *left = left.checked_sub(verify.span.len())?;
    let mut all = verify.clone();
    let Some((text, named)) = &verify.uses else { return Some(all) };
    let Some(used) = lesson.used_object(named).filter(|used| used.span != verify.span && depth > 0) else {
        return Some(all);
    };
    let used = whole(lesson, used, depth - 1, left)?;
    let reference = match named {
        UsedObject::Owner(address) => {
            lesson.lab(address).map(|_| VerifyLab::Reference(text.clone(), address.clone()))
        }
        UsedObject::Defined(_) => None,
    };
    all.lab = all.lab.or(used.lab).or(reference);
    add(&mut all.runs, used.runs, |run| &run.name);
    add(&mut all.measure, used.measure, |(name, _)| name);
    add(&mut all.find, used.find, |find| &find.name);
    Some(all)
}

/// Puts the used entries before the own entries, except those with the name of an own entry.
fn add<T>(entries: &mut Vec<T>, used: Vec<T>, name: impl Fn(&T) -> &Text) {
    let there = order::set(entries.iter().map(|one| name(one).value.clone()));
    let mut all: Vec<T> = used.into_iter().filter(|one| !there.contains(&name(one).value)).collect();
    all.append(entries);
    *entries = all;
}
