#include "compiler/field_bounds.h"

#include "compiler/backends/function_program.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace scc::compiler {

namespace {

using ir::Op;
using runtime::Bounds;
using runtime::Interval;
using runtime::Vec3;
using Range = Interval<double>;

constexpr int most_halvings = 24; ///< 8 of each axis
constexpr int most_boxes = 200'000;

struct Part {
    Bounds<double> box;
    int halvings = 0;
};

void halve(const Part& part, std::vector<Part>& parts) {
    const Vec3<double> size = part.box.max - part.box.min;
    double Vec3<double>::*const axis = size.x >= size.y && size.x >= size.z ? &Vec3<double>::x
                                       : size.y >= size.z                   ? &Vec3<double>::y
                                                                            : &Vec3<double>::z;
    Part low = part, high = part;
    low.box.max.*axis = high.box.min.*axis = (part.box.min.*axis + part.box.max.*axis) / 2;
    low.halvings = high.halvings = part.halvings + 1;
    parts.push_back(high);
    parts.push_back(low);
}

/// A box outside a sphere; other containers are taken for their boxes.
bool is_outside(const Bounds<double>& box, const runtime::Container<double>& container) {
    if (container.kind != runtime::Container<double>::Kind::sphere) {
        return false;
    }
    const Vec3<double> nearest = minimum(maximum(container.first, box.min), box.max);
    return length(nearest - container.first) > container.radius * (1 + 1e-12);
}

template <class T>
runtime::SurfacePoint<T> point_of(const T& x, const T& y, const T& z) {
    return {{x, y, z}, {}, {}};
}

bool is_finite(const Range& range) {
    constexpr double most = 1e290; // beyond, products of bounds overflow
    return range.min > -most && range.max < most;
}

/// What the operation does where its operands have these ranges, if that may be no number; else "".
std::string objection(Op op, const Range& result, const Range& a, const Range& b) {
    constexpr double slack = 1e-12; // of the operand's own rounding
    const double about = slack * (1 + std::abs(a.min) + std::abs(a.max));
    switch (op) {
    case Op::sqrt:
        return a.min < -about ? "this takes the square root of negative numbers" : "";
    case Op::log:
        return a.min <= 0 ? "this takes the logarithm of 0 or less" : "";
    case Op::asin:
    case Op::acos:
        return a.min < -1 - about || a.max > 1 + about ? "this takes the arc of numbers beyond -1 and 1" : "";
    case Op::pow:
        if (a.min < -about && !(b.min == b.max && b.min == std::floor(b.min))) {
            return "this raises negative numbers to powers that are not whole";
        }
        return is_finite(result) ? "" : "this power has no bounds";
    case Op::div:
    case Op::mod:
        return b.min <= 0 && b.max >= 0 ? "this divides by 0"
               : is_finite(result)      ? ""
                                        : "this quotient has no bounds";
    case Op::tan:
        return is_finite(result) ? "" : "this tangent has a pole";
    default:
        return is_finite(result) ? "" : "this is too large for a number";
    }
}

/// The nodes that the result depends on where these conditions hold.
std::vector<bool> reached(const ir::Function& function, const Range* ranges) {
    std::vector<bool> needed(function.nodes.size());
    needed[function.results[0]] = true;
    for (std::size_t i = function.nodes.size(); i-- > 0;) {
        const ir::Node& node = function.nodes[i];
        for (std::size_t k = 0; needed[i] && k < arity(node); ++k) {
            if (node.kind == ir::Node::Kind::apply && node.op == Op::select) {
                const Range& condition = ranges[node.operands[0]];
                const bool is_true = condition.min > 0, is_false = condition.max == 0;
                if ((k == 1 && is_false) || (k == 2 && is_true)) {
                    continue;
                }
            }
            needed[node.operands[k]] = true;
        }
    }
    return needed;
}

std::optional<Unbounded> objection_in(const ir::Function& function, const Range* ranges) {
    const std::vector<bool> needed = reached(function, ranges);
    for (std::size_t i = 0; i < function.nodes.size(); ++i) {
        const ir::Node& node = function.nodes[i];
        if (!needed[i] || node.kind != ir::Node::Kind::apply) {
            continue;
        }
        std::string what = objection(node.op, ranges[i], ranges[node.operands[0]], ranges[node.operands[1]]);
        if (!what.empty()) {
            return Unbounded{function.places[i], std::move(what)};
        }
    }
    return std::nullopt;
}

} // namespace

std::optional<Unbounded> find_unbounded(const ir::Function& field,
                                        const runtime::Container<double>& container) {
    const auto program = program_of<double>(field);
    std::vector<Part> parts{{container.bounds(), 0}};
    for (int count = 0; !parts.empty(); ++count) {
        const Part part = parts.back();
        parts.pop_back();
        if (is_outside(part.box, container)) {
            continue;
        }
        const Bounds<double>& b = part.box;
        const Range* ranges =
            run(program, point_of<Range>({b.min.x, b.max.x}, {b.min.y, b.max.y}, {b.min.z, b.max.z}));
        if (auto found = objection_in(field, ranges)) {
            if (part.halvings == most_halvings || count > most_boxes) {
                return found;
            }
            halve(part, parts);
        }
    }
    return std::nullopt;
}

Steepness gradient_bound(const ir::Function& field, const Bounds<double>& box) {
    using D = runtime::Dual<Range, 3>;
    constexpr int halvings = 12; // 16 parts along each axis
    constexpr int most_where_steep = 21;
    const auto program = program_of<double>(field);
    std::vector<Part> parts{{box, 0}};
    Steepness result;
    while (!parts.empty()) {
        const Part part = parts.back();
        parts.pop_back();
        if (part.halvings < halvings) {
            halve(part, parts);
            continue;
        }
        const Bounds<double>& b = part.box;
        const D* registers =
            run(program, point_of<D>(D::variable({b.min.x, b.max.x}, 0), D::variable({b.min.y, b.max.y}, 1),
                                     D::variable({b.min.z, b.max.z}, 2)));
        const D& value = registers[program.results[0]];
        double squared = 0;
        for (const Range& slope : value.d) {
            const double steepest = std::max(std::abs(slope.min), std::abs(slope.max));
            squared += steepest * steepest;
        }
        if (std::isfinite(squared)) {
            result.bound = std::max(result.bound, std::sqrt(squared));
        } else if (part.halvings < most_where_steep) {
            halve(part, parts);
        } else {
            const bool is_zero = value.v.min <= 0 && value.v.max >= 0;
            (is_zero ? result.at_zero : result.elsewhere) = true;
        }
    }
    return result;
}

} // namespace scc::compiler
