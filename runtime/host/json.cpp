#include "runtime/host/json.h"

#include <charconv>

namespace scc::host {

std::string json(double number) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, number);
    return {text, end};
}
std::string json(std::uint64_t number) {
    return std::to_string(number);
}
std::string json(int number) {
    return std::to_string(number);
}
std::string json(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < 0x20) {
            quoted += std::string("\\u00") + (c < 0x10 ? '0' : '1') + "0123456789abcdef"[c & 15];
        } else {
            quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
        }
    }
    return quoted + '"';
}

} // namespace scc::host
