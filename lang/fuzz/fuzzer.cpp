#include "lang/fuzz/targets.h"

#include <cstddef>
#include <cstdint>

/// libFuzzer's entry: SCC_FUZZ_TARGET is one of the functions of targets.h.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    scc::lang::fuzz::SCC_FUZZ_TARGET({reinterpret_cast<const char*>(bytes), size});
    return 0;
}
