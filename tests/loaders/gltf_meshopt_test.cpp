// EXT_meshopt_compression: every mode and filter gives what was compressed.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "loaders/animated_files.h"
#include "loaders/compressed_files.h"
#include "loaders/load.h"
#include "loaders/meshopt.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

/// The grid as an uncompressed file: accessors 0 positions, 1 texture coordinates, 2 indices.
json grid_file(const Grid& grid) {
    json gltf = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    const size_t positions = add_accessor(gltf, pack(grid.positions), 5126, "VEC3", grid.vertices());
    const size_t uvs = add_accessor(gltf, pack(grid.uvs), 5126, "VEC2", grid.vertices());
    const size_t indices = add_accessor(gltf, pack(grid.corners), 5125, "SCALAR", grid.corners.size());
    gltf["meshes"] = json::array(
        {{{"primitives",
           json::array({{{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"indices", indices}}})}}});
    return gltf;
}

/// A triangle's corners, the least first: the codec may turn triangles round.
std::multiset<std::array<uint32_t, 3>> triangles_of(const Primitive& p) {
    std::multiset<std::array<uint32_t, 3>> out;
    for (const glm::uvec3& t : p.triangles) {
        std::array<uint32_t, 3> corners = {t.x, t.y, t.z};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        out.insert(corners);
    }
    return out;
}

std::string narrow(const std::vector<uint32_t>& values) {
    return pack(std::vector<uint16_t>(values.begin(), values.end()));
}

TEST(GltfMeshopt, AttributesAndTriangles) {
    const TempFolder folder;
    for (const uint32_t side : {4u, 40u}) {  // one block of the codec, and several
        const Grid grid(side);
        json gltf = grid_file(grid);
        primitive(gltf)["attributes"]["NORMAL"] = add_accessor(gltf, pack(grid.normals), 5126, "VEC3", grid.vertices());
        const Primitive plain = only_primitive(load(folder, gltf));
        for (const bool is_narrow : {false, true}) {
            json compressed = gltf;
            compress_view(compressed, 0, pack(grid.positions), 12, "ATTRIBUTES");
            compress_view(compressed, 1, pack(grid.uvs), 8, "ATTRIBUTES");
            compressed["accessors"][2]["componentType"] = is_narrow ? 5123 : 5125;
            compress_view(compressed, 2, is_narrow ? narrow(grid.corners) : pack(grid.corners), is_narrow ? 2 : 4,
                          "TRIANGLES");
            const Scene scene = load(folder, compressed);
            EXPECT_EQ(only_primitive(scene).positions, plain.positions);
            EXPECT_EQ(only_primitive(scene).uvs, plain.uvs);
            EXPECT_EQ(triangles_of(only_primitive(scene)), triangles_of(plain));
            EXPECT_EQ(all_notes(scene), "");
            EXPECT_TRUE(scene.extensions_unsupported.empty());
        }
    }
}

TEST(GltfMeshopt, IndicesOfStrips) {
    const TempFolder folder;
    const Grid grid(4);
    const std::vector<uint32_t> strip = {0, 1, 4, 5, 8, 9, 12, 13};
    for (const bool is_narrow : {false, true}) {
        json gltf = grid_file(grid);
        primitive(gltf)["mode"] = 5;
        const std::string bytes = is_narrow ? narrow(strip) : pack(strip);
        primitive(gltf)["indices"] = add_accessor(gltf, bytes, is_narrow ? 5123 : 5125, "SCALAR", strip.size());
        const Primitive plain = only_primitive(load(folder, gltf));
        compress_view(gltf, 3, bytes, is_narrow ? 2 : 4, "INDICES");
        EXPECT_EQ(only_primitive(load(folder, gltf)).triangles, plain.triangles);
        EXPECT_EQ(only_primitive(load(folder, gltf)).positions, plain.positions);
    }
}

TEST(GltfMeshopt, OctahedralNormals) {
    const TempFolder folder;
    const Grid grid(12);
    std::vector<float> normals;
    for (size_t i = 0; i < grid.vertices(); ++i)
        normals.insert(normals.end(), {grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2], 0});
    for (const size_t stride : {4, 8}) {
        json gltf = grid_file(grid);
        const std::string bytes = meshopt_filtered(normals, stride, "OCTAHEDRAL", stride == 4 ? 8 : 14);
        const size_t accessor = add_accessor(gltf, bytes, stride == 4 ? 5120 : 5122, "VEC3", grid.vertices(), true);
        primitive(gltf)["attributes"]["NORMAL"] = accessor;
        compress_view(gltf, accessor, bytes, stride, "ATTRIBUTES", "OCTAHEDRAL");
        const Primitive p = only_primitive(load(folder, gltf));
        for (size_t i = 0; i < grid.vertices(); ++i)
            EXPECT_LT(glm::distance(p.normals[i], glm::vec3(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2])),
                      stride == 4 ? 0.02f : 3e-4f);
    }
}

