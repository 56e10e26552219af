// What glTF's extensions add to how materials reflect and let light through: sheen, iridescence, anisotropy,
// dispersion, diffuse transmission.
#include <cmath>

#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

/// The square with one material that has these extensions, and texture 0.
json with_extensions(const json& extensions) {
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {{{"extensions", extensions}}};
    for (const auto& [name, unused] : extensions.items()) gltf["extensionsUsed"].push_back(name);
    primitive(gltf)["material"] = 0;
    return gltf;
}

Scene load_extension(const TempFolder& folder, const char* name, const char* members) {
    return load(folder, with_extensions({{name, json::parse(members)}}));
}

void expect_use(const MaterialTexture& use, uint32_t channel) {
    EXPECT_EQ(use.texture, 0);
    EXPECT_EQ(use.channel, channel);
}

TEST(GltfLobes, FilesThatSayNothingHaveNone) {
    const TempFolder folder;
    const json empty = {{"KHR_materials_sheen", json::object()},
                        {"KHR_materials_iridescence", json::object()},
                        {"KHR_materials_anisotropy", json::object()},
                        {"KHR_materials_dispersion", json::object()},
                        {"KHR_materials_diffuse_transmission", json::object()}};
    for (const json& extensions : {json(json::object()), empty}) {
        const Scene scene = load(folder, with_extensions(extensions));
        EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
        EXPECT_TRUE(scene.extensions_unsupported.empty());
        const Material& m = scene.materials.at(0);
        EXPECT_EQ(m.sheen_color, glm::vec3(0));
        EXPECT_EQ(m.sheen_roughness, 0);
        EXPECT_EQ(m.iridescence, 0);
        EXPECT_FLOAT_EQ(m.film_ior, 1.3f);
        EXPECT_EQ(m.film_least, 100);
        EXPECT_EQ(m.film_most, 400);
        EXPECT_EQ(m.anisotropy, 0);
        EXPECT_EQ(m.anisotropy_rotation, 0);
        EXPECT_EQ(m.dispersion, 0);
        EXPECT_EQ(m.diffuse_transmission, 0);
        EXPECT_EQ(m.diffuse_transmission_color, glm::vec3(1));
        for (const auto use : material_textures) EXPECT_FALSE(m.*use);
        EXPECT_TRUE(only_primitive(scene).tangents.empty());
    }
}

TEST(GltfLobes, Sheen) {
    const TempFolder folder;
    Scene scene = load_extension(folder, "KHR_materials_sheen", R"({"sheenColorFactor": [0.25, 0.5, 0.75],
        "sheenRoughnessFactor": 0.375, "sheenColorTexture": {"index": 0}, "sheenRoughnessTexture": {"index": 0}})");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.sheen_color, glm::vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(m.sheen_roughness, 0.375f);
    expect_use(m.sheen_color_texture, 0);
    EXPECT_TRUE(is_color(&Material::sheen_color_texture));
    expect_use(m.sheen_roughness_texture, 3);
    scene = load_extension(folder, "KHR_materials_sheen",
                           R"({"sheenColorFactor": [-1, 0.5, 2], "sheenRoughnessFactor": 1.5})");
    EXPECT_EQ(scene.materials.at(0).sheen_color, glm::vec3(0, 0.5f, 1));
    EXPECT_EQ(scene.materials.at(0).sheen_roughness, 1);
    EXPECT_TRUE(has_note(scene, "2 values of sheenColorFactor out of their range (VALUE_NOT_IN_RANGE)"));
    EXPECT_TRUE(has_note(scene, "1 value of sheenRoughnessFactor out of its range"));
    // A black factor leaves nothing for textures to say.
    scene = load_extension(folder, "KHR_materials_sheen", R"({"sheenColorTexture": {"index": 0}})");
    EXPECT_FALSE(scene.materials.at(0).sheen_color_texture);
    EXPECT_TRUE(scene.textures.empty());
}

