// Materials and textures of glTF files.
#include <array>
#include <cmath>

#include "image/image.h"
#include "loaders/scene_files.h"
#include "scene/alpha_test.h"
#include "scene/sidedness.h"

namespace peelray::testing {
namespace {

/// Texture 0 shows these texels, side by side.
void add_texture(json& gltf, const TempFolder& folder, const std::vector<uint32_t>& texels) {
    write_png(folder.path() / "a.png", Image8{uint32_t(texels.size()), 1, texels}, true);
    gltf["images"] = {{{"uri", "a.png"}}};
    gltf["textures"] = {{{"source", 0}}};
}

TEST(GltfMaterial, MissingImagesWithoutTexelsInThePictureAreNoted) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "gone.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"normalTexture": {"index": 0}, "emissiveTexture": {"index": 0},
        "emissiveFactor": [1, 0.5, 0.25], "pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}])");
    const Scene scene = load(folder, gltf);
    expect_near(scene.materials.at(0).emissive, {1, 0.5f, 0.25f});
    ASSERT_EQ(scene.notes.size(), 1u) << all_notes(scene);
    EXPECT_MENTIONS(scene.notes[0], "3 textures other than of the base colour left out");
}

TEST(GltfMaterial, ImagesOfOtherTypesAreNoted) {
    const TempFolder folder;
    const std::pair<const char*, std::string> images[] = {{"KTX2", "\xABKTX 20\xBB\r\n\x1A\n"},
                                                          {"DDS", std::string("DDS |\0\0\0", 8)},
                                                          {"AVIF", std::string("\0\0\0\x1C"
                                                                               "ftypavif",
                                                                               12)},
                                                          {"DDS", "DDS |"}};
    for (const auto& [type, bytes] : images)
        for (const char* material : {R"([{"normalTexture": {"index": 0}}])",
                                     R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])",
                                     R"([{"emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1]}])"}) {
            json gltf = square();
            gltf["images"] = {{{"uri", data_uri(bytes)}}};
            gltf["textures"] = {{{"source", 0}}};
            gltf["materials"] = json::parse(material);
            const Scene scene = load(folder, gltf);
            EXPECT_EQ(scene.materials[0].base_color_texture, -1);
            EXPECT_TRUE(has_note(scene, std::string("of the type ") + type)) << type << material;
        }
}

TEST(GltfMaterial, SpecularAndGlossiness) {
    const TempFolder folder;
    json gltf = square();
    gltf["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
    add_texture(gltf, folder, {0x331e140au});
    const char* text = R"([{"pbrMetallicRoughness": {"metallicFactor": 1, "baseColorFactor": [0, 0, 0, 1]},
        "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 0.4],
        "specularFactor": [0.5, 0.6, 0.7], "glossinessFactor": 0.75}}},
        {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"glossinessFactor": 0.5,
        "specularGlossinessTexture": {"index": 0}}}},
        {"extensions": {"KHR_materials_pbrSpecularGlossiness": {}}}])";
    gltf["materials"] = json::parse(text);
    const Scene scene = load(folder, gltf);
    EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
    const Material& m = scene.materials.at(0);
    expect_near(m.base_color, {0.1f, 0.2f, 0.3f});
    EXPECT_FLOAT_EQ(m.alpha, 0.4f);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.ior, 0);  // whose reflection at normal incidence is all of the colour
    expect_near(m.specular_color, {0.5f, 0.6f, 0.7f});
    EXPECT_FLOAT_EQ(m.roughness, 0.25f);
    const Material& textured = scene.materials.at(1);
    EXPECT_EQ(textured.roughness, 1);
    ASSERT_TRUE(textured.roughness_texture && textured.specular_color_texture);
    EXPECT_EQ(textured.roughness_texture.channel, 3u);
    // 1 - 0.5 · 51 / 255 = 0.9
    EXPECT_EQ(scene.textures.at(size_t(textured.roughness_texture.texture)).texels.at(0) >> 24, 230u);
    EXPECT_EQ(scene.textures.at(size_t(textured.specular_color_texture.texture)).texels.at(0), 0x331e140au);
    EXPECT_EQ(scene.materials.at(2).roughness, 0);
    expect_near(scene.materials.at(2).specular_color, {1, 1, 1});
}

