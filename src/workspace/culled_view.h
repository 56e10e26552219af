// What a picture lacks because only the fronts of single-sided faces are shown.
#pragma once

#include "scene/picture.h"

namespace peelray {

/// The share of a picture in which something is seen, [0, 1].
double seen_share(const Picture& picture);

/// The share in which nothing is, but backs would be: found at so many pixels, spread evenly, that it is sure. Of a
/// picture of the geometry, which is that of its moment, seen by the camera of the settings.
double culled_share(const Scene& scene, const Geometry& geometry, const PictureSettings& settings,
                    const Picture& picture);

/// A note where nearly all that the camera could see are backs, as in a room that is made to be seen from outside;
/// else empty.
std::string culled_note(double seen, double culled);

/// Only below this share of the picture can there be a note.
inline constexpr double kMostSeenInNote = 0.1;

}  // namespace peelray
