#include "runtime/accel/build.h"
#include "runtime/math/pack.h"
#include "runtime/raycast.h"
#include "runtime/test/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

using namespace scc::runtime;
using namespace scc::runtime::test;

namespace {

bool is_used(const BvhNode& node, int slot) {
    return node.min[0][slot] <= node.max[0][slot];
}

int depth_of(const std::vector<BvhNode>& nodes, std::uint32_t node) {
    int depth = 0;
    for (int slot = 0; slot < bvh_width; ++slot) {
        const std::uint32_t child = nodes[node].child[slot];
        if (is_used(nodes[node], slot) && !is_leaf(child)) {
            depth = std::max(depth, depth_of(nodes, child));
        }
    }
    return depth + 1;
}

std::vector<BoxRef> refs_of(const std::vector<Bounds<float>>& boxes) {
    std::vector<BoxRef> refs;
    for (const Bounds<float>& box : boxes) {
        refs.push_back(box_ref(box, static_cast<std::uint32_t>(refs.size())));
    }
    return refs;
}

bool contains(const Bounds<float>& outer, const Bounds<float>& inner) {
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

Bounds<float> box_of(const BvhNode& node, int slot) {
    return {{node.min[0][slot], node.min[1][slot], node.min[2][slot]},
            {node.max[0][slot], node.max[1][slot], node.max[2][slot]}};
}

/// Counts in `seen` the primitives of the leaves; all boxes on the way must contain them.
void visit(const Bvh& bvh, std::uint32_t node, const Bounds<float>& outer,
           const std::vector<Bounds<float>>& boxes, std::vector<int>& seen) {
    for (int slot = 0; slot < bvh_width; ++slot) {
        if (!is_used(bvh.nodes[node], slot)) {
            continue;
        }
        const Bounds<float> box = box_of(bvh.nodes[node], slot);
        EXPECT_TRUE(contains(outer, box));
        const std::uint32_t child = bvh.nodes[node].child[slot];
        if (!is_leaf(child)) {
            visit(bvh, child, box, boxes, seen);
            continue;
        }
        const BvhLeaf leaf = leaf_of(child);
        EXPECT_LE(leaf.count, bvh_max_leaf);
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            ++seen[bvh.order[i]];
            EXPECT_TRUE(contains(box, boxes[bvh.order[i]]));
        }
    }
}

std::vector<Bounds<float>> random_boxes(std::size_t count) {
    Random<float> random(1);
    std::vector<Bounds<float>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3<float> low = random.vector(10);
        boxes.push_back({low, low + Vec3<float>{random.number(0, 1), random.number(0, 1), 0}});
    }
    return boxes;
}

constexpr Bounds<float> everywhere{{-1e9F, -1e9F, -1e9F}, {1e9F, 1e9F, 1e9F}};

TEST(Bvh, EveryPrimitiveIsInExactlyOneLeafAndInsideItsBoxes) {
    for (const std::size_t count : {1U, 4U, 5U, 9U, 1000U, 100000U}) {
        for (const BuildQuality quality : {BuildQuality::high, BuildQuality::quick}) {
            const std::vector<Bounds<float>> boxes = random_boxes(count);
            const Bvh bvh = build_bvh(refs_of(boxes), 2, quality);
            std::vector<int> seen(boxes.size());
            visit(bvh, 0, everywhere, boxes, seen);
            EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
        }
    }
}

TEST(Bvh, IsTheSameForAnyNumberOfThreads) {
    const std::vector<BoxRef> refs = refs_of(random_boxes(200000));
    const Bvh one = build_bvh(refs, 1), three = build_bvh(refs, 3);
    EXPECT_EQ(one.order, three.order);
    ASSERT_EQ(one.nodes.size(), three.nodes.size());
    EXPECT_EQ(std::memcmp(one.nodes.data(), three.nodes.data(), one.nodes.size() * sizeof(BvhNode)), 0);
}

