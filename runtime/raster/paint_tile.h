#pragma once

#include "runtime/aov.h"
#include "runtime/image.h"
#include "runtime/raster/background_rows.h"
#include "runtime/raster/fill.h"
#include "runtime/raster/lines.h"
#include "runtime/raster/shade_triangles.h"
#include "runtime/raster/tile_colors.h"
#include "runtime/raster/tile_depth.h"
#include "runtime/raster/tile_entries.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

/// The second stage: from a tile's triangles to its pixels.
namespace scc::runtime::raster {

/// Finds what is nearest at each sample first, and lights only that. What lets light through comes last: of
/// each sample, all such surfaces in front of the nearest opaque one, from the farthest on, so that those
/// that cross each other are right as well.
template <SceneModel S, class L>
class TilePainter {
    using R = typename S::Real;
    static constexpr int N = lane_count<L>;
    using Buffer = TileBuffer<L>;
    using Shader = TriangleShader<S, L>;

public:
    TilePainter(const S& scene, const RasterModel<R>& model, const RasterView<R>& view, const TileGrid& tiles,
                const std::vector<Bin<R>>& bins, const VertexLights<S, L>& lights, RasterShading shading)
        : scene_(scene), model_(model), view_(view), tiles_(tiles), bins_(bins),
          shader_(scene, model, view, lights, shading), colors_(tiles),
          background_(scene_background(), tiles.pixels_across()) {}

    /// Finds what the tile's samples show.
    void show(int tile) {
        const auto index = static_cast<std::size_t>(tile);
        entries_.clear();
        through_.clear();
        if (is_empty(tile)) {
            return;
        }
        reserve_entries(index);
        buffer_.clear(tiles_.left_of(tile), tiles_.top_of(tile),
                      view_.clips_depth() ? R(1) : std::numeric_limits<R>::max());
        shader_.start(buffer_.left(), buffer_.top());
        colors_.start(buffer_.left(), buffer_.top());
        const auto earlier = [this](std::uint32_t a, std::uint32_t b) { return is_earlier(a, b); };
        for (const Bin<R>& bin : bins_) {
            const auto fill = [&](const auto& triangles) {
                for (std::size_t i = 0; i < triangles.size(); ++i) {
                    buffer_.fill(triangles[i], entries_.add(triangles[i].id), earlier);
                    if (i % fills_per_write == 0) {
                        background_.write_some();
                    }
                }
            };
            fill(bin.small_of[index]);
            fill(bin.narrow_of[index]);
            for (const std::uint32_t i : bin.triangles_of[index]) {
                const ScreenTriangle<R>& t = bin.triangles[i];
                const std::uint32_t entry = entries_.add(t.id);
                if (S::traits.transmission && (t.id & lets_light_through) != 0) {
                    through_.push_back({&t, entry});
                } else {
                    buffer_.fill(t, entry, earlier);
                }
            }
        }
        first_line_ = entries_.size();
        if constexpr (S::traits.lines) {
            for (const Bin<R>& bin : bins_) {
                for (const std::uint32_t i : bin.lines_of[index]) {
                    const ScreenLine<R>& line = bin.lines[i];
                    const std::uint32_t entry = entries_.add(line.segment);
                    const SampleBox box{buffer_.left(), buffer_.top(), buffer_.left() + Buffer::size,
                                        buffer_.top() + Buffer::size};
                    draw_line(line, box, [&](std::int32_t column, std::int32_t row, const R& z) {
                        buffer_.put(column, row, z, entry);
                    });
                }
            }
        }
    }

    /// Its pixels' light, and z* if asked for, into pictures of the crop's size. The light of empty tiles is
    /// there after finish().
    void paint(int tile, const Crop& crop, Image& image, std::vector<R>* pseudodepth) {
        const Crop pixels = tiles_.pixels_of(tile);
        if (entries_.empty()) {
            store_background(tile, crop, image);
            if (pseudodepth != nullptr) {
                store_no_depth(pixels, crop, image.width, *pseudodepth);
            }
            return;
        }
        entries_.clear_marks();
        mark_samples(pixels);
        if constexpr (S::traits.transmission) {
            find_fragments();
        }
        prepare_shader();
        shade(pixels);
        if constexpr (S::traits.transmission) {
            blend();
        }
        colors_.store(pixels, crop, image);
        if (pseudodepth != nullptr) {
            store_depth(buffer_, tiles_.samples_across(), pixels, crop, image.width, *pseudodepth);
        }
    }

