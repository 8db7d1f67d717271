#include "lang/schema.h"

namespace scc::lang {

const Field* Constructor::find(std::string_view field) const {
    for (const Field& row : fields) {
        if (row.name == field) {
            return &row;
        }
    }
    return nullptr;
}

const Constructor* Schema::find(std::string_view name) const {
    for (const Constructor& row : constructors) {
        if (row.name == name) {
            return &row;
        }
    }
    return nullptr;
}

} // namespace scc::lang
