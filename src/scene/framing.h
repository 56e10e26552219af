// A camera from which points fill the picture.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>

#include "scene/box.h"
#include "scene/scene.h"

namespace peelray {

/// What a camera is to see, point by point: it looks from slightly above and to the right, as near as the points allow.
class Framing {
  public:
    /// Of the picture's height or width, whichever the points fill more of: what stays free at both of its ends.
    static constexpr double margin = 0.05;

    struct Lens {
        float vertical_fov = glm::radians(40.f);
        float aspect = 1;
        glm::vec3 up{0, 1, 0};
    };

    Framing() : Framing(Lens{}) {}
    /// `pivot`: the camera will go round the vertical line through this point; all is to stay in the picture on the
    /// way.
    explicit Framing(const Lens& lens, const std::optional<glm::vec3>& pivot = {});

    void add(std::span<const glm::vec3> points);
    /// Around the points; lower > upper: there is none.
    const Box& box() const { return box_; }
    Camera camera() const;

  private:
    /// The farthest that points reach along a direction; on the way round the pivot, if there is one.
    double reach(const glm::dvec3& point, const glm::dvec3& direction) const;

    Lens lens_;
    std::optional<glm::dvec3> pivot_;
    glm::dvec3 right_, up_, back_;
    glm::dvec2 tangents_;  ///< of half the angles that the points may fill, across and up
    /// Of the four planes through the eye that bound what the points may fill: right, left, top, bottom.
    std::array<glm::dvec3, 4> planes_;
    std::array<double, 4> farthest_;
    double nearest_ = -std::numeric_limits<double>::infinity();  ///< along `back_`
    Box box_;
};

}  // namespace peelray
