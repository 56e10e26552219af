// Every broken glTF file must give one clear line, and never read or allocate what is not there.

#include <cmath>

#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

TEST(GltfBad, MissingEmptyAndForeignFiles) {
    const TempFolder folder;
    EXPECT_MENTIONS(error_of((folder.path() / "none.gltf").string()), "no such file");
    EXPECT_MENTIONS(error_of(folder.write("empty.gltf", "")), "empty");
    EXPECT_MENTIONS(error_of(folder.write("empty.glb", "")), "empty");
    EXPECT_MENTIONS(error_of(folder.write("text.gltf", "hello\nworld")), "not a glTF file");
    EXPECT_MENTIONS(error_of(folder.write("list.gltf", "[1, 2]")), "not a glTF file");
    EXPECT_MENTIONS(error_of(folder.write("other.gltf", "{}")), "asset");
    EXPECT_MENTIONS(error_of(folder.write("old.gltf", R"({"asset": {"version": "1.0"}})")), "1.0");
    EXPECT_MENTIONS(error_of(folder.write("what.xyz", "x")), ".gltf, .glb, .obj, .ply, .stl, .off");
    std::filesystem::create_directory(folder.path() / "folder.gltf");
    EXPECT_MENTIONS(error_of((folder.path() / "folder.gltf").string()), "regular file");
}

TEST(GltfBad, TruncatedGlb) {
    const TempFolder folder;
    const std::string text = R"({"asset": {"version": "2.0"}}   )";
    const std::string whole = glb(text, "");
    EXPECT_MENTIONS(error_of(folder.write("whole.glb", whole)), "no triangles");
    for (size_t size = 1; size < whole.size(); ++size) error_of(folder.write("cut.glb", whole.substr(0, size)));
    std::string damaged = whole;
    damaged[12] = '\xFF', damaged[13] = '\xFF', damaged[15] = '\xFF';  // a chunk of 4 GB
    EXPECT_MENTIONS(error_of(folder.write("damaged.glb", damaged)), "truncated");
}

// tinygltf 2.7 would read 8 bytes behind the file here.
TEST(GltfBad, BinaryChunkLongerThanTheGlb) {
    const TempFolder folder;
    const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8}]})";
    std::string file = glb(text, std::string(8, '\0'));
    EXPECT_MENTIONS(error_of(folder.write("whole.glb", file)), "no triangles");
    file[file.size() - 16] = 16;  // the chunk's length
    EXPECT_MENTIONS(error_of(folder.write("long.glb", file)), "truncated");
}

// Every value of a good file in turn replaced by one of another type, or by a number that is too large.
TEST(GltfBad, WrongTypesEverywhere) {
    const TempFolder folder;
    json gltf = square();
    gltf["cameras"] = json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}])");
    gltf["materials"] =
        json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]}, "emissiveFactor": [0, 0, 0],
        "extensions": {"KHR_materials_volume": {"attenuationDistance": 3, "attenuationColor": [0.5, 0.6, 0.7]},
                       "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.6, 0.7]},
                       "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessMaximum": 500},
                       "KHR_materials_anisotropy": {"anisotropyStrength": 1, "anisotropyRotation": 1},
                       "KHR_materials_dispersion": {"dispersion": 1}}}])");
    gltf["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}})");
    gltf["nodes"][0] = {{"mesh", 0},
                        {"camera", 0},
                        {"translation", {1, 2, 3}},
                        {"name", "n"},
                        {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
    primitive(gltf)["material"] = 0;
    ASSERT_NO_THROW(load(folder, gltf));
    const json flat = gltf.flatten();
    for (const auto& [pointer, unused] : flat.items())
        for (json::json_pointer at(pointer); !at.empty(); at.pop_back())
            for (const json& value :
                 {json(nullptr), json(true), json("x"), json(-1), json(1e300), json(4294967296u * 4ull), json(0.5),
                  json::array(), json::object(), json::array({json::object()})}) {
                json bad = gltf;
                bad[at] = value;
                SCOPED_TRACE(at.to_string() + " = " + value.dump());
                try {
                    load(folder, bad);
                } catch (const Error& error) {
                    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                }
            }
}

TEST(GltfBad, AlphaModesAndCutoffs) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    const auto with = [&](const json& material) {
        gltf["materials"] = {material};
        return error_of(folder, gltf);
    };
    EXPECT_MENTIONS(with({{"alphaMode", "CUTOUT"}}),
                    "materials[0]: alphaMode \"CUTOUT\" is unknown; it must be OPAQUE, MASK or BLEND");
    EXPECT_MENTIONS(with({{"alphaMode", "mask"}}), "unknown");
    EXPECT_MENTIONS(with({{"alphaMode", "MA\nSK"}}), "unknown");
    EXPECT_MENTIONS(with({{"alphaMode", 1}}), "materials[0].alphaMode: is number, must be a string");
    EXPECT_MENTIONS(with({{"alphaMode", "MASK"}, {"alphaCutoff", "high"}}),
                    "materials[0].alphaCutoff: is string, must be a number");
    EXPECT_MENTIONS(with({{"alphaMode", "MASK"}, {"alphaCutoff", nullptr}}), "must be a number");
    EXPECT_MENTIONS(with({{"alphaMode", "MASK"}, {"alphaCutoff", -0.1}}),
                    "materials[0]: alphaCutoff -0.1 must not be below 0");
    EXPECT_MENTIONS(with({{"alphaCutoff", -1}}), "must not be below 0");
    EXPECT_MENTIONS(with({{"doubleSided", 1}}), "materials[0].doubleSided: is number");
    EXPECT_MENTIONS(with({{"alphaMode", "MASK"}, {"alphaCutoff", 1e300}}), "floating point");
}

