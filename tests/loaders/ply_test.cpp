// PLY files as programs write them, and what is said of those that cannot be read.

#include <algorithm>
#include <bit>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

const std::string ply_xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string ply_list = "property list uchar int vertex_indices\n";
const std::string square_points = "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n";

std::string ply_ascii(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

Geometry ply_geometry(const TempFolder& folder, const std::string& text) {
    return flatten(load_scene(folder.write("a.ply", text)));
}

/// A triangle with one value per vertex beside x, y, z.
std::string triangle_with(const std::string& properties, const std::string& values) {
    return ply_ascii("element vertex 3\n" + ply_xyz + properties + "element face 1\n" + ply_list,
                     "0 0 0 " + values + "\n1 0 0 " + values + "\n0 1 0 " + values + "\n3 0 1 2\n");
}

TEST(PlyFile, StripsWithRestartsInBothByteOrders) {
    // Two strips: three triangles (their winding alternates), then one.
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0};
    const std::vector<int32_t> strip = {9, 0, 1, 2, 3, 4, -1, 5, 6, 7};
    for (const bool big : {false, true}) {
        const auto bytes = [&](auto values) {
            std::string out = pack(values);
            for (size_t i = 0; i < out.size() && big; i += 4)
                std::reverse(out.begin() + long(i), out.begin() + long(i) + 4);
            return out;
        };
        const TempFolder folder;
        const Geometry g = ply_geometry(
            folder, std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nelement vertex 8\n" +
                        ply_xyz + "end_header\n" + bytes(strip) + bytes(points));
        ASSERT_EQ(g.triangles.size(), 4u);
        EXPECT_EQ(g.upper, glm::vec3(6, 2, 0));
        for (const glm::uvec3& t : g.triangles) EXPECT_EQ(g.normals[t.x], glm::vec3(0, 0, 1));
    }
}

TEST(PlyFile, StitchesOfStripsAreNoTriangles) {
    const TempFolder folder;
    const Geometry g = ply_geometry(
        folder,
        ply_ascii("element vertex 4\n" + ply_xyz + "element tristrips 1\nproperty list uchar short vertex_index\n",
                  square_points + "8 0 1 3 3 3 1 2 2\n"));
    EXPECT_EQ(g.triangles.size(), 2u);
    EXPECT_EQ(g.zero_area, 0u);
}

TEST(PlyFile, IndicesOfEveryIntegerType) {
    const TempFolder folder;
    const std::string points = pack(unit_square);
    const auto check = [&](const std::string& type, const std::string& face) {
        SCOPED_TRACE(type);
        const Geometry g = ply_geometry(folder, "ply\nformat binary_little_endian 1.0\nelement vertex 4\n" + ply_xyz +
                                                    "element face 1\nproperty list " + type +
                                                    " vertex_indices\nend_header\n" + points + face);
        EXPECT_EQ(g.triangles.size(), 2u);
    };
    check("uchar char", pack<int8_t>({4, 0, 1, 2, 3}));
    check("char uint8", pack<uint8_t>({4, 0, 1, 2, 3}));
    check("ushort short", pack<int16_t>({4, 0, 1, 2, 3}));
    check("int16 ushort", pack<uint16_t>({4, 0, 1, 2, 3}));
    check("int uint", pack<uint32_t>({4, 0, 1, 2, 3}));
    check("uint32 int32", pack<int32_t>({4, 0, 1, 2, 3}));
    check("uint64 int64", pack<int64_t>({4, 0, 1, 2, 3}));
    check("int float", pack<int32_t>({4}) + pack<float>({0, 1, 2, 3}));
}

TEST(PlyFile, FacesBeforeVertices) {
    const TempFolder folder;
    const Geometry g =
        ply_geometry(folder, ply_ascii("element edge 1\nproperty int vertex1\nproperty int vertex2\nelement face 2\n" +
                                           ply_list + "element vertex 4\n" + ply_xyz,
                                       "0 1\n3 0 1 2\n3 0 2 3\n" + square_points));
    EXPECT_EQ(g.triangles.size(), 2u);
    EXPECT_EQ(g.lower, glm::vec3(-1, -1, 0));
}

