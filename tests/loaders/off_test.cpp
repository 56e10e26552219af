// OFF files as programs write them, and what is said of those that cannot be read.

#include <algorithm>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

const std::string off_points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

Geometry off_geometry(const TempFolder& folder, const std::string& text) {
    return flatten(load_scene(folder.write("a.off", text)));
}

std::string off_notes(const TempFolder& folder, const std::string& text) {
    return all_notes(load_scene(folder.write("a.off", text)));
}

TEST(OffFile, CountsAndCommentsAnywhere) {
    const TempFolder folder;
    for (const std::string head :
         {"OFF4 2 0\n", "OFF 4 2 0\n", "OFF\n4 2 0\n", "# made by hand\nOFF # the keyword\n\n4 # vertices\n2 0\n",
          "4 2 0\n", "OFF\n4 2\n", "OFF\r\n4 2 0\r\n"}) {
        EXPECT_EQ(off_geometry(folder, head + off_points + "3 0 1 2\n3 1 3 2\n").triangles.size(), 2u) << head;
    }
    EXPECT_EQ(
        off_geometry(folder, "OFF\n4 2 0\n0 0 0 1 0 0\n# between\n0 1 0#behind\n1 1 0\n3 0 1 2 # red\n\n3\n1 3\n2\n")
            .triangles.size(),
        2u);
}

TEST(OffFile, Variants) {
    const TempFolder folder;
    const Geometry all =
        off_geometry(folder,
                     "STCNOFF\n3 1 0\n0 0 0 0 0 2 255 0 0 255 0.25 0\n1 0 0 0 0 2 255 0 0 255 1 0\n0 1 0 "
                     "0 0 2 255 0 0 255 0 1\n3 0 1 2\n");
    ASSERT_EQ(all.colors.size(), 3u);
    EXPECT_EQ(all.colors[0], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(all.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(all.uvs[0], glm::vec2(0.25f, 1));
    const Geometry given = off_geometry(folder, "NOFF\n3 1 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n");
    EXPECT_EQ(given.normals[0], glm::vec3(1, 0, 0));
    const Geometry homogeneous = off_geometry(folder, "4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 4 0 4\n3 0 1 2\n");
    EXPECT_EQ(homogeneous.upper, glm::vec3(1, 1, 0));
    EXPECT_EQ(off_geometry(folder, "nOFF\n3\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").triangles.size(), 1u);
    EXPECT_MENTIONS(error_of(folder.write("n.off", "nOFF 5\n3 1 0\n0 0 0 0 0\n")), "5 dimensions");
    EXPECT_MENTIONS(error_of(folder.write("w.off", "4OFF\n3 1 0\n0 0 0 1\n2 0 0 0\n0 4 0 4\n3 0 1 2\n")), "finite");
    const Geometry no_alpha =
        off_geometry(folder, "COFF\n3 1 0\n0 0 0 0 255 0\n1 0 0 0 255 0\n0 1 0 0 255 0\n3 0 1 2\n");
    EXPECT_EQ(no_alpha.colors[2], glm::vec4(0, 1, 0, 1));
}

TEST(OffFile, ColorsOfFaces) {
    const TempFolder folder;
    const Geometry g = off_geometry(
        folder, "OFF\n4 6 0\n" + off_points +
                    "3 0 1 2\n3 0 1 2 255 0 128\n3 0 1 2 0.5 0.25 1.0\n3 0 1 2 7\n4 0 1 3 2 0 255 0 255\n3 0 1 2 50\n");
    const auto color = [&](size_t triangle) { return g.colors[g.triangles[triangle].x]; };
    EXPECT_EQ(color(0), glm::vec4(0.666f, 0.666f, 0.666f, 1));  // others have one
    EXPECT_NEAR(color(1).z, 0.21586, 1e-4);
    EXPECT_EQ(color(1).x, 1);
    EXPECT_EQ(color(2), glm::vec4(0.5f, 0.25f, 1, 1));
    EXPECT_NEAR(color(3).x, 0.0331, 1e-4);  // 51, 51, 204
    EXPECT_NEAR(color(3).z, 0.6038, 1e-4);
    EXPECT_EQ(color(5), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(color(6).x, color(6).y);  // 191, 191, 191: the colour map repeats itself
    EXPECT_MENTIONS(off_notes(folder, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 900\n"), "1 colour grey");
    EXPECT_MENTIONS(off_notes(folder, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 9\n"),
                    "1 colour ignored, which does not");
    // Whole numbers that are all 0 or 1 are no parts of 255.
    EXPECT_EQ(off_geometry(folder, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 0 0\n").colors[0],
              glm::vec4(1, 0, 0, 1));
    EXPECT_MENTIONS(off_notes(folder, "COFF\n3 1 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2 255 0 0\n"),
                    "the colours of faces have no effect");
}

std::string big_endian(const std::string& little) {
    std::string out = little;
    for (size_t i = 0; i < out.size(); i += 4) std::reverse(out.begin() + long(i), out.begin() + long(i) + 4);
    return out;
}

TEST(OffFile, Binary) {
    const TempFolder folder;
    const std::string body = big_endian(pack<int32_t>({4, 2, 0}) + pack(unit_square) +
                                        pack<int32_t>({4, 0, 1, 2, 3, 0, 3, 0, 1, 2, 3}) + pack<float>({0, 0.5f, 1}));
    const Geometry g = off_geometry(folder, "OFF BINARY\n" + body);
    ASSERT_EQ(g.triangles.size(), 3u);
    EXPECT_EQ(g.colors[g.triangles[2].x], glm::vec4(0, 0.5f, 1, 1));
    const Geometry colors = off_geometry(
        folder, "COFF BINARY\n" + big_endian(pack<int32_t>({3, 1, 0}) + pack<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1,
                                                                                     0, 0, 1, 0, 1, 0, 1, 0, 0, 1}) +
                                             pack<int32_t>({3, 0, 1, 2, 1, 6})));
    EXPECT_EQ(colors.colors[colors.triangles[0].x], glm::vec4(1, 0, 0, 1));
    for (size_t size = 0; size < body.size(); ++size)
        error_of(folder.write("cut.off", "OFF BINARY\n" + body.substr(0, size)));
}

TEST(OffFile, BadFilesNameThePlace) {
    const TempFolder folder;
    const auto error = [&](const std::string& text) { return error_of(folder.write("bad.off", text)); };
    EXPECT_MENTIONS(error("OFF\n4 1 0\n" + off_points + "3 0 1 9\n"), "line 7: face 0 of 1 has index \"9\"");
    EXPECT_MENTIONS(error("OFF\n4 1 0\n0 0 zero\n" + off_points + "3 0 1 2\n"), "line 3: \"zero\" in vertex 0 of 4");
    EXPECT_MENTIONS(error("OFF\n4 1 0\n" + off_points + "-3 0 1 2\n"), "claims -3 corners");
    EXPECT_MENTIONS(error("OFF\n4 1 0\n" + off_points + "3 0 1 2 red\n"), "line 7: \"red\"");
    EXPECT_MENTIONS(error("OFF\n4 2 0\n" + off_points + "3 0 1 2\n"), "ends in face 1 of 2");
    EXPECT_MENTIONS(error("OFF\n4 0 0\n" + off_points), "point cloud of 4 points");
    EXPECT_MENTIONS(error("OFFICE\n"), "bad.off");
    EXPECT_MENTIONS(error("OFF\nfour 1 0\n"), "numbers of vertices");
}

}  // namespace
}  // namespace peelray::testing
