#pragma once

#include <string_view>

namespace scc::runtime {

/// What values an author may give a field.
enum class Rule {
    any,
    positive,
    non_negative,
    nonzero_vector,
    direction ///< any vector but 0; the front end makes it a unit vector
};

/// Describes one author-visible member of a shape: the front end's schema, the IR's text and the generated
/// C++ are all derived from it. The default value is the member's initialiser. A shape declares its members
/// in the order of fields(), the flag of an optional one right after it.
template <class Owner, class T>
struct Field {
    std::string_view name;
    T Owner::*member;
    Rule rule;
    std::string_view doc;
    bool required = false;
    bool Owner::*present = nullptr; ///< of an optional field: set where the author gave a value
};

template <class Owner, class T>
constexpr Field<Owner, T> field(std::string_view name, T Owner::*member, Rule rule, std::string_view doc) {
    return {name, member, rule, doc, false, nullptr};
}
template <class Owner, class T>
constexpr Field<Owner, T> required_field(std::string_view name, T Owner::*member, Rule rule,
                                         std::string_view doc) {
    return {name, member, rule, doc, true, nullptr};
}
template <class Owner, class T>
constexpr Field<Owner, T> optional_field(std::string_view name, T Owner::*member, bool Owner::*present,
                                         Rule rule, std::string_view doc) {
    return {name, member, rule, doc, false, present};
}

} // namespace scc::runtime
