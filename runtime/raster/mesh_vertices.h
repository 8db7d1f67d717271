#pragma once

#include "runtime/mesh_data.h"
#include "runtime/raster/model.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scc::runtime::raster {

/// `parts`: as RasterModel::mesh_parts has them.
inline MeshVertices shared_vertices(const MeshData& mesh, const std::vector<std::uint32_t>& parts) {
    if (mesh.normals == nullptr) {
        return {};
    }
    MeshVertices result;
    result.positions.resize(std::size_t{3} * mesh.normal_count);
    result.of_corners.reserve(3 * parts.size());
    std::vector<bool> is_known(mesh.normal_count);
    for (const std::uint32_t part : parts) {
        const TrianglePlace place = place_of(part);
        const std::uint32_t* const normals = mesh.normal_indices + std::size_t{3} * triangle_id(mesh, place);
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t vertex = normals[c];
            float* const known = &result.positions[std::size_t{3} * vertex];
            const float* const normal = mesh.normals + std::size_t{3} * vertex;
            if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0) {
                return {}; // each triangle has its own
            }
            for (std::uint32_t i = 0; i < 3; ++i) {
                const float coordinate = *triangle_word(mesh, place, 3 * c + i);
                if (is_known[vertex] && known[i] != coordinate) {
                    return {};
                }
                known[i] = coordinate;
            }
            is_known[vertex] = true;
            result.of_corners.push_back(vertex);
        }
    }
    return result;
}

} // namespace scc::runtime::raster
