#pragma once

#include "runtime/camera_rays.h"
#include "runtime/image.h"
#include "runtime/shade.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace scc::runtime::detail {

/// The fewest samples of a pixel after which `adaptive` may stop, and how many there are between two looks.
inline constexpr int adaptive_step = 16;

/// The mean and the spread of a pixel's samples, one after the other (B. Welford, 1962).
class Spread {
public:
    void add(const std::array<double, 3>& sample) {
        count_ += 1;
        for (std::size_t k = 0; k < sample.size(); ++k) {
            const double before = sample[k] - mean_[k];
            mean_[k] += before / count_;
            squares_[k] += before * (sample[k] - mean_[k]);
        }
    }
    /// Whether the standard error of the mean, sqrt(variance / count), is no more in any channel.
    bool is_within(double tolerance) const {
        const double most = tolerance * tolerance * count_ * (count_ - 1);
        return std::all_of(squares_.begin(), squares_.end(), [=](double s) { return s <= most; });
    }

private:
    double count_ = 0;
    std::array<double, 3> mean_{}, squares_{}; ///< of the differences from the mean
};

/// Draws tiles whose samples may lie anywhere in their pixels, be as many as a pixel needs, and count in
/// neighbouring pixels too (see sampling.h). For the last of these the samples around the tile are drawn too,
/// also outside of the picture. A pixel's value is the sum of the means of its own and its neighbours'
/// samples, weighted by the filter, row by row, over that of the weights: so it depends on no tile or crop.
template <SceneModel S, class L>
class FreePainter {
public:
    using R = typename S::Real;

    FreePainter(const CameraRays<S>& camera, Shader<S, L>& shader, const RenderRequest& request, Image& image,
                RayCounts& rays)
        : camera_(camera), shader_(shader), settings_(request.settings), crop_(request.crop), image_(image),
          rays_(rays), reach_(reach_of(settings_.filter)), n_(samples_per_axis(settings_)) {}

    /// The pixels from (x, y) of the crop on, so many in either direction; those outside the crop are left
    /// out.
    void paint(int x, int y, int size, Candidates candidates) {
        candidates_ = candidates;
        left_ = crop_.x0 + x;
        const int top = crop_.y0 + y;
        columns_ = std::min(size, crop_.x1 - left_);
        const int rows = std::min(size, crop_.y1 - top);
        sums_.assign(static_cast<std::size_t>(columns_ * rows), {});
        sampled_.resize(static_cast<std::size_t>(columns_ + 2 * reach_));
        for (int row = -reach_; row < rows + reach_; ++row) {
            sample_row(top + row);
            for (int to = std::max(0, row - reach_); to < std::min(rows, row + reach_ + 1); ++to) {
                gather(row - to, &sums_[static_cast<std::size_t>(to * columns_)]);
            }
        }
        for (int row = 0; row < rows; ++row) {
            store(&sums_[static_cast<std::size_t>(row * columns_)], image_.at(x, y + row));
        }
    }

private:
    static constexpr int packs = packs_together<S, L>;
    static constexpr int block = packs * lane_count<L>;

    static constexpr int most_reach = 2;
    /// What is seen at a sample, and its weights in the pixels around its own.
    struct Seen {
        Rgb<R> color;
        std::array<R, 2 * most_reach + 1> across,
            down; ///< by the other pixel's column and row from `reach_` on
    };
    struct SampledPixel {
        std::vector<Seen> samples;
        Spread spread; ///< only of adaptive sampling
    };
    struct Sum {
        Rgb<R> color{};
        R weight = 0;
    };

    /// Draws the samples of a row of pixels, of the tile and what counts in it.
    void sample_row(int row) {
        open_.clear();
        for (std::size_t i = 0; i < sampled_.size(); ++i) {
            sampled_[i].samples.clear();
            sampled_[i].spread = {};
            open_.push_back(i);
        }
        const bool adaptive = settings_.adaptive > 0;
        const int step = adaptive ? adaptive_step : settings_.samples;
        for (int first = 0; first < settings_.samples && !open_.empty(); first += step) {
            sample(row, first, std::min(step, settings_.samples - first));
            if (adaptive) {
                std::erase_if(open_, [&](std::size_t i) { return is_done(sampled_[i], first); });
            }
        }
    }
    /// After the samples from `first` on.
    bool is_done(SampledPixel& pixel, int first) const {
        for (auto i = static_cast<std::size_t>(first); i < pixel.samples.size(); ++i) {
            const Rgb<R>& color = pixel.samples[i].color;
            pixel.spread.add({double(color.r), double(color.g), double(color.b)});
        }
        return pixel.spread.is_within(settings_.adaptive);
    }