TEST(GltfBad, TruncatedJson) {
    const TempFolder folder;
    const std::string whole = square().dump();
    for (size_t size = 1; size < whole.size(); size += 7) error_of(folder.write("cut.gltf", whole.substr(0, size)));
}

TEST(GltfBad, DeeplyNestedJson) {
    const TempFolder folder;
    const std::string deep =
        R"({"asset": {"version": "2.0"}, "extras": )" + std::string(200000, '[') + std::string(200000, ']') + "}";
    EXPECT_MENTIONS(error_of(folder.write("deep.gltf", deep)), "no triangles");
}

TEST(GltfBad, EmptyScene) {
    const TempFolder folder;
    EXPECT_MENTIONS(error_of(folder, {{"asset", {{"version", "2.0"}}}}), "no triangles");
    json gltf = square();
    gltf["scenes"][0]["nodes"] = json::array();
    EXPECT_MENTIONS(error_of(folder, gltf), "no triangles");
}

TEST(GltfBad, BuffersMissingOrTooShort) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"][0]["uri"] = "gone.bin";
    EXPECT_MENTIONS(error_of(folder, gltf), "gone.bin: no such file");
    folder.write("short.bin", "1234");
    gltf["buffers"][0]["uri"] = "short.bin";
    EXPECT_MENTIONS(error_of(folder, gltf), "too short: byteLength is 48, there are 4 bytes");
    gltf["buffers"][0].erase("uri");
    EXPECT_MENTIONS(error_of(folder, gltf), "no data");
    gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64,!!!!";
    EXPECT_MENTIONS(error_of(folder, gltf), "base64");
    gltf["buffers"][0]["uri"] = "data:nothing";
    EXPECT_MENTIONS(error_of(folder, gltf), "data URI");
}

TEST(GltfBad, RangesOfViewsAndAccessors) {
    const TempFolder folder;
    const auto with = [&](const char* list, size_t index, const char* key, const json& value) {
        json gltf = square();
        gltf[list][index][key] = value;
        return error_of(folder, gltf);
    };
    EXPECT_MENTIONS(with("bufferViews", 0, "byteLength", 49), "outside of its buffer of 48 bytes");
    EXPECT_MENTIONS(with("bufferViews", 0, "byteOffset", 1), "outside of its buffer");
    EXPECT_MENTIONS(with("bufferViews", 0, "byteOffset", 9007199254740992), "outside of its buffer");
    EXPECT_MENTIONS(with("bufferViews", 0, "byteOffset", -1), "whole number");
    EXPECT_MENTIONS(with("bufferViews", 0, "buffer", 7), "the file has 2 buffers");
    EXPECT_MENTIONS(with("bufferViews", 0, "byteStride", 4), "byteStride 4");
    EXPECT_MENTIONS(with("bufferViews", 0, "byteStride", 16), "needs 60 bytes");
    EXPECT_MENTIONS(with("accessors", 0, "count", 5), "needs 60 bytes");
    EXPECT_MENTIONS(with("accessors", 0, "count", 4000000000u), "bytes");
    EXPECT_MENTIONS(with("accessors", 0, "count", 1e18), "whole number");
    EXPECT_MENTIONS(with("accessors", 0, "count", 1.5), "whole number");
    EXPECT_MENTIONS(with("accessors", 0, "count", "4"), "must be a whole number");
    EXPECT_MENTIONS(with("accessors", 0, "byteOffset", 4), "needs 52 bytes");
    EXPECT_MENTIONS(with("accessors", 0, "componentType", 5124), "component type 5124");
    EXPECT_MENTIONS(with("accessors", 0, "type", "VEC5"), "VEC5");
    EXPECT_MENTIONS(with("accessors", 0, "type", "VEC2"), "POSITION needs 3 components");
    EXPECT_MENTIONS(with("accessors", 0, "bufferView", 2), "the file has 2 buffer views");
    EXPECT_MENTIONS(with("accessors", 1, "componentType", 5126), "bytes");
    EXPECT_MENTIONS(with("accessors", 1, "componentType", 5122), "indices must be");
}

