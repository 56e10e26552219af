// What loaders, animation, flattening and the deformer on the GPU share about directions and transforms.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace peelray {

template <typename T>
glm::vec<3, T> unit_or(const glm::vec<3, T>& v, const glm::vec<3, T>& otherwise) {
    const T length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

inline glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : otherwise;
}

/// Transforms normals: the cofactors of the 3×3 part are its inverse transpose times the determinant, and stay finite
/// where it has no inverse (a mesh scaled flat).
struct NormalTransform {
    glm::dmat3 cofactors;
    bool mirrors;  ///< the transform turns triangles inside out

    explicit NormalTransform(const glm::mat4& world) {
        const glm::dvec3 x(world[0]), y(world[1]), z(world[2]);
        cofactors = glm::dmat3(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
        mirrors = glm::dot(x, cofactors[0]) < 0;
        if (mirrors) cofactors *= -1.0;
    }

    /// Unit; `otherwise` where the transform leaves no direction.
    glm::vec3 operator()(const glm::vec3& normal, const glm::vec3& otherwise) const {
        return unit_or(cofactors * glm::dvec3(normal), otherwise);
    }
};

/// Where a camera or light of a node stands and looks: along its negative z axis, its y axis up.
template <typename T>
struct BasicPose {
    using Vector = glm::vec<3, T>;
    Vector at, ahead, up;

    explicit BasicPose(const glm::mat<4, 4, T>& world)
        : at(world[3]),
          ahead(unit_or(-Vector(world[2]), Vector(0, 0, -1))),
          up(unit_or(Vector(world[1]), Vector(0, 1, 0))) {}
};
using Pose = BasicPose<float>;

}  // namespace peelray