    void finish() { background_.write_all(); }

    /// What lies on a sample of the picture, seen or not: a triangle by its id, or a line by its segment.
    struct Covering {
        std::uint32_t id;
        R z;
        bool is_line, is_seen;
    };
    std::vector<Covering> covering(int tile, int column, int row) const {
        std::vector<Covering> found;
        if (entries_.empty()) {
            return found;
        }
        const auto index = static_cast<std::size_t>(tile);
        const auto sample =
            static_cast<std::uint32_t>(Buffer::sample_of(column - buffer_.left(), row - buffer_.top()));
        const std::uint32_t seen = buffer_.entry(sample);
        const auto add = [&](std::uint32_t id, const R& z, bool is_line) {
            found.push_back(
                {id, z, is_line,
                 seen != no_entry && entries_.id(seen) == id && (seen >= first_line_) == is_line});
        };
        Buffer empty;
        empty.clear(buffer_.left(), buffer_.top(), std::numeric_limits<R>::max());
        const auto visit = [&](const auto& t) {
            const auto never = [](std::uint32_t, std::uint32_t) { return false; };
            empty.visit(t, 0, never, [&](std::uint32_t at, const R& z) {
                if (at == sample) {
                    add(t.id, z, false);
                }
            });
        };
        for (const Bin<R>& bin : bins_) {
            for (const SmallTriangle<R>& t : bin.small_of[index]) {
                visit(t);
            }
            for (const NarrowTriangle<R>& t : bin.narrow_of[index]) {
                visit(t);
            }
            for (const std::uint32_t i : bin.triangles_of[index]) {
                visit(bin.triangles[i]);
            }
            for (const std::uint32_t i : bin.lines_of[index]) {
                const SampleBox box{column, row, column + 1, row + 1};
                draw_line(bin.lines[i], box, [&](std::int32_t x, std::int32_t y, const R& z) {
                    if (x == box.x0 && y == box.y0) {
                        add(bin.lines[i].segment, z, true);
                    }
                });
            }
        }
        return found;
    }

    /// What its pixels' centres show beside light; see draw_raster_aovs.
    void store_aovs(int tile, const Crop& crop, AovImage& to) {
        const Crop pixels = tiles_.pixels_of(tile);
        const bool is_empty = entries_.empty();
        if (!is_empty) {
            entries_.clear_marks();
            mark_samples(pixels);
            prepare_shader();
        }
        const int left = tiles_.left_of(tile), top = tiles_.top_of(tile);
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            for (int x = pixels.x0; x < pixels.x1; ++x) {
                const std::size_t i =
                    static_cast<std::size_t>(y - crop.y0) * static_cast<std::size_t>(to.width) +
                    static_cast<std::size_t>(x - crop.x0);
                const std::uint32_t entry =
                    is_empty ? no_entry : buffer_.entry(Buffer::sample_of(x - left, y - top));
                store_aovs(x - left, y - top, entry, i, to);
            }
        }
    }

private:
    static constexpr std::size_t fills_per_write = 4; ///< which take about as long as write_some()
    struct Through {
        const ScreenTriangle<R>* triangle;
        std::uint32_t entry;
    };
    /// What one sample shows of what lets light through.
    struct Fragment {
        std::uint32_t sample; ///< of the buffer
        std::uint32_t entry;
        R z;
    };