TEST(GltfMeshopt, ExponentialPositions) {
    const TempFolder folder;
    const Grid grid(12);
    json gltf = grid_file(grid);
    compress_view(gltf, 0, meshopt_filtered(grid.positions, 12, "EXPONENTIAL", 16), 12, "ATTRIBUTES", "EXPONENTIAL");
    const Primitive plain = only_primitive(load(folder, grid_file(grid))), p = only_primitive(load(folder, gltf));
    float worst = 0;
    for (size_t i = 0; i < p.positions.size(); ++i)
        worst = std::max(worst, glm::distance(p.positions[i], plain.positions[i]));
    EXPECT_LT(worst, 1e-4f);
    EXPECT_GT(worst, 0.f);  // quantised, so it was this data that was read
}

TEST(GltfMeshopt, QuaternionsOfAnimations) {
    const TempFolder folder;
    json gltf = square();
    const std::vector<float> times = {0, 1, 2};
    const float c = std::cos(0.3f), s = std::sin(0.3f);
    const std::vector<float> rotations = {0, 0, 0, 1, 0, 0, s, c, s, 0, 0, c};
    animate_node(gltf, 0, "rotation", times, rotations, "VEC4");
    const Animation plain = load(folder, gltf).animations.at(0);
    const size_t output = gltf["animations"][0]["samplers"][0]["output"].get<size_t>();
    gltf["accessors"][output]["componentType"] = 5122;
    gltf["accessors"][output]["normalized"] = true;
    compress_view(gltf, output, meshopt_filtered(rotations, 8, "QUATERNION", 16), 8, "ATTRIBUTES", "QUATERNION");
    const size_t input = gltf["animations"][0]["samplers"][0]["input"].get<size_t>();
    compress_view(gltf, input, pack(times), 4, "ATTRIBUTES");
    const Animation animation = load(folder, gltf).animations.at(0);
    EXPECT_EQ(animation.channels.at(0).times, times);
    for (size_t i = 0; i < 12; ++i)
        EXPECT_NEAR(animation.channels.at(0).values.at(i), plain.channels.at(0).values.at(i), 1e-4f);
}

json& extension(json& gltf, size_t accessor) {
    const auto view = gltf["accessors"][accessor]["bufferView"].get<size_t>();
    return gltf["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

/// The grid with compressed positions.
json compressed_grid(const Grid& grid) {
    json gltf = grid_file(grid);
    compress_view(gltf, 0, pack(grid.positions), 12, "ATTRIBUTES");
    return gltf;
}

TEST(GltfMeshopt, KhronosNameOfTheSameFormat) {
    const TempFolder folder;
    const Grid grid(4);
    json gltf = compressed_grid(grid);
    json& extensions = gltf["bufferViews"][0]["extensions"];
    extensions["KHR_meshopt_compression"] = extensions["EXT_meshopt_compression"];
    extensions.erase("EXT_meshopt_compression");
    gltf["buffers"][0]["extensions"] = {{"KHR_meshopt_compression", {{"fallback", true}}}};
    gltf["extensionsRequired"] = {"KHR_meshopt_compression"};
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 18u);
    std::string stream = meshopt_stream(pack(grid.positions), 12, "ATTRIBUTES");
    stream[0] = '\xA2';
    gltf["buffers"].back()["uri"] = data_uri(stream);
    EXPECT_MENTIONS(error_of(folder, gltf), "version 2 of the format");
}

std::string decoded(const std::string& stream, size_t count, size_t stride, const char* filter = "NONE") {
    const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(stream.data()), stream.size());
    const Bytes out = decode_meshopt(bytes, {count, stride, "ATTRIBUTES", filter}, "here");
    return {out.begin(), out.end()};
}

TEST(GltfMeshopt, VersionOneOfTheExtensionsOwnExample) {
    // KHR_meshopt_compression, appendix A: sixteen deltas in four bits each, and what they stand for. Here they are the
    // first of an element's four bytes; the others do not change.
    const std::string packed = "\x17\x5f\xf0\xbc\x77\xa9\x21" + std::string(1, '\0') + "\x34\xb5";
    const std::array<int, 16> deltas = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    const std::string baseline = "\x64\x07\x08\x09";
    const std::string stream =
        std::string("\xA1\xA8", 2) + "\x03" + packed + std::string(19, '\0') + baseline + std::string(1, '\0');
    const std::string out = decoded(stream, 16, 4);
    int value = 0x64;
    for (size_t i = 0; i < 16; ++i) {
        value += deltas[i];
        EXPECT_EQ(static_cast<uint8_t>(out[4 * i]), static_cast<uint8_t>(value)) << i;
        EXPECT_EQ(out.substr(4 * i + 1, 3), baseline.substr(1));
    }
}

