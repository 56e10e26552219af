// The bodies of a scene on the device: which triangles are theirs, and their boxes as they are now.
#pragma once

#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "ldc/ldc_params.h"

namespace peelray {

/// Triangles that share a cube, in a space of their own.
struct CubeBody {
    uint32_t first_triangle = 0, triangles = 0;
    uint32_t resolution = 512;     ///< voxels along the longest side: 16 to 2048, rounded up to a multiple of 16
    glm::vec3 lower{0}, upper{0};  ///< bounds; of bodies that deform: as they are now, for a guess of what they need
    float tolerance = 0;           ///< of `tolerance` hits, in the units of the body's space
    /// No cube is built: rays test the triangles one by one, at most PEELRAY_BARE_TRIANGLES. By voxel, built by
    /// `compute`.
    bool bare = false;
};

/// The next multiple of 16. Throws Error unless 16 ≤ resolution ≤ 2048.
uint32_t round_resolution(uint32_t resolution);

/// What instances place, whoever traces rays. Bounds are written by the passes that bend a body; the rest of an entry
/// is filled in where a cube is built.
class BodyTable {
  public:
    /// `bodies` in ascending order of their triangles, without gaps; at least one. `part`: of the program, that their
    /// memory is accounted for as. Throws Error for a resolution out of range.
    BodyTable(Device& device, std::vector<CubeBody> bodies, const char* part);

    const std::vector<CubeBody>& bodies() const { return bodies_; }

    /// Records that the bounds of bodies [first, end) hold nothing.
    void record_emptying(Commands& commands, uint32_t first, uint32_t end) const;

    /// The entries as the last submission left them.
    std::vector<LdcBody> download(Commands& commands) const;

    Buffer entries;       ///< LdcBody each
    Buffer lower, upper;  ///< bounds: uvec3 each, as orderedBits of shaders/common/bounds.glsl

  private:
    std::vector<CubeBody> bodies_;
};

}  // namespace peelray
