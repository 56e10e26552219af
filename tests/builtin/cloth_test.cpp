// The sheet of builtin:cloth: it hangs on its ball, goes on smoothly, and passes neither through the ball nor through
// itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "builtin/builtin.h"
#include "motion/animation.h"
#include "motion/simulation.h"

namespace peelray::testing {
namespace {

Moment placed_at(const Scene& scene, Simulation& simulation, double time) {
    Moment moment = moment_of(scene, "wind", time);
    simulation.place(scene, moment);
    return moment;
}

/// The sheet alone.
struct Sheet {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

Sheet sheet_at(const Scene& scene, Simulation& simulation, double time) {
    const Cloth& cloth = scene.generated.cloths.at(0);
    const Moment moment = placed_at(scene, simulation, time);
    return {moment.surfaces.at(0).positions,
            scene.meshes[size_t(scene.nodes[size_t(cloth.node)].mesh)].primitives.at(0).triangles};
}

/// Does the edge from p to q pass through the triangle's inside?
bool crosses(const glm::dvec3& p, const glm::dvec3& q, const std::array<glm::dvec3, 3>& t) {
    const auto volume = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
        return glm::dot(glm::cross(b - a, c - a), d - a);
    };
    if (volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) >= 0) return false;
    const double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

/// Pairs of triangles that pass through each other.
size_t count_crossings(const Sheet& sheet) {
    struct Entry {
        glm::vec3 lower, upper;
        uint32_t triangle;
    };
    std::vector<Entry> entries;
    for (uint32_t i = 0; i < sheet.triangles.size(); i++) {
        const glm::uvec3 t = sheet.triangles[i];
        const glm::vec3 a = sheet.positions[t.x], b = sheet.positions[t.y], c = sheet.positions[t.z];
        entries.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), i});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.lower.x < b.lower.x; });
    const auto corners = [&](const glm::uvec3& t) {
        return std::array<glm::dvec3, 3>{sheet.positions[t.x], sheet.positions[t.y], sheet.positions[t.z]};
    };
    size_t count = 0;
    for (size_t i = 0; i < entries.size(); i++)
        for (size_t j = i + 1; j < entries.size() && entries[j].lower.x <= entries[i].upper.x; j++) {
            const Entry &e = entries[i], &f = entries[j];
            if (e.lower.y > f.upper.y || f.lower.y > e.upper.y || e.lower.z > f.upper.z || f.lower.z > e.upper.z)
                continue;
            const glm::uvec3 s = sheet.triangles[e.triangle], t = sheet.triangles[f.triangle];
            bool neighbours = false;
            for (int k = 0; k < 3; k++) neighbours |= s[k] == t.x || s[k] == t.y || s[k] == t.z;
            if (neighbours) continue;
            const auto a = corners(s), b = corners(t);
            bool pass = false;
            for (size_t k = 0; k < 3; k++) pass |= crosses(a[k], a[(k + 1) % 3], b) || crosses(b[k], b[(k + 1) % 3], a);
            count += pass;
        }
    return count;
}

TEST(Cloth, CrossingsAreFound) {
    // A strip that is folded back through itself.
    Sheet sheet{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}, {0.5f, -1, 0.2f}, {0.5f, -1, 0.8f}},
                {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}, {4, 5, 7}, {4, 7, 6}}};
    EXPECT_GT(count_crossings(sheet), 0u);
    sheet.positions[6].y = sheet.positions[7].y = 0.5f;
    EXPECT_EQ(count_crossings(sheet), 0u);
}

TEST(Cloth, HangsOnTheBallAndStaysWhole) {
    const Scene scene = make_builtin("cloth:8000");
    const Cloth& cloth = scene.generated.cloths.at(0);
    Simulation simulation;
    // In the mesh's own cells: how long a side is where nothing pulls at it.
    const float side = cloth.size / float(cloth.across);
    for (int k = 0; k <= 12; k++) {
        const double time = 0.5 * k;
        SCOPED_TRACE(time);
        const Sheet sheet = sheet_at(scene, simulation, time);
        float lowest = 10, highest = 0, longest = 0;
        for (const glm::vec3& p : sheet.positions) {
            ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
            lowest = std::min(lowest, p.y);
            highest = std::max(highest, p.y);
            // The spline cuts corners: it lies a little inside of its net.
            ASSERT_GT(glm::distance(p, cloth.ball), cloth.radius + 0.004f);
            const auto& reach = scene.generated.reach;
            ASSERT_TRUE(glm::all(glm::greaterThan(p, reach.lower)) && glm::all(glm::lessThan(p, reach.upper)));
        }
        for (const glm::uvec3& t : sheet.triangles)
            longest = std::max(longest, glm::distance(sheet.positions[t.x], sheet.positions[t.y]) / side);
        EXPECT_GT(lowest, 0.001f);
        EXPECT_LT(lowest, cloth.ball.y - 0.5f * cloth.radius) << "it hangs down";
        EXPECT_NEAR(highest, cloth.ball.y + cloth.radius, 0.03f) << "and lies on the ball";
        EXPECT_LT(longest, 1.6f);  // of a diagonal at rest: 1.42
        EXPECT_EQ(count_crossings(sheet), 0u);
    }
}

