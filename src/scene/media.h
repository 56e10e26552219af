// Media: what light is in between two surfaces. Materials with a volume fill one each, everything else is air. Where
// volumes overlap, the medium of the first rank counts, so that both sides of a wall decide alike (Schmidt and Budge,
// "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2), 2002).
#pragma once

#include "scene/moment.h"

namespace peelray {

/// Does a closed mesh of this material bound a medium?
bool fills_volume(const Material& material);

struct MediaRanks {
    static constexpr uint32_t none = ~0u;
    std::vector<uint32_t> of_material;  ///< rank of each material's medium, from 0; none: it fills no volume
    std::vector<uint32_t> materials;    ///< the other way: the material of each rank
};

/// The smaller volume counts: what floats in a drink, and the wall of the glass that the drink may reach into. A
/// material's volume is the largest that it fills in one node at rest, in world units; surfaces that are not closed
/// come after all others. Of equal volumes that of the material with the smaller index counts.
MediaRanks media_ranks(const Scene& scene);

/// The connected pieces of surface that bound volumes, for finding out whether media may overlap at a moment.
class MediaPieces {
  public:
    explicit MediaPieces(const Scene& scene);

    /// Do the boxes of two pieces meet? Then rays may be in several media at once. What is generated or deforms counts
    /// with its box at rest, copies of a swarm not at all.
    bool may_overlap(const Scene& scene, const Moment& moment) const;

    /// The materials whose volumes a point is in, each as often as it is: a surface counts where the point sees more of
    /// its inside than of its outside. What is generated or deforms counts as it is at rest.
    std::vector<uint32_t> around(const Scene& scene, const Moment& moment, const glm::dvec3& point) const;

  private:
    struct Piece {
        glm::vec3 lower, upper;  ///< in the space of its mesh
        uint32_t primitive;      ///< that it is a piece of
    };
    std::vector<std::vector<Piece>> pieces_;  ///< of all meshes
};

}  // namespace peelray