TEST(GltfMaterial, ClearCoat) {
    const TempFolder folder;
    json gltf = square();
    gltf["extensionsUsed"] = {"KHR_materials_clearcoat"};
    add_texture(gltf, folder, {0xff8080ffu});
    gltf["materials"] = json::parse(R"([{"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.75,
        "clearcoatRoughnessFactor": 0.5, "clearcoatTexture": {"index": 0}, "clearcoatRoughnessTexture": {"index": 0},
        "clearcoatNormalTexture": {"index": 0, "scale": 0.25}}}},
        {"extensions": {"KHR_materials_clearcoat": {"clearcoatRoughnessFactor": 2}}}])");
    primitive(gltf)["material"] = 0;
    const Scene scene = load(folder, gltf);
    const Material& m = scene.materials.at(0);
    EXPECT_FLOAT_EQ(m.clearcoat, 0.75f);
    EXPECT_FLOAT_EQ(m.coat_roughness, 0.5f);
    EXPECT_FLOAT_EQ(m.coat_normal_scale, 0.25f);
    EXPECT_EQ(m.clearcoat_texture.channel, 0u);
    EXPECT_EQ(m.coat_roughness_texture.channel, 1u);
    ASSERT_TRUE(m.clearcoat_texture && m.coat_roughness_texture && m.coat_normal_texture);
    EXPECT_FALSE(only_primitive(scene).tangents.empty());  // made for the coat alone
    EXPECT_EQ(scene.materials.at(1).clearcoat, 0);
    EXPECT_TRUE(has_note(scene, "VALUE_NOT_IN_RANGE"));
}

TEST(GltfMaterial, SamplersSayHowTexturesAreFiltered) {
    const TempFolder folder;
    using Mipmaps = Texture::Mipmaps;
    struct Case {
        json sampler;
        bool nearest, min_nearest;
        Mipmaps mipmaps;
    };
    const Case cases[] = {{json::object(), false, false, Mipmaps::linear},
                          {{{"magFilter", 9728}}, true, false, Mipmaps::linear},
                          {{{"magFilter", 9729}, {"minFilter", 9728}}, false, true, Mipmaps::none},
                          {{{"minFilter", 9729}}, false, false, Mipmaps::none},
                          {{{"minFilter", 9984}}, false, true, Mipmaps::nearest},
                          {{{"minFilter", 9985}}, false, false, Mipmaps::nearest},
                          {{{"minFilter", 9986}}, false, true, Mipmaps::linear},
                          {{{"minFilter", 9987}}, false, false, Mipmaps::linear}};
    for (const Case& c : cases) {
        json gltf = square();
        add_texture(gltf, folder, {0x331e140au});
        gltf["samplers"] = {c.sampler};
        gltf["textures"][0]["sampler"] = 0;
        gltf["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
        const Scene scene = load(folder, gltf);
        EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
        const Texture& t = scene.textures.at(0);
        EXPECT_EQ(t.nearest, c.nearest) << c.sampler;
        EXPECT_EQ(t.min_nearest, c.min_nearest) << c.sampler;
        EXPECT_EQ(t.mipmaps, c.mipmaps) << c.sampler;
        gltf["samplers"][0]["minFilter"] = 1234;
        EXPECT_TRUE(has_note(load(folder, gltf), "1 unknown filter of textures ignored (VALUE_NOT_IN_LIST)"));
    }
}

TEST(GltfMaterial, BlendingIsCoverageWhereAlphaIsLess) {
    const TempFolder folder;
    const auto material = [&](const char* text, uint8_t alpha) {
        json gltf = square();
        add_texture(gltf, folder, {0xff1e140au, uint32_t(alpha) << 24 | 0x1e140au});
        gltf["materials"] = {json::parse(text)};
        gltf["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume"};
        return load(folder, gltf);
    };
    const char* plain = R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})";
    EXPECT_FALSE(material(plain, 255).materials[0].blended);  // all of it is there
    EXPECT_TRUE(material(plain, 254).materials[0].blended);
    EXPECT_EQ(material(plain, 1).materials[0].alpha_cutoff, 0);
    EXPECT_GT(material(plain, 0).materials[0].alpha_cutoff, 0);  // holes
    EXPECT_TRUE(material(R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})", 255)
                    .materials[0]
                    .blended);
    EXPECT_FALSE(
        material(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})", 255).materials[0].blended);
    const Scene volume = material(
        R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5], "metallicFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 1}}})",
        255);
    EXPECT_FALSE(volume.materials[0].blended);
    EXPECT_TRUE(has_note(volume, "alphaMode BLEND of 1 material that bounds a refracting volume ignored"));
}

