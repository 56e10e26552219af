// What rough surfaces sample, and the densities that the samples have to follow: Heitz, Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs, JCGT 2014; Walter et al., Microfacet Models for Refraction
// through Rough Surfaces, EGSR 2007. In double precision, apart from the code that they check.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "statistics/chi_square.h"

namespace peelray::test {

/// The index of refraction of the cases' glass.
constexpr double glass_index = 1.5;

/// A rough surface and where it is seen from. Vectors are unit.
struct LobeCase {
    std::string name;
    double roughness = 1, stretch = 0;  ///< as materials have them (KHR_materials_anisotropy)
    glm::dvec2 alpha;                   ///< that follow: along `along` and across it
    glm::dvec3 normal, along, view;
};
/// Round lobes from almost a mirror to the roughest, and stretched ones, seen from above to a grazing angle.
std::vector<LobeCase> lobe_cases();

/// Density of the normals that the viewer sees.
double visible_density(const LobeCase& lobe, const glm::dvec3& half);

/// What one sample of a lobe makes of a ray. Laid out as the probe writes it.
struct LobeSample {
    glm::vec3 half, reflected;
    glm::vec3 entering, leaving;      ///< the ray refracted into glass; out of it
    uint32_t enters = 0, leaves = 0;  ///< or all is reflected
};

/// One quantity's counts against its density.
struct LobeFit {
    std::string name;
    double mass;  ///< the density's integral: 1
    ChiSquare fit;
};
/// Of the half vectors, the reflected directions and those refracted into glass and out of it. What is reflected
/// totally is a cell of its own.
std::vector<LobeFit> fit_lobe(const LobeCase& lobe, const std::vector<LobeSample>& samples);

/// Of directions around a normal, their density the cosine over pi.
LobeFit fit_cosine(const glm::dvec3& normal, const std::vector<glm::vec3>& directions);

/// Of pairs in [0, 1)², uniform.
ChiSquare fit_uniform(const std::vector<glm::vec2>& pairs);

/// Independent pairs in [0, 1)², the same everywhere. The picture's own ones are more even than chance.
std::vector<glm::vec2> independent_pairs(size_t count, uint32_t seed);

}  // namespace peelray::test
