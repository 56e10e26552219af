// The camera that points fill the picture of.
#include "scene/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/picture.h"

namespace peelray {
namespace {

/// Where points lie in the picture: 0 to 1 from the left and from the bottom.
struct Extent {
    glm::dvec2 lower{INFINITY}, upper{-INFINITY};
    glm::dvec2 size() const { return upper - lower; }
};

Extent extent_of(const Camera& camera, float aspect, const std::vector<glm::vec3>& points) {
    const View view = make_view(camera, aspect, glm::vec3(-100), glm::vec3(100));
    Extent extent;
    for (const glm::vec3& each : points) {
        const glm::dvec3 p = glm::dvec3(each) - camera.eye;
        const double depth = glm::dot(p, glm::dvec3(view.forward));
        EXPECT_GT(depth, 0) << "behind the camera";
        const glm::dvec3 right(view.right), up(view.up);
        const glm::dvec2 at(glm::dot(p, right) / glm::dot(right, right), glm::dot(p, up) / glm::dot(up, up));
        extent.lower = glm::min(extent.lower, 0.5 + 0.5 * at / depth);
        extent.upper = glm::max(extent.upper, 0.5 + 0.5 * at / depth);
    }
    return extent;
}

std::vector<glm::vec3> corners(const glm::vec3& lower, const glm::vec3& upper) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 8; i++)
        points.emplace_back(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z);
    return points;
}

std::vector<glm::vec3> points_of_ball(const glm::vec3& centre, float radius) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 2000; i++) {
        const float y = 1 - (float(i) + 0.5f) / 1000, phi = float(i) * 2.39996f, r = std::sqrt(1 - y * y);
        points.push_back(centre + radius * glm::vec3(r * std::cos(phi), y, r * std::sin(phi)));
    }
    return points;
}

/// They keep 5 % free on all sides, and on two opposite ones no more than that.
void expect_filled(const Framing::Lens& lens, const std::vector<glm::vec3>& points) {
    Framing framing(lens);
    framing.add(points);
    const Extent extent = extent_of(framing.camera(), lens.aspect, points);
    for (int axis = 0; axis < 2; axis++) {
        EXPECT_GE(extent.lower[axis], 0.05 - 1e-4);
        EXPECT_LE(extent.upper[axis], 0.95 + 1e-4);
    }
    EXPECT_NEAR(std::max(extent.size().x, extent.size().y), 0.9, 1e-3);
}

TEST(Framing, PointsFillThePicture) {
    for (const float aspect : {1.f, 1.25f, 2.5f, 0.3f}) {
        SCOPED_TRACE(aspect);
        const Framing::Lens lens{glm::radians(40.f), aspect, {0, 1, 0}};
        expect_filled(lens, corners({-1, -1, -1}, {1, 1, 1}));
        expect_filled(lens, corners({0, 0, 0}, {1, 80, 1}));      // tall
        expect_filled(lens, corners({-30, 0, -20}, {9, 0, 14}));  // flat
        expect_filled(lens, corners({90, 0, -3}, {99, 1, 3}));    // off the centre
        expect_filled(lens, points_of_ball({3, -2, 7}, 0.01f));
        std::vector<glm::vec3> uneven = points_of_ball({0, 0, 0}, 1);
        uneven.emplace_back(6, 0, 0);
        expect_filled(lens, uneven);
    }
}

TEST(Framing, ABallIsAsLargeAsItCanBeInEveryLens) {
    // A sphere around a box would leave a ball a half of the picture.
    for (const float degrees : {5.f, 20.f, 40.f, 120.f})
        for (const glm::vec3& up : {glm::vec3(0, 1, 0), glm::vec3(0.4f, 1, 0.2f), glm::vec3(0, 0, 3)})
            expect_filled({glm::radians(degrees), 1, up}, points_of_ball({0, 0, 0}, 1));
}

TEST(Framing, LooksFromAboveAndTheRight) {
    Framing framing;
    framing.add(corners({-1, -2, -3}, {1, 2, 3}));
    const Camera camera = framing.camera();
    EXPECT_EQ(camera.name, "framed");
    EXPECT_NEAR(camera.vertical_fov, glm::radians(40.f), 1e-6);
    EXPECT_GT(camera.eye.y, camera.look.y);
    EXPECT_GT(camera.eye.x, camera.look.x);
    EXPECT_GT(camera.eye.z, camera.look.z);
    EXPECT_EQ(framing.box().lower, glm::vec3(-1, -2, -3));
    EXPECT_EQ(framing.box().upper, glm::vec3(1, 2, 3));
}

TEST(Framing, NothingLeavesThePictureOnTheWayRound) {
    // Long, thin and seen from an end first.
    std::vector<glm::vec3> points = corners({7, -1, -5}, {8, 1, 5});
    points.emplace_back(10, 0, 0);
    const Framing::Lens lens{glm::radians(40.f), 1.25f, {0, 1, 0}};
    Framing framing(lens, glm::vec3(8, 0, 0));
    framing.add(points);
    Extent all;
    for (int i = 0; i < 360; i++) {
        const Extent extent = extent_of(turned(framing.camera(), i / 360.0), lens.aspect, points);
        all.lower = glm::min(all.lower, extent.lower);
        all.upper = glm::max(all.upper, extent.upper);
    }
    EXPECT_GE(std::min(all.lower.x, all.lower.y), 0.05 - 1e-4);
    EXPECT_LE(std::max(all.upper.x, all.upper.y), 0.95 + 1e-4);
    EXPECT_NEAR(std::max(all.size().x, all.size().y), 0.9, 2e-3) << "no smaller than need be";
    EXPECT_NEAR(framing.camera().look.x, 8, 1e-9);
    EXPECT_NEAR(framing.camera().look.z, 0, 1e-9);
}

TEST(Framing, OnePointOrNone) {
    Framing point;
    point.add(std::vector<glm::vec3>{{5e5f, 5, 5}});
    const Camera camera = point.camera();
    EXPECT_GT(glm::length(glm::vec3(camera.eye) - glm::vec3(camera.look)), 100) << "what floats can tell apart";
    const Camera empty = Framing().camera();
    EXPECT_TRUE(std::isfinite(glm::length(empty.eye)));
    EXPECT_NE(empty.eye, empty.look);
}

}  // namespace
}  // namespace peelray