TEST(Bvh, DepthIsBoundedForBoxesThatNoPlaneSeparates) {
    const std::vector<Bounds<float>> equal(20000, {{0, 0, 0}, {1, 1, 1}});
    EXPECT_LE(depth_of(build_bvh(refs_of(equal)).nodes, 0), 20);
    std::vector<Bounds<float>> shrinking; // each split separates one box only
    for (int i = 0; i < 126; ++i) {
        const float x = std::ldexp(1.0F, i - 63);
        shrinking.push_back({{x, 0, 0}, {x, 1, 1}});
    }
    for (int copies = 0; copies < 4; ++copies) {
        const std::size_t count = shrinking.size();
        shrinking.reserve(2 * count);
        shrinking.insert(shrinking.end(), shrinking.begin(),
                         shrinking.begin() + static_cast<std::ptrdiff_t>(count));
    }
    EXPECT_LE(depth_of(build_bvh(refs_of(shrinking)).nodes, 0), bvh_max_depth);
}

TEST(Bvh, InfiniteBoxesAreAccepted) {
    std::vector<Bounds<float>> boxes(20, {{0, 0, 0}, {1, 1, 1}});
    boxes[3].max.x = infinity<float>();
    boxes[5] = {{-infinity<float>(), 0, 0}, {infinity<float>(), 1, 1}};
    EXPECT_EQ(build_bvh(refs_of(boxes)).order.size(), boxes.size());
}

TEST(Bvh, OutwardRoundingContainsTheBox) {
    const double x = 0.1, huge = 1e300;
    const Bounds<float> b = round_outwards(Bounds<double>{{x, -x, -huge}, {x, -x, huge}});
    EXPECT_LE(double(b.min.x), x);
    EXPECT_GE(double(b.max.x), x);
    EXPECT_LE(double(b.min.y), -x);
    EXPECT_GE(double(b.max.y), -x);
    EXPECT_LE(double(b.min.z), -huge);
    EXPECT_GE(double(b.max.z), huge);
}

template <class T>
class Hierarchy : public testing::Test {};
using Reals = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Hierarchy, Reals);

template <class R>
void fill(DynamicScene<R>& scene, Random<R>& random, int count) {
    const auto put = [&](auto shape, std::uint32_t id) {
        if constexpr (!is_mesh<decltype(shape)>) {
            randomize(shape, random, id % 2 == 0 ? 10 : 1);
            add_field(shape, scene);
            if constexpr (requires { shape.offset; }) {
                shape.offset = -15;
            }
        }
        if (id % 2 == 0) {
            scene.add(Bare<decltype(shape)>{shape, {id, {}}});
        } else {
            const Affine<double> map = random.map(10);
            scene.add(Placed<decltype(shape), R>{
                shape, affine_cast<R>(map), affine_cast<R>(inverse(map)), {id, {}}});
        }
    };
    std::uint32_t id = 0;
    for (int i = 0; i < count; ++i) {
        put(Sphere<R>{}, id++);
        put(Triangle<R>{}, id++);
        put(Disc<R>{}, id++);
        put(Box<R>{}, id++);
        put(Cylinder<R>{}, id++);
        put(Cone<R>{}, id++);
        put(Torus<R>{}, id++);
        put(Mesh<R>{}, id++);
        put(Box<R>{}, id++);
        put(Triangle<R>{}, id++);
    }
    put(Plane<R>{}, id++);
    put(Quadric<R>{}, id++);
}

template <class R>
Ray<R> some_ray(Random<R>& random) {
    Ray<R> ray{random.vector(14), random.direction() * random.number(0.3, 3)};
    const R kind = random.number(0, 1);
    if (kind < R(0.1)) {
        ray.dir = {0, kind < R(0.05) ? R(1) : R(-1), 0};
    } else if (kind < R(0.2)) {
        ray.dir.z = R(-0.0);
    }
    return ray;
}