TEST(GltfBad, UnbackedAndSparseAccessors) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"][0].erase("bufferView");
    gltf["accessors"][0]["count"] = 4000000000u;
    EXPECT_MENTIONS(error_of(folder, gltf), "without a buffer view");
    gltf["accessors"][0]["count"] = 4;
    gltf["accessors"][0]["sparse"] = {
        {"count", 5}, {"indices", {{"bufferView", 1}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
    EXPECT_MENTIONS(error_of(folder, gltf), "5 sparse elements");
    gltf["accessors"][0]["sparse"]["count"] = 4;
    gltf["bufferViews"][1]["byteOffset"] = 2;
    gltf["bufferViews"][1]["byteLength"] = 10;
    gltf["accessors"][1]["count"] = 5;
    EXPECT_NO_THROW(load(folder, gltf));
    gltf["accessors"][0]["count"] = 3;
    gltf["accessors"][0]["sparse"]["count"] = 3;
    gltf["accessors"][0]["sparse"]["indices"]["byteOffset"] = 4;  // 2, 3: beyond the three elements
    EXPECT_MENTIONS(error_of(folder, gltf), "sparse index");
}

TEST(GltfBad, SharedAccessorsCannotExplode) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"][0].erase("bufferView");
    gltf["accessors"][0]["count"] = 1u << 24;
    for (int i = 0; i < 1000; ++i)
        gltf["meshes"][0]["primitives"][i] = {
            {"attributes", {{"COLOR_0", 0}, {"POSITION", 0}}}, {"indices", 1}, {"mode", 4}};
    gltf["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 1;  // fails early, so that the test itself stays small
    EXPECT_MENTIONS(error_of(folder, gltf), "NORMAL");
}

TEST(GltfBad, IndicesAndCounts) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["indices"] = add_accessor(gltf, pack<uint32_t>({0, 1, 4}), 5125, "SCALAR", 3);
    const std::string line = error_of(folder, gltf);
    EXPECT_MENTIONS(line, "meshes[0].primitives[0]");
    EXPECT_MENTIONS(line, "index 2 is 4, the primitive has 4 vertices");
    gltf = square();
    primitive(gltf)["attributes"]["NORMAL"] = add_accessor(gltf, pack<float>({0, 0, 1}), 5126, "VEC3", 1);
    EXPECT_MENTIONS(error_of(folder, gltf), "NORMAL has 1 element, POSITION has 4");
    gltf = square();
    primitive(gltf)["material"] = 0;
    EXPECT_MENTIONS(error_of(folder, gltf), "material");
    primitive(gltf).erase("material");
    primitive(gltf)["mode"] = 7;
    EXPECT_MENTIONS(error_of(folder, gltf), "mode");
}

TEST(GltfBad, NotFiniteVertices) {
    const TempFolder folder;
    for (const float bad : {NAN, INFINITY, -INFINITY}) {
        json gltf = square();
        std::vector<float> positions = unit_square;
        positions[7] = bad;
        primitive(gltf)["attributes"]["POSITION"] = add_accessor(gltf, pack(positions), 5126, "VEC3", 4);
        const std::string line = error_of(folder, gltf);
        EXPECT_MENTIONS(line, "meshes[0].primitives[0]");
        EXPECT_MENTIONS(line, "vertex 2");
    }
    json gltf = square();
    gltf["nodes"][0]["scale"] = {1e39, 1, 1};
    EXPECT_MENTIONS(error_of(folder, gltf), "scale");
    gltf["nodes"] = {{{"mesh", 0}, {"scale", {1e30, 1, 1}}}, {{"children", {0}}, {"scale", {1e30, 1, 1}}}};
    gltf["scenes"][0]["nodes"] = {1};
    EXPECT_MENTIONS(error_of(folder, gltf), "not finite");
}

TEST(GltfBad, Hierarchy) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
    EXPECT_MENTIONS(error_of(folder, gltf), "reached twice");
    gltf["nodes"] = {{{"children", {0}}, {"mesh", 0}}};
    EXPECT_MENTIONS(error_of(folder, gltf), "reached twice");
    gltf["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    gltf["scenes"][0]["nodes"] = {0, 1};
    EXPECT_MENTIONS(error_of(folder, gltf), "two parents");
    gltf["nodes"] = {{{"mesh", 0}, {"children", {5}}}};
    gltf["scenes"][0]["nodes"] = {0};
    EXPECT_MENTIONS(error_of(folder, gltf), "the file has 1 node");
    gltf["scene"] = 3;
    EXPECT_MENTIONS(error_of(folder, gltf), "the file has 1 scene");
}

TEST(GltfBad, RequiredExtensions) {
    const TempFolder folder;
    for (const char* name : {"KHR_texture_basisu", "KHR_materials_sss", "ACME_magic"}) {
        json gltf = square();
        gltf["extensionsRequired"] = {"KHR_materials_ior", name};
        EXPECT_MENTIONS(error_of(folder, gltf), name);
    }
}

TEST(GltfBad, Images) {
    const TempFolder folder;
    const Scene gone = load(folder, textured("gone.png"));  // the factor is used, and one note says so
    EXPECT_EQ(gone.materials.at(0).base_color_texture, -1);
    ASSERT_EQ(gone.notes.size(), 1u);
    EXPECT_MENTIONS(gone.notes[0], "gone.png is missing");
    // So it is used instead of a damaged one.
    const std::string whole = tiny_png();
    std::string huge = whole;
    huge[17] = '\x7F';  // a width of 8 million pixels
    const std::pair<const char*, std::string> damaged[] = {{"text.png", "this is no image"},
                                                           {"empty.png", ""},
                                                           {"cut.png", whole.substr(0, whole.size() - 25)},
                                                           {"huge.png", huge}};
    for (const auto& [name, bytes] : damaged) {
        SCOPED_TRACE(name);
        folder.write(name, bytes);
        for (const char* use : {"base colour", "mean", "without effect"}) {
            json gltf = textured(name);
            if (use[0] == 'm') gltf["materials"][0] = {{"emissiveTexture", {{"index", 0}}}};
            if (use[0] == 'w') gltf["materials"][0] = {{"normalTexture", {{"index", 0}}}};
            // The header of the one that is cut is whole, and nobody reads the rest.
            if (use[0] == 'w' && name == std::string("cut.png")) continue;
            const Scene scene = load(folder, gltf);
            EXPECT_EQ(scene.materials.at(0).base_color_texture, -1);
            EXPECT_TRUE(scene.textures.empty());
            EXPECT_MENTIONS(all_notes(scene), fmt::format("images[0] ({})", name)) << use;
            EXPECT_MENTIONS(all_notes(scene), "the factor is used") << use;
        }
    }
    // Also where it is no file, and once for all of its uses.
    for (const char* uri : {"data:image/png;base64,AAAA", "data:image/png;base64,A", "data:,"}) {
        json gltf = textured(uri);
        gltf["materials"].push_back(gltf["materials"][0]);
        gltf["materials"].push_back({{"emissiveTexture", {{"index", 0}}}});
        const Scene scene = load(folder, gltf);
        EXPECT_EQ(scene.notes.size(), 1u) << uri;
    }
    json several = textured("text.png");
    several["images"].push_back({{"uri", "empty.png"}});
    several["textures"].push_back({{"source", 1}});
    several["materials"].push_back({{"emissiveTexture", {{"index", 1}}}});
    EXPECT_MENTIONS(all_notes(load(folder, several)), "2 images are damaged");
    json gltf = textured("text.png");
    gltf["materials"][0] = {{"normalTexture", {{"index", 0}}}};
    gltf["materials"][0]["normalTexture"]["index"] = 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "the file has 1 texture");
}

TEST(GltfBad, TexturesWithoutAnImage) {
    const TempFolder folder;
    json gltf = textured("gone.png");
    gltf["textures"][0] = json::object();
    EXPECT_EQ(all_notes(load(folder, gltf)),
              "1 texture ignored that names no image, or only in an extension that is unknown\n");
    gltf["extensionsUsed"] = {"EXT_texture_future"};
    gltf["textures"][0] = {{"extensions", {{"EXT_texture_future", {{"source", 0}}}}}};
    EXPECT_MENTIONS(all_notes(load(folder, gltf)), "1 texture ignored that names no image, or only in an extension");
}

TEST(GltfBad, BracesInNamesStayInNotes) {
    const TempFolder folder;
    EXPECT_MENTIONS(all_notes(load(folder, textured("{a|b}{}.png"))), "the image file {a|b}{}.png is missing");
    json gltf = square();
    gltf["nodes"][0]["extensions"]["EXT_{a|b}{}"] = json::object();
    EXPECT_MENTIONS(all_notes(load(folder, gltf)), "EXT_{a|b}{}: without effect");
}

}  // namespace
}  // namespace peelray::testing
