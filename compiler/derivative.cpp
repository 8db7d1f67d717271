#include "compiler/derivative.h"

#include "compiler/function_builder.h"
#include "lang/scalar_math.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace scc::compiler {

namespace {

using ir::Op;
using lang::Scalar;
using lang::ScalarMath;
using lang::ScalarOp;

/// Forward differentiation: of each node its value and its derivatives by the three coordinates.
class Differentiator {
public:
    explicit Differentiator(const ir::Function& function) : function_(function), math_(&builder_) {}

    ir::Function run() {
        for (std::uint32_t i = 0; i < function_.nodes.size(); ++i) {
            builder_.locate(function_.places[i]);
            add(function_.nodes[i]);
        }
        const Derived& result = nodes_[function_.results[0]];
        ir::Function made =
            builder_.finish({result.value, result.slopes[0], result.slopes[1], result.slopes[2]});
        made.name = function_.name;
        return made;
    }

private:
    struct Derived {
        Scalar value;
        std::array<Scalar, 3> slopes{};
    };

    void add(const ir::Node& node) {
        Derived derived;
        switch (node.kind) {
        case ir::Node::Kind::constant:
            derived.value = {node.constant};
            break;
        case ir::Node::Kind::input:
            derived.value = {0, builder_.input(ir::name(node.input))};
            if (node.input <= ir::Input::p_z) {
                derived.slopes[static_cast<std::size_t>(node.input)] = {1};
            }
            break;
        case ir::Node::Kind::apply:
            derived = applied(node);
            break;
        case ir::Node::Kind::image:
            derived = looked_up(node);
            break;
        }
        nodes_.push_back(derived);
    }

    /// Between the centres of two texels an image that is blended is linear along the axis: its slope is the
    /// difference of what it is at these.
    Derived looked_up(const ir::Node& node) {
        const std::shared_ptr<const ir::Image>& image = function_.images[node.image];
        const std::array<Derived, 2> uv{nodes_[node.operands[0]], nodes_[node.operands[1]]};
        const auto look_up = [&](const Scalar& u, const Scalar& v) {
            return Scalar{0, builder_.look_up(image, node.channel, node_of(u), node_of(v))};
        };
        Derived result{look_up(uv[0].value, uv[1].value)};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto& slopes = uv[axis].slopes;
            if (image->data.filter == runtime::Filter::nearest ||
                std::all_of(slopes.begin(), slopes.end(), is_zero)) {
                continue;
            }
            const double texels = axis == 0 ? image->data.width : image->data.height;
            const Scalar before =
                one(ScalarOp::floor, math_.apply(ScalarOp::sub, product({texels}, uv[axis].value), {0.5}));
            const auto at_center = [&](double step) {
                const Scalar center = quotient(sum(before, {step + 0.5}), {texels});
                return axis == 0 ? look_up(center, uv[1].value) : look_up(uv[0].value, center);
            };
            const Scalar slope = product({texels}, difference(at_center(1), at_center(0)));
            for (std::size_t i = 0; i < 3; ++i) {
                result.slopes[i] = sum(result.slopes[i], product(slope, slopes[i]));
            }
        }
        return result;
    }

    std::uint32_t node_of(const Scalar& x) { return x.is_constant() ? builder_.constant(x.value) : x.symbol; }

    Derived applied(const ir::Node& node) {
        const Derived a = nodes_[node.operands[0]], b = nodes_[node.operands[1]],
                      c = nodes_[node.operands[2]];
        Derived result{value_of(node, a.value, b.value, c.value)};
        for (std::size_t i = 0; i < 3; ++i) {
            const int arity = row(node.op).arity;
            const Scalar none{}, da = a.slopes[i], db = arity > 1 ? b.slopes[i] : none,
                                 dc = arity > 2 ? c.slopes[i] : none;
            if (!is_zero(da) || !is_zero(db) || !is_zero(dc)) {
                result.slopes[i] = slope(node.op, result.value, a.value, b.value, da, db, dc);
            }
        }
        return result;
    }
    Scalar value_of(const ir::Node& node, const Scalar& a, const Scalar& b, const Scalar& c) {
        if (node.op == Op::square) {
            return math_.apply(ScalarOp::mul, a, a);
        }
        const ScalarOp op = lang::scalar_op(row(node.op).name);
        switch (row(node.op).arity) {
        case 1:
            return math_.apply(op, a);
        case 2:
            return math_.apply(op, a, b);
        default:
            return op == ScalarOp::select ? math_.select(a, b, c) : math_.apply(op, a, b, c);
        }
    }