TEST(PlyFile, ColorsByTheirManyNames) {
    const TempFolder folder;
    const auto color = [&](const std::string& properties, const std::string& values) {
        const Geometry g = ply_geometry(folder, triangle_with(properties, values));
        EXPECT_EQ(g.colors.size(), 3u) << properties;
        return g.colors.empty() ? glm::vec4(-1) : g.colors[0];
    };
    const glm::vec4 half(0.2158605f, 0, 1, 1);
    const auto near = [](const glm::vec4& a, const glm::vec4& b) { return glm::distance(a, b) < 1e-4f; };
    EXPECT_TRUE(near(color("property uchar red\nproperty uchar green\nproperty uchar blue\n", "128 0 255"), half));
    EXPECT_TRUE(near(color("property uchar r\nproperty uchar g\nproperty uchar b\nproperty uchar a\n", "128 0 255 51"),
                     glm::vec4(0.2158605f, 0, 1, 0.2f)));
    EXPECT_TRUE(near(
        color("property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n", "128 0 255"),
        half));
    EXPECT_TRUE(
        near(color("property ushort red\nproperty ushort green\nproperty ushort blue\n", "32896 0 65535"), half));
    EXPECT_TRUE(near(color("property int red\nproperty int green\nproperty int blue\n", "128 0 255"), half));
    EXPECT_TRUE(near(color("property float red\nproperty float green\nproperty float blue\n", "0.5 0 1"),
                     glm::vec4(0.5f, 0, 1, 1)));
    // A colour without blue is none.
    const Scene scene =
        load_scene(folder.write("b.ply", triangle_with("property uchar red\nproperty uchar green\n", "1 2")));
    EXPECT_TRUE(flatten(scene).colors.empty());
    EXPECT_MENTIONS(all_notes(scene), "vertex red, vertex green");
}

TEST(PlyFile, ColorsOfFaces) {
    const TempFolder folder;
    const std::string face_colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const Geometry g =
        ply_geometry(folder, ply_ascii("element vertex 4\n" + ply_xyz + "element face 2\n" + face_colors + ply_list,
                                       square_points + "255 0 0 3 0 1 2\n0 255 0 3 0 2 3\n"));
    ASSERT_EQ(g.colors.size(), 6u);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(g.colors[g.triangles[0][k]], glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(g.colors[g.triangles[1][k]], glm::vec4(0, 1, 0, 1));
    }
    // Beside colours of vertices they have no effect.
    const Scene both = load_scene(folder.write(
        "b.ply",
        ply_ascii("element vertex 3\n" + ply_xyz +
                      "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n" +
                      "element face 1\n" + face_colors + ply_list,
                  "0 0 0 0 0 255\n1 0 0 0 0 255\n0 1 0 0 0 255\n9 8 7 3 0 1 2\n")));
    EXPECT_EQ(flatten(both).colors[0], glm::vec4(0, 0, 1, 1));
    EXPECT_MENTIONS(all_notes(both), "the colours of faces have no effect");
    // MeshLab's colours of corners.
    const Geometry corners = ply_geometry(
        folder,
        ply_ascii("element vertex 4\n" + ply_xyz + "element face 2\n" + ply_list + "property list uchar float color\n",
                  square_points + "3 0 1 2 9 1 0 0 1 0 0 1 0 0\n3 0 2 3 9 0 0.5 0 0 0.5 0 0 0.5 0\n"));
    EXPECT_EQ(corners.colors[corners.triangles[1].x], glm::vec4(0, 0.5f, 0, 1));
    EXPECT_EQ(corners.positions.size(), 6u);
}

