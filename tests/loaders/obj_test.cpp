// OBJ files as many programs write them.

#include "loaders/obj.h"

#include <algorithm>
#include <random>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Geometry geometry_of(const TempFolder& folder, const std::string& text) {
    return flatten(load_scene(folder.write("a.obj", text)));
}

std::vector<std::string> notes_of(const TempFolder& folder, const std::string& text) {
    return load_scene(folder.write("a.obj", text)).notes;
}

TEST(ObjText, LineEndsCommentsAndContinuations) {
    const TempFolder folder;
    const std::string same[] = {
        three_vertices + "f 1 2 3",
        "\xEF\xBB\xBF" + three_vertices + "f 1 2 3\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "# made by hand \\\n  v\t0 0 0 # first\nv 1 0 0#second\n\n\tv 0 1 0   \n f 1 2 3  # tail\n",
        "v 0 \\\n0 0\nv 1 \\\r\n0 \\\n 0\nv 0 1 0\nf 1\\\n2 \\\n3 # tail \\\n",
        "v .0 0. +0\nv 1e0 -.0 0\nv 0 1.0E+00 1e-400\nf +1 2 3\n",
        "v 0 0 0\nv 10e-1 0 0\nv 0 0.1e1 0\nfo 1 2 3\nl 1 2\np 1\n",
    };
    for (const std::string& text : same) {
        const Geometry g = geometry_of(folder, text);
        ASSERT_EQ(g.triangles.size(), 1u) << text;
        EXPECT_EQ(g.positions[g.triangles[0].x], glm::vec3(0)) << text;
        EXPECT_EQ(g.positions[g.triangles[0].y], glm::vec3(1, 0, 0)) << text;
        EXPECT_EQ(g.positions[g.triangles[0].z], glm::vec3(0, 1, 0)) << text;
    }
    EXPECT_MENTIONS(error_of(folder.write("w.obj", std::string("\xFF\xFEv\0 \0", 6))), "UTF-16");
}

TEST(ObjText, EveryKindOfCorner) {
    const TempFolder folder;
    const std::string lists = three_vertices + "v 0 0 1\nvt 0.5\nvt 0.25 0.75\nvt 0 0 0.5\nvn 0 0 1\nvn 0 1 0\n";
    const Scene scene = load_scene(folder.write(
        "a.obj",
        lists + "f 1/1/1 2/2/1 3/3/1\nf 1/ 2// 3/3/\nf 1//1 2//1 3//1\nf -4/-3/-2 -3/-2/-1 -2/-1/-2\nf 1 2 3/3\n"));
    const Geometry g = flatten(scene);
    ASSERT_EQ(g.triangles.size(), 5u);
    const auto uv = [&](int t, int k) { return g.uvs[g.triangles[size_t(t)][k]]; };
    EXPECT_EQ(uv(0, 0), glm::vec2(0.5f, 1));  // one number: v is 0, at the bottom
    EXPECT_EQ(uv(0, 1), glm::vec2(0.25f, 0.25f));
    EXPECT_EQ(uv(1, 2), glm::vec2(0, 1));
    EXPECT_EQ(uv(3, 1), uv(0, 1));
    EXPECT_EQ(g.normals[g.triangles[3].y], glm::vec3(0, 1, 0));
    EXPECT_EQ(g.normals[g.triangles[2].x], glm::vec3(0, 0, 1));
    EXPECT_NEAR(g.normals[g.triangles[1].x].z, 1, 1e-6);  // its own has none: from the triangle
    EXPECT_EQ(scene.notes.size(), 2u);                    // the third number of a vt, the vertex without a face
}

TEST(ObjText, CornersMayNameWhatComesLater) {
    const TempFolder folder;
    EXPECT_EQ(geometry_of(folder, "f 1/1/1 2/1/1 3/1/1\n" + three_vertices + "vt 0 0\nvn 0 0 1\n").triangles.size(),
              1u);
}

TEST(ObjText, PolygonsOfAnySizeGiveTheirTrianglesInPlace) {
    const TempFolder folder;
    // An arrow head, whose dent a fan from its first corner would cover, between two triangles.
    const Geometry g = geometry_of(folder,
                                   "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 9 9 9\nv 9 8 9\nv 8 9 9\n"
                                   "f 5 6 7\nf 2 3 4 1\nf 7 6 5\n");
    ASSERT_EQ(g.triangles.size(), 4u);
    EXPECT_EQ(g.positions[g.triangles[0].x], glm::vec3(9));
    EXPECT_EQ(g.positions[g.triangles[3].x], glm::vec3(8, 9, 9));
    double area = 0;
    for (size_t i = 1; i < 3; ++i) {
        const glm::uvec3 t = g.triangles[i];
        area += glm::cross(g.positions[t.y] - g.positions[t.x], g.positions[t.z] - g.positions[t.x]).z / 2;
    }
    EXPECT_NEAR(area, 4, 1e-6);
    std::string ring;
    for (int i = 0; i < 100; ++i) ring += fmt::format("v {} {} 0\n", std::cos(i * 0.0628318), std::sin(i * 0.0628318));
    ring += "f";
    for (int i = 1; i <= 100; ++i) ring += fmt::format(" {}", i);
    EXPECT_EQ(geometry_of(folder, ring + "\n").triangles.size(), 98u);
}

