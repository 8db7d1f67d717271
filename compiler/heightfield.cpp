#include "compiler/heightfield.h"

#include "compiler/backends/function_program.h"
#include "runtime/math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace scc::compiler {

namespace {

using runtime::Vec3;

/// The corners of the cells, row by row along x.
class Grid {
public:
    Grid(const ir::Function& f, const Heightfield& shape)
        : shape_(shape), columns_(shape.cells_x + 1), rows_(shape.cells_z + 1) {
        const runtime::FunctionProgram<double> program = program_of<double>(f);
        heights_.reserve(columns_ * rows_);
        for (std::size_t j = 0; j < rows_ && !bad_; ++j) {
            for (std::size_t i = 0; i < columns_ && !bad_; ++i) {
                const double u = part(i, columns_), v = part(j, rows_);
                const double value =
                    run(program, runtime::SurfacePoint<double>{{u, v, 0}, {}, {}})[program.results[0]];
                heights_.push_back(shape.height * value);
                if (!std::isfinite(static_cast<float>(heights_.back()))) {
                    bad_ = HeightlessPoint{u, v, value};
                }
            }
        }
    }

    const std::optional<HeightlessPoint>& bad() const { return bad_; }

    ir::MeshArrays arrays() const {
        ir::MeshArrays arrays;
        arrays.positions.reserve(3 * heights_.size());
        arrays.normals.reserve(3 * heights_.size());
        for (std::size_t j = 0; j < rows_; ++j) {
            for (std::size_t i = 0; i < columns_; ++i) {
                append(arrays.positions, {x(i), at(i, j), z(j)});
                append(arrays.normals, normal(i, j));
                arrays.uvs.insert(arrays.uvs.end(), {static_cast<float>(part(i, columns_)),
                                                     static_cast<float>(part(j, rows_))});
            }
        }
        arrays.indices.reserve(6 * (columns_ - 1) * (rows_ - 1));
        for (std::size_t j = 0; j + 1 < rows_; ++j) {
            for (std::size_t i = 0; i + 1 < columns_; ++i) {
                const auto here = static_cast<std::uint32_t>(j * columns_ + i);
                const auto beyond = static_cast<std::uint32_t>(here + columns_);
                arrays.indices.insert(arrays.indices.end(),
                                      {here, beyond, beyond + 1, here, beyond + 1, here + 1});
            }
        }
        arrays.normal_indices = arrays.indices;
        arrays.uv_indices = arrays.indices;
        return arrays;
    }

private:
    static double part(std::size_t i, std::size_t corners) {
        return static_cast<double>(i) / static_cast<double>(corners - 1);
    }
    double x(std::size_t i) const { return shape_.size_x * (part(i, columns_) - 0.5); }
    double z(std::size_t j) const { return shape_.size_z * (part(j, rows_) - 0.5); }
    double at(std::size_t i, std::size_t j) const { return heights_[j * columns_ + i]; }

    /// From the neighbours on both sides, or at the rim on one.
    Vec3<double> normal(std::size_t i, std::size_t j) const {
        const std::size_t left = i > 0 ? i - 1 : i, right = std::min(i + 1, columns_ - 1);
        const std::size_t back = j > 0 ? j - 1 : j, front = std::min(j + 1, rows_ - 1);
        const double slope_x = (at(right, j) - at(left, j)) / (x(right) - x(left));
        const double slope_z = (at(i, front) - at(i, back)) / (z(front) - z(back));
        return normalize(Vec3<double>{-slope_x, 1, -slope_z});
    }
    static void append(std::vector<float>& to, const Vec3<double>& v) {
        to.insert(to.end(), {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    }

    const Heightfield& shape_;
    std::size_t columns_, rows_;
    std::vector<double> heights_;
    std::optional<HeightlessPoint> bad_;
};

} // namespace

HeightfieldMesh heightfield_mesh(std::string name, const ir::Function& f, const Heightfield& shape) {
    const Grid grid(f, shape);
    return {ir::make_mesh(std::move(name), grid.bad() ? ir::MeshArrays{} : grid.arrays()), grid.bad()};
}

} // namespace scc::compiler