template <class R>
TrianglePlace some_place(const MeshStorage& mesh, Random<R>& random) {
    const std::vector<TrianglePlace> places = places_of(mesh);
    const auto count = static_cast<R>(places.size());
    return places[std::min(static_cast<std::size_t>(random.number(0, 1) * count), places.size() - 1)];
}

template <class R>
ShapeHit<R> nearest_in(const MeshStorage& mesh, Ray<R> ray) {
    ShapeHit<R> hit;
    intersect_mesh<false, R>(mesh.data(), {&ray, 1}, Apex::none, {&hit, 1});
    return hit;
}
template <class R>
bool is_blocked_by(const MeshStorage& mesh, Ray<R> ray) {
    ShapeHit<R> hit;
    intersect_mesh<true, R>(mesh.data(), {&ray, 1}, Apex::none, {&hit, 1});
    return hit.t < infinity<R>();
}

TYPED_TEST(Hierarchy, FindsWhatATestOfEveryShapeFinds) {
    using R = TypeParam;
    Random<R> random(11);
    const MeshStorage mesh = ball_mesh(2, 1, {0, 0, 0});
    DynamicScene<R> scene;
    scene.meshes.push_back(mesh.data());
    fill(scene, random, 12);
    DynamicScene<R> plain = scene;
    prepare(scene);
    ASSERT_FALSE(scene.accelerator.nodes.empty());
    int hits = 0;
    for (int i = 0; i < property_count(20000); ++i) {
        const Ray<R> ray = some_ray(random);
        const Hit<R> got = closest_hit(scene, ray), expected = closest_hit(plain, ray);
        ASSERT_EQ(got.shape.t, expected.shape.t);
        ASSERT_EQ(got.id, expected.id);
        ASSERT_EQ(got.shape.part, expected.shape.part);
        ASSERT_EQ(got.kind, expected.kind);
        ASSERT_EQ(got.index, expected.index);
        Ray<R> feeler = ray;
        feeler.t_max = random.number(0, 10);
        ASSERT_EQ(any_hit(scene, feeler), any_hit(plain, feeler));
        hits += is_hit(got) ? 1 : 0;
    }
    EXPECT_GT(hits, 5000);
}

TYPED_TEST(Hierarchy, FindsWhatATestOfEveryTriangleFinds) {
    using R = TypeParam;
    Random<R> random(12);
    const MeshStorage mesh = ball_mesh(3, 8, {1, 2, 3});
    MeshStorage flat = mesh; // every ray that meets the mesh's box visits every leaf
    for (BvhNode& node : flat.nodes) {
        for (int slot = 0; slot < bvh_width; ++slot) {
            for (int axis = 0; is_used(node, slot) && axis < 3; ++axis) {
                node.min[axis][slot] = mesh.min[static_cast<std::size_t>(axis)];
                node.max[axis][slot] = mesh.max[static_cast<std::size_t>(axis)];
            }
        }
    }
    for (int i = 0; i < 4000; ++i) {
        Ray<R> ray = some_ray(random);
        if (i % 4 == 0) { // along a triangle
            const Corners<R> c = corners_at<R>(mesh.data(), some_place(mesh, random));
            ray.org = c.a + (c.a - c.b) * random.number(0, 3);
            ray.dir = (c.a + (c.c - c.a) * random.number(0, 1)) - ray.org;
        }
        const ShapeHit<R> got = nearest_in(mesh, ray);
        const ShapeHit<R> expected = nearest_in(flat, ray);
        ASSERT_EQ(got.t, expected.t);
        if (got.t < infinity<R>()) {
            ASSERT_EQ(got.part, expected.part);
        }
        ASSERT_EQ(is_blocked_by(mesh, ray), got.t < infinity<R>());
    }
}

