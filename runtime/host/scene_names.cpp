#include "runtime/host/scene_names.h"

#include <algorithm>
#include <span>

namespace scc::host {

namespace {

std::uint64_t append(std::string& names, std::string_view name) {
    const std::uint64_t place = names.size();
    names += name;
    names += '\0';
    return place;
}

template <class T>
std::vector<T> read_list(Values& from) {
    std::span<const T> list;
    from.read(list);
    return {list.begin(), list.end()};
}

} // namespace

void SceneNames::add_objects(Run run, std::string_view name) {
    run.name = append(object_names_, name);
    runs_.push_back(run);
}

void SceneNames::add_material(std::string_view name) {
    material_places_.push_back(append(material_names_, name));
}

std::string SceneNames::object(std::uint32_t id) const {
    auto run = std::upper_bound(runs_.begin(), runs_.end(), id,
                                [](std::uint32_t wanted, const Run& r) { return wanted < r.first; });
    while (run != runs_.begin()) {
        --run;
        const std::uint32_t round = (id - run->first) / run->step;
        if ((id - run->first) % run->step == 0 && round < run->count) {
            return name_at(run->name) +
                   (run->is_numbered == 0
                        ? ""
                        : "[" + std::to_string(run->first_number + round * run->number_step) + "]");
        }
        if (run->count == 1) {
            break; // a single object lies before all that comes later
        }
    }
    return "";
}

std::string SceneNames::material(std::uint32_t index) const {
    return index < material_places_.size() ? material_names_.c_str() + material_places_[index] : "";
}

void SceneNames::write(ValuesWriter& to) const {
    to.add(std::span<const Run>(runs_));
    to.add_text(object_names_);
    to.add(std::span<const std::uint64_t>(material_places_));
    to.add_text(material_names_);
}

void SceneNames::read(Values& from) {
    runs_ = read_list<Run>(from);
    object_names_ = from.read_text();
    material_places_ = read_list<std::uint64_t>(from);
    material_names_ = from.read_text();
}

} // namespace scc::host
