// Table 1 of the paper again: its scenes, with several ways to build their cubes and trace in them.
#pragma once

#include "bench/bench_settings.h"
#include "bench/paper_scenes.h"
#include "bench/timing.h"
#include "workspace/notes.h"
#include "workspace/stats.h"

namespace peelray {

/// A line of our table: a scene with one way to build and trace its cubes.
struct PaperRow {
    const PaperScene* scene = nullptr;
    std::string shown;  ///< file name or built-in scene
    bool stands_in = false;
    uint64_t triangles = 0;  ///< with the floor; 0: unknown
    BuilderKind builder = BuilderKind::compute;
    Traversal traversal = Traversal::voxel;
    HitTest hit = HitTest::exact;
    uint32_t ldc = 0;
    double tolerance = 0;               ///< world units
    std::optional<uint32_t> layers;     ///< samples of the fullest pixel; none: the cube has no such order
    uint32_t object_pixels = 0;         ///< along the longest side of what stands on the floor, in its LDIs; 0: unknown
    std::string left_out;               ///< why, as Error::text(); empty: it was measured
    Timing a, b, frame;                 ///< the cubes; all else; both
    std::vector<PassTime> passes;       ///< medians
    std::optional<PictureStats> stats;  ///< of the last frame
};

class PaperBench {
  public:
    /// Throws Error for a device that measures nothing. The settings must outlive it.
    PaperBench(const BenchSettings& settings, Notes notes);

    const Machine& machine() const { return machine_; }
    size_t rows() const;

    /// Measures and hands on every row; what cannot be measured is left out with the reason. Throws Interrupted, and
    /// Error where the validation layers said anything.
    void run(const std::function<void(const PaperRow&)>& add, const RowProgress& progress);

    /// A way to build cubes and trace in them.
    struct Combination {
        BuilderKind builder;
        Traversal traversal;
        HitTest hit;
    };

  private:
    void run(const PaperScene& scene, const std::function<void(const PaperRow&)>& add, const RowProgress& progress);

    const BenchSettings& settings_;
    Notes notes_;
    std::vector<Combination> combinations_;
    std::vector<const PaperScene*> scenes_;
    Machine machine_;
    size_t done_ = 0;
};

}  // namespace peelray