/// More of them with SCC_LEAK_RAYS=100000000 in the environment.
TYPED_TEST(Hierarchy, RaysThroughSharedEdgesAndCornersDoNotLeak) {
    using R = TypeParam;
    Random<R> random(13);
    const char* wanted = std::getenv("SCC_LEAK_RAYS");
    const long long rays = std::max(wanted != nullptr ? std::atoll(wanted) : 0, 76'800LL);
    const long long rounds = (rays + 2 * 320 * 4 - 1) / (2 * 320 * 4);
    for (const double distance : {0.0, 1000.0}) {
        const Vec3<double> center{distance, 0.3 * distance, -distance};
        const MeshStorage mesh = ball_mesh(2, 1, center);
        for (const TrianglePlace& place : places_of(mesh)) {
            const Corners<R> c = corners_at<R>(mesh.data(), place);
            for (long long i = 0; i < rounds; ++i) {
                const Vec3<R> org = lanes<R>(center) + random.vector(0.4);
                const R s = random.number(0, 1);
                for (const Vec3<R>& target :
                     {c.a, (c.a + c.b) * R(0.5), c.a + (c.b - c.a) * s, c.a + (c.c - c.a) * s}) {
                    const Ray<R> ray{org, target - org};
                    ASSERT_LT(nearest_in(mesh, ray).t, infinity<R>());
                }
            }
        }
    }
}

TYPED_TEST(Hierarchy, RaysThroughAxisParallelEdgesOfACubeDoNotLeak) {
    using R = TypeParam;
    std::vector<float> positions;
    for (int corner = 0; corner < 8; ++corner) {
        positions.insert(positions.end(),
                         {corner & 1 ? 1.0F : -1.0F, corner & 2 ? 1.0F : -1.0F, corner & 4 ? 1.0F : -1.0F});
    }
    const std::vector<std::uint32_t> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                             2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const MeshStorage cube = build_mesh(positions, indices);
    for (int i = -100; i <= 100; ++i) {
        for (int j = -100; j <= 100; ++j) {
            const Ray<R> ray{{0, 0, 0}, {static_cast<R>(i) / 100, static_cast<R>(j) / 100, 1}};
            const ShapeHit<R> hit = nearest_in(cube, ray);
            ASSERT_EQ(hit.t, 1);
        }
    }
}

TYPED_TEST(Hierarchy, OfCoincidentHitsTheSmallestIdCounts) {
    using R = TypeParam;
    DynamicScene<R> scene;
    for (const std::uint32_t id : {5U, 9U, 2U, 7U}) { // tables need not be sorted for this
        scene.add(Bare<Box<R>>{{}, {id, {}}});
        scene.add(Bare<Disc<R>>{{{0, 1, 0}, {0, 1, 0}, 1, 0}, {id + 20, {}}});
    }
    DynamicScene<R> with_hierarchy = scene;
    with_hierarchy.accelerator = build_accelerator(scene);
    const Ray<R> ray{{R(0.1), 5, R(0.2)}, {0, -1, 0}};
    EXPECT_EQ(closest_hit(scene, ray).id, 2);
    EXPECT_EQ(closest_hit(with_hierarchy, ray).id, 2);
    EXPECT_EQ(closest_hit(with_hierarchy, ray).shape.t, 4);
}

TYPED_TEST(Hierarchy, LanesFindWhatSingleRaysFind) {
    using R = TypeParam;
    using L = WidestLane<R>;
    Random<R> random(14);
    const MeshStorage mesh = ball_mesh(2, 1, {0, 0, 0});
    DynamicScene<R> scene;
    scene.meshes.push_back(mesh.data());
    fill(scene, random, 12);
    prepare(scene);
    for (int round = 0; round < 2000; ++round) {
        Ray<R> single[lane_count<L>];
        Ray<L> packed;
        for (int i = 0; i < lane_count<L>; ++i) {
            single[i] = some_ray(random);
            single[i].t_max = i % 5 == 4 ? R(-1) : single[i].t_max; // takes no part
            const auto put = [&](Vec3<L>& to, const Vec3<R>& from) {
                set_lane(to.x, i, from.x);
                set_lane(to.y, i, from.y);
                set_lane(to.z, i, from.z);
            };
            put(packed.org, single[i].org);
            put(packed.dir, single[i].dir);
            set_lane(packed.t_max, i, single[i].t_max);
        }
        const Hit<L> hits = closest_hit(scene, packed);
        const MaskOf<L> blocked = any_hit(scene, packed);
        for (int i = 0; i < lane_count<L>; ++i) {
            const Hit<R> expected = closest_hit(scene, single[i]);
            ASSERT_EQ(lane(hits.shape.t, i), expected.shape.t);
            ASSERT_EQ(lane(hits.id, i), expected.id);
            ASSERT_EQ(lane(hits.kind, i), expected.kind);
            if (is_hit(expected)) {
                ASSERT_EQ(lane(hits.index, i), expected.index);
                ASSERT_EQ(lane(hits.shape.part, i), expected.shape.part);
            }
            ASSERT_EQ((bits(blocked) >> i & 1U) != 0, is_hit(expected));
        }
    }
}

TYPED_TEST(Hierarchy, PacksAreJoinedToBeamsAsFarAsTheyRunAlike) {
    using R = TypeParam;
    using L = WidestLane<R>;
    if constexpr (lane_count<L> != 1) {
        const Vec3<R> directions[] = {{0, 0, 1}, {1, 0, 2}, {0, 0, -1}, {0, 1, 0}};
        std::array<Ray<L>, 8> rays;
        for (std::size_t p = 0; p < rays.size(); ++p) {
            rays[p].dir = lanes<L>(directions[p % 4]);
        }
        const Bounds<float> root{{-1, -1, -1}, {1, 1, 1}};
        set_lane(rays[7].dir.x, 0, R(0.3)); // apart from its own
        BeamSet<L> beams;
        EXPECT_EQ(beams.gather_some(rays, 0b11111111, Apex::none, root), 0b00110011U);
        EXPECT_EQ(beams.join(0b00110011, 0.1F), 0b00010001U);
        EXPECT_EQ(beams.join(0b00100010, 0.1F), 0b00100010U);
        EXPECT_EQ(beams.join(0b00110011, 0.6F), 0b00110011U);
        EXPECT_EQ(beams.gather_some(rays, 0b11001100, Apex::none, root), 0b01000100U);
        EXPECT_EQ(beams.gather_some(rays, 0b10001000, Apex::none, root), 0b10001000U);
        EXPECT_EQ(beams.join(0b10001000, 0.1F), 0b00001000U);
        EXPECT_EQ(beams.join(0b10000000, 0.1F), 0U);
        EXPECT_FALSE(beams.gather(rays, Apex::none, root));
        EXPECT_TRUE(beams.gather(std::span(rays).first(1), Apex::none, root));
    }
}

/// Blocks of rays that run alike: from one point, to one point, side by side, and off a curved mirror; and,
/// every third time, of packs in three such bundles.
TYPED_TEST(Hierarchy, PacksThatAreTracedTogetherFindWhatSingleRaysFind) {
    using R = TypeParam;
    using L = WidestLane<R>;
    if constexpr (lane_count<L> != 1) {
        Random<R> random(15);
        const MeshStorage mesh = ball_mesh(3, 1, {0, 0, 0});
        DynamicScene<R> scene;
        scene.meshes.push_back(mesh.data());
        fill(scene, random, 12);
        prepare(scene);
        int hit_count = 0;
        for (int round = 0; round < 800; ++round) {
            const int kind = round % 4;
            const Vec3<R> org = random.vector(14), dir = random.direction();
            const Vec3<R> directions[] = {dir, round % 3 == 0 ? random.direction() : dir,
                                          round % 3 == 0 ? random.direction() : dir};
            const R spread = random.number(R(0.001), R(0.4));
            const R distance = round % 8 == 1 ? R(10) : R(1000); // from the common end to the starts
            std::array<Ray<L>, most_packs> rays;
            std::array<Hit<L>, most_packs> hits;
            std::array<MaskOf<L>, most_packs> blocked;
            for (std::size_t p = 0; p < most_packs; ++p) {
                blocked[p] = MaskOf<L>(false);
                for (int i = 0; i < lane_count<L>; ++i) {
                    Ray<R> ray{org, directions[p % 3] + random.vector(spread)};
                    if (kind == 1) {
                        ray.org = org + ray.dir * distance;
                        ray.dir = org - ray.org;
                        ray.t_max = R(0.99);
                    } else if (kind == 2) {
                        ray = {org + random.vector(spread), directions[p % 3]};
                    } else if (kind == 3) {
                        ray.org = org + random.vector(spread);
                    }
                    if (p % 5 == 4 || i % 3 == 2) {
                        ray.t_max = -1; // takes no part
                    }
                    set_ray(rays[p], i, ray);
                }
            }
            const Apex apex = kind == 0 ? Apex::origin : kind == 1 ? Apex::end : Apex::none;
            std::array<Ray<L>, most_packs> closest = rays, feelers = rays;
            if (kind == 1) {
                any_hits<most_packs, DynamicScene<R>, L>(scene, feelers, apex, blocked);
            } else {
                closest_hits<most_packs, DynamicScene<R>, L>(scene, closest, apex, hits);
            }
            for (std::size_t p = 0; p < most_packs; ++p) {
                for (int i = 0; i < lane_count<L>; ++i) {
                    const Ray<R> ray{{lane(rays[p].org.x, i), lane(rays[p].org.y, i), lane(rays[p].org.z, i)},
                                     {lane(rays[p].dir.x, i), lane(rays[p].dir.y, i), lane(rays[p].dir.z, i)},
                                     R(0),
                                     lane(rays[p].t_max, i)};
                    const Hit<R> expected = closest_hit(scene, ray);
                    hit_count += is_hit(expected) ? 1 : 0;
                    if (kind == 1) {
                        ASSERT_EQ((bits(blocked[p]) >> i & 1U) != 0, is_hit(expected));
                        continue;
                    }
                    ASSERT_EQ(lane(hits[p].shape.t, i), expected.shape.t);
                    ASSERT_EQ(lane(hits[p].id, i), expected.id);
                    if (is_hit(expected)) {
                        ASSERT_EQ(lane(hits[p].shape.part, i), expected.shape.part);
                    }
                }
            }
        }
        EXPECT_GT(hit_count, 1000);
    }
}

/// Rays that have nothing in common, through a mesh of which every triangle is there twice: from outside and
/// inside, with ends on the surface, and any number of packs.
TYPED_TEST(Hierarchy, RaysThatTakeTurnsFindWhatEachFindsAlone) {
    using R = TypeParam;
    using L = WidestLane<R>;
    if constexpr (lane_count<L> != 1) {
        Random<R> random(16);
        const MeshStorage once = ball_mesh(4, 20, {0, 0, 0});
        std::vector<float> positions;
        std::vector<std::uint32_t> indices;
        for (const TrianglePlace& place : places_of(once)) {
            const Corners<float> c = corners_at<float>(once.data(), place);
            const auto first = static_cast<std::uint32_t>(positions.size() / 3);
            for (const Vec3<float>& corner : {c.a, c.b, c.c}) {
                positions.insert(positions.end(), {corner.x, corner.y, corner.z});
            }
            indices.insert(indices.end(), {first, first + 1, first + 2, first, first + 1, first + 2});
        }
        const MeshStorage mesh = build_mesh(positions, indices);
        int hit_count = 0;
        for (std::size_t count = 1; count <= most_packs; ++count) {
            std::array<Ray<L>, most_packs> rays;
            std::array<ShapeHit<L>, most_packs> hits, feeler_hits;
            for (std::size_t p = 0; p < count; ++p) {
                for (int i = 0; i < lane_count<L>; ++i) {
                    Ray<R> ray = some_ray(random);
                    if (i % 2 == 0) {
                        ray.org = random.vector(0.4);
                        ray.t_max = i % 4 == 0 ? nearest_in(mesh, ray).t : R(random.number(0, 2));
                    } else if (i % 7 == 3) {
                        ray.t_max = -1; // takes no part
                    }
                    set_ray(rays[p], i, ray);
                }
            }
            std::array<Ray<L>, most_packs> closest = rays, feelers = rays;
            const MeshData data = mesh.data();
            intersect_mesh<false, L>(data, {closest.data(), count}, Apex::none, {hits.data(), count});
            intersect_mesh<true, L>(data, {feelers.data(), count}, Apex::none, {feeler_hits.data(), count});
            for (std::size_t p = 0; p < count; ++p) {
                for (int i = 0; i < lane_count<L>; ++i) {
                    const Ray<R> ray = lane(rays[p], i);
                    const ShapeHit<R> expected = is_active(ray) ? nearest_in(mesh, ray) : ShapeHit<R>{};
                    const bool is_hit = expected.t < infinity<R>();
                    hit_count += is_hit ? 1 : 0;
                    ASSERT_EQ(lane(hits[p].t, i), expected.t);
                    ASSERT_TRUE(!is_hit || lane(hits[p].part, i) == expected.part);
                    ASSERT_EQ(lane(feeler_hits[p].t, i) < infinity<R>(), is_hit);
                }
            }
        }
        EXPECT_GT(hit_count, 200);
    }
}

/// Rays along edges and through corners, moved by up to some roundings, past slivers and from far away.
TYPED_TEST(Hierarchy, TheQuickTestRulesOutNoTriangleThatTheExactOneMeets) {
    using R = TypeParam;
    Random<R> random(17);
    int met_count = 0, far_count = 0, far_passed = 0;
    for (int i = 0; i < 200000; ++i) {
        const R size = std::ldexp(R(1), i % 12 - 8);
        const R offset = i % 3 == 0 ? R(0) : i % 3 == 1 ? R(10) : R(300);
        Corners<R> c;
        c.a = random.vector(1) * offset;
        c.b = c.a + random.vector(1) * size;
        c.c = c.a + random.vector(1) * size;
        if (i % 5 == 0) { // a sliver
            c.c = c.a + (c.b - c.a) * random.number(0, 1) + random.vector(1) * (size * R(1e-4));
        }
        const Vec3<R> org = random.vector(3) * (i % 2 == 0 ? R(1) : R(50));
        const R s = random.number(0, 1);
        const Vec3<R> on_edge = c.b + (c.c - c.b) * s;
        const R reach = largest_component(
            maximum(maximum(absolute(c.a - org), absolute(c.b - org)), absolute(c.c - org)));
        const Vec3<R> target = on_edge + random.vector(4) * (roundoff<R>() * reach);
        const Vec3<R> dir = (target - org) * random.number(0.1, 10);
        const R dir_size = largest_component(absolute(dir));
        const Corners<R> relative = relative_to(org, c);
        const EdgeFunctions<R> edges(TriangleView<R>(relative), dir, dir_size);
        const R tolerance = tolerance_per_size(dir_size, reach);
        if (edges.may_pass() && edges.pass(true, dir, [&](int) { return relative; })) {
            ++met_count;
            ASSERT_TRUE(may_pass_through(c, relative.a, dir, tolerance));
        }
        if (size > R(0.01) * reach && i % 5 != 0) {
            const Vec3<R> beside = c.a + (on_edge - c.a) * R(1.5) - org;
            ++far_count;
            far_passed += may_pass_through(c, relative.a, beside,
                                           tolerance_per_size(largest_component(absolute(beside)), reach))
                              ? 1
                              : 0;
        }
    }
    EXPECT_GT(met_count, 50000);
    EXPECT_GT(far_count, 10000);
    EXPECT_LT(far_passed, far_count / 50);
}

} // namespace
