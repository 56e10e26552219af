// Who takes part in a benchmark of rays.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/timing.h"
#include "common/ray.h"
#include "ldc/trace_params.h"
#include "render/cost_counter.h"

namespace peelray {

/// What a contender's answers claim to be, which decides how many may be wrong (judge.h).
enum class Claim : uint8_t {
    exact,   ///< those of a double-precision ray tracer
    voxel,   ///< those, within a voxel
    single,  ///< those of a single-precision ray tracer: wrong at some edges
};

/// Bytes held by each structure, by its name; scratch memory included.
using MemoryUse = std::vector<std::pair<std::string, uint64_t>>;

/// A structure over one scene's triangles and the rays that are traced in it. It is complete once constructed: built,
/// or ready to be built.
class RayContender {
  public:
    virtual ~RayContender() = default;

    virtual Claim claim() const = 0;
    /// Height above its surface from which a ray counts that starts at this triangle (file order), world units.
    virtual float start_offset(uint32_t /*triangle*/) const { return 0; }
    /// The side of a voxel of Claim::voxel, world units; 0: there are none.
    virtual double voxel() const { return 0; }

    /// Times building everything again from the vertices as they are.
    virtual Timing time_build(uint32_t runs) = 0;
    /// Times bringing the structure up to date where only vertices moved; no runs: it has no such way.
    virtual Timing time_refit(uint32_t /*runs*/) { return {}; }

    /// Takes the rays that the next calls are about. Throws Error where they do not fit.
    virtual void take(std::vector<Ray> rays) = 0;
    /// Times tracing all of them; `any_hit`: only whether there is a hit.
    virtual Timing time_trace(bool any_hit, uint32_t runs) = 0;
    /// What the last run of time_trace() found, for each ray: only whether it hit something, if that was `any_hit`.
    virtual std::vector<FileHit> answers() = 0;
    /// What the rays cost, counted apart; none: nobody counts.
    virtual std::optional<KindCosts> costs(bool /*any_hit*/) { return std::nullopt; }
    /// How the rays were traced, if there was a choice.
    virtual std::string way() const { return {}; }

    virtual MemoryUse memory() const = 0;
};

}  // namespace peelray
