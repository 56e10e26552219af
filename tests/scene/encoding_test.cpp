#include "scene/encoding.h"

#include <gtest/gtest.h>

namespace peelray {
namespace {

TEST(Encoding, SrgbOfTheStandard) {
    EXPECT_NEAR(linear_to_srgb(0.5), 0.7353569830524495, 1e-12);
    EXPECT_NEAR(linear_to_srgb(0.002), 0.02584, 1e-12);
    for (double c : {0.0, 0.001, 0.0031308, 0.18, 0.9, 1.0}) EXPECT_NEAR(srgb_to_linear(linear_to_srgb(c)), c, 1e-7);
}

TEST(Encoding, ToneCurves) {
    EXPECT_EQ(tone_curve({0.3, 2, -1}, Tonemap::none), glm::dvec3(0.3, 1, 0));
    // Neutral leaves colours below its start alone, but for the Fresnel offset of 0.04.
    const glm::dvec3 c = tone_curve({0.5, 0.4, 0.3}, Tonemap::neutral);
    EXPECT_NEAR(c.x, 0.46, 1e-12);
    EXPECT_NEAR(c.z, 0.26, 1e-12);
    EXPECT_LT(tone_curve({100, 0.1, 0.1}, Tonemap::neutral).x, 1);
    EXPECT_NEAR(tone_curve({1e9, 1e9, 1e9}, Tonemap::neutral).y, 1, 1e-6);
    EXPECT_NEAR(tone_curve({0.18, 0.18, 0.18}, Tonemap::aces).x,
                (0.18 * (2.51 * 0.18 + 0.03)) / (0.18 * (2.43 * 0.18 + 0.59) + 0.14), 1e-12);
}

TEST(Encoding, Pixels) {
    EXPECT_EQ(encode({0.25, 0, 9}, 1, Tonemap::none), 0xffff00bcu);  // sRGB of 0.5 is 188
    EXPECT_EQ(encode({0, 1, 0}, 0, Tonemap::none), 0xff00ff00u);
}

TEST(Reflective, ByMaterial) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].transmission = 1;  // no shown triangle has it
    Primitive shown, hidden;
    shown.triangles = hidden.triangles = {{0, 1, 2}};
    hidden.material = 1;
    scene.meshes = {{"shown", {shown}, {}}, {"hidden", {hidden}, {}}};
    scene.nodes.resize(2);
    scene.nodes[0].mesh = 0;
    const auto reflective = [&](uint32_t spp) { return is_reflective(scene, spp); };
    EXPECT_FALSE(reflective(1));
    scene.materials[0].roughness = 0.4f;
    EXPECT_TRUE(reflective(1));
    scene.materials[0].roughness = 0.55f;
    EXPECT_FALSE(reflective(1));
    EXPECT_TRUE(reflective(4));
    scene.materials[0].roughness = 1;
    scene.materials[0].metallic = 1;
    EXPECT_FALSE(reflective(1));
    EXPECT_TRUE(reflective(4));
    scene.materials[0].metallic = 0;
    scene.materials[0].transmission = 0.5f;
    EXPECT_TRUE(reflective(1));
    scene.materials[0].unlit = true;
    EXPECT_FALSE(reflective(4));
}

TEST(Reflective, AnisotropyWidensTheRoughestLobe) {
    Material material;
    material.roughness = 0.5f;
    EXPECT_EQ(most_roughness(material), 0.5f);
    material.anisotropy = 0.5f;  // alpha is 0.25 across and 0.25 + 0.75 / 4 along
    EXPECT_FLOAT_EQ(most_roughness(material), std::pow(0.25f * 0.4375f, 0.25f));
    material.roughness = 0;
    EXPECT_GT(most_roughness(material), float(MIRROR_ROUGHNESS));
    material.roughness = 1;
    EXPECT_EQ(most_roughness(material), 1);
    EXPECT_EQ(least_roughness({}, material), 1);
    material.clearcoat = 1;
    EXPECT_EQ(most_roughness(material), 1);
    EXPECT_EQ(least_roughness({}, material), 0);
}

}  // namespace
}  // namespace peelray
