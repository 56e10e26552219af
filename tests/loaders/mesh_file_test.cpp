// OBJ with MTL, PLY, STL and OFF.

#include <algorithm>
#include <cmath>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(Obj, FileOrderAcrossGroupsAndMaterials) {
    const TempFolder folder;
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    std::string text = "mtllib m.mtl\n";
    for (int i = 0; i < 8; ++i)
        text += "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + " 1 0\nv " + std::to_string(i) + " 0 1\n";
    // Materials alternate, a quad stands between triangles, and a second object follows.
    text +=
        "o one\nusemtl red\nf 1 2 3\nusemtl blue\nf 4 5 6\nusemtl red\nf 7 8 9\nf 10 11 12 1\no two\nusemtl blue\nf 13 "
        "14 15\nusemtl red\nf 16 17 18\n";
    const Scene scene = load_scene(folder.write("a.obj", text));
    const Geometry g = flatten(scene);
    ASSERT_EQ(g.triangles.size(), 7u);
    const float expected[] = {0, 1, 2, 3, 3, 4, 5};
    const char* materials[] = {"red", "blue", "red", "red", "red", "blue", "red"};
    for (size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(g.positions[g.triangles[i].x].x, expected[i]) << i;
        EXPECT_EQ(scene.materials[g.materials[i]].name, materials[i]) << i;
    }
}

TEST(Obj, ManyTrianglesKeepTheirOrder) {
    const TempFolder folder;
    std::string text;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
        const std::string x = std::to_string(i * 7919 % n);
        text += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\nf -3 -2 -1\n";
    }
    const Geometry g = flatten(load_scene(folder.write("a.obj", text)));
    ASSERT_EQ(g.triangles.size(), size_t(n));
    for (int i = 0; i < n; ++i) ASSERT_EQ(g.positions[g.triangles[static_cast<size_t>(i)].x].x, float(i * 7919 % n));
}

TEST(Obj, Materials) {
    const TempFolder folder;
    folder.write("my texture.png", tiny_png());
    folder.write("m.mtl",
                 "newmtl plain\nKd 0.1 0.2 0.3\nKs 0 0 0\nKe 1 2 3\nmap_Kd my texture.png\n"
                 "newmtl glossy\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 100\n"
                 "newmtl mirror\nKd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n"
                 "newmtl glass\nKd 0 0 0\nTf 0.5 0.75 1\nNi 1.33\nillum 7\n"
                 "newmtl sheet\nKd 1 1 1\nd 0.25\n"
                 "newmtl pbr\nKd 1 1 1\nPm 0.5\nPr 0.25\n");
    std::string text = "mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 0 1\n" + three;
    for (const char* name : {"plain", "glossy", "mirror", "glass", "sheet", "pbr"})
        text += std::string("usemtl ") + name + "\nf 1/1 2/2 3/3\n";
    const Scene scene = load_scene(folder.write("a.obj", text));
    const auto material = [&](const std::string& name) {
        const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                        [&](const Material& m) { return m.name == name; });
        EXPECT_NE(found, scene.materials.end()) << name;
        return found == scene.materials.end() ? Material{} : *found;
    };
    const Material plain = material("plain");
    EXPECT_EQ(plain.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(plain.emissive, glm::vec3(1, 2, 3));
    EXPECT_EQ(plain.roughness, 1);
    EXPECT_EQ(plain.metallic, 0);
    ASSERT_EQ(plain.base_color_texture, 0);
    EXPECT_EQ(scene.textures[0].texels[0], 0xFF0000FFu);
    EXPECT_NEAR(material("glossy").roughness, std::pow(2.0 / 102, 0.25), 1e-5);
    EXPECT_EQ(material("mirror").metallic, 1);
    EXPECT_EQ(material("mirror").roughness, 0);
    EXPECT_EQ(material("mirror").base_color, glm::vec3(0.9f, 0.8f, 0.7f));
    const Material glass = material("glass");
    EXPECT_EQ(glass.transmission, 1);
    EXPECT_FLOAT_EQ(glass.ior, 1.33f);
    EXPECT_GT(glass.thickness, 0);
    EXPECT_EQ(glass.base_color, glm::vec3(0.5f, 0.75f, 1));
    EXPECT_TRUE(material("sheet").blended);
    EXPECT_EQ(material("sheet").alpha, 0.25f);
    EXPECT_FLOAT_EQ(material("pbr").metallic, 0.5f);
    EXPECT_FLOAT_EQ(material("pbr").roughness, 0.25f);
    const Primitive& first = scene.meshes[0].primitives[0];
    EXPECT_EQ(first.uvs.at(first.triangles[0].x), glm::vec2(0, 1));  // v from the top
}

