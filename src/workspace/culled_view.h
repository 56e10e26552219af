// What a picture lacks because only the fronts of single-sided faces are shown.
#pragma once

#include "scene/picture.h"

namespace peelray {

/// Shares of a picture, [0, 1].
struct CulledView {
    double seen = 0;    ///< something is seen
    double culled = 0;  ///< nothing is, but backs would be: found at so many pixels, spread evenly, that it is sure
};

/// Of a picture of the geometry, which is that of its moment, seen by the camera of the settings.
CulledView culled_view(const Scene& scene, const Geometry& geometry, const PictureSettings& settings,
                       const Picture& picture);

/// How much of it a surface covers.
double covered(const Picture& picture);

/// A note where nearly all that the camera could see are backs, as in a room that is made to be seen from outside;
/// else empty.
std::string culled_note(const CulledView& view);

/// Only below this share of the picture can there be a note.
inline constexpr double kMostSeenInNote = 0.1;

}  // namespace peelray
