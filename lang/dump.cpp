#include "lang/dump.h"

#include "lang/text_table.h"

#include <fmt/format.h>

#include <iterator>

namespace scc::lang {
namespace {

std::string escaped(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        switch (c) {
        case '"':
            out += "\\\"";
            break;
        case '\\':
            out += "\\\\";
            break;
        case '\n':
            out += "\\n";
            break;
        case '\t':
            out += "\\t";
            break;
        default:
            out += c;
        }
    }
    return out + '"';
}

std::string type_text(const ast::TypeExpr& type);

struct TypeText {
    std::string operator()(const ast::NamedType& type) const { return type.name.text; }
    std::string operator()(const ast::ListType& type) const {
        return fmt::format("[{}]", type_text(*type.element));
    }
    std::string operator()(const ast::FunctionType& type) const {
        std::string parameters;
        for (const ast::TypeExprPtr& parameter : type.parameters) {
            parameters += (parameters.empty() ? "" : ", ") + type_text(*parameter);
        }
        return fmt::format("fn({}) -> {}", parameters, type_text(*type.result));
    }
};

std::string type_text(const ast::TypeExpr& type) {
    return std::visit(TypeText{}, type.node);
}

class Dump {
public:
    std::string take() { return std::move(out_); }

    void file(const ast::File& file) {
        if (file.language) {
            line("language {}", *file.language);
        }
        for (const ast::Item& child : file.items) {
            item(child);
        }
    }
    void expr(const ast::Expr& expression) { std::visit(*this, expression.node); }

    void operator()(const ast::ErrorExpr&) { line("error"); }
    void operator()(const ast::Number& node) { line("number {}{}", node.value, spelling(node.unit)); }
    void operator()(const ast::String& node) { line("string {}", escaped(node.value)); }
    void operator()(const ast::HexColor& node) { line("color #{:06x}", node.rgb); }
    void operator()(const ast::Bool& node) { line("{}", node.value); }
    void operator()(const ast::NameRef& node) { line("name {}", node.name); }
    void operator()(const ast::Construct& node) { body("construct " + node.constructor.text, node.body); }
    void operator()(const ast::Tuple& node) { exprs("tuple", node.elements); }
    void operator()(const ast::List& node) { exprs("list", node.elements); }
    void operator()(const ast::Comprehension& node) {
        line("comprehension {}", node.variable.text);
        nested([&] {
            expr(*node.range);
            expr(*node.element);
        });
    }
    void operator()(const ast::Conditional& node) {
        line("if");
        nested([&] {
            expr(*node.condition);
            expr(*node.yes);
            expr(*node.no);
        });
    }
    void operator()(const ast::Lambda& node) {
        line("lambda");
        nested([&] {
            formals(node.formals);
            expr(*node.body);
        });
    }
    void operator()(const ast::Unary& node) {
        line("unary {}", spelling(node.op));
        nested([&] { expr(*node.operand); });
    }
    void operator()(const ast::Binary& node) {
        line("binary {}", spelling(node.op));
        nested([&] {
            expr(*node.left);
            expr(*node.right);
        });
    }
    void operator()(const ast::Member& node) {
        line("member {}", node.member.text);
        nested([&] { expr(*node.object); });
    }
    void operator()(const ast::Call& node) {
        line("call");
        nested([&] {
            expr(*node.callee);
            for (const ast::Argument& argument : node.arguments) {
                labelled(argument.name ? "argument " + argument.name->text : "argument", *argument.value);
            }
        });
    }
    void operator()(const ast::Index& node) {
        line("index");
        nested([&] {
            expr(*node.object);
            expr(*node.index);
        });
    }