TEST(ObjText, ObjectsAndGroupsNameMeshes) {
    const TempFolder folder;
    std::string text;
    for (int i = 0; i < 7; ++i) text += fmt::format("v {0} 0 0\nv {0} 1 0\nv {0} 0 1\n", i);
    text +=
        "f 1 2 3\no one # the first\nf 4 5 6\ng a b\nf 7 8 9\ng a b\nf 10 11 12\ng\ng c#d\nf 13 14 15\n"
        "o one\nf 16 17 18\no \ng c#d\nf 19 20 21\n";
    const Scene scene = load_scene(folder.write("a.obj", text));
    std::vector<std::string> names;
    for (const Mesh& mesh : scene.meshes) names.push_back(mesh.name);
    EXPECT_EQ(names, (std::vector<std::string>{"defaultobject", "one", "a b", "c#d"}));
    const Geometry g = flatten(scene);
    std::vector<float> order;
    for (const glm::uvec3& t : g.triangles) order.push_back(g.positions[t.x].x);
    EXPECT_EQ(order, (std::vector<float>{0, 1, 5, 6, 2, 3, 4}));  // "one" returns; c#d is the group still
}

TEST(ObjText, ColorsOfVertices) {
    const TempFolder folder;
    const Geometry mixed = geometry_of(folder, "v 0 0 0\nv 1 0 0 0.5 0.25 1\nv 0 1 0 1 0 0 1\nf 1 2 3\n");
    ASSERT_EQ(mixed.colors.size(), 3u);
    EXPECT_EQ(mixed.colors[mixed.triangles[0].x], glm::vec4(1));
    EXPECT_EQ(mixed.colors[mixed.triangles[0].y], glm::vec4(0.5f, 0.25f, 1, 1));  // floats: linear
    EXPECT_EQ(mixed.colors[mixed.triangles[0].z], glm::vec4(1, 0, 0, 1));
    // ZBrush's: mask, red, green, blue; bytes are sRGB.
    const std::string painted = three_vertices + "f 1 2 3\n#MRGB ff800000ffFF0000\n#MRGB ff0000ff\n";
    const Geometry zbrush = geometry_of(folder, painted);
    ASSERT_EQ(zbrush.colors.size(), 3u);
    EXPECT_NEAR(zbrush.colors[zbrush.triangles[0].x].x, 0.2158605f, 1e-6);
    EXPECT_EQ(zbrush.colors[zbrush.triangles[0].z], glm::vec4(0, 0, 1, 1));
    EXPECT_TRUE(notes_of(folder, painted).empty());
    EXPECT_MENTIONS(notes_of(folder, three_vertices + "f 1 2 3\n#MRGB ff0000ff\n").at(0),
                    "1 colour (#MRGB) for 3 vertices");
    EXPECT_MENTIONS(notes_of(folder, "v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n").at(0), "colours");
}

TEST(ObjText, WhatHasNoEffectIsNoted) {
    const TempFolder folder;
    const auto first = [&](const std::string& line) {
        const std::vector<std::string> notes = notes_of(folder, three_vertices + line + "\nf 1 2 3\n");
        EXPECT_EQ(notes.size(), 1u) << line;
        return notes.empty() ? "" : notes[0];
    };
    EXPECT_MENTIONS(first("l 1 2 3"), "1 line statement dropped, in line 4");
    EXPECT_MENTIONS(first("p 1 2\np 3"), "2 point statements dropped, the first in line 4");
    EXPECT_MENTIONS(first("f 1 2"), "1 line statement dropped");
    EXPECT_MENTIONS(first("vp 0.5\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3\nend"), "5 statements of free-form curves");
    EXPECT_MENTIONS(first("lod 3"), "\"lod\"");
    EXPECT_MENTIONS(first("bevel on"), "\"bevel\"");
    EXPECT_MENTIONS(first("s 1"), "1 smoothing group ignored");
    EXPECT_MENTIONS(first("s off"), "s off");
    EXPECT_MENTIONS(first("vertices follow"), "\"vertices\"");
    EXPECT_MENTIONS(first("{a|b}{}}{ 1"), "(such as \"{a|b}{}}{\") ignored");
    EXPECT_MENTIONS(first("usemtl gone"), "\"gone\"");
    EXPECT_MENTIONS(first("vt nan 0\nf 1/1 2/1 3/1"), "finite");
    EXPECT_MENTIONS(first("v 9 9 9\nv 8 8 8"), "vertices that no polygon uses");
    EXPECT_TRUE(notes_of(folder, three_vertices + "vn 0 0 1\ns 1\nf 1//1 2//1 3//1\n").empty());
    // Homogeneous coordinates are divided, as before.
    const Geometry g = geometry_of(folder, "v 0 0 0 1\nv 2 0 0 2\nv 0 1 0 1\nf 1 2 3\n");
    EXPECT_EQ(g.positions[g.triangles[0].y], glm::vec3(1, 0, 0));
    EXPECT_MENTIONS(notes_of(folder, "v 0 0 0\nv 2 0 0 2\nv 0 1 0\nf 1 2 3\n").at(0), "weight");
}

