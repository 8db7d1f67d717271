#pragma once

#include <string>
#include <string_view>

namespace scc::lang::lsp {

/// The two directions of a connection to a client.
class Channel {
public:
    virtual ~Channel() = default;
    /// Appends what has arrived; with `wait`, waits until there is something. False at the end of the input.
    virtual bool read(std::string& into, bool wait) = 0;
    /// False if the client is gone.
    virtual bool write(std::string_view bytes) = 0;
};

/// A channel over open file descriptors, as of a pipe. The caller ignores SIGPIPE.
class DescriptorChannel final : public Channel {
public:
    DescriptorChannel(int input, int output) : input_(input), output_(output) {}

    bool read(std::string& into, bool wait) override;
    bool write(std::string_view bytes) override;

private:
    int input_;
    int output_;
};

} // namespace scc::lang::lsp
