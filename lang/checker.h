#pragma once

#include "lang/ast.h"
#include "lang/builtins.h"
#include "lang/check.h"
#include "lang/code.h"
#include "lang/diagnostic.h"
#include "lang/schema.h"
#include "lang/scope.h"
#include "lang/source.h"
#include "lang/stack_guard.h"
#include "lang/symbols.h"

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace scc::lang {

struct ImportSession;
struct ImportedFile;
struct ImportedNames;

/// What the static pass makes of a file; complete only if it reported no error.
struct CheckedFile {
    CheckedFile();
    CheckedFile(CheckedFile&&) noexcept;
    CheckedFile& operator=(CheckedFile&&) noexcept;
    ~CheckedFile();

    /// The `render` that has frames; null: none has.
    struct Animated {
        const code::Construct* render = nullptr;
        const Code* frames = nullptr;
        const Code* rate = nullptr; ///< null: the default
    };

    std::vector<std::unique_ptr<ImportedFile>> imports;
    Animated animated;
    BodyCode body;
    std::vector<Span> cells; ///< the names whose values the cells of `body` hold
    std::vector<ParamCode> params;
    std::deque<FunctionCode> functions;
    std::deque<ast::File> expanded; ///< rows of tables that the code refers to
    std::deque<ast::ExprPtr> given; ///< the syntax of `-D`, which the code refers to as it does to the file's
};

/// An expression's type and code. Where something was reported the code is null, as what a check() returns,
/// or code::Failed, as what expression() returns; so no value ever contradicts its type at run time.
struct Typed {
    Type type;
    CodePtr code;
};

/// Where an expression stands.
struct Place {
    Scope* scope;
    Binding* owner;              ///< the definition it belongs to; null: the file's items
    std::string_view thing_name; ///< for a thing that this expression directly makes

    Place unnamed() const { return {scope, owner, {}}; }
};

/// The static pass: names, types, fields. Reports everything and never stops; what is wrong gets the error
/// type.
class Checker {
public:
    /// With `symbols`, what the names stand for goes there.
    Checker(const Schema& schema, SourceSet& sources, Diagnostics& diagnostics,
            const EvaluationLimits& limits, ImportSession& session, SymbolIndex* symbols = nullptr);
    ~Checker();

    CheckedFile run(const ast::File& file, const std::vector<Definition>& definitions);

private:
    using Fields = std::map<std::string_view, Span>;
    /// The body that items stand in.
    struct Around {
        const Constructor* thing = nullptr; ///< null: the file, or an unknown thing
        bool is_file = false;               ///< in loops and conditions too
        bool is_open = false;               ///< in braces that are never closed
        bool at_top = false;                ///< not in those
        bool in_loop = false;
        Fields* fields = nullptr; ///< set so far
        bool* is_sound = nullptr; ///< becomes false with the first mistake in its fields and items
    };

    /// Within a body whose braces are never closed.
    class Open {
    public:
        Open(int& count, bool is_open) : count_(count), is_open_(is_open) { count_ += is_open_ ? 1 : 0; }
        ~Open() { count_ -= is_open_ ? 1 : 0; }
        Open(const Open&) = delete;
        Open& operator=(const Open&) = delete;

    private:
        int& count_;
        bool is_open_;
    };

    /// Where the code of an item goes.
    struct Into {
        const Around& around;
        const Place& place;
        std::vector<ItemCode>& out;
    };

    // check_items.cpp
    std::vector<Binding*> declare(const std::vector<ast::Item>& items, const Place& place, bool at_top);
    Binding& bind(Scope& scope, Binding::Kind kind, const ast::Name& name, Binding* owner);
    void check_definitions(const std::vector<Binding*>& bindings);
    void mention(Span definition, Span span, const Place& place);
    void add_symbols();
    Span without_brackets(Span span);
    std::vector<ItemCode> items(const std::vector<ast::Item>& items, const Around& around,
                                const Place& place);
    BodyCode body(const ast::Body& body, const Around& around, const Place& place);
    Around inside(const ast::Body& body, const Around& around);
    BodyCode otherwise(const ast::Item* item, const Around& around, const Place& place);
    void item(const ast::Import& item, Span span, const Into& into);
    void item(const ast::Param& item, Span span, const Into& into);
    void item(const ast::Let& item, Span span, const Into& into);
    void item(const ast::Function& item, Span span, const Into& into);
    void item(const ast::For& item, Span span, const Into& into);
    void item(const ast::If& item, Span span, const Into& into);
    void item(const ast::Block& item, Span span, const Into& into);
    void item(const ast::Field& item, Span span, const Into& into);
    void item(const ast::Child& item, Span span, const Into& into);
    // check_tables.cpp
    void item(const ast::Table& item, Span span, const Into& into);
    void rows_one_by_one(const TextTable& table, std::size_t begin, std::size_t end, const Into& into);
    bool unassigned_field(const ast::Expr& value, const Into& into);
    bool statement(const ast::Child& item, const Into& into);
    void misplaced(Span span, std::string_view what, const Around& around);
    void close(Scope& scope, std::vector<CodePtr>& cells);

    // check_imports.cpp
    struct Importing {
        const Checker& checker;
    };
    explicit Checker(Importing importing);
    void import_file(const ast::Import& item, Binding& binding);
    const ast::File* open_import(const ast::Import& item, ImportedFile& file);
    void report_import_cycle(std::size_t first, Span span);
    void given_param(const ast::Field& item, Binding& binding, const Place& place);
    /// The import that the expression names, if it does.
    Binding* import_named(const ast::Expr& expr, const Place& place);
    Binding* imported_binding(Binding& import, const ast::Name& name, const Place& place);
    Typed imported_member(Binding& import, const ast::Name& name, Span span, const Place& place);
    Typed imported_value(const Binding& import, const Binding& binding, Span span);

    // check_frames.cpp
    void find_frames(const ast::File& file);
    static void find_frames_code(CheckedFile& file);
    static bool is_frame_name(std::string_view name);
    Typed frame_number(std::string_view name, Span span);

    // check_things.cpp
    Typed check(const ast::Construct& node, const ast::Expr& expr, const Place& place);
    void field_value(const ast::Field& item, const Field& row, const Into& into);
    void unknown_body(const ast::Body& body, const Place& place);
    void unknown_constructor(const ast::Construct& node, const Place& place);
    void unknown_field(const ast::Field& item, const Constructor& thing);
    bool check_choice(const ast::Expr& value, const Field& row);
    bool child_fits(const Type& type, const Around& around, Span span);

    // check_definitions.cpp
    void ensure(Binding& binding);
    void ensure_let(Binding& binding);
    void ensure_signature(Binding& binding);
    void ensure_function(Binding& binding);
    Typed reference(Binding& binding, Span span, const Place& place);
    Typed value_of(const Binding& binding, std::uint32_t depth, Span span);
    Typed check(const ast::Lambda& node, const ast::Expr& expr, const Place& place);
    std::vector<Type> formal_types(const std::vector<ast::Formal>& formals);
    void defaults(const std::vector<ast::Formal>& formals, const std::vector<Type>& types, const Place& place,
                  FunctionCode& function);
    Scope& bind_formals(const std::vector<ast::Formal>& formals, const std::vector<Type>& types,
                        const Place& outer, Span extent);
    Type type(const ast::TypeExpr* written);
    Type bounded(Type type, Span span);

    // check_params.cpp
    void param(Binding& binding);
    ParamCode param_code(Binding& binding);
    void param_range(const ast::Param& item, const Type& type, const Place& place, ParamCode& code);
    void definition(const Definition& definition, std::string_view name, CheckedFile& file);
    static void set_param(CheckedFile& file, ParamCode& param, CodePtr value);
    CodePtr given_value(const Definition& definition, const ParamCode& param);
    void find_unit(const ast::File& file);

    // check_expressions.cpp
    Typed expression(const ast::ExprPtr& expr, const Place& place);
    Typed check(const ast::ErrorExpr& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Number& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::String& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::HexColor& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Bool& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::NameRef& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Tuple& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::List& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Comprehension& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Conditional& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Unary& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Binary& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Member& node, const ast::Expr& expr, const Place& place);
    Typed check(const ast::Index& node, const ast::Expr& expr, const Place& place);
    void unknown_member(std::string_view object, const ast::Name& member,
                        const std::vector<std::string_view>& members);
    Typed unknown_name(const ast::NameRef& node, Span span, const Place& place);
    Type element_of(const Type& range, Span span);

    // check_calls.cpp
    Typed check(const ast::Call& node, const ast::Expr& expr, const Place& place);
    Typed named_call(const ast::Call& node, std::string_view name, Span span, const Place& place);
    Typed function_call(const ast::Call& node, const Binding& binding, Typed callee, Span span,
                        const Place& place);
    Typed value_call(const ast::Call& node, Span span, const Place& place);
    Typed builtin_call(const ast::Call& node, const Builtin& builtin, Span span, const Place& place);
    Typed list_call(const ast::Call& node, std::string_view name, Span span, const Place& place);
    Typed constructor_call(std::string_view name, Span name_span, Span span);
    static constexpr std::size_t no_parameter = static_cast<std::size_t>(-1);
    std::size_t parameter_of(const ast::Call& node, std::size_t argument,
                             const std::vector<std::string_view>& names, std::string_view function);
    std::size_t parameter_index(const ast::Name& name, const std::vector<std::string_view>& names,
                                std::string_view function);
    std::vector<Typed> arguments(const ast::Call& node, std::string_view subject, const Place& place);
    bool argument_count(std::size_t wanted, std::string_view subject, const ast::Call& node, Span span);
    bool put_in_order(const ast::Call& node, const Builtin& builtin,
                      std::vector<const ast::Argument*>& arguments);
    void no_overload(const ast::Call& node, const Builtin& builtin,
                     const std::vector<const ast::Argument*>& given, std::vector<Typed>& values, Span span);
    void suspect_degrees(const ast::Call& node, std::string_view name);

    // check_types.cpp
    /// Reports a value of another type, and spoils its code; gives whether it fits.
    bool expect(std::string_view subject, const Type& wanted, Typed& value, const ast::Expr& expr,
                std::string_view alternative = {});
    bool is_lost(std::string_view name) const { return lost_names_->contains(std::string(name)); }
    Typed unknown(std::string_view name, Span span, const Place& place, std::vector<std::string_view> others);
    void not_supported(Span span, std::string_view what);
    /// What the author may have meant by an unknown name; given up after many of them, since each costs a
    /// search.
    std::optional<std::string_view> meant_name(std::string_view name, const Place& place,
                                               std::vector<std::string_view> others);

    const Schema& schema_;
    SourceSet& sources_;
    Diagnostics& diagnostics_;
    EvaluationLimits limits_;
    ImportSession& session_;
    Names names_;
    Scope* file_scope_ = nullptr;
    bool is_imported_ = false;
    std::vector<std::unique_ptr<ImportedFile>> imports_;
    std::vector<std::unique_ptr<ImportedNames>> imported_;
    bool import_failed_ = false;
    SymbolIndex* symbols_; ///< null: nobody asked
    std::vector<Names::Found> mentions_;
    std::deque<FunctionCode> functions_;
    std::deque<ast::ExprPtr> given_;
    std::deque<ast::File> expanded_;
    bool item_reported_ = false; ///< of the item before the one that is checked now
    const std::unordered_set<std::string>* lost_names_ = nullptr;
    bool unused_is_known_ = true; ///< no use of a name went unseen
    ast::Unit world_unit_ = ast::Unit::m;
    std::vector<const ast::Field*> unit_fields_; ///< those that find_unit could read
    Fields any_fields_;                          ///< of things of which nothing is known
    bool any_soundness_ = true;
    int open_bodies_ = 0; ///< of what stands in them nobody knows whether it belongs there
    int searches_left_ = 100;
    StackGuard stack_;
};

} // namespace scc::lang