    /// Draws so many samples of each open pixel, block by block.
    void sample(int row, int first, int count) {
        const int all = static_cast<int>(open_.size()) * count;
        for (int start = 0; start < all; start += block) {
            const auto sample_at = [&](int i) {
                const int pixel = static_cast<int>(open_[static_cast<std::size_t>((start + i) / count)]);
                return Sample{{left_ - reach_ + pixel, row}, first + (start + i) % count};
            };
            trace(std::min(block, all - start), sample_at);
        }
    }
    template <class SampleAt>
    void trace(int count, SampleAt&& sample_at) {
        std::array<Ray<L>, packs> rays;
        std::array<MaskOf<L>, packs> inside;
        std::array<Rgb<L>, packs> colors;
        std::array<Seen, block> seen;
        for (int p = 0; p < packs; ++p) {
            // What is left of the last block repeats its last sample.
            const auto sample_of = [&](int lane) {
                return sample_at(std::min(p * lane_count<L> + lane, count - 1));
            };
            const auto pack = static_cast<std::size_t>(p);
            L column, row, x, y;
            for (int lane = 0; lane < lane_count<L>; ++lane) {
                const int i = p * lane_count<L> + lane;
                const Sample sample = sample_of(lane);
                const Vec2<R> within = place(sample);
                weigh(within, seen[static_cast<std::size_t>(i)]);
                set_lane(column, lane, static_cast<R>(sample.pixel.column));
                set_lane(row, lane, static_cast<R>(sample.pixel.row));
                set_lane(x, lane, within.x);
                set_lane(y, lane, within.y);
                set_lane(inside[pack], lane, i < count);
            }
            const L window_x = camera_.window_x(column, x), window_y = camera_.window_y(row, y);
            rays[pack] = camera_.straight_ray(window_x, window_y);
            camera_.bend(window_x, window_y, sample_of, rays[pack]);
        }
        rays_.primary += static_cast<std::uint64_t>(count);
        shader_.radiance(rays, camera_.apex(), candidates_, inside, colors);
        for (int i = 0; i < count; ++i) {
            const Rgb<L>& color = colors[static_cast<std::size_t>(i / lane_count<L>)];
            const int k = i % lane_count<L>;
            Seen& one = seen[static_cast<std::size_t>(i)];
            one.color = {lane(color.r, k), lane(color.g, k), lane(color.b, k)};
            const int pixel = sample_at(i).pixel.column - (left_ - reach_);
            sampled_[static_cast<std::size_t>(pixel)].samples.push_back(one);
        }
    }
    /// Where a sample lies in its pixel, from its top left corner.
    Vec2<R> place(const Sample& sample) const {
        if (settings_.sampler == Sampler::grid) {
            return {(static_cast<R>(sample.number % n_) + R(0.5)) / static_cast<R>(n_),
                    (static_cast<R>(sample.number / n_) + R(0.5)) / static_cast<R>(n_)};
        }
        const SquarePoint point = SobolPoints(sample.pixel, PointUse::pixel)[sample.number];
        return {part_of_unit<R>(point.x), part_of_unit<R>(point.y)};
    }
    void weigh(const Vec2<R>& within, Seen& sample) const {
        for (int i = 0; i <= 2 * reach_; ++i) {
            const R from_center = static_cast<R>(i - reach_) - R(0.5);
            const auto k = static_cast<std::size_t>(i);
            sample.across[k] = filter_weight(settings_.filter, from_center + within.x);
            sample.down[k] = filter_weight(settings_.filter, from_center + within.y);
        }
    }

    /// Adds the row of samples to a row of the tile's pixels that lies so many rows higher.
    void gather(int below, Sum* sums) const {
        for (int from = 0; from < static_cast<int>(sampled_.size()); ++from) {
            const int column = from - reach_;
            for (int to = std::max(0, column - reach_); to < std::min(columns_, column + reach_ + 1); ++to) {
                add(sampled_[static_cast<std::size_t>(from)].samples, column - to, below, sums[to]);
            }
        }
    }
    /// What samples count in a pixel so many columns to the left and rows above.
    void add(const std::vector<Seen>& samples, int right, int below, Sum& sum) const {
        const auto column = static_cast<std::size_t>(right + reach_),
                   row = static_cast<std::size_t>(below + reach_);
        Sum own;
        for (const Seen& one : samples) {
            const R weight = one.across[column] * one.down[row];
            own.color = own.color + one.color * weight;
            own.weight += weight;
        }
        const R share = 1 / static_cast<R>(samples.size());
        sum.color = sum.color + own.color * share;
        sum.weight += own.weight * share;
    }

    /// + 0 as in the other painter.
    void store(const Sum* sums, float* pixel) const {
        for (int column = 0; column < columns_; ++column, pixel += 3) {
            const Sum& sum = sums[column];
            pixel[0] = static_cast<float>(sum.color.r / sum.weight) + 0.0F;
            pixel[1] = static_cast<float>(sum.color.g / sum.weight) + 0.0F;
            pixel[2] = static_cast<float>(sum.color.b / sum.weight) + 0.0F;
        }
    }

    const CameraRays<S>& camera_;
    Shader<S, L>& shader_;
    const RenderSettings& settings_;
    Crop crop_;
    Image& image_;
    RayCounts& rays_;
    int reach_; ///< see reach_of
    int n_;     ///< of the grid's n x n
    Candidates candidates_ = all_candidates;
    int left_ = 0, columns_ = 0;        ///< of the tile
    std::vector<SampledPixel> sampled_; ///< a row
    std::vector<std::size_t> open_;     ///< pixels of the row that want more samples
    std::vector<Sum> sums_;             ///< the tile
};

} // namespace scc::runtime::detail
