// Random rays for comparing traversals with the oracle: uniform, grazing, axis-parallel, starting on the surface.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <random>
#include <vector>

#include "common/ray.h"
#include "reference/oracle.h"
#include "scene/scene.h"

namespace peelray::test {

enum class RayKind { uniform, grazing, axis_parallel, on_surface };
inline const char* name_of(RayKind kind) {
    const char* names[] = {"uniform", "grazing", "axis-parallel", "on surface"};
    return names[int(kind)];
}

/// The same ray for the oracle.
inline OracleRay oracle_ray(const Ray& ray) {
    return {glm::dvec3(ray.origin), ray.tmin, glm::dvec3(ray.direction), ray.tmax};
}

/// Makes rays of one kind; the same seed gives the same rays.
class RaySource {
  public:
    /// `lift`: how far above their surface those on_surface start, world units.
    RaySource(const Geometry& geometry, uint32_t seed, double lift = 0)
        : geometry_(geometry), random_(seed), lift_(lift) {
        for (uint32_t i = 0; i < geometry.triangles.size(); i++)
            if (area_normal(i) != glm::dvec3(0)) usable_.push_back(i);
    }

    Ray make(RayKind kind) {
        switch (kind) {
            case RayKind::uniform:
                return towards(inside(0.4), direction());
            case RayKind::grazing:
                return grazing();
            case RayKind::axis_parallel:
                return axis_parallel();
            case RayKind::on_surface:
                return on_surface();
        }
        return {};
    }

  private:
    double unit() { return uniform_(random_); }
    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 d(unit() * 2 - 1, unit() * 2 - 1, unit() * 2 - 1);
            if (glm::dot(d, d) <= 1 && glm::dot(d, d) > 1e-4) return glm::normalize(d);
        }
    }
    /// A point of the box grown by `margin` times its size on each side.
    glm::dvec3 inside(double margin) {
        const glm::dvec3 size = glm::dvec3(geometry_.upper) - glm::dvec3(geometry_.lower);
        return glm::dvec3(geometry_.lower) + size * (glm::dvec3(unit(), unit(), unit()) * (1 + 2 * margin) - margin);
    }
    glm::dvec3 area_normal(uint32_t triangle) const {
        const glm::uvec3 t = geometry_.triangles[triangle];
        const glm::dvec3 a = geometry_.positions[t.x];
        return glm::cross(glm::dvec3(geometry_.positions[t.y]) - a, glm::dvec3(geometry_.positions[t.z]) - a);
    }
    glm::dvec3 surface_point(glm::dvec3& normal) {
        const uint32_t triangle = usable_[size_t(unit() * double(usable_.size()))];
        normal = glm::normalize(area_normal(triangle));
        double u = unit(), v = unit();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::uvec3 t = geometry_.triangles[triangle];
        return glm::dvec3(geometry_.positions[t.x]) * (1 - u - v) + glm::dvec3(geometry_.positions[t.y]) * u +
               glm::dvec3(geometry_.positions[t.z]) * v;
    }
    Ray towards(const glm::dvec3& origin, const glm::dvec3& d) {
        // Lengths over four decades: t counts in them.
        const double length = std::pow(10.0, unit() * 4 - 2);
        return {glm::vec3(origin), 0, glm::vec3(d * length), std::numeric_limits<float>::infinity()};
    }
    Ray grazing() {
        glm::dvec3 normal;
        const glm::dvec3 p = surface_point(normal);
        // In the surface's plane but for a slope of 10^-1 to 10^-6, from a short way before the point.
        glm::dvec3 along = glm::cross(normal, direction());
        if (glm::dot(along, along) < 1e-8) along = glm::cross(normal, glm::dvec3(0.3, 0.5, 0.8));
        const glm::dvec3 d = glm::normalize(glm::normalize(along) - normal * std::pow(10.0, -1 - 5 * unit()));
        const double diagonal = glm::length(glm::dvec3(geometry_.upper) - glm::dvec3(geometry_.lower));
        return towards(p - d * (diagonal * 0.3 * unit()), d);
    }
    Ray axis_parallel() {
        glm::dvec3 d(0), normal;
        const int axis = int(unit() * 3) % 3;
        d[axis] = unit() < 0.5 ? -1 : 1;
        glm::dvec3 p = inside(0.1);
        // Half of them through a vertex or a surface point: exactly along edges and coordinates that the mesh repeats.
        const double choice = unit();
        if (choice < 0.25)
            p = geometry_.positions[geometry_.triangles[usable_[size_t(unit() * double(usable_.size()))]].x];
        else if (choice < 0.5)
            p = surface_point(normal);
        const double diagonal = glm::length(glm::dvec3(geometry_.upper) - glm::dvec3(geometry_.lower));
        if (choice < 0.5) p[axis] -= d[axis] * diagonal * unit();
        return towards(p, d);
    }
    Ray on_surface() {
        glm::dvec3 normal;
        const glm::dvec3 p = surface_point(normal), d = direction();
        return towards(p + normal * (glm::dot(d, normal) >= 0 ? lift_ : -lift_), d);
    }

    const Geometry& geometry_;
    std::mt19937 random_;
    double lift_;
    std::uniform_real_distribution<double> uniform_{0, 1};
    std::vector<uint32_t> usable_;
};

}  // namespace peelray::test