    Rgb<float> scene_background() const {
        const Rgb<R> color(scene_.background);
        return {static_cast<float>(color.r) + 0.0F, static_cast<float>(color.g) + 0.0F,
                static_cast<float>(color.b) + 0.0F};
    }
    bool is_empty(int tile) const {
        return std::all_of(bins_.begin(), bins_.end(), [&](const Bin<R>& bin) {
            return bin.has_nothing_in(static_cast<std::size_t>(tile));
        });
    }
    void reserve_entries(std::size_t tile) {
        std::size_t count = 0;
        for (const Bin<R>& bin : bins_) {
            count += bin.count_in(tile);
        }
        entries_.reserve(count);
    }
    /// Of two triangles at the same depth: in the source. A mesh's are not kept in the source's order.
    bool is_earlier(std::uint32_t a, std::uint32_t b) const {
        const std::uint32_t first = entries_.id(a) & triangle_number,
                            second = entries_.id(b) & triangle_number;
        const RasterSurface<R>&one = surface_of_triangle(model_, first),
              &other = surface_of_triangle(model_, second);
        if (&one != &other) {
            return first < second;
        }
        return rank_of_triangle(model_, scene_.meshes, one, first - one.first) <
               rank_of_triangle(model_, scene_.meshes, other, second - other.first);
    }
    void find_fragments() {
        fragments_.clear();
        const auto earlier = [this](std::uint32_t a, std::uint32_t b) {
            return b >= first_line_ || is_earlier(a, b);
        };
        for (const Through& t : through_) {
            buffer_.visit(*t.triangle, t.entry, earlier, [&](std::uint32_t sample, const R& z) {
                fragments_.push_back({sample, t.entry, z});
                entries_.mark(t.entry);
            });
        }
        std::sort(fragments_.begin(), fragments_.end(), [this](const Fragment& a, const Fragment& b) {
            return a.sample != b.sample ? a.sample < b.sample
                   : a.z != b.z         ? a.z > b.z
                                        : is_earlier(b.entry, a.entry);
        });
    }

    /// f(lanes, entry) for each entry that active lanes of a block show.
    template <class F>
    void for_each_entry(std::size_t block, const MaskOf<L>& active, F&& f) const {
        for (unsigned left = bits(active); left != 0;) {
            const std::uint32_t entry = buffer_.entries(block)[__builtin_ctz(left)];
            const MaskOf<L> lanes = buffer_.shows(block, entry);
            f(lanes, entry);
            left &= ~bits(lanes);
        }
    }

    void mark_samples(const Crop& pixels) {
        std::uint32_t last = no_entry;
        colors_.for_each_block(pixels, [&](std::size_t block, int, int) {
            if (all(buffer_.shows(block, last))) {
                return;
            }
            for (std::size_t k = 0; k < N; ++k) {
                entries_.mark(buffer_.entry(block * N + k));
            }
            last = buffer_.entry(block * N);
        });
    }
    /// Tells the shader of what is marked.
    void prepare_shader() {
        entries_.number_marked([this](std::uint32_t entry) {
            const std::uint32_t id = entries_.id(entry);
            return entry < first_line_ ? shader_.add(id) : shader_.add(model_.segments[id].color);
        });
        shader_.prepare();
    }

    void shade(const Crop& pixels) {
        const Rgb<L> background = lanes<L>(Rgb<R>(scene_.background));
        colors_.for_each_block(pixels, [&](std::size_t block, int x, int y) {
            const auto active = buffer_.shown(block);
            if (none(active)) {
                colors_[block] = background;
                return;
            }
            const L column = buffer_.columns() + L(static_cast<R>(x)),
                    row = buffer_.rows() + L(static_cast<R>(y));
            const auto for_each_group = [&](auto&& f) {
                for_each_entry(block, active, [&](const MaskOf<L>& lanes, std::uint32_t entry) {
                    f(lanes, entries_.number(entry));
                });
            };
            Rgb<L> light;
            if (shader_.has_vertices_alone()) {
                light = shader_.interpolate(for_each_group, column, row).light;
            } else {
                LaneGroups<L> groups;
                for_each_group([&](const auto&... group) { groups.add(group...); });
                light = shader_.shade(groups, column, row, active).light;
            }
            colors_[block] = all(active) ? light : choose(active, light, background);
        });
    }

