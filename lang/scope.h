#pragma once

#include "lang/ast.h"
#include "lang/code.h"
#include "lang/diagnostic.h"
#include "lang/source.h"
#include "lang/type.h"

#include <cstdint>
#include <deque>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace scc::lang {

struct Scope;
struct Binding;
struct ImportedNames;

/// One mention of a name in the definition of another.
struct Use {
    Binding* target;
    Span span;
};

/// A name with what it stands for. Its type is found when it is first needed, so definitions may stand in any
/// order.
struct Binding {
    enum class Kind { let, param, function, variable, import, misplaced };
    enum class State { unchecked, checking, checked };

    Kind kind = Kind::variable;
    std::string_view name;
    Span span;
    Scope* scope = nullptr;
    Binding* owner = nullptr; ///< the definition within which this one stands
    State state = State::unchecked;
    Type type; ///< of a function with its parameters; known early if the result type is written
    bool type_known = false;
    bool used = false;
    bool needs_result_type = false; ///< a function that was called before its result was known
    bool is_spoilt = false;         ///< its definition was reported; what it means is not known
    std::uint32_t cell = 0;         ///< of the scope's frame; functions have none
    CodePtr code;                   ///< what the cell is computed from
    FunctionCode* function_code = nullptr;
    const ast::Let* let = nullptr;
    const ast::Param* param = nullptr;
    const ast::Function* function = nullptr;
    ImportedNames* imported = nullptr; ///< of an import; null: it could not be read
    std::vector<Use> uses;             ///< of definitions outside of this one
};

/// The names of one body, function or loop; one frame at run time.
struct Scope {
    Scope* parent = nullptr;
    std::unordered_map<std::string_view, Binding*> names;
    std::vector<Binding*> cells;
};

/// All scopes and bindings of a file.
class Names {
public:
    explicit Names(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    Scope& add_scope(Scope* parent);
    /// A second binding of a name in one scope is reported; the name keeps its first meaning.
    Binding& bind(Scope& scope, Binding::Kind kind, std::string_view name, Span span, Binding* owner);

    static Binding* find(Scope* scope, std::string_view name);
    static std::vector<std::string_view> visible(const Scope* scope);
    /// Frames from `from` out to `to`.
    static std::uint32_t depth(const Scope* from, const Scope* to);
    /// Remembers that the definition `user` (null: the file's items) mentions `target`.
    static void note_use(Binding& target, Span span, Binding* user);

    /// All names of the scope count as used from here on, as those that another file may use.
    static void export_all(const Scope& scope);
    /// Nothing is said of names for which `maybe_used` holds, or whose definition is wrong.
    template <class MaybeUsed>
    void warn_unused(const MaybeUsed& maybe_used);
    /// Reports every let or param whose value needs itself, by way of functions too, and functions whose
    /// result type cannot be found because they call themselves.
    void report_cycles();

private:
    static Span definition_span(const Binding& binding);
    void report_cycle(Binding* first, const std::vector<Binding*>& members);

    std::deque<Scope> scopes_;
    std::deque<Binding> bindings_;
    Diagnostics& diagnostics_;
};

template <class MaybeUsed>
void Names::warn_unused(const MaybeUsed& maybe_used) {
    for (const Binding& binding : bindings_) {
        const bool is_silent = binding.used || binding.name.starts_with('_') || maybe_used(binding.name);
        if (is_silent || diagnostics_.has_errors_within(definition_span(binding))) {
            continue;
        }
        if (binding.kind == Binding::Kind::let) {
            diagnostics_.report(Diag::unused_let, binding.span, binding.name);
        } else if (binding.kind == Binding::Kind::param) {
            diagnostics_.report(Diag::unused_param, binding.span, binding.name);
        } else if (binding.kind == Binding::Kind::import) {
            diagnostics_.report(Diag::unused_import, binding.span, binding.name);
        }
    }
}

} // namespace scc::lang
