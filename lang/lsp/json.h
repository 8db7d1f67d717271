#pragma once

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>

namespace scc::lang::lsp {

using Json = nlohmann::json;

/// Error codes of JSON-RPC and of the Language Server Protocol.
enum class ErrorCode {
    parse_error = -32700,
    invalid_request = -32600,
    method_not_found = -32601,
    invalid_params = -32602,
    internal_error = -32603,
    server_not_initialized = -32002,
    request_cancelled = -32800,
    request_failed = -32803,
};

/// Answers a request with an error.
struct RequestError : std::runtime_error {
    RequestError(ErrorCode error, const std::string& text) : std::runtime_error(text), code(error) {}

    ErrorCode code;
};

} // namespace scc::lang::lsp