    /// Each fragment's own light, and the part of what is behind it that it leaves.
    void blend() {
        for (std::size_t i = 0; i < fragments_.size(); i += N) {
            const int count = static_cast<int>(std::min<std::size_t>(N, fragments_.size() - i));
            LaneGroups<L> groups;
            L column, row;
            MaskOf<L> active(false);
            for (int k = 0; k < N; ++k) {
                const Fragment& fragment = fragments_[i + static_cast<std::size_t>(std::min(k, count - 1))];
                MaskOf<L> lane(false);
                set_lane(lane, k, true);
                groups.add(lane, entries_.number(fragment.entry));
                set_lane(column, k, static_cast<R>(Buffer::column_of(fragment.sample)));
                set_lane(row, k, static_cast<R>(Buffer::row_of(fragment.sample)));
                set_lane(active, k, k < count);
            }
            const Seen<L> seen = shader_.shade(groups, column, row, active);
            for (int k = 0; k < count; ++k) {
                const std::uint32_t sample = fragments_[i + static_cast<std::size_t>(k)].sample;
                Rgb<L>& to = colors_[sample / N];
                const int at = static_cast<int>(sample % N);
                const auto put = [&](L& channel, const L& light, const L& transmit) {
                    set_lane(channel, at, lane(light, k) + lane(transmit, k) * lane(channel, at));
                };
                put(to.r, seen.light.r, seen.transmit.r);
                put(to.g, seen.light.g, seen.transmit.g);
                put(to.b, seen.light.b, seen.transmit.b);
            }
        }
    }

    /// Of the first of several empty tiles side by side, all of theirs: long rows are faster to write than
    /// many short ones.
    void store_background(int tile, const Crop& crop, Image& image) {
        const auto is_first = [&](int t) { return t % tiles_.across() == 0; };
        if (!is_first(tile) && is_empty(tile - 1)) {
            return;
        }
        int end = tile + 1;
        while (end < tiles_.count() && !is_first(end) && is_empty(end)) {
            ++end;
        }
        const Crop pixels = tiles_.pixels_of(tile);
        const int width = tiles_.pixels_of(end - 1).x1 - pixels.x0;
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            background_.add(image.at(pixels.x0 - crop.x0, y - crop.y0), width);
        }
    }
    void store_aovs(int column, int row, std::uint32_t entry, std::size_t i, AovImage& to) const {
        const auto put = [i](auto& list, auto value) {
            if (!list.empty()) {
                using T = std::decay_t<decltype(list[0])>;
                list[i] = static_cast<T>(value) + T(0);
            }
        };
        const auto put_vector = [&](std::array<std::vector<float>, 3>& lists, const Vec3<L>& v,
                                    const std::array<double, 3>& origin) {
            put(lists[0], static_cast<double>(lane(v.x, 0)) + origin[0]);
            put(lists[1], static_cast<double>(lane(v.y, 0)) + origin[1]);
            put(lists[2], static_cast<double>(lane(v.z, 0)) + origin[2]);
        };
        if (entry == no_entry) {
            put(to.depth, std::numeric_limits<float>::infinity());
            put(to.planar, std::numeric_limits<float>::infinity());
            put_vector(to.position, {}, {});
            put_vector(to.normal, {}, {});
            put(to.uv[0], 0.0F);
            put(to.uv[1], 0.0F);
            put(to.object, 0U);
            put(to.material, 0U);
            return;
        }
        MaskOf<L> one(false);
        set_lane(one, 0, true);
        LaneGroups<L> groups;
        groups.add(one, entries_.number(entry));
        const auto at =
            shader_.template place<true>(groups, L(static_cast<R>(column)), L(static_cast<R>(row)), one);
        put(to.depth, lane(at.ahead * length(at.dir), 0));
        put(to.planar, lane(at.ahead, 0));
        put_vector(to.position, at.point.world, to.origin);
        put_vector(to.normal, at.normal, {});
        put(to.uv[0], lane(at.point.uv.x, 0));
        put(to.uv[1], lane(at.point.uv.y, 0));
        put(to.object, shader_.object_of(entries_.number(entry)) + 1);
        put(to.material, lane(at.material, 0) + 1);
    }

    const S& scene_;
    const RasterModel<R>& model_;
    const RasterView<R>& view_;
    const TileGrid& tiles_;
    const std::vector<Bin<R>>& bins_;
    Shader shader_;
    Buffer buffer_;
    TileColors<L> colors_;
    TileEntries entries_;
    std::uint32_t first_line_ = 0; ///< entries from here on are lines
    std::vector<Through> through_;
    std::vector<Fragment> fragments_;
    BackgroundRows background_;
};

} // namespace scc::runtime::raster
