// Closed bodies as a lathe, a press and a milling machine make them. Private to src/builtin.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace peelray {

/// Corners of a polygon or of a line, in a plane.
using Outline = std::vector<glm::vec2>;

/// Adds the vertices and triangles of `part`, moved; nothing but positions, normals and texture coordinates.
void add_shape(Primitive& out, const Primitive& part, const glm::mat4& transform = glm::mat4(1));

/// Normals: smooth but for edges sharper than `crease_degrees`.
Primitive finished(Primitive shape, float crease_degrees = 35);

/// A body of revolution around y. `profile`: (radius, y), its outside on the right of who walks along it. It runs from
/// the axis (radius 0) to the axis, or is `closed` and stays off the axis. Without normals: see finished().
Primitive lathe(std::span<const glm::vec2> profile, uint32_t segments, bool closed = false);

/// A smooth line through points (Catmull and Rom, centripetal), in `count` pieces of about equal length; the points
/// themselves are among their ends, unless there are too few pieces for that.
Outline smooth_line(std::span<const glm::vec2> points, uint32_t count);
std::vector<glm::vec3> smooth_path(std::span<const glm::vec3> points, uint32_t count);

/// A cross-section at a share [0, 1] of a path.
struct CrossSection {
    glm::vec2 half;      ///< half its width and half its height, the height along the path's own up
    float squareness{};  ///< 0: an ellipse, towards 1: a rectangle
};

/// A body along a path: cross-sections of `sides` corners each. `up`: what their height begins along; it is carried
/// along the path without turning about it. `closed`: the last point is joined to the first, which are not the same.
/// Without normals.
Primitive sweep(std::span<const glm::vec3> path, uint32_t sides, const std::function<CrossSection(float)>& section,
                const glm::vec3& up, bool closed = false);
/// A round wire.
Primitive wire(std::span<const glm::vec3> path, uint32_t sides, float radius, bool closed = false);

/// A closed body of horizontal faces and vertical walls, face by face. Outlines are counter-clockwise in (x, -z), those
/// of holes too. Faces are cut into triangles as exporters of CAD do: between corners of outlines alone, so that
/// triangles are long and thin.
class Shell {
  public:
    /// What `outer` bounds but for `holes`, each inside of it and apart from each other; it looks up or down.
    void face(const Outline& outer, std::span<const Outline> holes, float y, bool up);
    /// From one outline up to another with as many corners. `outwards`: the material is inside.
    void wall(const Outline& lower, float bottom, const Outline& upper, float top, bool outwards);
    void wall(const Outline& outline, float bottom, float top, bool outwards) {
        wall(outline, bottom, outline, top, outwards);
    }
    Primitive take() { return std::move(out_); }

  private:
    uint32_t add_corners(const Outline& outline, float y);

    Primitive out_;
};

/// An outline moved to its left by `by`: inwards.
Outline inset(const Outline& outline, float by);

/// A plate that stands from y = bottom to y = top: `outer` counter-clockwise in (x, -z), `holes` likewise, each inside
/// of it and apart from each other. Edges are bevelled by `bevel`, those of holes too. Without normals.
Primitive plate(const Outline& outer, std::span<const Outline> holes, float bottom, float top, float bevel = 0);

/// Counter-clockwise, `phase` in radians.
Outline circle(const glm::vec2& centre, float radius, uint32_t corners, float phase = 0);
/// With round corners of `steps` pieces each.
Outline rounded_rectangle(const glm::vec2& lower, const glm::vec2& upper, float radius, uint32_t steps);

/// Where a polygon with holes is cut along: one polygon, which runs into each hole and back.
Outline bridged(Outline outer, std::span<const Outline> holes);

/// A box with bevelled edges. Without normals.
Primitive bevelled_box(const glm::vec3& lower, const glm::vec3& upper, float bevel);

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

}  // namespace peelray
