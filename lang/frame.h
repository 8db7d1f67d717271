#pragma once

#include "lang/code.h"
#include "lang/value.h"

#include <memory>
#include <vector>

namespace scc::lang {

struct Frame;
using FramePtr = std::shared_ptr<Frame>;

/// Frames that function values refer to. A function may be stored in a frame that it refers to, so these do
/// not free each other; they are emptied together.
class CapturedFrames {
public:
    CapturedFrames() = default;
    CapturedFrames(const CapturedFrames&) = delete;
    CapturedFrames& operator=(const CapturedFrames&) = delete;
    ~CapturedFrames();

    void add(const FramePtr& frame) { frames_.push_back(frame); }

private:
    std::vector<std::weak_ptr<Frame>> frames_;
};

/// The values of a scope's names. A cell is computed when it is first read.
struct Frame {
    struct Cell {
        Value value;
        bool ready = false;
    };

    FramePtr parent;
    const std::vector<CodePtr>* code;
    CapturedFrames* captured;
    std::vector<Cell> cells;
    std::size_t depth; ///< of RunReport, where it was made
    bool is_captured = false;
    bool is_rehearsed = false; ///< made while a loop's body is recorded

    Frame(FramePtr outer, const std::vector<CodePtr>& cell_code, CapturedFrames* captured_frames,
          std::size_t report_depth)
        : parent(std::move(outer)), code(&cell_code), captured(captured_frames), cells(cell_code.size()),
          depth(report_depth) {}

    void set(std::size_t cell, Value value) {
        cells[cell].value = std::move(value);
        cells[cell].ready = true;
    }
};

inline CapturedFrames::~CapturedFrames() {
    for (const std::weak_ptr<Frame>& weak : frames_) {
        if (const FramePtr frame = weak.lock()) {
            frame->cells.clear();
        }
    }
}

struct Closure {
    const FunctionCode* function;
    FramePtr frame; ///< the one around the function
};

} // namespace scc::lang