TEST(GltfLobes, Iridescence) {
    const TempFolder folder;
    Scene scene = load_extension(folder, "KHR_materials_iridescence", R"({"iridescenceFactor": 0.5,
        "iridescenceIor": 1.75, "iridescenceThicknessMinimum": 250, "iridescenceThicknessMaximum": 750,
        "iridescenceTexture": {"index": 0}, "iridescenceThicknessTexture": {"index": 0}})");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.iridescence, 0.5f);
    EXPECT_EQ(m.film_ior, 1.75f);
    EXPECT_EQ(m.film_least, 250);
    EXPECT_EQ(m.film_most, 750);
    expect_use(m.iridescence_texture, 0);
    expect_use(m.film_thickness_texture, 1);
    // The texture may run from thick to thin.
    scene = load_extension(folder, "KHR_materials_iridescence",
                           R"({"iridescenceFactor": 1, "iridescenceThicknessMinimum": 600})");
    EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
    EXPECT_EQ(scene.materials.at(0).film_least, 600);
    EXPECT_EQ(scene.materials.at(0).film_most, 400);
    scene = load_extension(folder, "KHR_materials_iridescence", R"({"iridescenceFactor": 1.5, "iridescenceIor": 0.5,
        "iridescenceThicknessMinimum": -5, "iridescenceThicknessMaximum": 1e30})");
    EXPECT_EQ(scene.materials.at(0).iridescence, 1);
    EXPECT_EQ(scene.materials.at(0).film_ior, 1);
    EXPECT_EQ(scene.materials.at(0).film_least, 0);
    EXPECT_EQ(scene.materials.at(0).film_most, 1e5f) << "no film";
    for (const char* key : {"iridescenceFactor", "iridescenceIor", "iridescenceThicknessMinimum"})
        EXPECT_TRUE(has_note(scene, std::string("1 value of ") + key + " out of its range")) << key;
}

TEST(GltfLobes, Dispersion) {
    const TempFolder folder;
    const auto with = [&](double dispersion, double ior) {
        return load(folder, with_extensions({{"KHR_materials_dispersion", {{"dispersion", dispersion}}},
                                             {"KHR_materials_ior", {{"ior", ior}}}}));
    };
    EXPECT_FLOAT_EQ(with(0.36, 1.5).materials.at(0).dispersion, 0.36f);
    EXPECT_EQ(with(2.04, 1.5).materials.at(0).dispersion, 2.04f) << "of rutile";
    EXPECT_EQ(with(-1, 1.5).materials.at(0).dispersion, 0);
    EXPECT_TRUE(has_note(with(-1, 1.5), "1 value of dispersion out of its range (VALUE_NOT_IN_RANGE)"));
    EXPECT_EQ(with(0.5, 0).materials.at(0).dispersion, 0) << "an infinite index has no neighbours";
    EXPECT_TRUE(std::isfinite(with(3e38, 1e6).materials.at(0).dispersion * 1e6f));
}

TEST(GltfLobes, DiffuseTransmission) {
    const TempFolder folder;
    Scene scene = load_extension(folder, "KHR_materials_diffuse_transmission", R"({"diffuseTransmissionFactor": 0.25,
        "diffuseTransmissionColorFactor": [1, 0.5, 0.25], "diffuseTransmissionTexture": {"index": 0},
        "diffuseTransmissionColorTexture": {"index": 0}})");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.diffuse_transmission, 0.25f);
    EXPECT_EQ(m.diffuse_transmission_color, glm::vec3(1, 0.5f, 0.25f));
    expect_use(m.diffuse_transmission_texture, 3);
    expect_use(m.diffuse_transmission_color_texture, 0);
    EXPECT_TRUE(is_color(&Material::diffuse_transmission_color_texture));
    EXPECT_FALSE(is_color(&Material::diffuse_transmission_texture));
    scene = load_extension(folder, "KHR_materials_diffuse_transmission",
                           R"({"diffuseTransmissionFactor": 2, "diffuseTransmissionColorFactor": [3, -1, 0.5]})");
    EXPECT_EQ(scene.materials.at(0).diffuse_transmission, 1);
    EXPECT_EQ(scene.materials.at(0).diffuse_transmission_color, glm::vec3(1, 0, 0.5f));
    EXPECT_TRUE(has_note(scene, "2 values of diffuseTransmissionColorFactor out of their range"));
}

