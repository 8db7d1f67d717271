#pragma once

#include "runtime/host/values.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scc::host {

/// How the objects and materials of a scene are called, by the numbers that the renderer knows them by.
class SceneNames {
public:
    /// Objects whose Tag::id are first, first + step, ...: of one, `name` is the path; of several that a loop
    /// made, the path without its number.
    struct Run {
        std::uint32_t first = 0;
        std::uint32_t step = 1;
        std::uint32_t count = 1;
        std::uint32_t is_numbered = 0;
        std::uint64_t first_number = 0;
        std::uint64_t number_step = 1;
        std::uint64_t name = 0; ///< where it begins in the text of all names
    };

    /// In the order of `first`. Runs of more than one object that follow each other are of one loop, and
    /// their ids take turns.
    void add_objects(Run run, std::string_view name);
    void add_material(std::string_view name);

    /// Of a Tag::id of an object; "" for none.
    std::string object(std::uint32_t id) const;
    /// Of an index in the scene's table; "" for none.
    std::string material(std::uint32_t index) const;

    void write(ValuesWriter& to) const;
    void read(Values& from);

private:
    std::string name_at(std::uint64_t place) const { return object_names_.c_str() + place; }

    std::vector<Run> runs_;
    std::string object_names_;                   ///< each ends with a zero
    std::vector<std::uint64_t> material_places_; ///< in their names
    std::string material_names_;                 ///< likewise
};

} // namespace scc::host
