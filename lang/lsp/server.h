#pragma once

#include "lang/importer.h"
#include "lang/lsp/channel.h"
#include "lang/lsp/completion.h"
#include "lang/lsp/document.h"
#include "lang/lsp/framing.h"
#include "lang/lsp/imports.h"
#include "lang/lsp/reports.h"
#include "lang/schema.h"

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace scc::lang::lsp {

/// Checks a text that stands for the file at a path.
using CheckScene = std::function<Checked(const std::string& path, const std::string& text)>;

/// The importer of a scene at a path.
using ImporterFor = std::function<std::unique_ptr<Importer>(const std::string& path)>;

/// A server of the Language Server Protocol (3.17). One thread: it takes whatever has arrived before it
/// answers, and checks a document only when nothing waits, so that of many changes only the last is checked.
class Server {
public:
    Server(const Schema& schema, CheckScene check, ImporterFor importer, Channel& channel,
           std::string version)
        : schema_(schema), check_(std::move(check)), importer_(std::move(importer)), channel_(channel),
          version_(std::move(version)) {}

    /// Serves until the client says `exit` or hangs up. True if it asked for `shutdown` before.
    bool run();

private:
    using Handler = Json (Server::*)(const Json& parameters);

    void take_arrived(bool wait);
    void handle(const Json& message);
    void request(const Json& id, const std::string& method, const Json& parameters);
    void notification(const std::string& method, const Json& parameters);
    void refuse_if_not_running(const std::string& method) const;
    bool is_cancelled(const Json& id) const;
    static const std::map<std::string_view, Handler>& requests();
    static const std::map<std::string_view, Handler>& notifications();

    Json initialize(const Json& parameters);
    Json shutdown(const Json& parameters);
    Json completion(const Json& parameters);
    Json hover(const Json& parameters);
    Json definition(const Json& parameters);
    Json references(const Json& parameters);
    Json highlights(const Json& parameters);
    Json prepare_rename(const Json& parameters);
    Json rename(const Json& parameters);
    Json formatting(const Json& parameters);
    Json symbols(const Json& parameters);
    Json code_actions(const Json& parameters);
    Json opened(const Json& parameters);
    Json changed(const Json& parameters);
    Json saved(const Json& parameters);
    Json closed(const Json& parameters);

    Document& document(const Json& parameters);
    /// As the client has the files, if they are open.
    OpenImport imports() const;
    void check(Document& document);
    Document* first_unchecked();

    void send(const Json& message);
    void send_error(const Json& id, ErrorCode code, const std::string& text);
    void tell(const std::string& text);

    enum class State { new_born, running, shut_down };

    const Schema& schema_;
    CheckScene check_;
    ImporterFor importer_;
    Channel& channel_;
    std::string version_;
    Framing framing_;
    std::deque<Json> queue_;
    bool hung_up_ = false;
    bool exited_ = false;
    State state_ = State::new_born;
    Encoding encoding_ = Encoding::utf16;
    CompletionStyle completion_style_;
    DiagnosticStyle diagnostic_style_;
    std::map<std::string, Document> documents_; ///< by URI
};

} // namespace scc::lang::lsp
