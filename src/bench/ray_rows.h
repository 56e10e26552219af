// What the benchmark of rays found out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/judge.h"
#include "reference/ray_sets.h"
#include "render/cost_counter.h"

namespace peelray {

/// One set of rays through one contender.
struct TracedSet {
    RayKind kind = RayKind::primary;
    size_t rays = 0;
    Timing time;
    Judgement judged;
    std::string way;                 ///< how they were traced, if there was a choice
    std::optional<KindCosts> costs;  ///< of ours

    bool counts() const { return judged.passes() && time.runs > 0; }
    double mrays_per_second() const { return time.median > 0 ? double(rays) / time.median * 1e-3 : 0; }
};

/// One contender in one scene and picture size.
struct RayRow {
    std::string scene, shown;  ///< as --scenes has it; the file or built-in scene that it is
    bool stands_in = false;
    uint64_t triangles = 0;  ///< 0: unknown
    glm::uvec2 size{0};
    std::string contender;                   ///< what it is called: exact or planar (ours), khr, Embree
    std::optional<HitTest> hit;              ///< of ours; none: a rival
    Traversal traversal = Traversal::voxel;  ///< of ours
    std::optional<uint32_t> ldc;             ///< of ours: as asked for; none: auto
    uint32_t resolution = 0;                 ///< of ours: voxels along the largest cube
    bool series = false;                     ///< of the series of picture sizes
    std::string left_out;                    ///< why, as Error::text(); empty: it was measured
    Timing build, refit, frame;              ///< without runs: not measured
    std::string frame_left_out;              ///< the same of the frame, if it was tried
    std::vector<TracedSet> sets;             ///< in the order of --rays
    MemoryUse memory;

    bool is_ours() const { return hit.has_value(); }
    const TracedSet* set(RayKind kind) const;
    /// Everything rebuilt, mirror and shadow rays, milliseconds; none: not all of it was measured and right.
    std::optional<double> dynamic_ms() const;
    /// "exact 256", "planar auto", "khr": what it is called in plots and ratios.
    std::string label() const;
};

}  // namespace peelray
