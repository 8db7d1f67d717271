#include "lang/lsp/channel.h"

#include <cerrno>
#include <poll.h>
#include <unistd.h>

namespace scc::lang::lsp {
namespace {

/// Waits until the descriptor is ready, or only asks whether it is. An error counts as ready: the call that
/// follows will tell.
bool ready(int descriptor, short event, bool wait) {
    pollfd waited{descriptor, event, 0};
    int result = 0;
    do {
        result = poll(&waited, 1, wait ? -1 : 0);
    } while (result < 0 && errno == EINTR);
    return result != 0;
}

} // namespace

bool DescriptorChannel::read(std::string& into, bool wait) {
    char buffer[1 << 16];
    while (ready(input_, POLLIN, wait)) {
        const ssize_t count = ::read(input_, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return false;
        }
        into.append(buffer, static_cast<std::size_t>(count));
        wait = false;
    }
    return true;
}

bool DescriptorChannel::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(output_, bytes.data(), bytes.size());
        if (count < 0 && errno == EAGAIN) {
            ready(output_, POLLOUT, true);
        } else if (count < 0 && errno != EINTR) {
            return false;
        } else if (count > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
    }
    return true;
}

} // namespace scc::lang::lsp
