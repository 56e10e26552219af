// Where what the pixels see was at the moment before. Private to src/reference.
#pragma once

#include <optional>

#include "denoise/denoise_params.h"
#include "scene/picture.h"

namespace peelray {

/// Of a triangle, its object as Geometry::objects numbers them.
uint32_t object_of(const Geometry& geometry, uint32_t triangle);

/// What the surfaces on a way from the camera, mirrors and glass, make of points of the moment before: where the camera
/// saw their images.
struct PastImage {
    glm::dmat3 linear{1};
    glm::dvec3 origin{0};
    glm::dvec3 operator()(const glm::dvec3& point) const { return linear * point + origin; }
};

class MomentBefore {
  public:
    /// A point of a triangle; `u`, `v`: weights of its second and third vertex.
    struct Place {
        uint32_t triangle;
        double u, v;
    };

    /// The scene and its camera `now` and `before`; the triangles of now, and the settings, must outlive it.
    MomentBefore(const Geometry& now, Geometry before, const View& view_now, const View& view_before,
                 const PictureSettings& settings)
        : now_(now), before_(std::move(before)), view_now_(view_now), view_before_(view_before), settings_(settings) {}

    /// Aovs::motion of a camera ray's hit.
    glm::vec2 motion(const Place& hit) const;

    /// The images by one surface more, where a ray of direction `in`, unit like `out`, met it and goes on along `out`:
    /// the way behind it is mirrored or, where it goes through, turned, so that it goes straight on.
    PastImage straightened(const PastImage& image, const Place& hit, const glm::dvec3& in, const glm::dvec3& out) const;
    /// Of a hit whose image the camera sees at `seen` now; none: straight at the hit.
    DenoiseMotion motion_of_image(const Place& hit, const PastImage& image,
                                  const std::optional<glm::dvec3>& seen) const;

  private:
    struct Corners {
        glm::dvec3 a, b, c;
        glm::dvec3 at(const Place& hit) const { return a + hit.u * (b - a) + hit.v * (c - a); }
        glm::dvec3 normal() const { return glm::cross(b - a, c - a); }
    };
    /// As they are in order now: of a triangle that has been turned over since, the second and third were the other way
    /// round.
    Corners corners(const Geometry& geometry, const Place& hit) const;
    glm::dvec2 place(const View& view, const glm::dvec3& point) const;
    bool is_ahead(const glm::dvec3& point) const;

    const Geometry& now_;
    const Geometry before_;
    const View view_now_, view_before_;
    const PictureSettings& settings_;
};

}  // namespace peelray
