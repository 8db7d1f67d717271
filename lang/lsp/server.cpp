#include "lang/lsp/server.h"

#include "lang/format.h"
#include "lang/lsp/navigation.h"
#include "lang/lsp/outline.h"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <initializer_list>

namespace scc::lang::lsp {
namespace {

/// The value at a path of keys; null if the client did not send it.
Json find(const Json& json, std::initializer_list<const char*> keys) {
    const Json* at = &json;
    for (const char* key : keys) {
        const auto found = at->is_object() ? at->find(key) : at->end();
        if (found == at->end()) {
            return nullptr;
        }
        at = &*found;
    }
    return *at;
}

bool is_set(const Json& json, std::initializer_list<const char*> keys) {
    return find(json, keys) == true;
}

Encoding chosen_encoding(const Json& capabilities) {
    const Json offered = find(capabilities, {"general", "positionEncodings"});
    const bool has_utf8 = std::find(offered.begin(), offered.end(), Json("utf-8")) != offered.end();
    return has_utf8 ? Encoding::utf8 : Encoding::utf16;
}

/// The replacement of the lines that differ, which leaves the client's cursor where it is.
Json edits_between(Document& document, std::string_view wanted) {
    const std::string_view text = document.text();
    if (text == wanted) {
        return Json::array();
    }
    std::size_t begin = static_cast<std::size_t>(
        std::mismatch(text.begin(), text.end(), wanted.begin(), wanted.end()).first - text.begin());
    begin = begin == 0 ? 0 : text.rfind('\n', begin - 1) + 1; // npos + 1 is 0
    std::size_t same = static_cast<std::size_t>(
        std::mismatch(text.rbegin(), text.rend(), wanted.rbegin(), wanted.rend()).first - text.rbegin());
    same = std::min(same, std::min(text.size(), wanted.size()) - begin);
    const std::size_t line = text.find('\n', text.size() - same);
    same = line == std::string_view::npos ? 0 : text.size() - line - 1;
    const auto end = static_cast<std::uint32_t>(text.size() - same);
    return {{{"range", document.range(static_cast<std::uint32_t>(begin), end)},
             {"newText", wanted.substr(begin, wanted.size() - same - begin)}}};
}

} // namespace

bool Server::run() {
    while (!exited_) {
        const bool is_idle = queue_.empty() && first_unchecked() == nullptr;
        if (is_idle && hung_up_) {
            break;
        }
        take_arrived(is_idle);
        if (!queue_.empty()) {
            const Json message = std::move(queue_.front());
            queue_.pop_front();
            handle(message);
        } else if (Document* document = first_unchecked()) {
            check(*document);
        }
    }
    return state_ == State::shut_down;
}

void Server::take_arrived(bool wait) {
    if (hung_up_) {
        return;
    }
    std::string bytes;
    hung_up_ = !channel_.read(bytes, wait);
    framing_.add(bytes);
    while (const auto text = framing_.next()) {
        Json message = Json::parse(*text, nullptr, false);
        if (message.is_discarded()) {
            send_error(nullptr, ErrorCode::parse_error, "this is not JSON");
        } else {
            queue_.push_back(std::move(message));
        }
    }
}

void Server::handle(const Json& message) {
    const bool is_message =
        message.is_object() && message.contains("method") && message["method"].is_string();
    const Json id = message.is_object() ? message.value("id", Json()) : Json();
    if (!is_message) {
        const bool is_response =
            message.is_object() && (message.contains("result") || message.contains("error"));
        if (!is_response) { // we ask nothing of clients, but some answer all the same
            send_error(nullptr, ErrorCode::invalid_request, "this is no request");
        }
        return;
    }
    const auto& method = message["method"].get_ref<const std::string&>();
    const Json parameters = message.value("params", Json::object());
    if (id.is_null()) {
        notification(method, parameters);
    } else if (id.is_string() || id.is_number_integer()) {
        request(id, method, parameters);
    } else {
        send_error(nullptr, ErrorCode::invalid_request, "an id is a whole number or a string");
    }
}

void Server::request(const Json& id, const std::string& method, const Json& parameters) {
    if (is_cancelled(id)) {
        return send_error(id, ErrorCode::request_cancelled, "the client cancelled this");
    }
    try {
        refuse_if_not_running(method);
        const auto handler = requests().find(method);
        if (handler == requests().end()) {
            throw RequestError(ErrorCode::method_not_found, fmt::format("there is no method `{}`", method));
        }
        send({{"jsonrpc", "2.0"}, {"id", id}, {"result", (this->*handler->second)(parameters)}});
    } catch (const RequestError& error) {
        send_error(id, error.code, error.what());
    } catch (const Json::exception& error) {
        send_error(id, ErrorCode::invalid_params, error.what());
    } catch (const std::exception& error) {
        send_error(id, ErrorCode::internal_error, error.what());
    }
}

void Server::refuse_if_not_running(const std::string& method) const {
    if (state_ == State::shut_down) {
        throw RequestError(ErrorCode::invalid_request, "the server has been shut down");
    }
    if (state_ == State::new_born && method != "initialize") {
        throw RequestError(ErrorCode::server_not_initialized, "the first request is `initialize`");
    }
    if (state_ == State::running && method == "initialize") {
        throw RequestError(ErrorCode::invalid_request, "`initialize` was sent already");
    }
}

bool Server::is_cancelled(const Json& id) const {
    return std::any_of(queue_.begin(), queue_.end(), [&](const Json& message) {
        return find(message, {"method"}) == "$/cancelRequest" && find(message, {"params", "id"}) == id;
    });
}

/// What is wrong with a notification is nobody's to answer.
void Server::notification(const std::string& method, const Json& parameters) {
    if (method == "exit") {
        exited_ = true;
        return;
    }
    const auto handler = notifications().find(method);
    if (state_ != State::running || handler == notifications().end()) {
        return;
    }
    try {
        (this->*handler->second)(parameters);
    } catch (const std::exception& error) {
        tell(fmt::format("{}: {}", method, error.what()));
    }
}

const std::map<std::string_view, Server::Handler>& Server::requests() {
    static const std::map<std::string_view, Handler> table{
        {"initialize", &Server::initialize},
        {"shutdown", &Server::shutdown},
        {"textDocument/completion", &Server::completion},
        {"textDocument/hover", &Server::hover},
        {"textDocument/definition", &Server::definition},
        {"textDocument/references", &Server::references},
        {"textDocument/documentHighlight", &Server::highlights},
        {"textDocument/prepareRename", &Server::prepare_rename},
        {"textDocument/rename", &Server::rename},
        {"textDocument/formatting", &Server::formatting},
        {"textDocument/documentSymbol", &Server::symbols},
        {"textDocument/codeAction", &Server::code_actions},
    };
    return table;
}

const std::map<std::string_view, Server::Handler>& Server::notifications() {
    static const std::map<std::string_view, Handler> table{
        {"textDocument/didOpen", &Server::opened},
        {"textDocument/didChange", &Server::changed},
        {"textDocument/didSave", &Server::saved},
        {"textDocument/didClose", &Server::closed},
    };
    return table;
}

// ---- life ----------------------------------------------------------------------------------------------

Json Server::initialize(const Json& parameters) {
    const Json capabilities = parameters.value("capabilities", Json::object());
    encoding_ = chosen_encoding(capabilities);
    completion_style_.snippets =
        is_set(capabilities, {"textDocument", "completion", "completionItem", "snippetSupport"});
    diagnostic_style_.related =
        is_set(capabilities, {"textDocument", "publishDiagnostics", "relatedInformation"});
    state_ = State::running;
    constexpr int incremental = 2;
    return {{"serverInfo", {{"name", "scc"}, {"version", version_}}},
            {"capabilities",
             {{"positionEncoding", encoding_ == Encoding::utf8 ? "utf-8" : "utf-16"},
              {"textDocumentSync", {{"openClose", true}, {"change", incremental}, {"save", true}}},
              {"completionProvider", {{"triggerCharacters", {".", "\""}}}},
              {"hoverProvider", true},
              {"definitionProvider", true},
              {"referencesProvider", true},
              {"documentHighlightProvider", true},
              {"renameProvider", {{"prepareProvider", true}}},
              {"documentFormattingProvider", true},
              {"documentSymbolProvider", true},
              {"codeActionProvider", {{"codeActionKinds", {"quickfix", "source.fixAll"}}}}}}};
}

Json Server::shutdown(const Json&) {
    state_ = State::shut_down;
    documents_.clear();
    return nullptr;
}

// ---- documents -----------------------------------------------------------------------------------------

Document& Server::document(const Json& parameters) {
    const auto& uri = parameters.at("textDocument").at("uri").get_ref<const std::string&>();
    const auto found = documents_.find(uri);
    if (found == documents_.end()) {
        throw RequestError(ErrorCode::invalid_params, fmt::format("`{}` is not open", uri));
    }
    return found->second;
}

Document* Server::first_unchecked() {
    for (auto& [uri, document] : documents_) {
        if (!document.checked) {
            return &document;
        }
    }
    return nullptr;
}

Json Server::opened(const Json& parameters) {
    const Json& item = parameters.at("textDocument");
    const auto& uri = item.at("uri").get_ref<const std::string&>();
    documents_.insert_or_assign(uri, Document(uri, item.value("version", std::int64_t{0}),
                                              item.at("text").get<std::string>(), encoding_));
    return nullptr;
}

Json Server::changed(const Json& parameters) {
    const auto version = parameters.at("textDocument").value("version", std::int64_t{0});
    document(parameters).change(parameters.at("contentChanges"), version);
    return nullptr;
}

/// What is saved may be read by other scenes.
Json Server::saved(const Json&) {
    for (auto& [uri, document] : documents_) {
        document.checked.reset();
    }
    return nullptr;
}

Json Server::closed(const Json& parameters) {
    const std::string uri = document(parameters).uri();
    documents_.erase(uri);
    send({{"jsonrpc", "2.0"},
          {"method", "textDocument/publishDiagnostics"},
          {"params", {{"uri", uri}, {"diagnostics", Json::array()}}}});
    return nullptr;
}

/// Checks what has not been checked in this state, and publishes it.
void Server::check(Document& document) {
    if (document.checked) {
        return;
    }
    try {
        document.checked = check_(document.path(), document.text());
    } catch (const std::exception& error) {
        document.checked.emplace();
        tell(fmt::format("{} could not be checked: {}", document.path(), error.what()));
    }
    send({{"jsonrpc", "2.0"},
          {"method", "textDocument/publishDiagnostics"},
          {"params", published(document, diagnostic_style_)}});
}

OpenImport Server::imports() const {
    return [this](const std::string& from, const std::string& name) -> std::optional<SceneText> {
        const std::unique_ptr<Importer> importer = importer_(from);
        const ImportTarget target = importer->find(from, name);
        if (target.status != ImportTarget::Status::found) {
            return std::nullopt;
        }
        if (const auto open = documents_.find(uri_of(target.path)); open != documents_.end()) {
            return SceneText{target.path, open->second.text()};
        }
        ImportText read = importer->read(target);
        return read.problem.empty() ? std::optional(SceneText{target.path, std::move(read.text)})
                                    : std::nullopt;
    };
}

// ---- requests ------------------------------------------------------------------------------------------

Json Server::completion(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::completion(open, schema_, imports(), open.offset(parameters.at("position")),
                           completion_style_);
}

Json Server::hover(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::hover(open, schema_, imports(), open.offset(parameters.at("position")));
}

Json Server::definition(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::definition(open, schema_, imports(), open.offset(parameters.at("position")));
}

Json Server::references(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::references(open, schema_, open.offset(parameters.at("position")),
                           is_set(parameters, {"context", "includeDeclaration"}));
}

Json Server::highlights(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::highlights(open, schema_, open.offset(parameters.at("position")));
}

Json Server::prepare_rename(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::prepare_rename(open, schema_, open.offset(parameters.at("position")));
}

Json Server::rename(const Json& parameters) {
    Document& open = document(parameters);
    return lsp::rename(open, schema_, open.offset(parameters.at("position")),
                       parameters.at("newName").get<std::string>());
}

Json Server::formatting(const Json& parameters) {
    Document& open = document(parameters);
    const Analysis& analysis = open.analysis(schema_);
    if (analysis.syntax.has_errors()) {
        return nullptr;
    }
    return edits_between(open, checked_format(analysis.sources, analysis.tokens, *analysis.tree));
}

Json Server::symbols(const Json& parameters) {
    Document& open = document(parameters);
    check(open);
    return outline(open, schema_);
}

Json Server::code_actions(const Json& parameters) {
    Document& open = document(parameters);
    check(open);
    const Json& range = parameters.at("range");
    return lsp::code_actions(open, open.offset(range.at("start")), open.offset(range.at("end")),
                             diagnostic_style_);
}

// ---- out -----------------------------------------------------------------------------------------------

void Server::send(const Json& message) {
    const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    hung_up_ = !channel_.write(Framing::framed(text)) || hung_up_;
}

void Server::send_error(const Json& id, ErrorCode code, const std::string& text) {
    send({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}});
}

void Server::tell(const std::string& text) {
    constexpr int error = 1; // MessageType
    send({{"jsonrpc", "2.0"},
          {"method", "window/logMessage"},
          {"params", {{"type", error}, {"message", text}}}});
}

} // namespace scc::lang::lsp
