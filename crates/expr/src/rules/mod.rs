//! Every rule of the language, each on a page of its own: what is wrong, and why it matters. The parser, the binder and the machine
//! say where one is broken; a wrong and a right example are shown by the host, whose names they need.

pub use labspec_finding::Rule;

macro_rules! rules {
    ($($file:ident :: $name:ident,)*) => {
        $(mod $file; pub use $file::$name;)*
        /// Every rule, in the order of the stages that find them.
        pub const ALL: &[&Rule] = &[$($name),*];
    };
}

rules! {
    // Reading the text.
    too_long::TOO_LONG,
    too_deep::TOO_DEEP,
    too_many_errors::TOO_MANY_ERRORS,
    bad_character::BAD_CHARACTER,
    bad_number::BAD_NUMBER,
    bad_string::BAD_STRING,
    unclosed_comment::UNCLOSED_COMMENT,
    missing_value::MISSING_VALUE,
    missing_operator::MISSING_OPERATOR,
    missing_name::MISSING_NAME,
    missing_bracket::MISSING_BRACKET,
    missing_statement::MISSING_STATEMENT,
    decimal_comma::DECIMAL_COMMA,
    misplaced::MISPLACED,
    unopened::UNOPENED,
    half_choice::HALF_CHOICE,
    do_without_while::DO_WITHOUT_WHILE,
    loop_head::LOOP_HEAD,
    loop_without_const::LOOP_WITHOUT_CONST,
    lone_declaration::LONE_DECLARATION,
    declared_without_value::DECLARED_WITHOUT_VALUE,
    outside_of_loop::OUTSIDE_LOOP,
    unclosed::UNCLOSED,
    empty::EMPTY,
    not_in_language::NOT_IN_LANGUAGE,
    ambiguous_power::AMBIGUOUS_POWER,
    ambiguous_default::AMBIGUOUS_DEFAULT,
    // Resolving names.
    unknown_name::UNKNOWN_NAME,
    unknown_field::UNKNOWN_FIELD,
    unknown_function::UNKNOWN_FUNCTION,
    unknown_object::UNKNOWN_OBJECT,
    computed_name::COMPUTED_NAME,
    name_taken::NAME_TAKEN,
    used_too_early::USED_TOO_EARLY,
    no_value_here::NO_VALUE_HERE,
    unset_ctx::UNSET_GLOBAL,
    // Indexes.
    index_out_of_range::INDEX_RANGE,
    index_negative::INDEX_NEGATIVE,
    index_not_whole::INDEX_FRACTION,
    index_not_a_number::INDEX_KIND,
    not_indexable::NOT_INDEXABLE,
    // Values and types.
    whole_array::WHOLE_ARRAY,
    not_a_value::NOT_A_VALUE,
    no_result::NO_RESULT,
    string_as_number::STRING_AS_NUMBER,
    xor_as_power::XOR_AS_POWER,
    chained_comparison::CHAINED_COMPARISON,
    compare_nan::COMPARE_NAN,
    degrees_for_radians::DEGREES,
    not_random::NOT_RANDOM,
    // Calls.
    not_callable::NOT_CALLABLE,
    not_called::NOT_CALLED,
    argument_count::ARGUMENT_COUNT,
    argument_type::ARGUMENT_TYPE,
    // Assignments and statements.
    not_assignable::NOT_ASSIGNABLE,
    assign_derived::ASSIGN_DERIVED,
    assign_structure::ASSIGN_STRUCTURE,
    assign_const::ASSIGN_CONST,
    assign_array::ASSIGN_ARRAY,
    assign_inside::ASSIGN_INSIDE,
    expression_only::EXPRESSION_ONLY,
    empty_body::EMPTY_BODY,
    never_reached::UNREACHABLE,
    unused_result::UNUSED_RESULT,
    // While running.
    too_many_steps::BUDGET,
    calls_too_deep::CALL_DEPTH,
    too_much_memory::MEMORY,
    no_parts::NO_PARTS,
    text_too_long::TEXT_TOO_LONG,
    call_failed::HOST_CALL,
    store_failed::HOST_STORE,
    store_past_end::STORE_PAST_END,
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
