#include "lang/lsp/grammar.h"

#include "lang/builtins.h"
#include "lang/lexer.h"
#include "lang/lexer_tables.h"
#include "lang/type.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

namespace scc::lang::lsp {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view name_pattern = "[A-Za-z_][A-Za-z0-9_]*";

/// The longest first: a regular expression takes the first alternative that fits.
std::string any_of(std::vector<std::string> words) {
    std::sort(words.begin(), words.end());
    words.erase(std::unique(words.begin(), words.end()), words.end());
    std::stable_sort(words.begin(), words.end(),
                     [](const std::string& a, const std::string& b) { return a.size() > b.size(); });
    return fmt::format("(?:{})", fmt::join(words, "|"));
}

std::string any_of(const std::vector<std::string_view>& words) {
    return any_of(std::vector<std::string>(words.begin(), words.end()));
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool is_special = std::string_view(".*+?^$()[]{}|\\/").find(c) != std::string_view::npos;
        result += is_special ? std::string{'\\', c} : std::string(1, c);
    }
    return result;
}

Json match(const std::string& pattern, std::string_view scope) {
    return {{"name", scope}, {"match", pattern}};
}

/// Scopes of the parenthesised parts of a pattern, in their order.
Json match_parts(const std::string& pattern, const std::vector<std::string_view>& scopes) {
    Json captures = Json::object();
    for (std::size_t i = 0; i < scopes.size(); ++i) {
        captures[std::to_string(i + 1)] = {{"name", scopes[i]}};
    }
    return {{"match", pattern}, {"captures", captures}};
}

std::string_view scope_of_word(TokenKind kind) {
    switch (kind) {
    case TokenKind::kw_let:
    case TokenKind::kw_fn:
    case TokenKind::kw_param:
        return "storage.type.scn";
    case TokenKind::kw_then:
    case TokenKind::kw_and:
    case TokenKind::kw_or:
    case TokenKind::kw_not:
        return "keyword.operator.word.scn";
    case TokenKind::kw_true:
    case TokenKind::kw_false:
        return "constant.language.scn";
    default:
        return "keyword.control.scn";
    }
}

std::vector<TokenKind> kinds(TokenKind first, TokenKind last) {
    std::vector<TokenKind> result;
    for (auto i = static_cast<int>(first); i <= static_cast<int>(last); ++i) {
        result.push_back(static_cast<TokenKind>(i));
    }
    return result;
}

Json reserved_words() {
    const std::vector<TokenKind> words = kinds(TokenKind::kw_language, TokenKind::kw_false);
    Json patterns = Json::array();
    std::vector<std::string_view> scopes;
    for (const TokenKind word : words) {
        if (std::find(scopes.begin(), scopes.end(), scope_of_word(word)) == scopes.end()) {
            scopes.push_back(scope_of_word(word));
        }
    }
    for (const std::string_view scope : scopes) {
        std::vector<std::string_view> of_scope;
        for (const TokenKind word : words) {
            if (scope_of_word(word) == scope) {
                of_scope.push_back(spelling(word));
            }
        }
        patterns.push_back(match(fmt::format("\\b{}\\b", any_of(of_scope)), scope));
    }
    return patterns;
}

Json operators() {
    std::vector<std::string> signs;
    for (const TokenKind kind : kinds(TokenKind::assign, TokenKind::caret)) {
        signs.push_back(escaped(spelling(kind)));
    }
    return match(any_of(std::move(signs)), "keyword.operator.scn");
}

Json comments() {
    return Json::array({match("//.*$", "comment.line.double-slash.scn"),
                        {{"name", "comment.block.scn"}, {"begin", "/\\*"}, {"end", "\\*/"}}});
}

Json strings() {
    return {{"name", "string.quoted.double.scn"},
            {"begin", "\""},
            {"end", "\"|$"},
            {"patterns", Json::array({match("\\\\[\"\\\\nt]", "constant.character.escape.scn"),
                                      match("\\\\.", "invalid.illegal.escape.scn")})}};
}

Json numbers() {
    const std::string number = "\\b[0-9]+(?:\\.[0-9]+)?(?:[eE][+-]?[0-9]+)?";
    return Json::array({match("#[0-9a-fA-F]{6}\\b", "constant.other.color.scn"),
                        match_parts(fmt::format("({})({})\\b", number, any_of(unit_names())),
                                    {"constant.numeric.scn", "keyword.other.unit.scn"}),
                        match(fmt::format("{}\\b", number), "constant.numeric.scn")});
}

Json definitions() {
    return Json::array({match_parts(fmt::format("\\b(fn)\\s+({})", name_pattern),
                                    {"storage.type.scn", "entity.name.function.scn"}),
                        match_parts(fmt::format("\\b(let|param)\\s+({})", name_pattern),
                                    {"storage.type.scn", "variable.other.constant.scn"})});
}

Json constructors(const Schema& schema) {
    std::vector<std::string_view> names;
    for (const Constructor& row : schema.constructors) {
        names.push_back(row.name);
    }
    return Json::array({match(fmt::format("\\b{}(?=\\s*\\{{)", any_of(names)), "support.class.scn")});
}

Json fields(const Schema& schema) {
    std::vector<std::string_view> names;
    for (const Constructor& row : schema.constructors) {
        for (const Field& field : row.fields) {
            names.push_back(field.name);
        }
    }
    return Json::array(
        {match(fmt::format("\\b{}(?=\\s*=(?!=))", any_of(names)), "support.type.property-name.scn"),
         match(fmt::format("\\b{}(?=\\s*=(?!=))", name_pattern), "variable.parameter.scn")});
}

Json functions() {
    return Json::array(
        {match(fmt::format("(?<!\\.)\\b{}(?=\\s*\\()", any_of(function_names())), "support.function.scn"),
         match(fmt::format("(?<!\\.)\\b{}(?=\\()", name_pattern), "entity.name.function.scn")});
}

/// Behind a colon or an arrow there is nothing but a type; elsewhere a type's name may be a field or a thing.
Json types() {
    const std::string name = any_of(type_names());
    return Json::array({match_parts(fmt::format("(:|->)\\s*\\[*({})\\b", name),
                                    {"keyword.operator.scn", "support.type.scn"}),
                        match(fmt::format("(?<!\\.)\\b{}\\b(?!\\s*[={{(.])", name), "support.type.scn")});
}

void append(Json& list, const Json& more) {
    if (more.is_array()) {
        list.insert(list.end(), more.begin(), more.end());
    } else {
        list.push_back(more);
    }
}

} // namespace

std::string textmate_grammar(const Schema& schema) {
    Json patterns = Json::array();
    for (const Json& part : {comments(), strings(), numbers(), definitions(), types(), constructors(schema),
                             reserved_words(), fields(schema), functions()}) {
        append(patterns, part);
    }
    patterns.push_back(match("\\bpi\\b", "constant.language.scn"));
    patterns.push_back(match(fmt::format("(?<=\\.){}", name_pattern), "variable.other.member.scn"));
    append(patterns, operators());
    const Json grammar{
        {"name", "scn"}, {"scopeName", "source.scn"}, {"fileTypes", {"scn"}}, {"patterns", patterns}};
    return grammar.dump(2) + "\n";
}

} // namespace scc::lang::lsp