TEST(Cloth, GoesOnSmoothlyAndAlways) {
    const Scene scene = make_builtin("cloth:800");
    Simulation simulation;
    std::vector<Sheet> sheets;
    for (int frame = 0; frame < 90; frame++) sheets.push_back(sheet_at(scene, simulation, frame / 60.0));
    for (size_t frame = 2; frame < sheets.size(); frame++) {
        float moved = 0, jerk = 0;
        for (size_t i = 0; i < sheets[frame].positions.size(); i++) {
            const glm::vec3 &a = sheets[frame - 2].positions[i], &b = sheets[frame - 1].positions[i],
                            &c = sheets[frame].positions[i];
            moved = std::max(moved, glm::distance(b, c));
            jerk = std::max(jerk, glm::distance(c - b, b - a));
        }
        ASSERT_GT(moved, 1e-4f) << frame;  // a tenth of a millimetre: all frames differ
        ASSERT_LT(moved, 0.08f) << frame;  // 5 m/s
        ASSERT_LT(jerk, 0.03f) << frame;
    }
}

TEST(Cloth, AFrameDependsOnItsTimeAlone) {
    const Scene scene = make_builtin("cloth:200"), other = make_builtin("cloth:200");
    Simulation used, fresh;
    for (int frame = 0; frame < 57; frame += 7) placed_at(scene, used, frame / 30.0);
    const Moment later = placed_at(scene, used, 57 / 30.0), before = placed_at(scene, used, 0.4);
    EXPECT_EQ(later.surfaces.at(0).positions, placed_at(other, fresh, 57 / 30.0).surfaces.at(0).positions);
    EXPECT_EQ(before.surfaces.at(0).positions, placed_at(other, fresh, 0.4).surfaces.at(0).positions);
    EXPECT_EQ(flatten(scene, placed_at(scene, used, 0)).positions, flatten(scene).positions);
    // However finely it is drawn, it is the same sheet.
    const Scene finer = make_builtin("cloth:800");
    Simulation third;
    const auto coarse = later.surfaces[0].positions, fine = placed_at(finer, third, 57 / 30.0).surfaces.at(0).positions;
    const size_t rows = scene.generated.cloths[0].across + 1;
    ASSERT_EQ(finer.generated.cloths[0].across + 1, 2 * rows - 1);
    for (size_t z = 0; z < rows; z++)
        for (size_t x = 0; x < rows; x++)
            ASSERT_LT(glm::distance(coarse[z * rows + x], fine[2 * z * (2 * rows - 1) + 2 * x]), 1e-6f);
}

TEST(Cloth, NormalsAreThoseOfTheSurface) {
    // Against differences of a thousandth of a cell.
    const Scene scene = make_builtin("cloth:8");
    const Cloth& cloth = scene.generated.cloths.at(0);
    std::vector<glm::dvec3> net(cloth.start.begin(), cloth.start.end());
    for (const double u : {0.0, 0.013, 0.31, 0.5, 0.77, 1.0 - 1e-4})
        for (const double v : {0.0, 0.02, 0.46, 0.9, 1.0 - 1e-4}) {
            constexpr double h = 2e-5;
            const auto at = [&](double s, double t) { return cloth_point(cloth, net, s, t).position; };
            const glm::dvec3 expected = glm::normalize(glm::cross(at(u, v + h) - at(u, v), at(u + h, v) - at(u, v)));
            EXPECT_GT(glm::dot(cloth_point(cloth, net, u, v).normal, expected), 0.99999) << u << " " << v;
        }
    // Its corners are the net's.
    EXPECT_LT(glm::distance(cloth_point(cloth, net, 0, 0).position, net.front()), 1e-12);
    EXPECT_LT(glm::distance(cloth_point(cloth, net, 1, 1).position, net.back()), 1e-12);
}

TEST(Cloth, MeetsItsNumber) {
    for (const uint32_t n : {8u, 9u, 50u, 999u, 32768u, 100000u}) {
        const Scene scene = make_builtin("cloth:" + std::to_string(n));
        const Cloth& cloth = scene.generated.cloths.at(0);
        const double made =
            double(scene.meshes[size_t(scene.nodes[size_t(cloth.node)].mesh)].primitives[0].triangles.size());
        EXPECT_NEAR(made, n, std::sqrt(n)) << n;
        EXPECT_EQ(made, 2.0 * cloth.across * cloth.along);
    }
}

}  // namespace
}  // namespace peelray::testing
