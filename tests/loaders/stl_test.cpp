// STL files as programs write them, and what is said of those that cannot be read.

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

/// One facet of a binary file, at a height.
std::string facet_at(float z, uint16_t attribute = 0) {
    return pack<float>({0, 0, 1, 0, 0, z, 1, 0, z, 0, 1, z}) + pack<uint16_t>({attribute});
}

std::string binary_stl(std::string header, const std::string& facets, uint32_t count) {
    header.resize(80, ' ');
    return header + pack<uint32_t>({count}) + facets;
}

TEST(StlFile, KeywordsInAnyCaseAndLayout) {
    const TempFolder folder;
    for (const char* text : {"SOLID CATIA\r\nFACET NORMAL 0 0 0\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 0 1 "
                             "0\r\nVERTEX 1 0 0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID "
                             "CATIA\r\n",
                             "\n\t solid\n  Facet Normal nan -nan(ind) 1.#QNAN\n outer loop vertex 0 0 0 vertex +1e0 "
                             ".0 0. vertex 0 1 0 endloop endfacet endsolid",
                             "solid a part of two\nfacet normal 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 "
                             "1 0\nend loop\nend facet\nend solid\n",
                             "solid x facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                             "0\nendloop\nendfacet\nendsolid\n",
                             "\xEF\xBB\xBFsolid\rfacet\router loop\rvertex 0 0 0\rvertex 1 0 0\rvertex 0 1 "
                             "0\rendloop\rendfacet\rendsolid\r"}) {
        const Geometry g = flatten(load_scene(folder.write("a.stl", text)));
        ASSERT_EQ(g.triangles.size(), 1u) << text;
        EXPECT_EQ(g.upper, glm::vec3(1, 1, 0));
    }
}

TEST(StlFile, SolidsAreObjects) {
    const TempFolder folder;
    const std::string body =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const Scene scene = load_scene(
        folder.write("a.stl", "solid left half\n" + body + body + "endsolid left half\nsolid\n" + body + "endsolid\n"));
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].name, "left half");
    EXPECT_EQ(scene.meshes[0].primitives[0].triangles.size(), 2u);
    EXPECT_TRUE(scene.notes.empty());
    const Scene open = load_scene(folder.write("b.stl", "solid a\n" + body));
    EXPECT_MENTIONS(all_notes(open), "without \"endsolid\"");
    // Some write polygons.
    const Scene square =
        load_scene(folder.write("c.stl", "solid a\n" + body +
                                             "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 "
                                             "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"));
    EXPECT_EQ(flatten(square).triangles.size(), 3u);
}

TEST(StlFile, BinaryThatBeginsWithSolid) {
    const TempFolder folder;
    EXPECT_EQ(flatten(load_scene(
                          folder.write("a.stl", binary_stl("solid exported by someone", facet_at(0) + facet_at(1), 2))))
                  .triangles.size(),
              2u);
    EXPECT_MENTIONS(error_of(folder.write("b.stl", binary_stl("solid", facet_at(0) + facet_at(1), 3))),
                    "claims 3 facets, holds 2");
}

TEST(StlFile, WrongCounts) {
    const TempFolder folder;
    EXPECT_MENTIONS(error_of(folder.write("a.stl", binary_stl("x", facet_at(0) + facet_at(1), 0))),
                    "claims 0 facets and holds bytes for 2");
    EXPECT_MENTIONS(error_of(folder.write("b.stl", binary_stl("x", facet_at(0), 4000000000u))),
                    "claims 4000000000 facets, holds 1");
    const Scene more = load_scene(folder.write("c.stl", binary_stl("x", facet_at(0) + "tail", 1)));
    EXPECT_EQ(flatten(more).triangles.size(), 1u);
    EXPECT_MENTIONS(all_notes(more), "4 bytes after the last of 1 facet");
}

glm::vec4 facet_color(const Geometry& g, const Scene& scene, size_t triangle) {
    const glm::vec4 base(scene.materials[g.materials[triangle]].base_color, 1);
    return g.colors.empty() ? base : base * g.colors[g.triangles[triangle].x];
}

TEST(StlFile, ColorsOfMagics) {
    const TempFolder folder;
    const std::string orange = std::string("COLOR=\xFF\x80\x00\xFF", 10);
    // Bit 15 = 0: the facet's own, red lowest.
    const Scene own = load_scene(folder.write(
        "a.stl", binary_stl(orange + ",MATERIAL=",
                            facet_at(0, 31) + facet_at(1, 31 << 5) + facet_at(2, 31 << 10) + facet_at(3, 0x8000), 4)));
    const Geometry g = flatten(own);
    EXPECT_EQ(facet_color(g, own, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(facet_color(g, own, 1), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(facet_color(g, own, 2), glm::vec4(0, 0, 1, 1));
    EXPECT_NEAR(facet_color(g, own, 3).y, 0.21586, 1e-4);
    // A header alone colours the whole part.
    const Scene part = load_scene(folder.write("b.stl", binary_stl(orange, facet_at(0) + facet_at(1), 2)));
    EXPECT_NEAR(facet_color(flatten(part), part, 1).y, 0.21586, 1e-4);
    EXPECT_EQ(facet_color(flatten(part), part, 1).x, 1);
    // A material goes before the colour.
    const Scene material = load_scene(folder.write(
        "c.stl", binary_stl(orange + std::string(",MATERIAL=\x00\x00\xFF\xFF\x01\x02\x03\xFF\x01\x02\x03\xFF", 22),
                            facet_at(0, 0x8000), 1)));
    EXPECT_EQ(facet_color(flatten(material), material, 0), glm::vec4(0, 0, 1, 1));
    EXPECT_MENTIONS(all_notes(material), "specular");
}

TEST(StlFile, ColorsOfVisCam) {
    const TempFolder folder;
    // Bit 15 = 1: the facet's own, blue lowest.
    const Scene scene = load_scene(folder.write(
        "a.stl", binary_stl("x", facet_at(0, 0x8000 | 31 << 10) + facet_at(1, 0x8000 | 31) + facet_at(2, 7), 3)));
    const Geometry g = flatten(scene);
    EXPECT_EQ(facet_color(g, scene, 0), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(facet_color(g, scene, 1), glm::vec4(0, 0, 1, 1));
    EXPECT_EQ(facet_color(g, scene, 2), glm::vec4(1));
    EXPECT_MENTIONS(all_notes(scene), "1 facet has attributes that are no colours");
}

TEST(StlFile, Bad) {
    const TempFolder folder;
    const auto error = [&](const std::string& text) { return error_of(folder.write("bad.stl", text)); };
    EXPECT_MENTIONS(
        error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n"),
        "line 7: the facet has 2 vertices");
    EXPECT_MENTIONS(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 zero 0\n"),
                    "line 5: \"zero\"");
    EXPECT_MENTIONS(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1"),
                    "ends in a facet");
    EXPECT_MENTIONS(error("solid a\nface normal 0 0 1\n"), "line 2: \"face\"");
    EXPECT_MENTIONS(error("solid a\nendsolid a\n"), "no facets");
    EXPECT_MENTIONS(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex inf 0 0\nvertex 0 1 "
                          "0\nendloop\nendfacet\nendsolid\n"),
                    "finite");
    EXPECT_MENTIONS(error("not a mesh"), "no STL file");
}

}  // namespace
}  // namespace peelray::testing
