#include "runtime/test/tracing.h"

namespace scc::runtime {

SCC_TRACING()

} // namespace scc::runtime
