// What a picture took, and what it was made with.
#pragma once

#include <string>
#include <vector>

#include "render/cost_counter.h"
#include "render/cube_maps.h"
#include "render/render_settings.h"
#include "render/tracers/tracer_stats.h"

namespace peelray {

struct RenderStats : TracerStats {
    Tracer tracer = Tracer::ldc;
    Visibility visibility = Visibility::compute;  ///< of the camera; never automatic
    /// GPU times; medians over the repeated frames; summed over bands, samples and levels of a frame; in order of their
    /// first run.
    std::vector<PassTime> passes;
    struct FrameTime {
        double frame_ms, build_ms;
    };
    std::vector<FrameTime> frames;  ///< each of those that the medians are taken of, in order
    double frame_ms = 0;            ///< GPU time from first to last pass, median over the frames
    double build_ms = 0;            ///< of the passes that build cubes, or acceleration structures
    double maps_ms = 0;             ///< of the passes of probes and shadow maps
    bool timed = false;             ///< false: the device has no timestamps
    uint32_t moved = 0;             ///< instances that stand elsewhere than in the frame before
    uint64_t scene_bytes = 0, frame_bytes = 0, peak_bytes = 0;
    uint32_t bands = 1, band_rows = 0;            ///< a picture is made in, for want of memory, and how high they are
    std::vector<Allocation> memory, peak_memory;  ///< all of the device's when the picture was done, and at the peak
    HitTest hit = HitTest::exact;
    CubeChoice choice;  ///< of the cubes
    CubeMaps::Stats maps;
    bool counted = false;  ///< with RenderSettings::counters
    AllKindCosts costs;    ///< of the last frame
    uint32_t redone = 0;   ///< how often something did not fit and was done again
};

}  // namespace peelray
