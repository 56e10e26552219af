// Rays and frames of many scenes: our cubes against rivals on the same rays.
#pragma once

#include "bench/bench_settings.h"
#include "bench/clock_probe.h"
#include "bench/ray_rows.h"
#include "bench/scenes.h"
#include "workspace/notes.h"
#include "workspace/stats.h"

namespace peelray {

class MeasuredScene;

class RayBench {
  public:
    /// Throws Error for a device that measures nothing. The settings must outlive it.
    RayBench(const BenchSettings& settings, Notes notes);

    Machine machine() const { return machine_of(device_); }
    const std::vector<RayKind>& kinds() const { return kinds_; }
    size_t rows() const;  ///< at most

    /// Measures and hands on every row; what cannot be measured is left out with the reason. Throws Interrupted, and
    /// Error where the validation layers said anything.
    void run(const std::function<void(const RayRow&)>& add, const RowProgress& progress);

    /// One way of ours to build and trace.
    struct Way {
        HitTest hit;
        Traversal traversal;
        std::optional<uint32_t> ldc;
    };

  private:
    using Measure = std::function<void(RayRow&)>;
    std::vector<glm::uvec2> series_sizes() const;
    std::string series_scene() const;
    void measure_scene(const std::string& name);
    void measure_ways(MeasuredScene& scene, const RayRow& row, const std::vector<Way>& ways);
    void measure(RayRow row, const Measure& measure);

    const BenchSettings& settings_;
    Notes notes_;
    std::vector<RayKind> kinds_;
    Device device_;
    ClockProbe probe_{device_};
    std::vector<Way> ways_, series_ways_;
    std::function<void(const RayRow&)> add_;  ///< while it runs
    RowProgress progress_;
    size_t done_ = 0;
};

}  // namespace peelray
