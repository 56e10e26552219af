#include "statistics/lobes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "statistics/sphere_cells.h"

namespace peelray::test {
namespace {

/// The microfacets of a surface as one viewer sees them; all in the frame of the lobe.
struct Microfacets {
    glm::dvec2 alpha;
    glm::dvec3 view;
    double masking;  ///< Smith's, of the viewer, by way of Lambda

    Microfacets(const glm::dvec2& alpha, const glm::dvec3& view) : alpha(alpha), view(view) {
        const glm::dvec2 slope(view.x / view.z * alpha.x, view.y / view.z * alpha.y);
        masking = 2 / (1 + std::sqrt(1 + glm::dot(slope, slope)));
    }
    double distribution(const glm::dvec3& h) const {
        const glm::dvec2 slope(h.x / h.z / alpha.x, h.y / h.z / alpha.y);
        const double k = (1 + glm::dot(slope, slope)) * h.z * h.z;
        return 1 / (pi * alpha.x * alpha.y * k * k);
    }
    /// Density of the visible normals.
    double visible(const glm::dvec3& h) const {
        const double facing = glm::dot(view, h);
        return h.z > 0 && facing > 0 ? masking * facing * distribution(h) / view.z : 0;
    }
    /// Density of the directions that they reflect the viewer to.
    double reflected(const glm::dvec3& to) const {
        const glm::dvec3 both = view + to;
        const double length = glm::length(both);
        if (length == 0 || both.z <= 0) return 0;
        return visible(both / length) / (4 * glm::dot(view, both / length));
    }
    /// Density of the directions that they refract the viewer to; `eta`: index behind over that before (Walter et al.,
    /// equations 16 and 17).
    double refracted(const glm::dvec3& to, double eta) const {
        const glm::dvec3 both = eta > 1 ? -(view + eta * to) : view + eta * to;
        const double length = glm::length(both);
        if (length == 0) return 0;
        const glm::dvec3 h = both / length;
        const double before = glm::dot(view, h), behind = glm::dot(to, h), sum = before + eta * behind;
        if (before <= 0 || behind >= 0) return 0;
        return visible(h) * eta * eta * -behind / (sum * sum);
    }
    /// That of the normals which reflect totally.
    double total(const glm::dvec3& h, double eta) const {
        const double cosine = glm::dot(view, h);
        return 1 - cosine * cosine > eta * eta ? visible(h) : 0;
    }
};

/// Where the mirror's ray goes, or as far as it gets: the axis of what is refracted.
glm::dvec3 refracted_axis(const glm::dvec3& view, double eta) {
    const glm::dvec2 across = -glm::dvec2(view.x, view.y) / eta;
    const double sine2 = std::min(1.0, glm::dot(across, across));
    return glm::normalize(glm::dvec3(across, -std::sqrt(1 - sine2)));
}

/// Counts and expectations, cell by cell.
struct Table {
    const SphereCells& cells;
    std::vector<uint32_t> observed;
    std::vector<double> expected;

