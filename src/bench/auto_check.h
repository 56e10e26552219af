// What `auto` chooses against the best fixed choice.
#pragma once

#include "bench/bench_settings.h"
#include "bench/clock_probe.h"
#include "bench/scenes.h"
#include "workspace/posed_scene.h"
#include "workspace/stats.h"

namespace peelray {

/// One scene, everything rebuilt or kept: the automatic choice and the best fixed ones.
struct AutoRow {
    /// A frame's time with one choice.
    struct Choice {
        std::optional<HitTest> hit;  ///< none: auto
        std::optional<uint32_t> ldc;
        double ms = 0;
        HitTest chosen = HitTest::exact;  ///< the hit test that it came to
    };

    std::string scene, shown;
    std::string left_out;  ///< why, as Error::text(); empty: it was measured
    bool stands_in = false, rebuilt = false;
    uint64_t triangles = 0;
    Choice automatic, best, best_same;  ///< best_same: among those with the hit test that `auto` chose
    std::vector<Choice> fixed;

    double ratio() const { return best.ms > 0 ? automatic.ms / best.ms : 0; }
    double ratio_same() const { return best_same.ms > 0 ? automatic.ms / best_same.ms : 0; }
};

class AutoCheck {
  public:
    /// Throws Error for a device that measures nothing. The settings must outlive it.
    AutoCheck(const BenchSettings& settings, Notes notes);

    Machine machine() const { return machine_of(device_); }
    size_t rows() const { return 2 * settings_.scenes.size(); }  ///< at most

    /// Measures and hands on every row; what cannot be measured is left out with the reason. Throws Interrupted, and
    /// Error where the validation layers said anything.
    void run(const std::function<void(const AutoRow&)>& add, const RowProgress& progress);

  private:
    using Add = std::function<void(const AutoRow&)>;
    void measure(const std::string& name, const Add& add);
    void measure(const PosedScene& scene, const PictureArguments& picture, Renderer& renderer, AutoRow& row);
    void time(const PictureArguments& picture, const PosedScene& scene, Renderer& renderer, AutoRow::Choice& choice);

    const BenchSettings& settings_;
    Notes notes_;
    Device device_;
    ClockProbe probe_{device_};
};

}  // namespace peelray