TEST(GltfMaterial, Materials) {
    const TempFolder folder;
    json gltf = square();
    gltf["materials"] = json::parse(
        R"([{"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6},
        "emissiveFactor": [1, 0.5, 0], "alphaMode": "BLEND", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.7},
        "KHR_materials_ior": {"ior": 1.4}, "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 3, "attenuationColor": [0.5, 0.6, 0.7]},
        "KHR_materials_emissive_strength": {"emissiveStrength": 10}, "KHR_materials_unlit": {}, "ACME_materials_magic": {}}}])");
    gltf["extensionsUsed"] = {"KHR_materials_transmission", "ACME_materials_magic"};
    primitive(gltf)["material"] = 0;
    const Scene scene = load(folder, gltf);
    const Material& m = scene.materials.at(0);
    expect_near(m.base_color, {0.1f, 0.2f, 0.3f});
    EXPECT_FLOAT_EQ(m.alpha, 0.4f);
    EXPECT_FLOAT_EQ(m.metallic, 0.5f);
    EXPECT_FLOAT_EQ(m.roughness, 0.6f);
    expect_near(m.emissive, {10, 5, 0});
    EXPECT_FLOAT_EQ(m.transmission, 0.7f);
    EXPECT_FLOAT_EQ(m.ior, 1.4f);
    EXPECT_FLOAT_EQ(m.thickness, 2);
    EXPECT_FLOAT_EQ(m.attenuation_distance, 3);
    expect_near(m.attenuation_color, {0.5f, 0.6f, 0.7f});
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(scene.extensions_unsupported, std::vector<std::string>{"ACME_materials_magic"});
    EXPECT_EQ(scene.extensions_used.size(), 2u);
    EXPECT_TRUE(m.blended);  // unlit: it bounds no volume
}

TEST(GltfMaterial, ReflectanceOfDielectrics) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    const auto with = [&](const json& extensions) {
        gltf["materials"] = {{{"extensions", extensions}}};
        gltf["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_specular"};
        return load(folder, gltf);
    };
    const auto ior = [&](double value) { return with({{"KHR_materials_ior", {{"ior", value}}}}); };
    EXPECT_FLOAT_EQ(with(json::object()).materials[0].ior, 1.5f);
    EXPECT_EQ(with(json::object()).materials[0].specular, 1);
    EXPECT_EQ(with(json::object()).materials[0].specular_color, glm::vec3(1));
    EXPECT_EQ(ior(0).materials[0].ior, 0) << "stands for an infinite one";
    EXPECT_TRUE(ior(0).notes.empty());
    EXPECT_EQ(ior(1000).materials[0].ior, 1000);
    EXPECT_EQ(ior(1e30).materials[0].ior, 0) << "as good as infinite";
    for (double impossible : {0.5, -2.0}) {
        EXPECT_EQ(ior(impossible).materials[0].ior, 1);
        EXPECT_TRUE(has_note(ior(impossible), "index of refraction below 1"));
    }
    const Scene scene = with(
        {{"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", json::array({0.25, 2, -1})}}}});
    EXPECT_EQ(scene.materials[0].specular, 0.5f);
    EXPECT_EQ(scene.materials[0].specular_color, glm::vec3(0.25f, 2, 0));
    EXPECT_TRUE(scene.extensions_unsupported.empty());
    EXPECT_EQ(with({{"KHR_materials_specular", {{"specularFactor", 7}}}}).materials[0].specular, 1);
}