TEST(GltfLobes, ValuesOfOtherTypesAreRefused) {
    const TempFolder folder;
    const auto error = [&](const char* name, const char* members) {
        return error_of(folder, with_extensions({{name, json::parse(members)}}));
    };
    EXPECT_MENTIONS(error("KHR_materials_sheen", R"({"sheenColorFactor": [1, 1]})"),
                    "materials[0].extensions.KHR_materials_sheen.sheenColorFactor: has 2 numbers, needs 3");
    EXPECT_MENTIONS(error("KHR_materials_sheen", R"({"sheenRoughnessTexture": {"index": 7}})"), "out of range");
    EXPECT_MENTIONS(error("KHR_materials_iridescence", R"({"iridescenceIor": "high"})"), "must be a number");
    EXPECT_MENTIONS(error("KHR_materials_iridescence", R"({"iridescenceTexture": {}})"), "\"index\" is missing");
    EXPECT_MENTIONS(error("KHR_materials_anisotropy", R"({"anisotropyRotation": 1e300})"), "floating point");
    EXPECT_MENTIONS(error("KHR_materials_anisotropy", "[]"), "must be an object");
    EXPECT_MENTIONS(error("KHR_materials_dispersion", R"({"dispersion": null})"), "must be a number");
    EXPECT_MENTIONS(error("KHR_materials_diffuse_transmission", R"({"diffuseTransmissionColorFactor": 1})"),
                    "must be an array");
}

/// A brushed square with normals: its image is turned by a quarter, so that u rises with y.
json brushed(const char* members = R"({"anisotropyStrength": 0.5})") {
    json gltf = with_extensions({{"KHR_materials_anisotropy", json::parse(members)}});
    primitive(gltf)["attributes"]["NORMAL"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
    primitive(gltf)["attributes"]["TEXCOORD_0"] =
        add_accessor(gltf, pack<float>({0, 0, 0, 1, 1, 1, 1, 0}), 5126, "VEC2", 4);
    return gltf;
}

void expect_tangents(const Scene& scene, const glm::vec4& tangent) {
    const Primitive& p = only_primitive(scene);
    EXPECT_EQ(p.tangents.size(), p.positions.size());
    for (const glm::vec4& t : p.tangents) EXPECT_LT(glm::distance(t, tangent), 1e-6f) << t.x << " " << t.y;
}

constexpr const char* kComputed =
    "1 anisotropic primitive without TANGENT, which programs that optimise files drop: its direction was computed from "
    "texture coordinates";
constexpr const char* kIsotropic =
    "1 anisotropic primitive without tangents and texture coordinates drawn as isotropic";

TEST(GltfLobes, AnisotropyAndItsTexture) {
    const TempFolder folder;
    Scene scene = load(folder, brushed(R"({"anisotropyStrength": 0.75, "anisotropyRotation": 1.5,
        "anisotropyTexture": {"index": 0}})"));
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.anisotropy, 0.75f);
    EXPECT_EQ(m.anisotropy_rotation, 1.5f);
    expect_use(m.anisotropy_texture, 0);
    EXPECT_FALSE(is_color(&Material::anisotropy_texture));
    scene = load(folder, brushed(R"({"anisotropyStrength": 2, "anisotropyRotation": -621.0353})"));
    EXPECT_EQ(scene.materials.at(0).anisotropy, 1);
    EXPECT_NEAR(scene.materials.at(0).anisotropy_rotation, 1, 1e-4) << "whole turns do not count";
    EXPECT_TRUE(has_note(scene, "1 value of anisotropyStrength out of its range"));
    scene = load(folder, brushed(R"({"anisotropyStrength": -1})"));
    EXPECT_EQ(scene.materials.at(0).anisotropy, 0);
    EXPECT_TRUE(only_primitive(scene).tangents.empty());
}