TEST(PlyFile, TextureCoordinatesOfCornersSplitVertices) {
    const TempFolder folder;
    folder.write("skin a.png", tiny_png());
    const Scene scene = load_scene(
        folder.write("a.ply", ply_ascii("comment TextureFile skin a.png\nelement vertex 4\n" + ply_xyz +
                                            "element face 2\n" + ply_list + "property list uchar float texcoord\n",
                                        square_points + "3 0 1 2 6 0 0 0.5 0 0.5 0.5\n3 0 2 3 6 0.6 0.6 1 1 0.6 1\n")));
    const Geometry g = flatten(scene);
    EXPECT_EQ(g.positions.size(), 6u);
    EXPECT_EQ(g.uvs[g.triangles[0].z], glm::vec2(0.5f, 0.5f));
    EXPECT_EQ(g.uvs[g.triangles[1].y], glm::vec2(1, 0));
    EXPECT_EQ(scene.materials.at(g.materials[0]).base_color_texture, 0);
    EXPECT_EQ(scene.textures.at(0).texels[0], 0xFF0000FFu);
    EXPECT_TRUE(scene.notes.empty());
}

TEST(PlyFile, SeveralTexturesByNumber) {
    const TempFolder folder;
    folder.write("one.png", tiny_png());
    const Scene scene = load_scene(folder.write(
        "a.ply",
        ply_ascii("comment TextureFile one.png\ncomment TextureFile gone.png\nelement vertex 4\n" + ply_xyz +
                      "element face 3\n" + ply_list + "property list uchar float texcoord\nproperty int texnumber\n",
                  square_points + "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n3 0 1 3 0 7\n")));
    const Geometry g = flatten(scene);
    EXPECT_EQ(scene.materials.at(g.materials[0]).base_color_texture, 0);
    EXPECT_EQ(scene.materials.at(g.materials[1]).name, "gone.png");
    EXPECT_EQ(scene.materials.at(g.materials[1]).base_color_texture, -1);
    EXPECT_EQ(g.materials[2], 0u);
    EXPECT_MENTIONS(all_notes(scene), "gone.png");
    EXPECT_MENTIONS(all_notes(scene), "1 face names a texture that the file does not have");
}

TEST(PlyFile, NormalsAndTextureCoordinatesOfVertices) {
    const TempFolder folder;
    for (const char* names : {"s t", "u v", "texture_u texture_v"}) {
        const std::string u(names, std::strchr(names, ' ')), v(std::strchr(names, ' ') + 1);
        const Geometry g = ply_geometry(
            folder, triangle_with("property double nx\nproperty double ny\nproperty double nz\nproperty float " + u +
                                      "\nproperty float " + v + "\n",
                                  "2 0 0 0.25 1"));
        EXPECT_EQ(g.normals[0], glm::vec3(1, 0, 0));
        EXPECT_EQ(g.uvs[0], glm::vec2(0.25f, 0));
    }
}

TEST(PlyFile, WhatHasNoEffectIsNoted) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write(
        "a.ply", ply_ascii("element camera 1\nproperty float view_px\nelement vertex 3\n" + ply_xyz +
                               "property float confidence\nproperty list uchar float weights\nelement face 1\n" +
                               ply_list + "property int flags\n",
                           "7\n0 0 0 0.5 2 1 2\n1 0 0 0.5 0\n0 1 0 0.5 1 3\n3 0 1 2 4\nand more\n")));
    EXPECT_EQ(flatten(scene).triangles.size(), 1u);
    EXPECT_MENTIONS(all_notes(scene), "element camera (1), vertex confidence, vertex weights, face flags");
    EXPECT_MENTIONS(all_notes(scene), "line 20");
}

TEST(PlyFile, LineEndsOfAllSystems) {
    const TempFolder folder;
    const std::string unix =
        ply_ascii("comment by hand\n\nelement vertex 4\n" + ply_xyz + "element face 1\n" + ply_list,
                  square_points + "4 0 1 2 3\n");
    for (const std::string end : {"\r\n", "\r"}) {
        std::string text;
        for (const char c : unix) text += c == '\n' ? end : std::string(1, c);
        EXPECT_EQ(ply_geometry(folder, text).triangles.size(), 2u);
    }
    // The first byte of a binary body after "\r\n" is a line feed.
    std::string body = pack(unit_square) + "\4" + pack<uint32_t>({0, 1, 2, 3});
    body[0] = '\n';
    std::string header;
    for (const char c : "ply\nformat binary_little_endian 1.0\nelement vertex 4\n" + ply_xyz +
                            "element face 1\nproperty list uchar uint vertex_indices\nend_header\n")
        header += c == '\n' ? "\r\n" : std::string(1, c);
    const Geometry g = ply_geometry(folder, header + body);
    EXPECT_EQ(g.triangles.size(), 2u);
    EXPECT_EQ(std::bit_cast<uint32_t>(g.positions[0].x), 10u);
}