/// Shares of alpha that are there, at the corners of the square: (0, 0), (1, 0), (1, 1) of its first triangle.
std::array<bool, 3> corners_present(const Scene& scene) {
    const Geometry geometry = flatten(scene);
    const AlphaTest alpha(scene, geometry);
    return {alpha.is_present(0, 0, 0), alpha.is_present(0, 1, 0), alpha.is_present(0, 0, 1)};
}

TEST(GltfMaterial, AlphaModes) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    const auto with = [&](const json& material) {
        gltf["materials"] = {material};
        return load(folder, gltf);
    };
    const json factor = {{"baseColorFactor", {1, 1, 1, 0.4}}};
    const auto all = [](bool present) { return std::array<bool, 3>{present, present, present}; };

    Scene scene = with({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", factor}});
    EXPECT_FLOAT_EQ(scene.materials.at(0).alpha, 0.4f);
    EXPECT_FLOAT_EQ(scene.materials.at(0).alpha_cutoff, 0.5f) << "the format's default";
    EXPECT_EQ(corners_present(scene), all(false));
    EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
    scene = with({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"pbrMetallicRoughness", factor}});
    EXPECT_FLOAT_EQ(scene.materials.at(0).alpha_cutoff, 0.25f);
    EXPECT_EQ(corners_present(scene), all(true));
    // An alpha that equals the cutoff is there; a cutoff of 0 leaves nothing out, one above 1 leaves nothing.
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 0.4}, {"pbrMetallicRoughness", factor}})),
              all(true));
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 0}, {"pbrMetallicRoughness", factor}})),
              all(true));
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 1}})), all(true));
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 1.01}})), all(false));

    EXPECT_EQ(corners_present(with({{"alphaMode", "OPAQUE"}, {"alphaCutoff", 0.9}, {"pbrMetallicRoughness", factor}})),
              all(true));
    EXPECT_EQ(corners_present(with({{"alphaCutoff", 0.9}, {"pbrMetallicRoughness", factor}})), all(true));
    scene = with({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", factor}});
    EXPECT_EQ(scene.materials.at(0).alpha_cutoff, 0);
    EXPECT_EQ(corners_present(scene), all(true));
    EXPECT_TRUE(scene.materials.at(0).blended);
    EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
}

TEST(GltfMaterial, MasksMultiplyFactorTextureAndVertexAlpha) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    gltf["materials"] = json::parse(
        R"([{"alphaMode": "MASK", "alphaCutoff": 0.3, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}])");
    primitive(gltf)["attributes"]["COLOR_0"] =
        add_accessor(gltf, pack<float>({1, 1, 1, 0.5f, 1, 1, 1, 0.7f, 1, 1, 1, 1, 1, 1, 1, 1}), 5126, "VEC4", 4);
    EXPECT_EQ(corners_present(load(folder, gltf)), (std::array<bool, 3>{false, true, true}));
    // A texture of 2×1 texels: opaque, then an alpha of 204/255.
    gltf["images"] = {
        {{"uri",
          "data:image/"
          "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADElEQVR42mP4DwFnACOyB8axSYLdAAAAAElFTkSuQmCC"}}};
    gltf["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    primitive(gltf)["attributes"]["TEXCOORD_0"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 1, 1, 0, 1}), 5126, "VEC2", 4);
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(scene.textures.at(0).texels.at(0) >> 24, 255u);
    EXPECT_EQ(scene.textures.at(0).texels.at(1) >> 24, 204u);
    EXPECT_EQ(corners_present(scene), (std::array<bool, 3>{false, false, true}));
}

TEST(GltfMaterial, BaseColorTextureWithTransformAndSampler) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf["materials"] =
        json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 0, "extensions":
        {"KHR_texture_transform": {"texCoord": 1, "offset": [10, 20], "scale": [2, 3], "rotation": 1.5707963}}}}}])");
    primitive(gltf)["material"] = 0;
    primitive(gltf)["attributes"]["TEXCOORD_1"] =
        add_accessor(gltf, pack<uint8_t>({0, 0, 255, 0, 255, 255, 0, 255}), 5121, "VEC2", 4, true);
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.textures.size(), 1u);
    const Texture& texture = scene.textures[0];
    EXPECT_EQ(texture.width, 2u);
    EXPECT_EQ(texture.height, 1u);
    EXPECT_EQ(texture.texels, (std::vector<uint32_t>{0xFF0000FFu, 0xFF00FF00u}));
    EXPECT_EQ(texture.wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(texture.wrap_v, Texture::Wrap::mirror);
    EXPECT_TRUE(texture.nearest);
    const Primitive& p = only_primitive(scene);
    EXPECT_EQ(p.uvs.at(p.triangles[0].y), glm::vec2(1, 0));
    EXPECT_TRUE(p.more_uvs.empty());  // the first set that is used, not the file's first
    const MaterialTexture& use = scene.materials[0].base_color_texture;
    EXPECT_EQ(use.uv_set, 0u);
    // Scaled to (2, 0), turned counter-clockwise in an image whose v runs down.
    const glm::vec2 uv = use.place({1, 0});
    EXPECT_NEAR(uv.x, 10, 1e-4);
    EXPECT_NEAR(uv.y, 18, 1e-4);
}