    static bool is_zero(const Scalar& x) { return x.is_constant() && x.value == 0; }
    static bool is_one(const Scalar& x) { return x.is_constant() && x.value == 1; }
    Scalar sum(const Scalar& a, const Scalar& b) {
        return is_zero(a) ? b : is_zero(b) ? a : math_.apply(ScalarOp::add, a, b);
    }
    Scalar negated(const Scalar& a) { return is_zero(a) ? a : math_.apply(ScalarOp::neg, a); }
    Scalar difference(const Scalar& a, const Scalar& b) {
        return is_zero(a) ? negated(b) : is_zero(b) ? a : math_.apply(ScalarOp::sub, a, b);
    }
    Scalar product(const Scalar& a, const Scalar& b) {
        return is_zero(a) || is_zero(b) ? Scalar{}
               : is_one(a)              ? b
               : is_one(b)              ? a
                                        : math_.apply(ScalarOp::mul, a, b);
    }
    Scalar quotient(const Scalar& a, const Scalar& b) {
        return is_zero(a) ? a : math_.apply(ScalarOp::div, a, b);
    }
    Scalar one(ScalarOp op, const Scalar& a) { return math_.apply(op, a); }

    /// By one coordinate; `value` is the operation's own.
    Scalar slope(Op op, const Scalar& value, const Scalar& a, const Scalar& b, const Scalar& da,
                 const Scalar& db, const Scalar& dc) {
        const Scalar unit{1};
        switch (op) {
        case Op::neg:
            return negated(da);
        case Op::add:
            return sum(da, db);
        case Op::sub:
            return difference(da, db);
        case Op::mul:
            return sum(product(da, b), product(a, db));
        case Op::square:
            return product(product({2}, a), da);
        case Op::div:
            return quotient(difference(da, product(value, db)), b);
        case Op::mod:
            return difference(da, product(one(ScalarOp::floor, math_.apply(ScalarOp::div, a, b)), db));
        case Op::pow:
            return power_slope(value, a, b, da, db);
        case Op::min:
            return math_.select(math_.apply(ScalarOp::lt, b, a), db, da);
        case Op::max:
            return math_.select(math_.apply(ScalarOp::gt, b, a), db, da);
        case Op::abs:
            return math_.select(math_.apply(ScalarOp::lt, a, {0}), negated(da), da);
        case Op::sqrt:
            return quotient(da, product({2}, value));
        case Op::sin:
            return product(one(ScalarOp::cos, a), da);
        case Op::cos:
            return negated(product(one(ScalarOp::sin, a), da));
        case Op::tan:
            return product(sum(unit, product(value, value)), da);
        case Op::asin:
            return quotient(da, one(ScalarOp::sqrt, difference(unit, product(a, a))));
        case Op::acos:
            return negated(quotient(da, one(ScalarOp::sqrt, difference(unit, product(a, a)))));
        case Op::atan2:
            return quotient(difference(product(b, da), product(a, db)), sum(product(a, a), product(b, b)));
        case Op::exp:
            return product(value, da);
        case Op::log:
            return quotient(da, a);
        case Op::select:
            return math_.select(a, db, dc);
        default:
            return {}; // steps, conditions and random numbers
        }
    }
    Scalar power_slope(const Scalar& value, const Scalar& a, const Scalar& b, const Scalar& da,
                       const Scalar& db) {
        const Scalar less = math_.apply(ScalarOp::sub, b, {1});
        const Scalar by_base = product(product(b, math_.apply(ScalarOp::pow, a, less)), da);
        return is_zero(db) ? by_base : sum(by_base, product(product(value, one(ScalarOp::log, a)), db));
    }

    const ir::Function& function_;
    FunctionBuilder builder_;
    ScalarMath math_;
    std::vector<Derived> nodes_;
};

/// Whether it varies in steps only.
bool is_step(Op op) {
    switch (op) {
    case Op::floor:
    case Op::ceil:
    case Op::eq:
    case Op::ne:
    case Op::lt:
    case Op::le:
    case Op::gt:
    case Op::ge:
    case Op::logical_and:
    case Op::logical_or:
    case Op::logical_not:
    case Op::random:
        return true;
    default:
        return false;
    }
}

} // namespace

std::optional<ir::Function> with_gradient(const ir::Function& function) {
    const bool has_unknown =
        std::any_of(function.nodes.begin(), function.nodes.end(), [](const ir::Node& node) {
            return node.kind == ir::Node::Kind::apply && node.op == Op::noise;
        });
    return has_unknown ? std::nullopt : std::optional(Differentiator(function).run());
}

bool has_slope(const ir::Function& function) {
    std::vector<bool> slopes;
    for (const ir::Node& node : function.nodes) {
        const auto of = [&](std::size_t i) { return slopes[node.operands[i]]; };
        bool has = false;
        for (std::size_t i = 0; i < arity(node); ++i) {
            has = has || of(i);
        }
        switch (node.kind) {
        case ir::Node::Kind::constant:
            break;
        case ir::Node::Kind::input:
            has = true;
            break;
        case ir::Node::Kind::image:
            has = has && function.images[node.image]->data.filter != runtime::Filter::nearest;
            break;
        case ir::Node::Kind::apply:
            has = has && !is_step(node.op) && (node.op != Op::select || of(1) || of(2));
            break;
        }
        slopes.push_back(has);
    }
    return slopes[function.results[0]];
}

} // namespace scc::compiler
