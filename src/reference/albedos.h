// What rough surfaces reflect of white light, by numerical integration in double precision. Private to src/reference.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/once.h"
#include "reference/real.h"
#include "reference/surface.h"

namespace peelray::inline PRECISION {

/// Of each material, worked out when it is first asked for; threads may ask at once. The surfaces must outlive it.
class Albedos {
  public:
    using Means = AlbedoMeans;
    /// Of a perfect mirror's microfacets (AlbedoMeans) and of a dielectric's.
    struct Grays {
        real dielectric = 0, normal = 0, grazing = 0;
    };

    Albedos(const Scene& scene, const Surfaces& surfaces);

    /// Without thin films and dispersion. `cosine`: between the view and the surface's normal.
    Means at(const Surface& surface, real cosine) const;
    /// The share that the surface's clear coat mirrors; `cosine`: between the view and the coat's normal.
    real coat(const Surface& surface, real cosine) const;
    /// The share that a white sheen of the surface's roughness reflects.
    real sheen(const Surface& surface, real cosine) const;

  private:
    static constexpr size_t steps = 64;  ///< in the square root of the cosine
    struct Table {
        Once once;
        std::array<Grays, steps + 1> entries;
    };

    /// Of white sheens of one roughness.
    struct SheenTable {
        static constexpr size_t steps = 256;  ///< in the square root of the cosine
        Once once;
        std::array<real, steps + 1> entries;
    };
    static real look_up(SheenTable& table, real alpha, real cosine);

    struct Place;
    /// Materials whose roughness a texture changes, or whose lobes are stretched where there are tangents, have a table
    /// for each of these, in the square root of the roughness; the others one, for their own.
    static constexpr size_t roughnesses = 65;
    static Grays look_up(Table& table, real ior, real roughness, const Place& at);
    /// Between those of the roughnesses around; `first`: of as many tables.
    static Grays between(Table* first, real ior, real roughness, const Place& at);

    /// Of a material's lobe; those of the same index, and of the same roughness where it does not vary, share theirs.
    struct Lobes {
        size_t first;
        bool vary;
    };
    const Surfaces& surfaces_;
    std::vector<Lobes> lobes_;  ///< per material
    std::unique_ptr<Table[]> tables_;
    std::unique_ptr<Table[]> coats_;  ///< of all coats
    /// Per material, or where a texture changes the roughness, equally spaced from the least on.
    std::vector<size_t> first_sheen_;
    std::unique_ptr<SheenTable[]> sheens_;
};

}  // namespace peelray::inline PRECISION