TEST(GltfMaterial, EveryTextureOfAMaterial) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["samplers"] = {{{"wrapS", 33071}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
    gltf["materials"] = json::parse(R"([{
        "pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0.25,
            "baseColorTexture": {"index": 0, "texCoord": 2}, "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 1, "texCoord": 2, "scale": -0.5},
        "occlusionTexture": {"index": 1, "strength": 0.75,
            "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 4]}}},
        "emissiveTexture": {"index": 1, "texCoord": 5}, "emissiveFactor": [1, 0.5, 0.25],
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": {"index": 1,
                           "extensions": {"KHR_texture_transform": {"texCoord": 2}}}},
                       "KHR_materials_volume": {"thicknessFactor": 2, "thicknessTexture": {"index": 0}}}}])");
    primitive(gltf)["material"] = 0;
    for (const char* set : {"TEXCOORD_0", "TEXCOORD_2"})
        primitive(gltf)["attributes"][set] =
            add_accessor(gltf, pack<float>({0, 1, set[9] == '2' ? 3.f : 1.f, 1, 1, 0, 0, 0}), 5126, "VEC2", 4);
    const Scene scene = load(folder, gltf);
    const Material& m = scene.materials.at(0);
    ASSERT_EQ(scene.textures.size(), 2u);  // one image, two samplers
    const Primitive& p = only_primitive(scene);
    ASSERT_EQ(p.more_uvs.size(), 2u);  // sets 2, 0, 5 in the order of their use; there is no set 5
    EXPECT_EQ(p.uvs.at(p.triangles[0].y), glm::vec2(3, 1));
    EXPECT_EQ(p.more_uvs[0].at(p.triangles[0].y), glm::vec2(1, 1));
    EXPECT_TRUE(p.more_uvs[1].empty());
    EXPECT_TRUE(has_note(scene, "1 primitive without the texture coordinates"));
    const auto expect_use = [](const MaterialTexture& use, int texture, uint32_t set, uint32_t channel) {
        EXPECT_EQ(use.texture, texture);
        EXPECT_EQ(use.uv_set, set);
        EXPECT_EQ(use.channel, channel);
    };
    expect_use(m.base_color_texture, 0, 0, 0);
    expect_use(m.roughness_texture, 0, 1, 1);
    expect_use(m.metallic_texture, 0, 1, 2);
    expect_use(m.emissive_texture, 1, 2, 0);
    expect_use(m.normal_texture, 1, 0, 0);
    expect_use(m.occlusion_texture, 1, 1, 0);
    expect_use(m.transmission_texture, 1, 0, 0);
    expect_use(m.thickness_texture, 0, 1, 1);
    EXPECT_EQ(m.occlusion_texture.place({1, 1}), glm::vec2(2.5f, 4.25f));
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.normal_scale, -0.5f);
    EXPECT_EQ(m.occlusion_strength, 0.75f);
    EXPECT_EQ(p.tangents.size(), p.positions.size());  // made, since the file has none
}

