//! Every rule of the language: what is wrong, and why it matters. The parser, the binder and the machine say where one is broken;
//! a wrong and a right example are shown by the host, whose names they need.

pub use labspec_finding::Rule;
use labspec_finding::{Example, Layer, Severity};

/// Rules, a row each: name, severity, code, what is wrong, why it matters.
macro_rules! rules {
    ($($name:ident $severity:ident $code:literal: $summary:literal, $why:literal;)*) => {
        $(
            #[doc = $summary]
            pub const $name: &Rule = &Rule {
                code: $code,
                severity: Severity::$severity,
                layer: Layer::Program,
                summary: $summary,
                why: $why,
                bad: Example::OfHost,
                good: Example::OfHost,
            };
        )*
        /// Every rule, in the order of the stages that find them.
        pub const ALL: &[&Rule] = &[$($name),*];
    };
}

rules! {
    // Reading the text.
    TOO_LONG Error "too-long": "the source is longer than the language accepts",
        "a limit keeps a program responsive whatever it is given";
    TOO_DEEP Error "too-deep": "the expression is nested deeper than the language accepts",
        "a limit keeps a program responsive whatever it is given";
    TOO_MANY_ERRORS Error "too-many-errors": "so many mistakes that the rest was not read",
        "the first mistakes explain most of the others";
    BAD_CHARACTER Error "bad-character": "a character that has no meaning in the language",
        "JavaScript refuses the whole text";
    BAD_NUMBER Error "bad-number": "a number that is not written as the language writes numbers",
        "JavaScript refuses the whole text";
    BAD_STRING Error "bad-string": "a string that does not end, or holds a broken escape",
        "all that follows is read as part of the string";
    UNCLOSED_COMMENT Error "unclosed-comment": "a comment that does not end",
        "all that follows is read as part of the comment";
    MISSING_VALUE Error "missing-value": "a value is missing",
        "JavaScript refuses the whole text";
    MISSING_OPERATOR Error "missing-operator": "two values stand beside each other",
        "nothing between them says how they belong together: a product needs its `*`";
    MISSING_NAME Error "missing-name": "a name or a key is missing",
        "JavaScript refuses the whole text";
    MISSING_BRACKET Error "missing-bracket": "an opening bracket is missing",
        "JavaScript refuses the whole text: conditions stand in parentheses, bodies of functions in braces";
    MISSING_STATEMENT Error "missing-statement": "a condition or a loop has nothing to do",
        "JavaScript refuses the whole text";
    DECIMAL_COMMA Error "decimal-comma": "a decimal comma",
        "a comma separates things; the decimal sign is a point";
    MISPLACED Error "misplaced": "something stands where it has no place",
        "JavaScript refuses the whole text";
    UNOPENED Error "unopened": "a bracket closes nothing",
        "JavaScript refuses the whole text";
    HALF_CHOICE Error "half-choice": "a choice lacks one of its two values",
        "JavaScript refuses the whole text: a choice is written `test ? a : b`";
    DO_WITHOUT_WHILE Error "do-without-while": "a `do` loop without its `while`",
        "nothing says when it ends";
    LOOP_HEAD Error "loop-head": "the head of a `for` lacks one of its three parts",
        "JavaScript refuses the whole text: a start, a condition and a step stand there";
    LOOP_WITHOUT_CONST Error "loop-without-const": "the name of a `for … of` loop is not declared",
        "it would be a variable of all texts";
    LONE_DECLARATION Error "lone-declaration": "a declaration alone behind a condition or a loop",
        "the name would be gone at once; JavaScript refuses it";
    DECLARED_WITHOUT_VALUE Error "declared-without-value": "a `const` or a pattern gets no value",
        "a name that never changes needs its value at once";
    OUTSIDE_LOOP Error "outside-of-loop": "`break` or `continue` outside of a loop",
        "there is no loop that it could leave or go on with";
    UNCLOSED Error "unclosed": "a bracket that is not closed",
        "JavaScript refuses the whole text";
    EMPTY Error "empty": "there is nothing to evaluate",
        "a computation with it gives NaN";
    NOT_IN_LANGUAGE Error "not-in-language": "a construct of JavaScript that the language does not have, on purpose",
        "what a text computes must come to an end, touch nothing but what it is given, and give the same numbers everywhere";
    AMBIGUOUS_POWER Error "ambiguous-power": "a sign before `**`",
        "JavaScript refuses it, because it could mean either of two numbers";
    AMBIGUOUS_DEFAULT Error "ambiguous-default": "`??` beside `||` or `&&` without brackets",
        "JavaScript refuses it, because it could mean either of two things";
    // Resolving names.
    UNKNOWN_NAME Error "unknown-name": "a name that nothing defines",
        "JavaScript throws there";
    UNKNOWN_FIELD Error "unknown-field": "an object has no member of this name",
        "JavaScript gives undefined there, and a computation with it NaN";
    UNKNOWN_FUNCTION Error "unknown-function": "there is no function of this name",
        "JavaScript throws there";
    UNKNOWN_OBJECT Error "unknown-object": "there is no object of this name",
        "JavaScript throws there";
    COMPUTED_NAME Error "computed-name": "a name that is computed where a literal string must stand",
        "which object is meant could change in the run, and nobody could check it";
    NAME_TAKEN Error "name-taken": "a declaration of a name that already means something",
        "JavaScript refuses it, or the new name hides what a reader expects";
    USED_TOO_EARLY Error "used-too-early": "a local name is used before its declaration",
        "JavaScript throws there";
    NO_VALUE_HERE Error "no-value-here": "`value` is used where no control gives one",
        "there is no such name: JavaScript throws there";
    UNSET_GLOBAL Warning "unset-ctx": "a `ctx` variable is read that nothing stores",
        "it is undefined, and a computation with it gives NaN";
    // Indexes.
    INDEX_RANGE Error "index-out-of-range": "an index past the last element",
        "JavaScript gives undefined there, and a computation with it NaN";
    INDEX_NEGATIVE Error "index-negative": "an index below zero",
        "JavaScript gives undefined there: indexes count from 0, and never from the end";
    INDEX_FRACTION Error "index-not-whole": "an index that is not a whole number",
        "JavaScript gives undefined there, and a computation with it NaN";
    INDEX_KIND Error "index-not-a-number": "an index that is not a number",
        "JavaScript gives undefined there, and a computation with it NaN";
    NOT_INDEXABLE Error "not-indexable": "an index behind something that has no elements",
        "JavaScript gives undefined there, and a computation with it NaN";
    // Values and types.
    WHOLE_ARRAY Error "whole-array": "a whole array stands where one number must stand",
        "JavaScript makes a text of it, and a computation with it gives NaN";
    NOT_A_VALUE Error "not-a-value": "an object or a function stands where a value must stand",
        "JavaScript makes a text of it, and a computation with it gives NaN";
    NO_RESULT Error "no-result": "the result of a function that gives nothing back is used",
        "it is undefined, and a computation with it gives NaN";
    STRING_AS_NUMBER Warning "string-as-number": "a string stands where a number is needed",
        "JavaScript converts it silently: `\"2\" + 1` is \"21\"";
    XOR_AS_POWER Warning "xor-as-power": "`^` between numbers",
        "it is the bitwise exclusive or, and not a power: `3 ^ 2` is 1";
    CHAINED_COMPARISON Warning "chained-comparison": "two comparisons in a row",
        "the second one compares a truth value: `0 < 5 < 3` is true";
    COMPARE_NAN Warning "compare-nan": "a comparison with NaN",
        "NaN equals nothing, not even itself";
    DEGREES Warning "degrees-for-radians": "a number of degrees where radians are meant",
        "the functions of `Math`, and fields that hold angles, measure in radians";
    NOT_RANDOM Error "not-random": "a random number",
        "the same text must give the same numbers, for every reader and every check";
    // Calls.
    NOT_CALLABLE Error "not-callable": "something is called that is not a function",
        "JavaScript throws there";
    NOT_CALLED Error "not-called": "a function is named but not called",
        "nothing happens, or the text of the function is shown";
    ARGUMENT_COUNT Error "argument-count": "a function gets too few or too many arguments",
        "what is missing is undefined, what is too much is not looked at";
    ARGUMENT_TYPE Error "argument-type": "a function gets an argument of the wrong kind",
        "JavaScript throws there, or computes with what it makes of the argument";
    // Assignments and statements.
    NOT_ASSIGNABLE Error "not-assignable": "something stands left of `=` that cannot hold a value",
        "JavaScript refuses the whole text, or nothing is stored";
    ASSIGN_DERIVED Error "assign-derived": "a computed field is assigned",
        "it is computed anew, and what was stored is gone";
    ASSIGN_STRUCTURE Error "assign-structure": "a size, a type or an address is assigned",
        "it is fixed from the start: the host would read what is not there";
    ASSIGN_CONST Error "assign-const": "a name declared with `const` is assigned again",
        "JavaScript throws there";
    ASSIGN_ARRAY Error "assign-array": "a whole array is assigned instead of one element",
        "JavaScript throws there, or the field is replaced and the host never sees it";
    ASSIGN_INSIDE Error "assign-inside": "`=` inside an expression",
        "it stores; a comparison was probably meant";
    EXPRESSION_ONLY Error "expression-only": "a statement stands where only an expression is read",
        "JavaScript refuses the whole text";
    EMPTY_BODY Warning "empty-body": "a `;` directly behind the head of a condition or a loop",
        "the condition decides nothing: what follows always happens";
    UNREACHABLE Warning "never-reached": "a statement behind a `return`, a `break` or a `continue`",
        "it never happens";
    UNUSED_RESULT Warning "unused-result": "a statement that changes nothing",
        "a value is computed and thrown away";
    // While running.
    BUDGET Error "too-many-steps": "a loop or a recursion that does not come to an end",
        "whoever waits for it would wait forever";
    CALL_DEPTH Error "calls-too-deep": "functions that call each other too deeply",
        "JavaScript throws there when its stack is full";
    MEMORY Error "too-much-memory": "lists and records that take too much memory",
        "whoever waits for it would wait forever";
    NO_PARTS Error "no-parts": "a member or an element of something that has none",
        "JavaScript throws there, and stops the whole text";
    TEXT_TOO_LONG Error "text-too-long": "a string grew beyond the limit",
        "whoever waits for it would wait forever";
    HOST_CALL Error "call-failed": "a function of the host failed",
        "JavaScript throws there, and stops the whole text";
    HOST_STORE Error "store-failed": "the host refused to store a value",
        "nothing is stored, and nobody is told";
    STORE_PAST_END Error "store-past-end": "an element past the end was assigned",
        "nothing is stored, and nobody is told";
}

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn codes_are_unique_and_in_words() {
        for (i, rule) in ALL.iter().enumerate() {
            assert!(rule.code.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{}", rule.code);
            assert!(!rule.summary.ends_with('.') && !rule.why.ends_with('.'), "{}", rule.code);
            assert!(ALL[..i].iter().all(|other| other.code != rule.code), "{} twice", rule.code);
        }
    }
}
