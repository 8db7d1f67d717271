#pragma once

#include "lang/ast.h"
#include "lang/schema.h"
#include "lang/source.h"
#include "lang/value.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// A scene after checking: names are cells of frames, calls know what they call, fields know their row. Every
/// scope with a binding becomes one frame at run time.
namespace scc::lang {

struct Code;
struct ItemCode;
struct FunctionCode;
struct Overload;
struct ImportedFile;
using CodePtr = std::unique_ptr<const Code>;

struct BodyCode {
    bool has_frame = false;
    std::vector<CodePtr> cells; ///< what each cell of the frame is computed from; null: set on entry
    std::vector<ItemCode> items;
};

namespace code {

struct Failed {}; ///< stands where something was reported; gives an ErrorValue
struct Constant {
    Value value;
};
struct Variable {
    std::uint32_t depth; ///< frames to go out
    std::uint32_t cell;
};
struct FunctionValue { ///< a named function or a lambda
    std::uint32_t depth;
    const FunctionCode* function;
};
struct Unary {
    ast::UnaryOp op;
    CodePtr operand;
};
struct Binary {
    ast::BinaryOp op;
    CodePtr left, right;
};
struct Tuple {
    std::vector<CodePtr> elements;
};
struct List {
    std::vector<CodePtr> elements;
};
struct Comprehension {
    CodePtr range, element;
    std::string_view variable;
    Span variable_span;
    std::vector<CodePtr> cells; ///< one: the variable
};
struct Conditional {
    CodePtr condition, yes, no;
};
struct Component { ///< `.x` and its like
    CodePtr object;
    std::size_t index;
};
struct SurfaceInput { ///< `s.p`
    CodePtr object;
    std::string_view name;
};
struct BuiltinCall {
    const Overload* overload;
    std::vector<CodePtr> arguments;
};
enum class ListOp { map, filter, sum, len };
struct ListCall {
    ListOp op;
    std::vector<CodePtr> arguments; ///< the list first
    Value zero;                     ///< the sum of no elements
};
struct Call {
    CodePtr callee;
    std::vector<CodePtr> arguments; ///< in the order of the parameters; null: the default
};
struct ImageCall {
    CodePtr image, uv;
};
struct Index {
    CodePtr object, index;
};
struct Imported { ///< `name.x`: computed among the imported file's own names
    const ImportedFile* file;
    CodePtr value;
};
struct ImportedScene { ///< `name.scene`
    const ImportedFile* file;
};
struct Given { ///< a value of an import's `with`: computed among the names of the importing file
    CodePtr value;
};
struct FrameNumber { ///< `frame`, or `time`
    bool in_seconds;
};
struct Construct {
    const Constructor* constructor;
    BodyCode body;
    std::string_view name;              ///< the thing's
    Span name_span;                     ///< of the constructor's name
    std::vector<const Field*> required; ///< those that the text sets, in a branch maybe
    bool is_sound;                      ///< nothing was reported of its fields and items
};

} // namespace code

struct FieldCode {
    const Field* field;
    CodePtr value;
    Span name_span;
};
struct ChildCode {
    CodePtr value;
};
/// Rows of a table, from `begin` to `end`.
struct RowsCode {
    std::shared_ptr<const TextTable> table;
    const Code* first;             ///< makes the first row's thing
    const ast::Construct* written; ///< what that was made of
    std::size_t begin, end;
};
struct ForCode {
    CodePtr range;
    BodyCode body; ///< cell 0 is the variable
    std::string_view variable;
    Span span; ///< of the word `for`
};
struct IfCode {
    CodePtr condition;
    BodyCode yes, no;
};
struct AssertCode {
    CodePtr condition, text;
};
struct PrintCode {
    CodePtr value;
};
struct ItemCode {
    std::variant<FieldCode, ChildCode, RowsCode, ForCode, IfCode, AssertCode, PrintCode> node;
};

struct Code {
    std::variant<code::Failed, code::Constant, code::Variable, code::FunctionValue, code::Unary, code::Binary,
                 code::Tuple, code::List, code::Comprehension, code::Conditional, code::Component,
                 code::SurfaceInput, code::BuiltinCall, code::ListCall, code::Call, code::ImageCall,
                 code::Index, code::Imported, code::ImportedScene, code::Given, code::FrameNumber,
                 code::Construct>
        node;
    Span span;
};

struct FunctionCode {
    std::string_view name; ///< empty for a lambda
    Span span;
    std::size_t parameters = 0;
    std::vector<CodePtr>
        defaults;               ///< one per parameter, null: required; run in the frame around the function
    std::vector<CodePtr> cells; ///< the parameters, then the lets
    CodePtr result;
};

struct ParamCode {
    std::string_view name;
    Type type;
    CodePtr default_value; ///< only where `-D` gives another value; else the cell's code is the default
    CodePtr begin, end;    ///< of its range; null: none
    std::string text;
    Span span;
    std::size_t cell; ///< of the file's frame
};

template <class Node>
CodePtr make_code(Node node, Span span) {
    return std::make_unique<const Code>(Code{std::move(node), span});
}

} // namespace scc::lang
