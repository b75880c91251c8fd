//! The address of a lab in a lesson: `#2`, `#quiz-id.1`.

use serde::{Deserialize, Serialize};

/// The address of a lab within a lesson, written `#2` or `#quiz-id.1`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LabAddress {
    /// The index of a lab, from 1.
    Lab(usize),
    /// The `sim` of a question.
    Sim {
        /// Id of the quiz.
        quiz: String,
        /// Number of the question, from 1.
        question: usize,
    },
}

impl LabAddress {
    /// Parses `#2` or `#quiz-id.1`; ids may contain dots. `None` for other texts.
    pub fn parse(text: &str) -> Option<LabAddress> {
        let name = text.strip_prefix('#')?;
        let number = |digits: &str| digits.parse::<usize>().ok().filter(|&n| n > 0 && digits.len() < 8);
        if let Some(n) = number(name) {
            return Some(LabAddress::Lab(n));
        }
        let (quiz, question) = name.rsplit_once('.')?;
        Some(LabAddress::Sim { quiz: quiz.to_string(), question: number(question)? })
            .filter(|_| !quiz.is_empty())
    }
}

impl std::fmt::Display for LabAddress {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LabAddress::Lab(n) => write!(f, "#{n}"),
            LabAddress::Sim { quiz, question } => write!(f, "#{quiz}.{question}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_read_what_they_print() {
        for (text, address) in [
            ("#2", Some(LabAddress::Lab(2))),
            ("#0.1-predict.2", Some(LabAddress::Sim { quiz: "0.1-predict".into(), question: 2 })),
            ("#0", None),
            ("2", None),
            ("#quiz", None),
            ("#.1", None),
            ("#quiz.0", None),
            ("#99999999999999999999", None),
        ] {
            assert_eq!(LabAddress::parse(text), address, "{text}");
            if let Some(address) = address {
                assert_eq!(address.to_string(), text);
            }
        }
    }
}
