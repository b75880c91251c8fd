//! The stable names of all findings, each with what it says. Reports, filters and documentation use these.

macro_rules! codes {
    ($($name:ident = $code:literal, $doc:literal;)*) => {
        $(#[doc = $doc] pub const $name: &str = $code;)*
        /// Every code with its meaning, in the order of the stages that find them.
        pub const ALL: &[(&str, &str)] = &[$(($code, $doc)),*];
    };
}

codes! {
    // Reading the text.
    TOO_LONG = "too-long", "The source is longer than the language accepts.";
    TOO_DEEP = "too-deep", "The expression is nested deeper than the language accepts.";
    TOO_MANY_ERRORS = "too-many-errors", "So many mistakes that the rest was not read.";
    BAD_CHARACTER = "bad-character", "A character that has no meaning in the language.";
    BAD_NUMBER = "bad-number", "A number that is not written as the language writes numbers.";
    BAD_STRING = "bad-string", "A string that does not end, or holds a broken escape.";
    UNCLOSED_COMMENT = "unclosed-comment", "A comment that does not end.";
    UNEXPECTED = "unexpected", "Something stands where something else must stand.";
    UNCLOSED = "unclosed", "A bracket that is not closed.";
    EMPTY = "empty", "There is nothing to evaluate.";
    NOT_IN_LANGUAGE = "not-in-language", "A construct of JavaScript that lessons do not have, on purpose.";
    NOT_SUPPORTED = "not-supported-yet", "A construct of JavaScript that is not supported yet.";
    AMBIGUOUS_POWER = "ambiguous-power", "A sign before `**`: JavaScript refuses it as ambiguous.";

    AMBIGUOUS_DEFAULT = "ambiguous-default", "`??` beside `||` or `&&`: JavaScript refuses it as ambiguous.";

    // Resolving names.
    UNKNOWN_NAME = "unknown-name", "A name that nothing defines.";
    UNKNOWN_FIELD = "unknown-field", "An object has no member of this name.";
    UNKNOWN_FUNCTION = "unknown-function", "There is no function of this name.";
    UNKNOWN_OBJECT = "unknown-object", "The model has no object of this name.";
    COMPUTED_NAME = "computed-name", "A name that is computed where a literal string must stand.";
    NAME_TAKEN = "name-taken", "A declaration of a name that already means something.";
    USED_TOO_EARLY = "used-too-early", "A local name is used before its declaration.";
    NO_VALUE_HERE = "no-value-here", "`value` is used where no control gives one.";
    UNSET_GLOBAL = "unset-ctx", "A `ctx` variable is read that nothing stores.";

    // Indexes.
    INDEX_RANGE = "index-out-of-range", "An index past the last element.";
    INDEX_NEGATIVE = "index-negative", "An index below zero.";
    INDEX_FRACTION = "index-not-whole", "An index that is not a whole number.";
    INDEX_KIND = "index-not-a-number", "An index that is not a number.";
    NOT_INDEXABLE = "not-indexable", "An index behind something that has no elements.";

    // Values and types.
    WHOLE_ARRAY = "whole-array", "A whole array stands where one number must stand.";
    NOT_A_VALUE = "not-a-value", "An object or a function stands where a value must stand.";
    NO_RESULT = "no-result", "The result of a function that gives nothing back is used.";
    STRING_AS_NUMBER = "string-as-number", "A string stands where a number is needed.";
    XOR_AS_POWER = "xor-as-power", "`^` between numbers: it is the bitwise exclusive or, not a power.";
    CHAINED_COMPARISON = "chained-comparison", "`a < b < c`: the second comparison gets a truth value.";
    COMPARE_NAN = "compare-nan", "A comparison with NaN, which is never equal to anything.";
    QUATERNION_AS_ANGLE = "quaternion-as-angle", "A component of a quaternion is used as if it were an angle.";
    DEGREES = "degrees-for-radians", "A number of degrees where radians are meant.";
    NOT_RANDOM = "not-random", "A random number: the same lesson must give the same numbers.";

    // Calls.
    NOT_CALLABLE = "not-callable", "Something is called that is not a function.";
    NOT_CALLED = "not-called", "A function is named but not called.";
    ARGUMENT_COUNT = "argument-count", "A function gets too few or too many arguments.";
    ARGUMENT_TYPE = "argument-type", "A function gets an argument of the wrong kind.";

    // Assignments and statements.
    NOT_ASSIGNABLE = "not-assignable", "Something stands left of `=` that cannot hold a value.";
    ASSIGN_DERIVED = "assign-derived", "A computed field is assigned: the value would be overwritten.";
    ASSIGN_STRUCTURE = "assign-structure", "A size, type or address is assigned: it is fixed with the model.";
    ASSIGN_CONST = "assign-const", "A name declared with `const` is assigned again.";
    ASSIGN_ARRAY = "assign-array", "A whole array is assigned instead of one element.";
    ASSIGN_INSIDE = "assign-inside", "`=` inside an expression, where a comparison was probably meant.";
    EXPRESSION_ONLY = "expression-only", "A statement stands where only an expression is read.";
    EMPTY_BODY = "empty-body", "A `;` directly behind the head of a condition or a loop.";
    UNREACHABLE = "never-reached", "A statement behind a `return`, a `break` or a `continue`.";
    UNUSED_RESULT = "unused-result", "A statement that changes nothing.";

    // While running.
    BUDGET = "too-many-steps", "A loop or a recursion that does not come to an end.";
    CALL_DEPTH = "calls-too-deep", "Functions that call each other too deeply.";
    MEMORY = "too-much-memory", "Lists and records that take too much memory.";
    NO_PARTS = "no-parts", "A member or an element of something that has none: JavaScript stops the text here.";
    TEXT_TOO_LONG = "text-too-long", "A string grew beyond the limit.";
    HOST_CALL = "call-failed", "A function of the host failed.";
    HOST_STORE = "store-failed", "The host refused to store a value.";
    READ_PAST_END = "read-past-end", "An element past the end was read: the value is `undefined`.";
    STORE_PAST_END = "store-past-end", "An element past the end was assigned: nothing was stored.";
}

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn codes_are_unique_and_kebab_case() {
        for (i, (code, doc)) in ALL.iter().enumerate() {
            assert!(code.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{code}");
            assert!(doc.ends_with('.'), "{code}");
            assert!(ALL[..i].iter().all(|(other, _)| other != code), "{code} twice");
        }
    }
}