TEST(PlyFile, PointsAreRefusedByWhatTheyAre) {
    const TempFolder folder;
    EXPECT_MENTIONS(error_of(folder.write("cloud.ply", ply_ascii("element vertex 4\n" + ply_xyz, square_points))),
                    "point cloud of 4 points");
    EXPECT_MENTIONS(
        error_of(folder.write(
            "none.ply", ply_ascii("element vertex 4\n" + ply_xyz + "element face 0\n" + ply_list, square_points))),
        "point cloud of 4 points");
    EXPECT_MENTIONS(error_of(folder.write("splat.ply", ply_ascii("element vertex 1\n" + ply_xyz +
                                                                     "property float f_dc_0\nproperty float opacity\n",
                                                                 "0 0 0 1 1\n"))),
                    "Gaussian splat");
}

TEST(PlyFile, BadHeaders) {
    const TempFolder folder;
    const std::string body(200, '0');
    const auto error = [&](const std::string& text) { return error_of(folder.write("bad.ply", text)); };
    EXPECT_MENTIONS(
        error(
            ply_ascii("element vertex 3\n" + ply_xyz + "element face 1\nproperty list float int vertex_indices\n", "")),
        "line 8: a list");
    EXPECT_MENTIONS(error(ply_ascii("element vertex -3\n" + ply_xyz, "")), "line 3: the PLY header gives no count");
    EXPECT_MENTIONS(error(ply_ascii("propertee float x\n", "")), "line 3");
    EXPECT_MENTIONS(
        error(ply_ascii("element vertex 3\n" + ply_xyz + "element vertex 3\n" + ply_xyz + "element face 1\n" + ply_list,
                        body)),
        "two elements");
    EXPECT_MENTIONS(error(ply_ascii("element vertex 3\n" + ply_xyz + "element face 1\nproperty int a\n", body)),
                    "no list vertex_indices");
    EXPECT_MENTIONS(error("ply\nformat ascii2 1.0\nend_header\n"), "ascii2");
    EXPECT_MENTIONS(error("ply\nend_header\n"), "no format");
    EXPECT_MENTIONS(error("plywood\n"), "not a PLY file");
}

TEST(PlyFile, BadBodiesNameThePlace) {
    const TempFolder folder;
    const auto error = [&](const std::string& body) {
        return error_of(
            folder.write("bad.ply", ply_ascii("element vertex 3\n" + ply_xyz + "element face 2\n" + ply_list, body)));
    };
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_MENTIONS(error("0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"), "line 11: \"x\" in vertex 1 of 3 is no number");
    EXPECT_MENTIONS(error(points + "3 0 1 2\n3 0 1 5\n"), "line 14: face 1 of 2 has index 5, the file has 3 vertices");
    EXPECT_MENTIONS(error(points + "3 0 1 1.5\n3 0 1 2\n"), "\"1.5\" in face 0 of 2 is no whole number");
    EXPECT_MENTIONS(error(points + "3 0 1 2\n"), "the file ends in face 1 of 2");
    EXPECT_MENTIONS(error(points + "-1 0 1 2\n3 0 1 2\n"), "claims a list of -1 values");
    EXPECT_MENTIONS(error("0 0 0\n1e99 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"), "vertex 1 is at (inf, 0, 0)");
    EXPECT_MENTIONS(error_of(folder.write("many.ply", ply_ascii("element vertex 3\n" + ply_xyz +
                                                                    "element face 900000000000000\n" + ply_list,
                                                                points))),
                    "claims 900000000000000 elements \"face\"");
}

}  // namespace
}  // namespace peelray::testing
