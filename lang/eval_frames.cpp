#include "lang/evaluator.h"
#include "lang/imports.h"

#include <cmath>

namespace scc::lang {
namespace {

constexpr double most_frames = 1e6;

} // namespace

std::optional<Frames> Evaluator::frames(const CheckedFile& file, const FramePtr& globals,
                                        std::optional<std::int64_t> chosen) {
    const CheckedFile::Animated& animated = file.animated;
    if (!animated.frames) {
        return std::nullopt;
    }
    const BodyCode& body = animated.render->body;
    const FramePtr frame = body.has_frame ? make_frame(globals, body.cells) : globals;
    const Value value = eval(*animated.frames, frame);
    const auto* range = std::get_if<RangeValue>(&value.v);
    if (!range) {
        return std::nullopt;
    }
    const Span span = animated.frames->span;
    if (std::floor(range->begin) != range->begin || std::floor(range->end) != range->end) {
        report_.report(Diag::fractional_range, span, to_string(value));
        return std::nullopt;
    }
    const bool is_small = std::abs(range->begin) <= most_frames && std::abs(range->end) <= most_frames;
    if (!(range->end > range->begin) || !is_small) {
        report_.report(Diag::value_out_of_range, span, "frames", to_string(value),
                       "it holds at least one frame, from -1000000 to 1000000");
        return std::nullopt;
    }
    Frames result;
    result.begin = static_cast<std::int64_t>(range->begin);
    result.end = static_cast<std::int64_t>(range->end);
    if (animated.rate) {
        const Value rate = eval(*animated.rate, frame);
        const auto* number = std::get_if<NumberValue>(&rate.v);
        if (!number || !(number->v.value > 0)) { // reported with the field
            return std::nullopt;
        }
        result.rate = number->v.value;
    }
    result.chosen = chosen.value_or(result.begin);
    frames_ = result;
    return result;
}

Value Evaluator::run(const code::FrameNumber& node, Span span, const FramePtr&) {
    if (!frames_) {
        report_.report(Diag::frame_too_early, span, node.in_seconds ? "time" : "frame");
        return failed();
    }
    const auto frame = static_cast<double>(frames_->chosen);
    return number(node.in_seconds ? frame / frames_->rate : frame);
}

} // namespace scc::lang
