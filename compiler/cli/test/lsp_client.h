#pragma once

#include "lang/lsp/framing.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace scc::cli::test {

using Json = nlohmann::json;

/// `scc lsp` as a child process, and the client's side of the protocol. What does not come within the time
/// limit fails the test.
class LspClient {
public:
    LspClient() {
        std::signal(SIGPIPE, SIG_IGN);
        int in[2], out[2];
        if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) {
            ADD_FAILURE() << "no pipe";
            return;
        }
        process_ = fork();
        if (process_ == 0) {
            dup2(in[0], STDIN_FILENO);
            dup2(out[1], STDOUT_FILENO);
            execl(SCC_PROGRAM, SCC_PROGRAM, "lsp", static_cast<char*>(nullptr));
            _exit(127);
        }
        close(in[0]);
        close(out[1]);
        to_ = in[1];
        from_ = out[0];
    }
    LspClient(const LspClient&) = delete;
    LspClient& operator=(const LspClient&) = delete;
    ~LspClient() {
        hang_up();
        close(from_);
        if (process_ > 0) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
    }

    // ---- what is sent ----
    void send_bytes(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t count = write(to_, bytes.data(), bytes.size());
            if (count < 0) {
                ASSERT_EQ(errno, EINTR);
                continue;
            }
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
    }
    void send(const Json& message) { send_bytes(lang::lsp::Framing::framed(message.dump())); }
    void notify(const std::string& method, Json parameters) {
        send({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(parameters)}});
    }
    int ask(const std::string& method, Json parameters) {
        send({{"jsonrpc", "2.0"}, {"id", ++last_id_}, {"method", method}, {"params", std::move(parameters)}});
        return last_id_;
    }
    void hang_up() {
        if (to_ >= 0) {
            close(std::exchange(to_, -1));
        }
    }

    // ---- what comes back ----
    /// The next message; null when the server has hung up or is silent for too long.
    Json receive() {
        for (;;) {
            if (const auto text = framing_.next()) {
                return Json::parse(*text);
            }
            constexpr int limit_ms = 60'000;
            pollfd waited{from_, POLLIN, 0};
            if (poll(&waited, 1, limit_ms) <= 0) {
                ADD_FAILURE() << "no answer within a minute";
                return nullptr;
            }
            char buffer[1 << 16];
            const ssize_t count = read(from_, buffer, sizeof buffer);
            if (count <= 0) {
                return nullptr;
            }
            framing_.add({buffer, static_cast<std::size_t>(count)});
        }
    }
    /// The answer to a request; what the server says in between is kept for `diagnostics`.
    Json answer(int id) {
        for (Json message = receive(); !message.is_null(); message = receive()) {
            if (message.contains("id") && message["id"] == id) {
                return message;
            }
            said_.push_back(std::move(message));
        }
        ADD_FAILURE() << "no answer to request " << id;
        return nullptr;
    }
    Json request(const std::string& method, Json parameters) {
        return answer(ask(method, std::move(parameters)));
    }
    Json result(const std::string& method, Json parameters) {
        const Json message = request(method, std::move(parameters));
        EXPECT_FALSE(message.contains("error")) << message.dump();
        return message.value("result", Json());
    }
    /// The diagnostics of this version of a document, waited for.
    Json diagnostics(const std::string& uri, int version) {
        const auto is_wanted = [&](const Json& message) {
            return message.value("method", "") == "textDocument/publishDiagnostics" &&
                   message["params"]["uri"] == uri && message["params"].value("version", -1) == version;
        };
        for (const Json& message : said_) {
            if (is_wanted(message)) {
                return message["params"]["diagnostics"];
            }
        }
        for (Json message = receive(); !message.is_null(); message = receive()) {
            if (is_wanted(message)) {
                return message["params"]["diagnostics"];
            }
            said_.push_back(std::move(message));
        }
        ADD_FAILURE() << "no diagnostics of version " << version;
        return nullptr;
    }
    const std::vector<Json>& said() const { return said_; }

    // ---- usual exchanges ----
    Json initialize(Json capabilities = Json::object()) {
        const Json answer =
            result("initialize", {{"processId", nullptr}, {"capabilities", std::move(capabilities)}});
        notify("initialized", Json::object());
        return answer;
    }
    void open(const std::string& uri, const std::string& text, int version = 1) {
        notify(
            "textDocument/didOpen",
            {{"textDocument", {{"uri", uri}, {"languageId", "scn"}, {"version", version}, {"text", text}}}});
    }
    void replace_all(const std::string& uri, const std::string& text, int version) {
        notify("textDocument/didChange", {{"textDocument", {{"uri", uri}, {"version", version}}},
                                          {"contentChanges", {{{"text", text}}}}});
    }
    /// The exit status once the process has ended; -1 if a signal ended it.
    int status() {
        int status = 0;
        waitpid(std::exchange(process_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    pid_t process() const { return process_; }

private:
    pid_t process_ = -1;
    int to_ = -1;
    int from_ = -1;
    int last_id_ = 0;
    lang::lsp::Framing framing_;
    std::vector<Json> said_;
};

} // namespace scc::cli::test
