// What frames take on the GPU, and medians over several of them.
#pragma once

#include <algorithm>
#include <map>

#include "gpu/commands.h"
#include "render/render_stats.h"

namespace peelray {

/// The middle value, of an even number the upper one of the two; 0 of none.
double median(std::vector<double> values);

/// Times of passes by name, added up in the order in which the names first appeared.
class TimeTable {
  public:
    void add(const std::vector<PassTime>& times);
    const std::vector<PassTime>& rows() const { return rows_; }

  private:
    std::vector<PassTime> rows_;
};

/// One frame, submission by submission.
struct FrameMeter {
    TimeTable passes;
    double ms = 0;        ///< from first to last pass, over all submissions
    uint32_t redone = 0;  ///< how often something did not fit and was done again

    /// Adds what the last submission took.
    void add(const Commands& commands);
};

/// The frames of a picture that is rendered several times over.
class Measurement {
  public:
    /// `repeat`: frames to render, at least one; 0 counts as one.
    explicit Measurement(uint32_t repeat) : repeat_(std::max(repeat, 1u)) {}

    uint32_t frames() const { return repeat_; }
    /// The next frame. The first of several warms up (pipelines, memory, clocks): of it only `redone` counts.
    void add(const FrameMeter& frame);
    /// Fills in the times, which are medians, and `redone`.
    void describe(RenderStats& stats) const;

  private:
    uint32_t repeat_, added_ = 0, redone_ = 0;
    TimeTable last_;
    std::map<std::string, std::vector<double>> passes_;
    std::vector<RenderStats::FrameTime> frames_;
};

}  // namespace peelray
