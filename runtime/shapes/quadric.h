#pragma once

#include "runtime/bounds.h"
#include "runtime/field.h"
#include "runtime/math/vec.h"
#include "runtime/ray.h"

#include <string_view>
#include <tuple>
#include <type_traits>

namespace scc::runtime {

/// The points p where f(p) = p.A p + linear.p + constant is 0, with the squares' factors on the diagonal of A
/// and half the products' beside it; inside where f < 0. Unbounded, as far as the kernels know.
template <class R>
struct Quadric {
    static constexpr std::string_view name = "quadric";

    Vec3<R> squares{1, 1, 1};
    Vec3<R> products{0, 0, 0};
    Vec3<R> linear{0, 0, 0};
    R constant = -1;

    static constexpr auto fields() {
        return std::tuple{
            field("squares", &Quadric::squares, Rule::any, "factors of x^2, y^2, z^2"),
            field("products", &Quadric::products, Rule::any, "factors of x y, y z, z x"),
            field("linear", &Quadric::linear, Rule::any, "factors of x, y, z"),
            field("constant", &Quadric::constant, Rule::any,
                  "what is added to these; where the sum is 0 is the surface, inside it is less")};
    }

    /// A box around what is inside, infinite where that is no ellipsoid.
    Bounds<R> inside_bounds() const {
        if constexpr (!std::is_same_v<R, double>) {
            const Bounds<double> box = Quadric<double>{lanes<double>(squares), lanes<double>(products),
                                                       lanes<double>(linear), static_cast<double>(constant)}
                                           .inside_bounds();
            const Vec3<R> low = lanes<R>(box.min), high = lanes<R>(box.max);
            const Vec3<R> slack = maximum(absolute(low), absolute(high)) * (64 * roundoff<R>());
            return {low - slack, high + slack};
        } else {
            return ellipsoid_bounds();
        }
    }

    template <class L>
    ShapeHit<L> intersect(const Ray<L>& ray) const {
        const Roots<L> roots(*this, ray);
        return {first_in_range(ray, roots.near, roots.far), {}};
    }

    /// The first point of the surface in each ray's range. Which one it is does not depend on t_max; called
    /// again with t_min behind a hit it gives the next.
    template <class L>
    Crossing<L> cross(const Ray<L>& ray) const {
        const Roots<L> roots(*this, ray);
        const MaskOf<L> before = roots.near >= ray.t_min, between = (!before) & (roots.far >= ray.t_min);
        const L t = choose(before, roots.near, choose(between, roots.far, infinity<L>()));
        return {{choose(t <= ray.t_max, t, infinity<L>()), {}},
                MaskOf<L>((before & roots.inside_before) | (between & roots.inside_between) |
                          ((!(before | between)) & roots.inside_after))};
    }

    template <class L>
    Surface<L> surface(const Ray<L>& ray, const ShapeHit<L>& hit) const {
        Vec3<L> point = ray.org + hit.t * ray.dir;
        for (int step = 0; step < 2; ++step) {
            const Terms<L> here(*this, point);
            const L squared = dot(here.gradient, here.gradient);
            point = point - here.gradient * choose(squared > 0, here.value / squared, L(0));
        }
        const Terms<L> here(*this, point);
        const L steepness = length(here.gradient);
        const MaskOf<L> is_smooth = steepness > 0;
        const Vec3<L> normal =
            choose(is_smooth, here.gradient * (1 / steepness), normalize(-ray.dir)); // a cone's tip
        // How far f can be from 0 here and where a ray starts, by its slope, or where that vanishes by its
        // curvature.
        const L off = 24 * roundoff<L>() * here.magnitude;
        const L curvature = L(largest_component(maximum(absolute(squares), absolute(products))));
        const L by_slope = off / steepness, by_curvature = square_root(off / curvature);
        return {point,
                absolute(point) * (4 * roundoff<L>()) + absolute(normal) * minimum(by_slope, by_curvature),
                normal, normal};
    }

    /// As of other surfaces without coordinates of their own.
    template <class L, class T>
    constexpr Vec2<T> uv(const Ray<L>&, const ShapeHit<L>&, const Vec3<T>& point) const {
        return {point.x, point.y};
    }

private:
    Bounds<R> ellipsoid_bounds() const {
        const Vec3<R> all{infinity<R>(), infinity<R>(), infinity<R>()};
        const R xy = products.x / 2, yz = products.y / 2, zx = products.z / 2;
        // The cofactors of A, which is positive definite where its leading minors are positive.
        const Vec3<R> own{squares.y * squares.z - yz * yz, squares.z * squares.x - zx * zx,
                          squares.x * squares.y - xy * xy};
        const Vec3<R> mixed{yz * zx - squares.z * xy, zx * xy - squares.x * yz, xy * yz - squares.y * zx};
        const R determinant = squares.x * own.x + xy * mixed.x + zx * mixed.z;
        const R size = largest_component(absolute(squares)), least = R(1e-9) * size * size * size;
        if (!(squares.x > 0 && own.z > 0 && determinant > least)) {
            return {-all, all};
        }
        const Vec3<R> half = linear * (R(-0.5) / determinant);
        const Vec3<R> center{dot(half, Vec3<R>{own.x, mixed.x, mixed.z}),
                             dot(half, Vec3<R>{mixed.x, own.y, mixed.y}),
                             dot(half, Vec3<R>{mixed.z, mixed.y, own.z})};
        const Terms<R> terms(*this, center);
        // Inside, (p - center).A (p - center) is at most -f(center), which is known to within its rounding
        // and the centre's.
        const R slack = R(1e-6) * terms.magnitude;
        const R depth = maximum(R(0), slack - terms.value) / determinant;
        const Vec3<R> reach{square_root(depth * own.x), square_root(depth * own.y),
                            square_root(depth * own.z)};
        return terms.value > slack ? Bounds<R>{} : Bounds<R>{center - reach, center + reach};
    }