TEST(GltfMaterial, TangentsAreReadWhereTheyAreRight) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"normalTexture": {"index": 0}}])");
    primitive(gltf)["material"] = 0;
    primitive(gltf)["attributes"]["NORMAL"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
    primitive(gltf)["attributes"]["TEXCOORD_0"] =
        add_accessor(gltf, pack<float>({0, 1, 1, 1, 1, 0, 0, 0}), 5126, "VEC2", 4);
    json right = gltf;
    primitive(right)["attributes"]["TANGENT"] =
        add_accessor(right, pack<float>({0, 2, 0, -1, 0, 2, 0, -1, 0, 2, 0, -1, 0, 2, 0, -1}), 5126, "VEC4", 4);
    const Scene given = load(folder, right);
    EXPECT_EQ(only_primitive(given).tangents, std::vector<glm::vec4>(4, glm::vec4(0, 1, 0, -1)));
    for (const float bad : {0.f, 0.5f, NAN}) {
        json wrong = gltf;
        primitive(wrong)["attributes"]["TANGENT"] =
            add_accessor(wrong, pack<float>({0, 1, 0, -1, 0, 1, 0, bad, 0, 1, 0, 1, 0, 1, 0, 1}), 5126, "VEC4", 4);
        const Scene scene = load(folder, wrong);
        EXPECT_TRUE(has_note(scene, "1 primitive whose tangents have no direction or no side")) << bad;
        for (const glm::vec4& t : only_primitive(scene).tangents) EXPECT_NEAR(t.x, 1, 1e-6) << bad;
    }
    primitive(gltf)["attributes"].erase("NORMAL");  // flat normals: the file's tangents would not belong to them
    primitive(gltf)["attributes"]["TANGENT"] = primitive(right)["attributes"]["TANGENT"];
    right = gltf;
    primitive(right)["attributes"]["TANGENT"] =
        add_accessor(right, pack<float>({0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}), 5126, "VEC4", 4);
    const Scene flat = load(folder, right);
    EXPECT_FALSE(only_primitive(flat).tangents.empty());
    for (const glm::vec4& t : only_primitive(flat).tangents) EXPECT_NEAR(t.x, 1, 1e-6);
}

TEST(GltfMaterial, SixteenBitImagesKeepTheirDepth) {
    // 2×1 texels of 16 bits, RGB: (0x1234, 0x5678, 0x9ABC) and (0xFFFF, 0, 1).
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri",
                        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR4nGMQMgmrmLXn/"
                        "38GBgZGAB+fBGrbFwuVAAAAAElFTkSuQmCC"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"occlusionTexture": {"index": 0}}])");
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_TRUE(scene.textures[0].texels.empty());
    EXPECT_EQ(scene.textures[0].deep_texels, (std::vector<uint64_t>{0xFFFF9ABC56781234ull, 0xFFFF00010000FFFFull}));
}

TEST(GltfMaterial, MaterialsAreSingleSidedUnlessTheFileSaysOtherwise) {
    const TempFolder folder;
    json gltf = square();
    json glass = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                  {"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
                    {"KHR_materials_volume", {{"thicknessFactor", 0.1}}}}}};
    json wall = glass, opaque = glass, metal = glass, unlit = glass;
    wall["extensions"].erase("KHR_materials_volume");
    opaque["extensions"].erase("KHR_materials_transmission");
    metal["pbrMetallicRoughness"]["metallicFactor"] = 1;
    unlit["extensions"]["KHR_materials_unlit"] = json::object();
    gltf["materials"] = {json::object(), {{"doubleSided", false}}, {{"doubleSided", true}}, wall, glass, opaque, metal,
                         unlit};
    const Scene scene = load(folder, gltf);
    // The last one is the default material, of primitives without any.
    const std::vector<bool> single = {true, true, false, true, false, true, true, true, true};
    ASSERT_EQ(scene.materials.size(), single.size());
    for (size_t i = 0; i < single.size(); i++) EXPECT_EQ(is_single_sided(scene.materials[i]), single[i]) << i;
    EXPECT_TRUE(has_single_sided(scene, {2, 8}));
    EXPECT_FALSE(has_single_sided(scene, {2, 4}));
}

}  // namespace
}  // namespace peelray::testing
