#pragma once

#include "lang/ast.h"
#include "lang/diagnostic.h"
#include "lang/lexer.h"
#include "lang/lsp/json.h"
#include "lang/lsp/positions.h"
#include "lang/schema.h"
#include "lang/source.h"
#include "lang/symbols.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scc::lang::lsp {

/// `file:` URIs and paths. Of other URIs the path is the URI's last part, in the working directory.
std::string path_of(std::string_view uri);
std::string uri_of(std::string_view path);

/// A text with what its names stand for; nothing in it is evaluated.
struct Analysis {
    Analysis(const std::string& path, std::string text, const Schema& known);
    Analysis(const Analysis&) = delete;
    Analysis& operator=(const Analysis&) = delete;

    std::string_view text() const { return sources.file(file).text(); }
    std::string_view text(Span span) const { return sources.text(span); }

    const Schema& schema;
    SourceSet sources;
    FileId file;
    Diagnostics syntax; ///< of lexer and parser
    std::vector<Token> tokens;
    std::shared_ptr<const ast::File> tree;
    SymbolIndex symbols;
};

/// A thing of the evaluated scene.
struct ObjectPlace {
    std::uint32_t begin; ///< of the constructor that made it
    std::string path;    ///< `table/leg[2]`
    std::size_t count;   ///< of things that this place made
};

/// What the compiler says of a scene; its text is the first of the files.
struct Checked {
    SourceSet sources;
    std::vector<Diagnostic> diagnostics;
    std::vector<ObjectPlace> objects;
};

/// An open file as the client has it.
class Document {
public:
    Document(std::string uri, std::int64_t version, std::string text, Encoding encoding)
        : uri_(std::move(uri)), path_(path_of(uri_)), version_(version), text_(std::move(text)),
          encoding_(encoding) {}

    const std::string& uri() const { return uri_; }
    const std::string& path() const { return path_; }
    const std::string& text() const { return text_; }
    std::int64_t version() const { return version_; }
    Encoding encoding() const { return encoding_; }

    /// A `contentChanges` array: ranges to be replaced, each in the text that the one before left, or whole
    /// texts.
    void change(const Json& changes, std::int64_t version);

    const Analysis& analysis(const Schema& schema);
    const Positions& positions();
    std::uint32_t offset(const Json& position) { return positions().offset(read_place(position)); }
    Json range(std::uint32_t begin, std::uint32_t end);
    Json range(Span span) { return range(span.begin, span.end); }

    /// Of the present text; empty until it has been checked.
    std::optional<Checked> checked;

private:
    static Place read_place(const Json& position);
    void forget();

    std::string uri_;
    std::string path_;
    std::int64_t version_;
    std::string text_;
    Encoding encoding_;
    std::optional<Positions> positions_;
    std::unique_ptr<Analysis> analysis_;
};

Json range_in(const Positions& positions, std::uint32_t begin, std::uint32_t end);

} // namespace scc::lang::lsp