    void operator()(const ast::Import& node) {
        line("import as {}", node.alias.text);
        nested([&] {
            expr(*node.path);
            if (node.with) {
                body("with", *node.with);
            }
        });
    }
    void operator()(const ast::Param& node) {
        line("param {}: {}", node.name.text, type_text(*node.type));
        nested([&] {
            labelled("default", *node.default_value);
            if (node.range) {
                labelled("in", *node.range);
            }
            if (node.text) {
                line("text {}", escaped(*node.text));
            }
        });
    }
    void operator()(const ast::Let& node) {
        labelled(node.type ? fmt::format("let {}: {}", node.name.text, type_text(*node.type))
                           : "let " + node.name.text,
                 *node.value);
    }
    void operator()(const ast::Function& node) {
        line("fn {}{}", node.name.text, node.result ? " -> " + type_text(*node.result) : "");
        nested([&] {
            formals(node.formals);
            for (const ast::Let& let : node.body.lets) {
                (*this)(let);
            }
            labelled("result", *node.body.result);
        });
    }
    void operator()(const ast::For& node) {
        line("for {}", node.variable.text);
        nested([&] {
            labelled("in", *node.range);
            body("do", node.body);
        });
    }
    void operator()(const ast::If& node) {
        line("if");
        nested([&] {
            labelled("condition", *node.condition);
            body("then", node.yes);
            if (node.otherwise) {
                line("else");
                nested([&] { item(*node.otherwise); });
            }
        });
    }
    void operator()(const ast::Block& node) { body("block", node.body); }
    void operator()(const ast::Field& node) { labelled("field " + node.name.text, *node.value); }
    void operator()(const ast::Table& table) { line("{} more", table.rows->rows() - 1); }
    void operator()(const ast::Child& node) { labelled("child", *node.value); }

private:
    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        constexpr std::size_t indent = 2;
        out_.append(depth_ * indent, ' ');
        fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
        out_ += '\n';
    }
    template <class Inside>
    void nested(Inside inside) {
        ++depth_;
        inside();
        --depth_;
    }
    void item(const ast::Item& node) { std::visit(*this, node.node); }
    void labelled(std::string_view label, const ast::Expr& value) {
        line("{}", label);
        nested([&] { expr(value); });
    }
    void exprs(std::string_view label, const std::vector<ast::ExprPtr>& elements) {
        line("{}", label);
        nested([&] {
            for (const ast::ExprPtr& element : elements) {
                expr(*element);
            }
        });
    }
    void body(std::string_view label, const ast::Body& node) {
        line("{}", label);
        nested([&] {
            for (const ast::Item& child : node.items) {
                item(child);
            }
        });
    }
    void formals(const std::vector<ast::Formal>& formals) {
        for (const ast::Formal& formal : formals) {
            line("formal {}: {}", formal.name.text, type_text(*formal.type));
            if (formal.default_value) {
                nested([&] { expr(*formal.default_value); });
            }
        }
    }

    std::string out_;
    std::size_t depth_ = 0;
};

} // namespace

std::string dump_tokens(const SourceSet& sources, const std::vector<Token>& tokens) {
    std::string out;
    for (const Token& token : tokens) {
        const Position position = sources.file(token.span.file).position(token.span.begin);
        const bool is_word = token.kind >= TokenKind::kw_language;
        fmt::format_to(std::back_inserter(out), "{}:{}{} {}", position.line, position.column,
                       token.starts_line ? " line" : "", is_word ? "" : spelling(token.kind));
        const std::string_view text = sources.text(token.span);
        fmt::format_to(std::back_inserter(out), "{}`{}`", is_word ? "" : " ", text);
        if (token.kind == TokenKind::number) {
            fmt::format_to(std::back_inserter(out), " = {}", token.number);
        }
        out += '\n';
    }
    return out;
}

std::string dump_ast(const ast::File& file) {
    Dump dump;
    dump.file(file);
    return dump.take();
}

std::string dump_ast(const ast::Expr& expression) {
    Dump dump;
    dump.expr(expression);
    return dump.take();
}

std::string_view spelling(ast::Unit unit) {
    switch (unit) {
    case ast::Unit::none:
        return "";
    case ast::Unit::deg:
        return "deg";
    case ast::Unit::rad:
        return "rad";
    case ast::Unit::mm:
        return "mm";
    case ast::Unit::cm:
        return "cm";
    case ast::Unit::m:
        return "m";
    case ast::Unit::km:
        return "km";
    case ast::Unit::inch:
        return "inch";
    }
    return {};
}

std::string_view spelling(ast::UnaryOp op) {
    return op == ast::UnaryOp::minus ? "-" : "not";
}

std::string_view spelling(ast::BinaryOp op) {
    switch (op) {
    case ast::BinaryOp::then:
        return "then";
    case ast::BinaryOp::logical_or:
        return "or";
    case ast::BinaryOp::logical_and:
        return "and";
    case ast::BinaryOp::eq:
        return "==";
    case ast::BinaryOp::ne:
        return "!=";
    case ast::BinaryOp::lt:
        return "<";
    case ast::BinaryOp::le:
        return "<=";
    case ast::BinaryOp::gt:
        return ">";
    case ast::BinaryOp::ge:
        return ">=";
    case ast::BinaryOp::range:
        return "..";
    case ast::BinaryOp::add:
        return "+";
    case ast::BinaryOp::sub:
        return "-";
    case ast::BinaryOp::mul:
        return "*";
    case ast::BinaryOp::div:
        return "/";
    case ast::BinaryOp::mod:
        return "%";
    case ast::BinaryOp::pow:
        return "^";
    }
    return {};
}

} // namespace scc::lang
