// Cubes of light become images: which way their faces look, without seams.
#include "scene/cube_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/environment.h"
#include "scene/pi.h"

namespace peelray {
namespace {

/// The direction of a texel by OpenGL's table of cube maps (version 4.6, table 8.19), whose images the extension flips
/// about their vertical axis.
glm::dvec3 direction_of(size_t face, double x, double y) {
    const double s = 1 - 2 * x, t = 2 * y - 1;  // flipped
    switch (face) {
        case 0:
            return {1, -t, -s};
        case 1:
            return {-1, -t, s};
        case 2:
            return {s, 1, t};
        case 3:
            return {s, -1, -t};
        case 4:
            return {s, -t, 1};
        default:
            return {-s, -t, -1};
    }
}

/// Light that tells directions apart, and is smooth.
glm::dvec3 light_from(const glm::dvec3& direction) {
    return 0.5 + 0.4 * glm::normalize(direction);
}

CubeLight cube_of(uint32_t size) {
    CubeLight light;
    light.size = size;
    for (size_t face = 0; face < 6; face++)
        for (uint32_t i = 0; i < size * size; i++)
            light.faces[face].push_back(
                glm::vec3(light_from(direction_of(face, (i % size + 0.5) / size, (i / size + 0.5) / size))));
    return light;
}

double largest_error(const Environment& environment, const glm::dmat3& back, double factor) {
    double worst = 0;
    for (uint32_t i = 0; i < environment.width * environment.height; i++) {
        const uint32_t x = i % environment.width, y = i / environment.width;
        const glm::vec3 d = environment_direction((float(x) + 0.5f) / float(environment.width),
                                                  (float(y) + 0.5f) / float(environment.height));
        const glm::dvec3 off = glm::abs(glm::dvec3(environment.texels[i]) - factor * light_from(back * glm::dvec3(d)));
        worst = std::max({worst, off.x, off.y, off.z});
    }
    return worst;
}

TEST(CubeLight, FacesLookWhereTheirNamesSay) {
    const Environment environment = cube_environment(cube_of(32));
    EXPECT_TRUE(environment.is_image);
    EXPECT_EQ(environment.height, 64u);
    EXPECT_LT(largest_error(environment, glm::dmat3(1), 1), 0.015) << "at seams, too";
    EXPECT_NEAR(environment.irradiance[0].x, kPi * 0.5, 0.01);
    EXPECT_NEAR(environment.irradiance[1].y, kPi * 0.4 * 2 / 3, 0.01) << "brighter above";
}

TEST(CubeLight, TurnsAndDims) {
    CubeLight light = cube_of(32);
    light.turn = glm::dmat3(glm::rotate(glm::dmat4(1), 1.1, glm::normalize(glm::dvec3(1, 2, -0.5))));
    light.intensity = 3;
    EXPECT_LT(largest_error(cube_environment(light), glm::transpose(light.turn), 3), 0.045);
    light.intensity = 1;
    EXPECT_GT(largest_error(cube_environment(light), glm::dmat3(1), 1), 0.2);
}

TEST(CubeLight, OneTexelAFaceWillDo) {
    CubeLight light = cube_of(1);
    const Environment environment = cube_environment(light);
    EXPECT_NEAR(environment.texels[0].y, 0.9, 0.05) << "straight up";
    EXPECT_NEAR(environment.texels[size_t(environment.height / 2) * environment.width + environment.width / 2].z, 0.1,
                0.05)
        << "-z";
}

}  // namespace
}  // namespace peelray
