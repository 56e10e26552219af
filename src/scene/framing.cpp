#include "scene/framing.h"

#include <algorithm>
#include <cmath>

#include "scene/origin.h"

namespace peelray {

Framing::Framing(const Lens& lens, const std::optional<glm::vec3>& pivot) : lens_(lens), pivot_(pivot) {
    back_ = glm::normalize(glm::dvec3(0.55, 0.45, 1));
    right_ = glm::cross(glm::dvec3(lens.up), back_);
    // Along the view no direction is up: whoever makes a view of it says so.
    if (!(glm::length(right_) > 1e-6 * glm::length(lens.up))) right_ = glm::cross(glm::dvec3(0, 1, 0), back_);
    right_ = glm::normalize(right_);
    up_ = glm::cross(back_, right_);
    const double tangent = std::tan(double(lens.vertical_fov) / 2) * (1 - 2 * margin);
    tangents_ = {tangent * lens.aspect, tangent};
    planes_ = {right_ + tangents_.x * back_, -right_ + tangents_.x * back_, up_ + tangents_.y * back_,
               -up_ + tangents_.y * back_};
    farthest_.fill(-std::numeric_limits<double>::infinity());
}

double Framing::reach(const glm::dvec3& point, const glm::dvec3& direction) const {
    if (!pivot_) return glm::dot(point, direction);
    const glm::dvec3 arm = point - *pivot_;
    return glm::dot(*pivot_, direction) + arm.y * direction.y +
           std::hypot(arm.x, arm.z) * std::hypot(direction.x, direction.z);
}

void Framing::add(std::span<const glm::vec3> points) {
    for (const glm::vec3& each : points) {
        const glm::dvec3 point = each;
        for (size_t i = 0; i < planes_.size(); i++) farthest_[i] = std::max(farthest_[i], reach(point, planes_[i]));
        nearest_ = std::max(nearest_, reach(point, back_));
        box_.add(each);
    }
}

Camera Framing::camera() const {
    Camera camera;
    camera.name = "framed";
    camera.vertical_fov = lens_.vertical_fov;
    camera.up = lens_.up;
    if (box_.lower.x > box_.upper.x) return camera;
    const glm::dvec3 lower = box_.lower, upper = box_.upper, pivot = pivot_.value_or(0.5 * (lower + upper));
    // Two opposite planes meet in the eye where it is as near as they allow; where the other two keep it farther away,
    // it stays in the middle between them.
    const auto& f = farthest_;
    const double x = 0.5 * (f[0] - f[1]), y = 0.5 * (f[2] - f[3]);
    const double size = glm::length(upper - lower);
    // A single point far from the origin needs a distance that its coordinates can still express.
    const double least = size > 0 ? 1e-3 * size : std::max(1e-4, 1e-3 * reach_of(pivot));
    const double z = std::max({0.5 * (f[0] + f[1]) / tangents_.x, 0.5 * (f[2] + f[3]) / tangents_.y, nearest_ + least});
    camera.eye = x * right_ + y * up_ + z * back_;
    // It looks at the point of its axis that is nearest to the vertical line through the pivot.
    const glm::dvec2 level(back_.x, back_.z);
    const glm::dvec3 from = camera.eye - pivot;
    camera.look = camera.eye - back_ * (glm::dot(glm::dvec2(from.x, from.z), level) / glm::dot(level, level));
    return camera;
}

}  // namespace peelray
