#include "reference/moment_before.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace peelray {

uint32_t object_of(const Geometry& geometry, uint32_t triangle) {
    const auto after = std::ranges::upper_bound(geometry.objects, triangle, {}, &Geometry::Object::first);
    return uint32_t(after - geometry.objects.begin()) - 1;
}

MomentBefore::Corners MomentBefore::corners(const Geometry& geometry, const Place& hit) const {
    const glm::uvec3 vertices = now_.triangles[hit.triangle];
    return {geometry.positions[vertices.x], geometry.positions[vertices.y], geometry.positions[vertices.z]};
}

/// Where a point is in the picture that a camera sees, pixels from its middle, right and up.
glm::dvec2 MomentBefore::place(const View& view, const glm::dvec3& point) const {
    const glm::dvec3 p = point - glm::dvec3(view.eye), right(view.right), up(view.up);
    glm::dvec2 place(glm::dot(p, right) / glm::dot(right, right), glm::dot(p, up) / glm::dot(up, up));
    if (!view.orthographic) place /= glm::dot(p, glm::dvec3(view.forward));
    return 0.5 * place * glm::dvec2(settings_.width, settings_.height);
}

/// Did the camera before see it before it, not behind?
bool MomentBefore::is_ahead(const glm::dvec3& point) const {
    const glm::dvec3 ahead = point - glm::dvec3(view_before_.eye);
    return view_before_.orthographic || glm::dot(ahead, glm::dvec3(view_before_.forward)) > double(view_before_.near);
}

glm::vec2 MomentBefore::motion(const Place& hit) const {
    const glm::dvec3 p = corners(before_, hit).at(hit);
    if (!is_ahead(p)) return glm::vec2(0);
    return place(view_before_, p) - place(view_now_, corners(now_, hit).at(hit));
}

PastImage MomentBefore::straightened(const PastImage& image, const Place& hit, const glm::dvec3& in,
                                     const glm::dvec3& out) const {
    const Corners now = corners(now_, hit), before = corners(before_, hit);
    const glm::dvec3 side = now.normal(), axis = glm::cross(out, in);
    const double sine = glm::length(axis);
    glm::dmat3 turn(1);
    if (glm::dot(side, in) * glm::dot(side, out) < 0) {
        const glm::dvec3 n = glm::normalize(out - in);
        turn -= 2.0 * glm::outerProduct(n, n);
    } else if (sine > 0) {
        turn = glm::dmat3(glm::rotate(glm::dmat4(1), std::atan2(sine, glm::dot(out, in)), axis / sine));
    }
    // It is fixed to the triangle, and has turned as two directions of that have.
    const auto axes = [](const Corners& t) {
        const glm::dvec3 x = glm::normalize(t.b - t.a), z = glm::normalize(t.normal());
        return glm::dmat3(x, glm::cross(z, x), z);
    };
    if (glm::dot(side, side) > 0 && glm::dot(before.normal(), before.normal()) > 0) {
        const glm::dmat3 turned = axes(before) * glm::transpose(axes(now));
        turn = turned * turn * glm::transpose(turned);
    }
    const glm::dvec3 point = before.at(hit);
    return {image.linear * turn, image(point - turn * point)};
}

DenoiseMotion MomentBefore::motion_of_image(const Place& hit, const PastImage& image,
                                            const std::optional<glm::dvec3>& seen) const {
    const glm::dvec3 before = image(corners(before_, hit).at(hit));
    if (!is_ahead(before)) return {glm::vec2(0), 0, DENOISE_NO_OBJECT};
    const glm::dvec2 moved = place(view_before_, before) - place(view_now_, seen.value_or(corners(now_, hit).at(hit)));
    const glm::dvec3 way = before - glm::dvec3(view_before_.eye);
    const double depth = view_before_.orthographic ? glm::dot(way, glm::dvec3(view_before_.forward)) : glm::length(way);
    return {glm::vec2(moved.x, -moved.y), float(depth), object_of(now_, hit.triangle)};
}

}  // namespace peelray
