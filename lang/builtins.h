#pragma once

#include "lang/run_report.h"
#include "lang/scalar_math.h"
#include "lang/source.h"
#include "lang/type.h"
#include "lang/value.h"

#include <string>
#include <string_view>
#include <vector>

namespace scc::lang {

/// What a built-in function may use while it runs.
struct BuiltinRun {
    ScalarMath& math;
    RunReport& report;
    Span span; ///< of the call
};

struct Overload {
    std::vector<Type> parameters;
    Type result;
    Value (*run)(BuiltinRun& run, const std::vector<Value>& arguments);
    bool needs_constants = false;          ///< takes known arguments only
    std::vector<std::string_view> names{}; ///< of the parameters
    bool takes_spectra = false;            ///< takes colours that have spectra
};

/// A function of the language with one result per list of parameter types. `map filter sum len` are typed by
/// their arguments and live in the checker.
struct Builtin {
    std::string_view name;
    std::vector<Overload> overloads;
    std::string_view doc;     ///< one line
    std::string_view example; ///< an expression
};

/// What an author is told of anything that is called, the list functions and statements too.
struct FunctionDoc {
    std::string_view name;
    std::vector<std::string> signatures; ///< `mix(a: vec3, b: vec3, t: number) -> vec3`
    std::string_view doc;                ///< one line
    std::string_view example;            ///< an expression; of a statement, the statement
};

/// In the order of the table; the list functions and statements come last.
const std::vector<FunctionDoc>& function_docs();

const Builtin* find_builtin(std::string_view name);
/// Every name that is a function to an author: the built-in ones, the list functions, `assert` and `print`.
const std::vector<std::string_view>& function_names();
bool is_list_function(std::string_view name);
bool is_statement(std::string_view name);

} // namespace scc::lang