TEST(GltfMeshopt, VersionOneInAllItsModes) {
    std::string bytes;
    uint32_t state = 1;
    for (uint32_t i = 0; i < 1000; ++i) {  // several blocks, the last of them not full
        state = state * 1664525 + 1013904223;
        const float wave = std::sin(float(i) / 50);
        const uint16_t near[] = {uint16_t(i / 3), uint16_t(40000 + 7 * i)};
        const uint8_t small[] = {uint8_t(state >> 31), uint8_t(state >> 29), uint8_t(state >> 24), 9};
        bytes += pack<float>({wave}) + std::string(reinterpret_cast<const char*>(near), 4) +
                 std::string(reinterpret_cast<const char*>(small), 4);
    }
    for (const uint8_t rotation : {0, 4, 15})
        for (const uint8_t first : {uint8_t(0), uint8_t(1), uint8_t(2 | rotation << 4)})
            for (const uint8_t second : {0, 1, 2})
                for (const std::vector<int>& controls :
                     {std::vector<int>(12, 0), std::vector<int>(12, 1), std::vector<int>(12, 3),
                      std::vector<int>{0, 1, 3, 0, 1, 3, 0, 1, 3, 0, 1, 3}}) {
                    const std::string stream = meshopt_stream_1(bytes, 12, {first, second, 0}, controls);
                    EXPECT_TRUE(decoded(stream, 1000, 12) == bytes) << int(first) << " " << int(second);
                }
    EXPECT_LT(meshopt_stream_1(bytes, 12, {0, 1, 0}, std::vector<int>(12, 0)).size(), bytes.size());
}

