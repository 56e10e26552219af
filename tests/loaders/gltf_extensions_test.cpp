// Extensions that choose: among images, among materials, among nodes.

#include <webp/encode.h>

#include <cmath>

#include "loaders/animated_files.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"
#include "motion/motion.h"

namespace peelray::testing {
namespace {

/// Two texels, as a WebP file without loss.
std::string webp_of(uint32_t left, uint32_t right) {
    const uint32_t texels[] = {left, right};
    uint8_t* out = nullptr;
    const size_t size = WebPEncodeLosslessRGBA(reinterpret_cast<const uint8_t*>(texels), 2, 1, 8, &out);
    const std::string bytes(reinterpret_cast<const char*>(out), size);
    WebPFree(out);
    return bytes;
}

constexpr uint32_t blue = 0xFFFF0000, yellow = 0x8000FFFF;
constexpr uint32_t red = 0xFF0000FF;  // the first texel of tiny_png()

TEST(GltfImages, WebP) {
    const TempFolder folder;
    folder.write("t.png", tiny_png());
    folder.write("t.webp", webp_of(blue, yellow));
    // As a plain source, which the format does not allow and exporters write.
    json gltf = textured("t.webp");
    EXPECT_EQ(load(folder, gltf).textures.at(0).texels, (std::vector<uint32_t>{blue, yellow}));

    gltf = textured("t.png");
    gltf["images"].push_back({{"uri", "t.webp"}, {"mimeType", "image/webp"}});
    gltf["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    gltf["extensionsUsed"] = {"EXT_texture_webp"};
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(scene.textures.at(0).texels.at(1), yellow);
    EXPECT_EQ(scene.textures.at(0).width, 2u);
    EXPECT_EQ(all_notes(scene), "");
    EXPECT_TRUE(scene.extensions_unsupported.empty());

    gltf["textures"][0].erase("source");
    gltf["extensionsRequired"] = {"EXT_texture_webp"};
    EXPECT_EQ(load(folder, gltf).textures.at(0).texels.at(0), blue);
    gltf["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 2;
    EXPECT_MENTIONS(error_of(folder, gltf), "out of range");
}

TEST(GltfImages, DamagedWebP) {
    const TempFolder folder;
    json gltf = textured("t.webp");
    const std::string good = webp_of(blue, yellow);
    for (size_t length = 12; length + 2 < good.size(); ++length) {
        folder.write("t.webp", good.substr(0, length));
        const Scene scene = load(folder, gltf);
        EXPECT_TRUE(scene.textures.empty());
        EXPECT_MENTIONS(all_notes(scene), "images[0] (t.webp): the WebP image");
    }
}

TEST(GltfImages, FormatsWithoutReader) {
    const TempFolder folder;
    folder.write("t.png", tiny_png());
    folder.write("t.ktx2", std::string("\xABKTX 20\xBB\r\n\x1A\n", 12) + std::string(80, '\0'));
    folder.write("t.avif", std::string("\0\0\0\x1C"
                                       "ftypavif",
                                       12) +
                               std::string(80, '\0'));
    for (const auto& [name, file, type] :
         {std::tuple("KHR_texture_basisu", "t.ktx2", "KTX2"), std::tuple("EXT_texture_avif", "t.avif", "AVIF")}) {
        json gltf = textured("t.png");
        gltf["images"].push_back({{"uri", file}});
        gltf["textures"][0]["extensions"][name]["source"] = 1;
        gltf["extensionsUsed"] = {name};
        const Scene fallback = load(folder, gltf);
        EXPECT_EQ(fallback.textures.at(0).texels.at(0), red);
        EXPECT_MENTIONS(all_notes(fallback), std::string("1 texture of ") + name + " shown by the other image");
        gltf["textures"][0].erase("source");
        const Scene none = load(folder, gltf);
        EXPECT_TRUE(none.textures.empty());
        EXPECT_MENTIONS(all_notes(none), std::string("of the type ") + type);
        gltf["extensionsRequired"] = {name};
        EXPECT_MENTIONS(error_of(folder, gltf), name);
    }
}

/// Two squares side by side in one mesh, of materials 0 and none; "night" gives both material 1, "day" the second
/// one 2.
json with_variants() {
    json gltf = square();
    gltf["materials"] = {{{"name", "plain"}}, {{"name", "dark"}}, {{"name", "bright"}}};
    primitive(gltf)["material"] = 0;
    gltf["meshes"][0]["primitives"].push_back(primitive(gltf));
    gltf["meshes"][0]["primitives"][1].erase("material");
    gltf["extensionsUsed"] = {"KHR_materials_variants"};
    gltf["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    const auto mapping = [](int material, const std::vector<int>& variants) {
        return json{{"material", material}, {"variants", variants}};
    };
    primitive(gltf)["extensions"]["KHR_materials_variants"]["mappings"] = json::array({mapping(1, {1})});
    gltf["meshes"][0]["primitives"][1]["extensions"]["KHR_materials_variants"]["mappings"] =
        json::array({mapping(2, {0}), mapping(1, {1})});
    return gltf;
}

TEST(GltfVariants, ChooseMaterials) {
    const TempFolder folder;
    const std::string file = folder.write("v.gltf", with_variants().dump());
    const auto materials = [&](const char* variant) {
        const Scene scene = load_scene(file, {variant});
        EXPECT_EQ(scene.variants, (std::vector<std::string>{"day", "night"}));
        EXPECT_TRUE(scene.extensions_unsupported.empty());
        std::vector<std::string> names;
        for (const Primitive& p : scene.meshes.at(0).primitives) names.push_back(scene.materials.at(p.material).name);
        return names;
    };
    EXPECT_EQ(materials(""), (std::vector<std::string>{"plain", "default"}));
    EXPECT_EQ(materials("day"), (std::vector<std::string>{"plain", "bright"}));
    EXPECT_EQ(materials("night"), (std::vector<std::string>{"dark", "dark"}));
}

TEST(GltfVariants, UnknownOnesGiveOneLine) {
    const TempFolder folder;
    const auto error = [](const std::string& scene, const char* variant) -> std::string {
        try {
            load_scene(scene, {variant});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const std::string file = folder.write("v.gltf", with_variants().dump());
    EXPECT_MENTIONS(error(file, "dusk"), "no variant \"dusk\"");
    EXPECT_MENTIONS(error(file, "dusk"), "day, night");
    EXPECT_MENTIONS(error(folder.write("s.gltf", square().dump()), "day"), "no variants of its materials");
    EXPECT_MENTIONS(error("builtin:glass", "day"), "no variants of its materials");
    json gltf = with_variants();
    primitive(gltf)["extensions"]["KHR_materials_variants"]["mappings"][0]["variants"] = {2};
    EXPECT_MENTIONS(error_of(folder, gltf), "2 is out of range, the file has 2 variants");
    gltf = with_variants();
    primitive(gltf)["extensions"]["KHR_materials_variants"]["mappings"][0]["material"] = 3;
    EXPECT_MENTIONS(error_of(folder, gltf), "3 is out of range, the file has 3 materials");
}

TEST(GltfVisibility, HidesWhatHangsBelow) {
    const TempFolder folder;
    json gltf = square();
    gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_node_visibility"};
    const auto visible = [](bool is_visible) { return json{{"KHR_node_visibility", {{"visible", is_visible}}}}; };
    json lamp = {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
    gltf["nodes"] = {{{"mesh", 0}, {"extensions", visible(true)}},
                     {{"mesh", 0}, {"children", {2, 3}}, {"extensions", visible(false)}},
                     {{"mesh", 0}, {"camera", 0}, {"extensions", visible(true)}},
                     lamp};
    gltf["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(flatten(scene).triangles.size(), 2u);
    EXPECT_EQ(scene.cameras.size(), 1u);  // cameras stay
    EXPECT_TRUE(scene.lights.empty());
    gltf["nodes"][1].erase("extensions");
    EXPECT_EQ(flatten(load(folder, gltf)).triangles.size(), 6u);
    EXPECT_EQ(load(folder, gltf).lights.size(), 1u);
    gltf["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = 0;
    EXPECT_MENTIONS(error_of(folder, gltf), "must be true or false");
}

/// The first node shown twice, the second time 5 to the right as the node sees it; the node lies on its side.
json shown_twice(json gltf) {
    const size_t places = add_accessor(gltf, pack<float>({0, 0, 0, 5, 0, 0}), 5126, "VEC3", 2);
    gltf["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return gltf;
}

TEST(GltfInstancing, SkinsAreMovedAsTheirNodesWouldBe) {
    const TempFolder folder;
    const Scene plain = load(folder, lifted()), scene = load(folder, shown_twice(lifted()));
    EXPECT_EQ(all_notes(scene), "");
    for (const double time : {0.0, 0.5, 1.0}) {
        const std::vector<glm::vec3> once = positions_at(plain, time), twice = positions_at(scene, time);
        ASSERT_EQ(twice.size(), 2 * once.size());
        for (size_t i = 0; i < once.size(); ++i) {
            expect_near(twice[i], once[i]);
            expect_near(twice[once.size() + i], once[i] + glm::vec3(0, 5, 0));
        }
    }
}

TEST(GltfInstancing, WeightsOfTheNodeMorphAllItsInstances) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["targets"] = {{{"POSITION", add_accessor(gltf, pack(unit_square), 5126, "VEC3", 4)}}};
    animate_node(gltf, 0, "weights", {0, 1}, {0, 1}, "SCALAR");
    const Scene scene = load(folder, shown_twice(gltf));
    EXPECT_EQ(all_notes(scene), "");
    const std::vector<glm::vec3> rest = positions_at(scene, 0), grown = positions_at(scene, 1);
    ASSERT_EQ(rest.size(), 12u);
    for (size_t i = 0; i < 6; ++i) {
        expect_near(grown[i], 2.f * rest[i]);
        expect_near(grown[6 + i], 2.f * rest[i] + glm::vec3(0, 5, 0));
    }
    const Motion motion = motion_of(scene, "all");
    EXPECT_TRUE(motion.morphs.at(1) && motion.morphs.at(2));
}

}  // namespace
}  // namespace peelray::testing
