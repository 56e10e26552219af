// Are a contender's answers right? The time counts only if they are.
#pragma once

#include <span>

#include "bench/contender.h"
#include "reference/oracle.h"

namespace peelray {

/// What the oracle says of some of a contender's answers.
struct Judgement {
    uint64_t checked = 0, wrong = 0;
    uint64_t counted = 0;      ///< what `allowed` is a share of: the answers, of Claim::voxel the hits among them
    uint64_t second_look = 0;  ///< right for a ray beside it only
    double allowed = 0;        ///< share of `counted` that may be wrong

    double beside = 0;  ///< share of `counted` that may be right for a ray beside it only

    bool passes() const {
        return double(wrong) <= allowed * double(counted) && double(second_look) <= beside * double(counted);
    }
};

/// Judges up to `most` answers, spread evenly over the set, on all cores.
/// - Claim::exact: Oracle::check, none may be wrong, by the rule of docs/accuracy.md, "Rays" (the answer of a ray
/// within
///   2·10⁻⁶ of the diagonal, to 10⁻⁵).
/// - Claim::single: the same, one in 10,000 may be: single precision decides wrongly at some edges.
/// - Claim::voxel: hits must lie within a voxel of the right one, or of that of a parallel ray at most a voxel away.
///   0.3 % of the hits may be off by more at 1024 voxels, and at other resolutions as much more as the voxels are
///   larger: 1.2 % at 256. `resolution`: voxels along the largest cube.
Judgement judge(const Oracle& oracle, const Geometry& geometry, const RayContender& contender, uint32_t resolution,
                std::span<const Ray> rays, std::span<const FileHit> hits, bool any_hit, size_t most = 20'000);

/// The largest share of answers that may be right for a ray beside theirs only: 0.1 %, of Claim::voxel 2 % at 1024
/// voxels and as much more as the voxels are larger.
double beside_share(Claim claim, uint32_t resolution);

/// The largest share of wrong answers that a claim allows.
double allowed_share(Claim claim, uint32_t resolution);

}  // namespace peelray