TEST(GltfMeshopt, DamagedVersionOne) {
    const Grid grid(20);
    const std::string bytes = pack(grid.positions),
                      good = meshopt_stream_1(bytes, 12, {2, 2, 2}, std::vector<int>(12, 0));
    ASSERT_TRUE(decoded(good, 400, 12) == bytes);
    const auto error = [&](const std::string& stream, size_t count) -> std::string {
        try {
            decoded(stream, count, 12);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    for (size_t length = 8; length < good.size(); length += 7)
        EXPECT_MENTIONS(error(good.substr(0, length), 400), "damaged or cut");
    EXPECT_MENTIONS(error(good + "x", 400), "damaged or cut");
    EXPECT_MENTIONS(error(good, 800), "damaged or cut");
    EXPECT_MENTIONS(error(good, size_t(1) << 40), "cannot come from");
    std::string mode = good;
    mode.back() = 3;
    EXPECT_MENTIONS(error(mode, 400), "damaged or cut");
    mode.back() = 0x10;
    EXPECT_MENTIONS(error(mode, 400), "damaged or cut");
}

TEST(GltfMeshopt, ColorsAsLumaAndChroma) {
    // Eight bits of red, green, blue and seven of alpha: Y is the mean of green and the mean of the others.
    struct Case {
        int r, g, b, a;
    };
    for (const Case& c : {Case{200, 100, 40, 255}, Case{0, 0, 0, 0}, Case{255, 255, 255, 128}, Case{10, 250, 30, 64}}) {
        const int co = (c.r - c.b) / 2, rest = c.b + co, cg = (c.g - rest) / 2, y = rest + cg;
        const std::string narrow = {char(y), char(co), char(cg), char(128 | c.a >> 1)};
        const std::string stream = meshopt_stream(narrow, 4, "ATTRIBUTES");
        const std::string out = decoded(stream, 1, 4, "COLOR");
        const auto at = [](const std::string& text, size_t k) { return int(static_cast<uint8_t>(text[k])); };
        EXPECT_NEAR(at(out, 0), c.r, 2);
        EXPECT_NEAR(at(out, 1), c.g, 2);
        EXPECT_NEAR(at(out, 2), c.b, 2);
        EXPECT_NEAR(at(out, 3), c.a, 1);
        // The same eight bits in shorts: their scale goes by alpha's highest bit.
        const std::string wide = pack<int16_t>({int16_t(y), int16_t(co), int16_t(cg), int16_t(128 | c.a >> 1)});
        const std::string deep = decoded(meshopt_stream(wide, 8, "ATTRIBUTES"), 1, 8, "COLOR");
        for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(at(deep, 2 * k + 1), at(out, k), 1);
    }
    EXPECT_EQ(decoded(meshopt_stream(std::string(4, '\0'), 4, "ATTRIBUTES"), 1, 4, "COLOR"), std::string(4, '\0'));
}

TEST(GltfMeshopt, FallbackWhereTheDataIsDamaged) {
    const TempFolder folder;
    const Grid grid(4);
    json gltf = compressed_grid(grid);
    std::string stream = meshopt_stream(pack(grid.positions), 12, "ATTRIBUTES");
    stream.resize(stream.size() / 2);
    gltf["buffers"].back() = {{"byteLength", stream.size()}, {"uri", data_uri(stream)}};
    extension(gltf, 0)["byteLength"] = stream.size();
    EXPECT_MENTIONS(error_of(folder, gltf), "damaged or cut");
    folder.write("plain.bin", pack(grid.positions));
    gltf["buffers"][0]["uri"] = "plain.bin";
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(only_primitive(scene).positions, only_primitive(load(folder, grid_file(grid))).positions);
    EXPECT_MENTIONS(all_notes(scene), "1 compressed buffer view that cannot be decoded");
    // Whoever does not need the fallback does not ask for it.
    json good = compressed_grid(grid);
    good["buffers"][0]["uri"] = "missing.bin";
    EXPECT_EQ(only_primitive(load(folder, good)).triangles.size(), 18u);
}

TEST(GltfMeshopt, FallbackThatAnUncompressedViewReads) {
    const TempFolder folder;
    const Grid grid(4);
    const Scene plain = load(folder, grid_file(grid));
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        json gltf = grid_file(grid);
        gltf["buffers"][0]["extensions"][name] = {{"fallback", true}};
        EXPECT_EQ(only_primitive(load(folder, gltf)).positions, only_primitive(plain).positions) << name;
        folder.write("plain.bin", pack(grid.positions));
        gltf["buffers"][0]["uri"] = "plain.bin";
        const Scene scene = load(folder, gltf);
        EXPECT_EQ(only_primitive(scene).positions, only_primitive(plain).positions) << name;
        EXPECT_EQ(scene.files.size(), 2u);
        gltf["buffers"][0].erase("uri");
        EXPECT_MENTIONS(error_of(folder, gltf), "buffers[0]: the buffer has no data");
    }
}

TEST(GltfMeshopt, WrongLayouts) {
    const TempFolder folder;
    const Grid grid(4);
    const json good = compressed_grid(grid);
    const auto expect_error = [&](const char* key, const json& value, const char* words) {
        json gltf = good;
        extension(gltf, 0)[key] = value;
        EXPECT_MENTIONS(error_of(folder, gltf), words);
    };
    expect_error("byteStride", 0, "multiple of 4");
    expect_error("byteStride", 10, "multiple of 4");
    expect_error("byteStride", 260, "multiple of 4");
    expect_error("mode", "TRIANGLES", "2 or 4 bytes");
    expect_error("mode", "POINTS", "must be ATTRIBUTES");
    expect_error("filter", "OCTAHEDRAL", "4 or 8");
    expect_error("filter", "QUATERNION", "byteStride of 8");
    expect_error("filter", "ROUND", "not supported");
    expect_error("count", 15, "are not the 192 bytes");
    expect_error("count", uint64_t(1) << 50, "cannot come from");
    expect_error("byteLength", 0, "empty");
    expect_error("byteLength", 100000, "outside of its buffer");
    expect_error("byteLength", 9, "damaged or cut");
    expect_error("buffer", 99, "out of range");
    json gltf = good;
    extension(gltf, 0).erase("count");
    EXPECT_MENTIONS(error_of(folder, gltf), "\"count\" is missing");
    gltf = grid_file(grid);
    compress_view(gltf, 2, pack(grid.corners), 4, "TRIANGLES");
    extension(gltf, 2)["filter"] = "EXPONENTIAL";
    EXPECT_MENTIONS(error_of(folder, gltf), "no filter");
    extension(gltf, 2)["filter"] = "NONE";
    extension(gltf, 2)["count"] = 53;
    EXPECT_MENTIONS(error_of(folder, gltf), "multiple of 3");
    extension(gltf, 2)["mode"] = "INDICES";
    EXPECT_MENTIONS(error_of(folder, gltf), "not that of mode INDICES");
}

TEST(GltfMeshopt, SampleLooksLikeItsTwin) {
    expect_like_box("BoxMeshopt.glb", PEELRAY_MODELS "/gltf");
}

}  // namespace
}  // namespace peelray::testing