    template <class L>
    static Vec3<L> times(const Vec3<L>& squares, const Vec3<L>& half_products, const Vec3<L>& p) {
        return {squares.x * p.x + half_products.x * p.y + half_products.z * p.z,
                squares.y * p.y + half_products.x * p.x + half_products.y * p.z,
                squares.z * p.z + half_products.y * p.y + half_products.z * p.x};
    }
    template <class L>
    Vec3<L> times(const Vec3<L>& p) const {
        return times(lanes<L>(squares), lanes<L>(products * R(0.5)), p);
    }
    /// The sum of the sizes of what times() adds up.
    template <class L>
    Vec3<L> times_magnitude(const Vec3<L>& p) const {
        return times(lanes<L>(absolute(squares)), lanes<L>(absolute(products) * R(0.5)), absolute(p));
    }

    /// f and what belongs to it at a point.
    template <class L>
    struct Terms {
        L value, magnitude; ///< the sum of the terms and of their sizes
        Vec3<L> gradient;

        Terms(const Quadric& q, const Vec3<L>& p) {
            const Vec3<L> product = q.times(p), linear = lanes<L>(q.linear);
            value = dot(p, product + linear) + L(q.constant);
            magnitude = dot(absolute(p), q.times_magnitude(p) + absolute(linear)) + L(absolute(q.constant));
            gradient = 2 * product + linear;
        }
    };

    /// Where a ray's line meets the surface: a t^2 + 2 b t + c = 0. The discriminant b^2 - a c, which loses
    /// its digits where the ray comes from afar, is -a f(p) with p the point where f is stationary along the
    /// ray: that which is known better is taken. One root comes from a sum, the other from c, which where a
    /// ray has just left the surface has the right sign.
    template <class L>
    struct Roots {
        L near, far; ///< in order; infinite where there is none
        MaskOf<L> inside_before, inside_between, inside_after;

        Roots(const Quadric& q, const Ray<L>& ray) {
            const L inf = infinity<L>(), u = roundoff<L>();
            const Vec3<L> along = q.times(ray.dir);
            const Terms<L> start(q, ray.org);
            const L b = dot(ray.dir, q.times(ray.org)) + dot(ray.dir, lanes<L>(q.linear)) * L(R(0.5));
            const L c = start.value;
            const L exact_a = dot(ray.dir, along);
            const L noise = 8 * u * dot(absolute(ray.dir), q.times_magnitude(ray.dir));
            const L a = choose(absolute(exact_a) > noise, exact_a, L(0));
            const Terms<L> middle(q, ray.org - (b / a) * ray.dir);
            const L from_start = b * b - a * c;
            const L from_middle = -(a * middle.value);
            const MaskOf<L> is_far = absolute(a) * middle.magnitude < b * b + absolute(a) * start.magnitude;
            const L discriminant = choose(is_far, from_middle, from_start);
            const MaskOf<L> real = discriminant >= 0;
            const L root = square_root(maximum(L(0), discriminant));
            const L sum = -(b + choose(b < 0, -root, root));
            const MaskOf<L> touches = sum == 0;
            const L t0 = choose(real & !(a == 0), sum / a, inf);
            const L t1 = choose(real & !touches, c / sum, t0);
            near = minimum(t0, t1);
            far = choose(near == t0, t1, t0);
            const MaskOf<L> none_at_all = !(near < inf);
            // f has the sign of a far away, or of b where it is linear, or of c where it is constant.
            const MaskOf<L> flat = a == 0, constant = flat & (b == 0);
            const MaskOf<L> is_low = choose_mask(constant, c < 0, choose_mask(flat, b < 0, a < 0));
            inside_after = is_low;
            inside_before = choose_mask(flat & !constant & !none_at_all, !is_low, is_low);
            inside_between = choose_mask(flat, inside_after, !is_low);
        }

        static MaskOf<L> choose_mask(const MaskOf<L>& mask, const MaskOf<L>& a, const MaskOf<L>& b) {
            return MaskOf<L>((mask & a) | ((!mask) & b));
        }
    };
};

} // namespace scc::runtime