TEST(Obj, MissingLibraryIsANote) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write("a.obj", "mtllib gone.mtl\n" + three + "usemtl x\nf 1 2 3\n"));
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_MENTIONS(scene.notes[0], "gone.mtl");
    const Scene no_texture = load_scene((folder.write("m.mtl", "newmtl x\nmap_Kd gone.png\n"),
                                         folder.write("b.obj", "mtllib m.mtl\n" + three + "usemtl x\nf 1 2 3\n")));
    ASSERT_EQ(no_texture.notes.size(), 1u);
    EXPECT_MENTIONS(no_texture.notes[0], "gone.png");
}

TEST(Obj, NormalsAreSmoothOnCurvesAndHardOnBoxes) {
    const TempFolder folder;
    const Geometry box =
        flatten(load_scene(folder.write("box.obj",
                                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")));
    EXPECT_EQ(box.triangles.size(), 12u);
    EXPECT_EQ(box.positions.size(), 24u);
    for (const glm::vec3& n : box.normals)
        EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-6);
    // A roof of 40° is a curve.
    const Geometry roof =
        flatten(load_scene(folder.write("roof.obj", "v 0 0 0\nv 0 0 1\nv 1 0.36 0\nv -1 0.36 0\nf 1 2 3\nf 2 1 4\n")));
    EXPECT_EQ(roof.positions.size(), 4u);
    const Geometry own = flatten(load_scene(folder.write("own.obj", three + "vn 0 0 2\nvn 0 0 0\nf 1//1 2//1 3//2\n")));
    for (const glm::vec3& n : own.normals) EXPECT_NEAR(n.z, 1, 1e-6);
}

TEST(Obj, VertexColors) {
    const TempFolder folder;
    const Geometry g =
        flatten(load_scene(folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n")));
    ASSERT_EQ(g.colors.size(), 3u);
    EXPECT_EQ(g.colors[g.triangles[0].y], glm::vec4(0, 1, 0, 1));
}

TEST(Obj, Bad) {
    const TempFolder folder;
    EXPECT_MENTIONS(error_of((folder.path() / "none.obj").string()), "no such file");
    EXPECT_MENTIONS(error_of(folder.write("empty.obj", "")), "empty");
    error_of(folder.write("text.obj", "Dear reader, this is a letter and no mesh at all.\nYours\n"));
    error_of(folder.write("points.obj", three + "p 1 2 3\n"));
    EXPECT_MENTIONS(error_of(folder.write("range.obj", three + "f 1 2 4\n")), "range.obj");
    EXPECT_MENTIONS(error_of(folder.write("zero.obj", three + "f 0 1 2\n")), "zero.obj");
    EXPECT_MENTIONS(error_of(folder.write("negative.obj", three + "f -1 -2 -9\n")), "negative.obj");
    EXPECT_MENTIONS(error_of(folder.write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), "finite");
    EXPECT_MENTIONS(error_of(folder.write("inf.obj", "v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n")), "finite");
}

TEST(Obj, CoincidentVerticesTakeLinearTime) {
    const TempFolder folder;
    std::string text = "v 0 0 0\n";
    for (int i = 0; i < 100000; ++i)
        text += "v " + std::to_string(std::cos(i * 1e-4)) + " " + std::to_string(std::sin(i * 1e-4)) + " 0\n";
    for (int i = 2; i < 100000; ++i) text += "f 1 " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
    EXPECT_EQ(flatten(load_scene(folder.write("fan.obj", text))).triangles.size(), 99998u);
}

const std::string ply_head =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";

TEST(Ply, AsciiBinaryAndColors) {
    const TempFolder folder;
    const Geometry ascii = flatten(
        load_scene(folder.write("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                                "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 "
                                "0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n")));
    ASSERT_EQ(ascii.triangles.size(), 1u);
    EXPECT_EQ(ascii.colors.at(ascii.triangles[0].y), glm::vec4(0, 1, 0, 1));
    const std::string head =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar uint vertex_indices\nend_header\n";
    const std::string body = pack(unit_square) + "\3" + pack<uint32_t>({0, 1, 2}) + "\3" + pack<uint32_t>({0, 2, 3});
    EXPECT_EQ(flatten(load_scene(folder.write("b.ply", head + body))).triangles.size(), 2u);
    // The first byte of the body is a line feed: 10 + 2^-20 or so.
    std::string feed = body;
    feed[0] = '\n';
    EXPECT_EQ(flatten(load_scene(folder.write("c.ply", head + feed))).positions.size(), 4u);
    for (size_t cut = 1; cut < body.size(); ++cut)
        error_of(folder.write("cut.ply", (head + body).substr(0, head.size() + body.size() - cut)));
    for (size_t size = 1; size < head.size(); size += 5) error_of(folder.write("cut.ply", head.substr(0, size)));
}

TEST(Ply, Bad) {
    const TempFolder folder;
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n",
                      vertices = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_MENTIONS(error_of(folder.write("empty.ply", "")), "empty");
    EXPECT_MENTIONS(error_of(folder.write("text.ply", "this is no mesh")), "not a PLY file");
    EXPECT_MENTIONS(error_of(folder.write("range.ply", ply_head + faces + vertices + "3 0 1 3\n")),
                    "index 3, the file has 3 vertices");
    EXPECT_MENTIONS(error_of(folder.write("negative.ply", ply_head + faces + vertices + "3 0 1 -1\n")), "index -1");
    EXPECT_MENTIONS(error_of(folder.write("list.ply", ply_head + faces + vertices + "4000000000 0 1 2\n")),
                    "list of 4000000000");
    EXPECT_MENTIONS(error_of(folder.write("nan.ply", ply_head + faces + "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), "finite");
    EXPECT_MENTIONS(
        error_of(folder.write("many.ply",
                              "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n")),
        "4000000000 elements");
    EXPECT_MENTIONS(
        error_of(folder.write("type.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nend_header\n0\n")),
        "quad");
    error_of(folder.write("cloud.ply", ply_head + "end_header\n" + vertices));
}

TEST(Stl, AsciiAndBinary) {
    const TempFolder folder;
    const std::string facet =
        "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const Geometry ascii = flatten(load_scene(folder.write("a.stl", "solid a\n" + facet + "endsolid a\n")));
    ASSERT_EQ(ascii.triangles.size(), 1u);
    EXPECT_NEAR(ascii.normals[0].z, 1, 1e-6);  // the file's own normal is nonsense
    const std::string one = pack<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string(2, '\0');
    const std::string two = pack<float>({0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + std::string(2, '\0');
    const std::string whole = std::string(80, ' ') + pack<uint32_t>({2}) + one + two;
    const Geometry binary = flatten(load_scene(folder.write("b.stl", whole)));
    ASSERT_EQ(binary.triangles.size(), 2u);
    EXPECT_EQ(binary.positions.size(), 4u);  // joined
    EXPECT_EQ(binary.positions[binary.triangles[1].x], glm::vec3(1, 0, 0));
    EXPECT_MENTIONS(error_of(folder.write("cut.stl", whole.substr(0, whole.size() - 10))), "cut.stl");
    EXPECT_MENTIONS(error_of(folder.write("empty.stl", "")), "empty");
    error_of(folder.write("text.stl", "not a mesh"));
    error_of(folder.write("huge.stl", std::string(80, ' ') + pack<uint32_t>({0xFFFFFFFFu}) + one));
}

TEST(Off, GoodAndBad) {
    const TempFolder folder;
    const std::string good = "OFF\n# a square\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    EXPECT_EQ(flatten(load_scene(folder.write("a.off", good))).triangles.size(), 2u);
    EXPECT_EQ(flatten(load_scene(folder.write("b.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 0.5 0.5\n")))
                  .triangles.size(),
              1u);
    EXPECT_MENTIONS(error_of(folder.write("empty.off", "")), "empty");
    EXPECT_MENTIONS(error_of(folder.write("text.off", "no mesh\n")), "not an OFF file");
    EXPECT_MENTIONS(error_of(folder.write("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")), "index \"3\"");
    EXPECT_MENTIONS(error_of(folder.write("negative.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n")),
                    "index \"-2\"");
    EXPECT_MENTIONS(error_of(folder.write("many.off", "OFF\n4000000000 1 0\n0 0 0\n")), "claims 4000000000 vertices");
    EXPECT_MENTIONS(error_of(folder.write("nan.off", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), "nan.off");
    for (size_t size = 4; size + 2 < good.size(); size += 3) error_of(folder.write("cut.off", good.substr(0, size)));
}

}  // namespace
}  // namespace peelray::testing
