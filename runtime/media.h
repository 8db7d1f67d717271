#pragma once

#include <cstdint>
#include <vector>

namespace scc::runtime {

/// Which transparent bodies a ray is in, the last one entered on top: where bodies overlap, it is that one
/// whose index of refraction counts. Entering and leaving are told apart by whether the ray is in the body,
/// not by normals. (As POV-Ray's stack of interiors.)
///
/// The lists share their lower parts and never change, so that rays which branch each need no more than the
/// index of their top.
template <class R>
class Media {
public:
    static constexpr std::uint32_t air = 0; ///< in no body

    /// What a ray that goes through a body's surface is in then, and between which indices of refraction.
    struct Crossing {
        std::uint32_t media;
        R from, to;
    };

    Crossing cross(std::uint32_t media, std::uint32_t body, R ior) {
        const R from = list_[media].ior;
        if (media != air && list_[media].body == body) {
            const std::uint32_t outer = list_[media].outer;
            return {outer, from, list_[outer].ior};
        }
        if (has(media, body)) { // covered by what was entered later, and left before it
            return {without(media, body), from, from};
        }
        return {push(media, body, ior), from, ior};
    }

    std::uint32_t push(std::uint32_t media, std::uint32_t body, R ior) {
        list_.push_back({media, body, ior});
        return static_cast<std::uint32_t>(list_.size() - 1);
    }

    /// Forgets all lists but the air.
    void clear() { list_.resize(1); }

private:
    struct Entry {
        std::uint32_t outer, body;
        R ior;
    };

    bool has(std::uint32_t media, std::uint32_t body) const {
        for (; media != air; media = list_[media].outer) {
            if (list_[media].body == body) {
                return true;
            }
        }
        return false;
    }
    std::uint32_t without(std::uint32_t media, std::uint32_t body) {
        std::vector<Entry> above;
        for (; list_[media].body != body; media = list_[media].outer) {
            above.push_back(list_[media]);
        }
        media = list_[media].outer;
        for (; !above.empty(); above.pop_back()) {
            media = push(media, above.back().body, above.back().ior);
        }
        return media;
    }

    std::vector<Entry> list_{{air, ~0U, R(1)}};
};

} // namespace scc::runtime