TEST(ObjText, ErrorsNameTheLine) {
    const TempFolder folder;
    const auto error = [&](const std::string& text) { return error_of(folder.write("bad.obj", text)); };
    EXPECT_MENTIONS(error(three_vertices + "f 1 2 4\n"), "bad.obj, line 4: a corner names vertex 4, the file has 3");
    EXPECT_MENTIONS(error(three_vertices + "f 1 2 99999999999999999999\n"), "line 4");
    EXPECT_MENTIONS(error(three_vertices + "# \\\n\nf 0 1 2\n"), "line 6: a corner names vertex 0");
    EXPECT_MENTIONS(error(three_vertices + "f -1 -2 -9\n"), "line 4: a corner names vertex -9");
    EXPECT_MENTIONS(error(three_vertices + "vt 0 0\nf 1/1 2/2 3/1\n"), "line 5: a corner names texture coordinate 2");
    EXPECT_MENTIONS(error(three_vertices + "vn 0 0 1\nf 1//1 2//1 3//-2\n"), "line 5: a corner names normal -2");
    EXPECT_MENTIONS(error("v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "line 1: a vertex has three coordinates");
    EXPECT_MENTIONS(error("v 0 0 zero\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "line 1: \"zero\"");
    EXPECT_MENTIONS(error("v 0 0 0,5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "line 1: \"0,5\"");
    EXPECT_MENTIONS(error("\nv 0 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "line 2: the vertex has the weight 0");
    EXPECT_MENTIONS(error(three_vertices + "f 1 2 x\n"), "line 4: \"x\" is no corner");
    EXPECT_MENTIONS(error(three_vertices + "f 1 2 3/x\n"), "line 4: \"3/x\" is no corner");
    EXPECT_MENTIONS(error(three_vertices + "f 1 2 3//\\\n/4\n"), "line 4");
    EXPECT_MENTIONS(error(three_vertices + "f 1 2 3-4\n"), "line 4");
    EXPECT_MENTIONS(error(three_vertices + "vn 0 1\nf 1 2 3\n"), "line 4: a normal has three numbers");
    EXPECT_MENTIONS(error(three_vertices + "vt\nf 1 2 3\n"), "line 4: a texture coordinate");
    for (const char* nothing : {"nan", "inf", "-nan(ind)", "1.#QNAN", "-1.#IND00", "1e99"})
        EXPECT_MENTIONS(error("# no number\nv 0 0 0\nv 1 \\\n 0 " + std::string(nothing) + "\nv 0 1 0\nf 1 2 3\n"),
                        "line 3: the vertex is at");
    EXPECT_MENTIONS(error("v 0 0 0\np 1\n"), "none of its 2 lines");
    // Some programs write 1/1/1 whatever the file has.
    for (const char* face : {"f 1/1/1 2/2/2 3/3/3\n", "f 1//-1 2//-1 3//-1\n"})
        EXPECT_MENTIONS(notes_of(folder, three_vertices + face).at(0), "the file has none");
    EXPECT_MENTIONS(error(three_vertices + "f 1//-1 2//-1 3//-1\nvn 0 0 1\n"), "line 4: a corner counts back");
    EXPECT_EQ(geometry_of(folder, "v 3.1+e2 0 0\n" + three_vertices + "f 2 3 4\n").triangles.size(), 1u);
    EXPECT_EQ(geometry_of(folder, "v nan 0 0\n" + three_vertices + "f 2 3 4\n").triangles.size(),
              1u);  // nobody uses it
}

/// Bytes changed, numbers replaced by extremes, lines cut and doubled: an error's line or a mesh, and nothing else.
TEST(ObjText, ChangedFilesAreReadOrRefused) {
    const TempFolder folder;
    const std::string whole =
        "mtllib m.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0\nvt 0 0\nvt 1 0\n"
        "vt 1 1\nvn 0 0 1\nusemtl x\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\ng b \\\n c\nf -4//1 -3//1 -2//1\n"
        "l 1 2\n#MRGB ff000000\n";
    folder.write("m.mtl", "newmtl x\nKd 1 0 0\n");
    const char* extremes[] = {"-1", "0",  "4294967296",           "1e39", "nan", "",
                              "/",  "\\", "99999999999999999999", "-0.0", "#"};
    std::mt19937 random(7);
    size_t loaded = 0, refused = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = whole;
        for (unsigned edits = 1 + random() % 3; edits > 0; --edits) {
            const size_t at = random() % text.size(), length = random() % 12;
            if (random() % 3 == 0)
                text[at] = static_cast<char>(random());
            else if (random() % 2)
                text.replace(at, std::min(length, text.size() - at), extremes[random() % 11]);
            else
                text.insert(at, text.substr(random() % text.size(), length));
        }
        try {
            load_scene(folder.write("a.obj", text));
            ++loaded;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            ++refused;
        }
    }
    EXPECT_GT(loaded, 300u);
    EXPECT_GT(refused, 300u);
}

}  // namespace
}  // namespace peelray::testing
