#pragma once

#include "lang/source.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <variant>
#include <vector>

namespace scc::lang {
struct TextTable;
}

/// The syntax tree: plain structs with spans, as parsed. Nothing here knows a type, a shape or a value.
namespace scc::lang::ast {

struct Expr;
struct Item;
using ExprPtr = std::unique_ptr<Expr>;

struct Name {
    std::string text;
    Span span;
};

struct Body { ///< `{ items }`
    std::vector<Item> items;
    Span span;             ///< with the braces
    bool has_gaps = false; ///< an item of it could not be read
    bool is_open = false;  ///< never closed: what stands in it may belong elsewhere
};

// ---- types ---------------------------------------------------------------------------------------------

struct TypeExpr;
using TypeExprPtr = std::unique_ptr<TypeExpr>;
struct NamedType {
    Name name;
};
struct ListType {
    TypeExprPtr element;
};
struct FunctionType {
    std::vector<TypeExprPtr> parameters;
    TypeExprPtr result;
};
struct TypeExpr {
    std::variant<NamedType, ListType, FunctionType> node;
    Span span;
};

// ---- expressions ---------------------------------------------------------------------------------------

enum class Unit : std::uint8_t { none, deg, rad, mm, cm, m, km, inch };
enum class UnaryOp { minus, logical_not };
enum class BinaryOp {
    then,
    logical_or,
    logical_and,
    eq,
    ne,
    lt,
    le,
    gt,
    ge,
    range,
    add,
    sub,
    mul,
    div,
    mod,
    pow
};

struct Formal {
    Name name;
    TypeExprPtr type;
    ExprPtr default_value; ///< null: the argument is required
};

struct Let; // also stands in function blocks

struct FunctionBody { ///< `= expr`, or a block of lets with a final expression
    std::vector<Let> lets;
    ExprPtr result;
};

struct Number {
    double value; ///< as written, before the unit
    Unit unit;
};
struct String {
    std::string value; ///< escapes resolved
};
struct HexColor {
    std::uint32_t rgb; ///< 0xrrggbb
};
struct Bool {
    bool value;
};
struct NameRef {
    std::string name;
};
struct Construct { ///< `sphere { ... }`
    Name constructor;
    Body body;
};
struct Tuple { ///< `(x, y)` or `(x, y, z)`; a parenthesised single expression leaves no node
    std::vector<ExprPtr> elements;
};
struct List {
    std::vector<ExprPtr> elements;
};
struct Comprehension { ///< `[for (i in range) element]`
    Name variable;
    ExprPtr range;
    ExprPtr element;
};
struct Conditional { ///< `if (c) a else b`
    ExprPtr condition, yes, no;
};
struct Lambda { ///< `fn(s: surface) = expr`
    std::vector<Formal> formals;
    ExprPtr body;
};
struct Unary {
    UnaryOp op;
    ExprPtr operand;
};
struct Binary {
    BinaryOp op;
    ExprPtr left, right;
    Span op_span;
};
struct Member {
    ExprPtr object;
    Name member;
};
struct Argument {
    std::optional<Name> name;
    ExprPtr value;
};
struct Call {
    ExprPtr callee;
    std::vector<Argument> arguments;
};
struct Index {
    ExprPtr object, index;
};
struct ErrorExpr {}; ///< stands where parsing failed; reported already

struct Expr {
    std::variant<ErrorExpr, Number, String, HexColor, Bool, NameRef, Construct, Tuple, List, Comprehension,
                 Conditional, Lambda, Unary, Binary, Member, Call, Index>
        node;
    Span span;
};

// ---- items ---------------------------------------------------------------------------------------------

struct Import {
    ExprPtr path; ///< a String
    Name alias;
    std::optional<Body> with;
};
struct Param {
    Name name;
    TypeExprPtr type;
    ExprPtr default_value;
    ExprPtr range; ///< null: any value of the type
    std::optional<std::string> text;
};
struct Let {
    Name name;
    TypeExprPtr type; ///< null: inferred
    ExprPtr value;
    Span span;
};
struct Function {
    Name name;
    std::vector<Formal> formals;
    TypeExprPtr result; ///< null: inferred
    FunctionBody body;
    bool has_gaps = false; ///< its parameters could not be read
};
struct For {
    Name variable;
    ExprPtr range;
    Body body;
};
struct If {
    ExprPtr condition;
    Body yes;
    std::unique_ptr<Item> otherwise; ///< null, an If item, or a Block item
};
struct Block { ///< the body of a final `else`
    Body body;
};
struct Field {
    Name name;
    ExprPtr value;
};
/// Lines that repeat `first`, the item before, but for its numbers.
struct Table {
    std::shared_ptr<const TextTable> rows;
    const Construct* first;
};
struct Child { ///< an expression on a line of its own: puts its value into the surrounding thing
    ExprPtr value;
};

struct Item {
    std::variant<Import, Param, Let, Function, For, If, Block, Field, Child, Table> node;
    Span span;
};

struct File {
    std::optional<double> language;
    std::vector<Item> items;
    FileId file = 0;
    /// Every name in text that could not be read: it may be defined there, so nothing is known of it.
    std::unordered_set<std::string> lost_names;
};

} // namespace scc::lang::ast
