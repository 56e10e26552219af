// Where the camera saw the image of a point in mirrors, at the moment before.
#include "reference/moment_before.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace peelray {
namespace {

/// A mirror, triangle 0, in the plane z = 0, and what is before it, triangle 1, each moved.
Geometry placed(const glm::dmat4& mirror, const glm::dmat4& thing) {
    Geometry g;
    const auto add = [&](const glm::dmat4& to_world, std::initializer_list<glm::dvec3> corners) {
        const auto first = uint32_t(g.positions.size());
        for (const glm::dvec3& corner : corners) g.positions.emplace_back(to_world * glm::dvec4(corner, 1));
        g.objects.push_back({uint32_t(g.triangles.size()), 1});
        g.triangles.push_back({first, first + 1, first + 2});
    };
    add(mirror, {{-4, -4, 0}, {8, -4, 0}, {-4, 8, 0}});
    add(thing, {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
    return g;
}

PictureSettings picture() {
    PictureSettings settings;
    settings.width = 200;
    settings.height = 100;
    return settings;
}

/// From (0, 0, 5) along -z; at distance 1 two units by one.
View view(const glm::vec3& eye = {0, 0, 5}) {
    View view;
    view.eye = eye;
    view.right = {1, 0, 0};
    view.up = {0, 0.5f, 0};
    view.forward = {0, 0, -1};
    view.near = 0.01f;
    return view;
}

/// What the camera sees of a point, pixels.
glm::dvec2 place(const View& view, const glm::dvec3& point) {
    const glm::dvec3 p = point - glm::dvec3(view.eye);
    return glm::dvec2(100 * p.x, -100 * p.y) / -p.z;
}

TEST(MomentBefore, AMirrorThatMovesCarriesItsImagesTwiceAsFar) {
    const PictureSettings settings = picture();
    const glm::dmat4 still(1);
    const Geometry now = placed(still, still);
    const MomentBefore::Place on_mirror{0, 0.3, 0.3}, on_thing{1, 0.25, 0.5};
    const glm::dvec3 point(0.25, 0.5, 2), image(0.25, 0.5, -2);
    const glm::dvec3 in = glm::normalize(glm::dvec3(0.1, 0.2, -1)), out = in * glm::dvec3(1, 1, -1);

    struct Case {
        const char* name;
        glm::dmat4 mirror, thing;
        glm::vec3 eye;
        glm::dvec3 image;  ///< before
    };
    // A mirror through the origin that is turned by 0.1 around y turns images by 0.2.
    const glm::dmat4 turn = glm::rotate(still, 0.1, {0, 1, 0});
    const glm::dvec3 turned = glm::rotate(still, 0.2, {0, 1, 0}) * glm::dvec4(image, 1);
    for (const Case& c :
         {Case{"all stands", still, still, {0, 0, 5}, image},
          Case{"the camera moves", still, still, {0.5f, 0.25f, 4}, image},
          Case{"the thing moves", still, glm::translate(still, {0.25, -0.5, 0.5}), {0, 0, 5}, glm::dvec3(0.5, 0, -2.5)},
          Case{"the mirror moves", glm::translate(still, {3, 1, -0.25}), still, {0, 0, 5}, glm::dvec3(0.25, 0.5, -2.5)},
          Case{"the mirror turns", turn, still, {0, 0, 5}, turned}}) {
        SCOPED_TRACE(c.name);
        const MomentBefore before(now, placed(c.mirror, c.thing), view(), view(c.eye), settings);
        const PastImage mirrored = before.straightened({}, on_mirror, in, out);
        const DenoiseMotion motion = before.motion_of_image(on_thing, mirrored, image);
        const glm::dvec2 expected = place(view(c.eye), c.image) - place(view(), image);
        EXPECT_NEAR(motion.motion.x, expected.x, 1e-4);
        EXPECT_NEAR(motion.motion.y, expected.y, 1e-4);
        EXPECT_NEAR(motion.depth, glm::length(c.image - glm::dvec3(c.eye)), 1e-5);
        EXPECT_EQ(motion.object, 1u);
    }
    // Twice the same mirror is none, and a way that goes through is not mirrored.
    const MomentBefore before(now, now, view(), view(), settings);
    const PastImage once = before.straightened({}, on_mirror, in, out),
                    twice = before.straightened(once, on_mirror, out, in);
    EXPECT_LT(glm::length(once(point) - image), 1e-12);
    EXPECT_LT(glm::length(twice(point) - point), 1e-12);
    EXPECT_EQ(before.straightened({}, on_mirror, in, in)(point), point);
}

/// What stands still behind glass has not moved, however the light was bent: its image lies straight ahead.
TEST(MomentBefore, GlassTurnsTheWayBehindItStraight) {
    const PictureSettings settings = picture();
    const Geometry now = placed(glm::dmat4(1), glm::dmat4(1));
    const MomentBefore::Place on_glass{0, 0.3, 0.3};
    const glm::dvec3 met = 0.4 * glm::dvec3(-4, -4, 0) + 0.3 * glm::dvec3(8, -4, 0) + 0.3 * glm::dvec3(-4, 8, 0);
    const glm::dvec3 in = glm::normalize(glm::dvec3(0.3, 0.2, -1)), out = glm::normalize(glm::dvec3(0.2, 0.15, -1));
    const MomentBefore before(now, now, view(), view(), settings);
    const PastImage image = before.straightened({}, on_glass, in, out);
    EXPECT_LT(glm::length(image(met + 3.0 * out) - (met + 3.0 * in)), 1e-12);
    // Glass that has moved along takes what is behind it along.
    const glm::dvec3 way(0.5, -0.25, 1);
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), way);
    const MomentBefore both(now, placed(moved, moved), view(), view(), settings);
    const PastImage of_both = both.straightened({}, on_glass, in, out);
    EXPECT_LT(glm::length(of_both(met + 3.0 * out + way) - (met + 3.0 * in + way)), 1e-6);
}

TEST(MomentBefore, WhatWasBehindTheCameraWasNowhere) {
    const PictureSettings settings = picture();
    const Geometry now = placed(glm::dmat4(1), glm::dmat4(1));
    const MomentBefore before(now, now, view(), view({0, 0, 1}), settings);
    EXPECT_EQ(before.motion_of_image({1, 0.2, 0.2}, {}, {}).object, DENOISE_NO_OBJECT);
}

}  // namespace
}  // namespace peelray
