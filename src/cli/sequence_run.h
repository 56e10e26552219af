// What all kinds of sequences have in common: frames are rendered one after the other and handed to other threads.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>

#include "cli/frame_pool.h"
#include "cli/sequence.h"

namespace peelray {

/// Everything that the frames of a run share.
class SequenceRun {
  public:
    /// Opens the scene. `sequence` must outlive it. Throws Error.
    SequenceRun(const RenderArguments& arguments, const Sequence& sequence);

    const PosedScene& scene() const { return workspace_.scene(); }
    std::string renderer_name() { return workspace_.renderer_name(*arguments_.tracing.tracer); }

    /// What is to be done with a frame, on any thread, and after it in the order of the frames, if there is anything.
    struct Tasks {
        FramePool::Work work;
        std::function<void()> deliver = {};
    };
    using TasksOf = std::function<Tasks(uint32_t frame)>;
    /// What becomes of frames that are rendered but not written when the run ends early.
    enum class Rest { written, dropped };
    /// Renders frames, one at a time, and hands each to the pool, until all is written. Throws Error, and Interrupted
    /// between any two steps.
    void render(const std::vector<uint32_t>& frames, FramePool& pool, Rest rest, const TasksOf& tasks_of);

    /// The stats file. `left_alone`: frames that were there already.
    nlohmann::ordered_json stats(size_t left_alone) const;
    /// What to print in the end, without what was written.
    std::string summary(size_t left_alone) const;
    /// Seconds that rendering alone took so far.
    double render_seconds() const { return render_seconds_; }

  private:
    struct Frame {
        uint32_t number;
        Shot shot;
        PictureStats stats;
    };
    MadePicture make(uint32_t frame, const std::function<void(double)>& progress);
    void render_all(const std::vector<uint32_t>& frames, FramePool& pool, const TasksOf& tasks_of);
    void count(uint32_t frame, MadePicture& made);
    nlohmann::ordered_json frame_json(const Frame& frame) const;

    const Sequence& sequence_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    RenderArguments arguments_;
    Workspace workspace_;
    size_t done_ = 0;
    double render_seconds_ = 0;
    std::string device_;  ///< that rendered so far
    RayCounts rays_;
    double frame_ms_ = 0, build_ms_ = 0;
    std::vector<Frame> frames_;  ///< for the stats file, if there is one
};

/// The ways that a sequence goes. Each throws Error.
void render_pictures(const RenderArguments& arguments, const Sequence& sequence);
void render_video(const RenderArguments& arguments, const Sequence& sequence);
/// To the standard output.
void render_stream(const RenderArguments& arguments, const Sequence& sequence);

}  // namespace peelray