    Table(const SphereCells& cells, const SphereCells::Density& density)
        : cells(cells), observed(cells.count()), expected(cells.integrate(density)) {}
    void add(const glm::dvec3& direction) { observed[cells.cell(direction)]++; }
    LobeFit fit(std::string name, size_t count) {
        const double mass = std::accumulate(expected.begin(), expected.end(), 0.0);
        for (double& e : expected) e *= double(count);
        return {std::move(name), mass, chi_square(observed, expected)};
    }
};

LobeFit fit_refracted(const std::string& name, const Microfacets& facets, const glm::dmat3& to_lobe, double eta,
                      const SphereCells& half_cells, const std::vector<LobeSample>& samples) {
    const double width = 0.25 * (facets.alpha.x + facets.alpha.y);
    const SphereCells cells(refracted_axis(facets.view, eta), width);
    Table table(cells, [&](const glm::dvec3& to) { return facets.refracted(to, eta); });
    const auto total = half_cells.integrate([&](const glm::dvec3& h) { return facets.total(h, eta); });
    table.expected.push_back(std::accumulate(total.begin(), total.end(), 0.0));
    table.observed.push_back(0);
    for (const LobeSample& s : samples)
        if (eta > 1 ? s.enters : s.leaves)
            table.add(to_lobe * glm::dvec3(eta > 1 ? s.entering : s.leaving));
        else
            table.observed.back()++;
    return table.fit(name, samples.size());
}

glm::dmat3 frame_of(const LobeCase& lobe) {
    return glm::transpose(glm::dmat3(lobe.along, glm::cross(lobe.normal, lobe.along), lobe.normal));
}

}  // namespace

double visible_density(const LobeCase& lobe, const glm::dvec3& half) {
    const glm::dmat3 to_lobe = frame_of(lobe);
    return Microfacets(lobe.alpha, to_lobe * lobe.view).visible(to_lobe * half);
}

std::vector<LobeFit> fit_lobe(const LobeCase& lobe, const std::vector<LobeSample>& samples) {
    const glm::dmat3 to_lobe = frame_of(lobe);
    const Microfacets facets(lobe.alpha, to_lobe * lobe.view);
    const double width = std::sqrt(lobe.alpha.x * lobe.alpha.y) * 0.5;
    const glm::dvec3 mirrored(-facets.view.x, -facets.view.y, facets.view.z);
    const SphereCells half_cells({0, 0, 1}, width, true), reflected_cells(mirrored, std::min(1.0, 2 * width));
    Table half(half_cells, [&](const glm::dvec3& h) { return facets.visible(h); });
    Table reflected(reflected_cells, [&](const glm::dvec3& to) { return facets.reflected(to); });
    for (const LobeSample& s : samples) {
        half.add(to_lobe * glm::dvec3(s.half));
        reflected.add(to_lobe * glm::dvec3(s.reflected));
    }
    return {half.fit(lobe.name + ", half vectors", samples.size()),
            reflected.fit(lobe.name + ", reflected", samples.size()),
            fit_refracted(lobe.name + ", into glass", facets, to_lobe, glass_index, half_cells, samples),
            fit_refracted(lobe.name + ", out of glass", facets, to_lobe, 1 / glass_index, half_cells, samples)};
}

LobeFit fit_cosine(const glm::dvec3& normal, const std::vector<glm::vec3>& directions) {
    const SphereCells cells(normal, 1);
    Table table(cells, [&](const glm::dvec3& d) { return std::max(0.0, glm::dot(d, normal)) / pi; });
    for (const glm::vec3& d : directions) table.add(d);
    return table.fit("cosine", directions.size());
}

ChiSquare fit_uniform(const std::vector<glm::vec2>& pairs) {
    constexpr int n = 16;
    std::vector<uint32_t> observed(n * n);
    for (const glm::vec2& p : pairs) observed.at(size_t(int(p.y * n) * n + int(p.x * n)))++;
    return chi_square(observed, std::vector<double>(observed.size(), double(pairs.size()) / (n * n)));
}

std::vector<glm::vec2> independent_pairs(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<glm::vec2> pairs(count);
    for (glm::vec2& p : pairs)
        for (int k = 0; k < 2; k++) p[k] = float(random() >> 8) / 16777216.0f;
    return pairs;
}

std::vector<LobeCase> lobe_cases() {
    std::vector<LobeCase> cases;
    const std::array<glm::dvec3, 3> normals{{{0, 0, 1}, {0.48, 0.6, 0.64}, {0.6, 0, -0.8}}};
    const auto add = [&](LobeCase lobe, double degrees, double azimuth) {
        const double angle = degrees * pi / 180, turn = azimuth * pi / 180;
        lobe.name += ", seen from " + std::to_string(int(degrees)) + "° at " + std::to_string(int(azimuth)) + "°";
        lobe.normal = normals[cases.size() % 3];
        lobe.along = glm::normalize(glm::cross(lobe.normal, glm::dvec3(0.36, -0.48, 0.8)));
        const glm::dvec3 across = glm::cross(lobe.normal, lobe.along);
        lobe.view =
            std::cos(angle) * lobe.normal + std::sin(angle) * (std::cos(turn) * lobe.along + std::sin(turn) * across);
        cases.push_back(lobe);
    };
    for (const double roughness : {0.1, 0.3, 0.6, 1.0})
        for (const double degrees : {0, 40, 45, 80}) {  // glass reflects totally from 42° on
            LobeCase lobe{"roughness " + std::to_string(roughness).substr(0, 3), roughness, 0, {}, {}, {}, {}};
            lobe.alpha = glm::dvec2(roughness * roughness);
            add(lobe, degrees, 35);
        }
    for (const glm::dvec2 alpha : {glm::dvec2(0.8, 0.05), glm::dvec2(0.5, 0.2)})
        for (const double degrees : {0, 45, 80})
            for (const double azimuth : {0, 30, 90}) {
                if (degrees == 0 && azimuth > 0) continue;
                const std::string name =
                    std::to_string(alpha.x).substr(0, 3) + " by " + std::to_string(alpha.y).substr(0, 4);
                LobeCase lobe{"stretched " + name, std::sqrt(alpha.y), 0, alpha, {}, {}, {}};
                lobe.stretch = std::sqrt((alpha.x - alpha.y) / (1 - alpha.y));
                add(lobe, degrees, azimuth);
            }
    return cases;
}

}  // namespace peelray::test
