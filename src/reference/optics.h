// What light does at a surface, in double precision: Fresnel, Snell, microfacets, random numbers, tone curves. The
// rules are those of shaders/path/shading.glsl; the arithmetic is written independently, so that each checks the other.
// Private to src/reference.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "path/shading_numbers.h"
#include "reference/real.h"
#include "scene/picture.h"

namespace peelray::inline PRECISION::optics {

inline constexpr real pi = 3.14159265358979323846;

inline real largest(const Vec3& c) {
    return std::max(c.x, std::max(c.y, c.z));
}
inline real luminance(const Vec3& c) {
    return LUMINANCE_RED * c.x + LUMINANCE_GREEN * c.y + LUMINANCE_BLUE * c.z;
}
/// Unpolarised reflectance of a dielectric interface; `cosine` ≥ 0 to the normal on the incoming side, `eta`: index
/// behind it over index before it. 1 at total internal reflection.
real fresnel_dielectric(real cosine, real eta);
/// From `f0` at normal incidence to `f90` at grazing angles.
Vec3 fresnel_schlick(const Vec3& f0, real f90, real cosine);
/// Snell's law; nothing at total internal reflection. All unit; `incoming` goes towards the surface, against `normal`.
std::optional<Vec3> refract_ray(const Vec3& incoming, const Vec3& normal, real eta);

/// A normal that the viewer would see from behind is bent until it is just visible.
Vec3 visible_normal(const Vec3& normal, const Vec3& geometric, const Vec3& to_viewer);
/// A direction that would enter the surface is lifted to just above it.
Vec3 above_surface(const Vec3& direction, const Vec3& geometric);

real ggx_distribution(real n_h, real alpha);
/// Smith's masking of one direction.
real ggx_masking(real cosine, real alpha);
/// A visible normal (Heitz, JCGT 2018); `view` and the result in the frame whose z is the surface's normal; `alpha`:
/// along its x and y.
Vec3 sample_ggx(const Vec3& view, const Vec2& alpha, const Vec2& random);

struct Tangents {
    Vec3 t, b;
};
/// Duff et al., JCGT 2017.
Tangents tangents(const Vec3& n);

/// A direction in front of a surface, its density the cosine over pi; `random` in [0, 1).
Vec3 cosine_direction(const Vec3& normal, const Vec2& random);

/// Microfacets of GGX around a normal, wider along t than along b where the surface is brushed (Heitz, JCGT 2014).
struct Lobe {
    Vec3 t, b, n;
    Vec2 alpha;  ///< along t and b

    Lobe(const Vec3& normal, real alpha);
    /// `along`: unit, perpendicular to the normal.
    Lobe(const Vec3& normal, const Vec3& along, const Vec2& alpha);
    real distribution(const Vec3& half) const;
    /// Smith's masking of a direction; 0 below the surface.
    real masking(const Vec3& direction) const;
    /// Of the directions that visible normals reflect `view` to. 0 for mirrors and below the surface.
    real density(const Vec3& view, const Vec3& reflected) const;
    /// A visible normal.
    Vec3 sample(const Vec3& view, const Vec2& random) const;

  private:
    Vec3 local(const Vec3& d) const { return {glm::dot(d, t), glm::dot(d, b), glm::dot(d, n)}; }
};

}  // namespace peelray::inline PRECISION::optics
