// What light does at a surface, in double precision: Fresnel, Snell, microfacets, random numbers, tone curves. The
// rules are those of shaders/path/shading.glsl; the arithmetic is written independently, so that each checks the other.
// Private to src/reference.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "path/shading_numbers.h"
#include "scene/picture.h"

namespace peelray::optics {

inline constexpr double pi = 3.14159265358979323846;

inline double largest(const glm::dvec3& c) {
    return std::max(c.x, std::max(c.y, c.z));
}
inline double luminance(const glm::dvec3& c) {
    return LUMINANCE_RED * c.x + LUMINANCE_GREEN * c.y + LUMINANCE_BLUE * c.z;
}
/// Unpolarised reflectance of a dielectric interface; `cosine` ≥ 0 to the normal on the incoming side, `eta`: index
/// behind it over index before it. 1 at total internal reflection.
double fresnel_dielectric(double cosine, double eta);
/// From `f0` at normal incidence to `f90` at grazing angles.
glm::dvec3 fresnel_schlick(const glm::dvec3& f0, double f90, double cosine);
/// Snell's law; nothing at total internal reflection. All unit; `incoming` goes towards the surface, against `normal`.
std::optional<glm::dvec3> refract_ray(const glm::dvec3& incoming, const glm::dvec3& normal, double eta);

/// A normal that the viewer would see from behind is bent until it is just visible.
glm::dvec3 visible_normal(const glm::dvec3& normal, const glm::dvec3& geometric, const glm::dvec3& to_viewer);
/// A direction that would enter the surface is lifted to just above it.
glm::dvec3 above_surface(const glm::dvec3& direction, const glm::dvec3& geometric);

double ggx_distribution(double n_h, double alpha);
/// Smith's masking of one direction.
double ggx_masking(double cosine, double alpha);
/// A visible normal (Heitz, JCGT 2018); `view` and the result in the frame whose z is the surface's normal; `alpha`:
/// along its x and y.
glm::dvec3 sample_ggx(const glm::dvec3& view, const glm::dvec2& alpha, const glm::dvec2& random);

struct Tangents {
    glm::dvec3 t, b;
};
/// Duff et al., JCGT 2017.
Tangents tangents(const glm::dvec3& n);

/// A direction in front of a surface, its density the cosine over pi; `random` in [0, 1).
glm::dvec3 cosine_direction(const glm::dvec3& normal, const glm::dvec2& random);

/// Microfacets of GGX around a normal, wider along t than along b where the surface is brushed (Heitz, JCGT 2014).
struct Lobe {
    glm::dvec3 t, b, n;
    glm::dvec2 alpha;  ///< along t and b

    Lobe(const glm::dvec3& normal, double alpha);
    /// `along`: unit, perpendicular to the normal.
    Lobe(const glm::dvec3& normal, const glm::dvec3& along, const glm::dvec2& alpha);
    double distribution(const glm::dvec3& half) const;
    /// Smith's masking of a direction; 0 below the surface.
    double masking(const glm::dvec3& direction) const;
    /// Of the directions that visible normals reflect `view` to. 0 for mirrors and below the surface.
    double density(const glm::dvec3& view, const glm::dvec3& reflected) const;
    /// A visible normal.
    glm::dvec3 sample(const glm::dvec3& view, const glm::dvec2& random) const;

  private:
    glm::dvec3 local(const glm::dvec3& d) const { return {glm::dot(d, t), glm::dot(d, b), glm::dot(d, n)}; }
};

}  // namespace peelray::optics