TEST(GltfLobes, TheDirectionOfAnisotropyIsTheFilesTangent) {
    const TempFolder folder;
    json gltf = brushed();
    const size_t tangents =
        add_accessor(gltf, pack<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}), 5126, "VEC4", 4);
    Scene scene = load(folder, gltf);
    expect_tangents(scene, {0, 1, 0, 1});
    ASSERT_EQ(scene.notes.size(), 1u) << all_notes(scene);
    EXPECT_EQ(scene.notes[0], kComputed);
    primitive(gltf)["attributes"]["TANGENT"] = tangents;
    scene = load(folder, gltf);
    expect_tangents(scene, {1, 0, 0, -1});
    EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
    // The file's tangents need no texture coordinates.
    primitive(gltf)["attributes"].erase("TEXCOORD_0");
    scene = load(folder, gltf);
    expect_tangents(scene, {1, 0, 0, -1});
    EXPECT_TRUE(scene.notes.empty()) << all_notes(scene);
    primitive(gltf)["attributes"].erase("TANGENT");
    scene = load(folder, gltf);
    expect_tangents(scene, glm::vec4(0));
    ASSERT_EQ(scene.notes.size(), 1u) << all_notes(scene);
    EXPECT_EQ(scene.notes[0], kIsotropic);
    // What shows its colour alone has no direction, and no note.
    gltf["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
    gltf["extensionsUsed"].push_back("KHR_materials_unlit");
    EXPECT_TRUE(load(folder, gltf).notes.empty());
}

TEST(GltfLobes, TangentsOfAnisotropyFollowTheCoordinatesOfATexture) {
    const TempFolder folder;
    json gltf = brushed();
    primitive(gltf)["attributes"]["TEXCOORD_1"] =
        add_accessor(gltf, pack<float>({0, 1, 1, 1, 1, 0, 0, 0}), 5126, "VEC2", 4);  // u rises with x
    const glm::vec4 first(0, 1, 0, 1), second(1, 0, 0, 1);
    const json use = {{"index", 0}, {"texCoord", 1}};
    json& material = gltf["materials"][0];
    json& anisotropy = material["extensions"]["KHR_materials_anisotropy"];
    // Without a texture by TEXCOORD_0, whichever the other textures use.
    material["pbrMetallicRoughness"]["baseColorTexture"] = use;
    Scene scene = load(folder, gltf);
    expect_tangents(scene, first);
    EXPECT_TRUE(has_note(scene, kComputed));
    ASSERT_EQ(scene.notes.size(), 1u) << all_notes(scene);
    anisotropy["anisotropyTexture"] = use;
    expect_tangents(load(folder, gltf), second);
    // A primitive has one set of tangents; normals would be wrong with another one.
    material["normalTexture"] = {{"index", 0}};
    expect_tangents(load(folder, gltf), first);
    anisotropy.erase("anisotropyTexture");
    material["normalTexture"] = use;
    expect_tangents(load(folder, gltf), second);
    // No TEXCOORD_0: the base colour's coordinates are none of its direction.
    material.erase("normalTexture");
    primitive(gltf)["attributes"].erase("TEXCOORD_0");
    scene = load(folder, gltf);
    expect_tangents(scene, glm::vec4(0));
    ASSERT_EQ(scene.notes.size(), 1u) << all_notes(scene);
    EXPECT_EQ(scene.notes[0], kIsotropic);
}

TEST(GltfLobes, VariantsChooseAnisotropicMaterials) {
    const TempFolder folder;
    json gltf = brushed();
    gltf["materials"].push_back(json::object());
    gltf["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "brushed"}}, {{"name", "plain"}}};
    primitive(gltf)["material"] = 1;
    primitive(gltf)["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 0}, {"variants", {0}}}};
    gltf["extensionsUsed"].push_back("KHR_materials_variants");
    const std::string file = folder.write("scene.gltf", gltf.dump());
    EXPECT_TRUE(only_primitive(load_scene(file)).tangents.empty());
    EXPECT_TRUE(load_scene(file).notes.empty());
    LoadOptions options;
    options.variant = "brushed";
    const Scene scene = load_scene(file, options);
    expect_tangents(scene, {0, 1, 0, 1});
    EXPECT_TRUE(has_note(scene, kComputed));
}

TEST(GltfLobes, RequiredExtensionsAreThere) {
    const TempFolder folder;
    for (const char* name : {"KHR_materials_sheen", "KHR_materials_iridescence", "KHR_materials_anisotropy",
                             "KHR_materials_dispersion", "KHR_materials_diffuse_transmission"}) {
        json gltf = with_extensions({{name, json::object()}});
        gltf["extensionsRequired"] = {name};
        EXPECT_NO_THROW(load(folder, gltf)) << name;
    }
}

}  // namespace
}  // namespace peelray::testing
