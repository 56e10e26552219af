// Material libraries of OBJ files.

#include "loaders/mtl.h"

#include <algorithm>
#include <cmath>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

const std::string square_with_uvs =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";

/// A square with the material "m" of a library.
Scene load_with(const TempFolder& folder, const std::string& library, const std::string& uses = "mtllib m.mtl\n") {
    folder.write("m.mtl", library);
    return load_scene(folder.write("a.obj", uses + square_with_uvs));
}

Material material_of(const Scene& scene) {
    return scene.materials.at(scene.meshes.at(0).primitives.at(0).material);
}

/// The square's texture coordinates, lower left and upper right, counted from the top.
std::pair<glm::vec2, glm::vec2> corners_of(const Scene& scene) {
    const Primitive& p = scene.meshes[0].primitives[0];
    const MaterialTexture& use = scene.materials.at(p.material).base_color_texture;
    return {use.place(p.uvs.at(p.triangles[0].x)), use.place(p.uvs.at(p.triangles[0].z))};
}

void expect_color(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
}

TEST(Mtl, CommentsBlanksAndShortColours) {
    const TempFolder folder;
    const Scene scene =
        load_with(folder,
                  "# library\r\n  newmtl m # mine\r\n\tKd 0.25 # grey\r\n Ks .5 1. +1 #shiny\r\nNs 1e2 # so\r\n"
                  "illum 2#usual\r\n");
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_EQ(material_of(scene).name, "m");
    EXPECT_EQ(material_of(scene).base_color, glm::vec3(0.25f));
    EXPECT_NEAR(material_of(scene).roughness, std::pow(2.0 / 102, 0.25), 1e-5);
    // A '#' may be part of a name.
    folder.write("m.mtl", "newmtl Material #25\nKd 1 0 0\nnewmtl Material #26\nKd 0 1 0\n");
    const Scene names = load_scene(
        folder.write("b.obj", "mtllib m.mtl # here\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Material #26\nf 1 2 3\n"));
    EXPECT_EQ(material_of(names).base_color, glm::vec3(0, 1, 0));
    EXPECT_TRUE(names.notes.empty());
}

TEST(Mtl, SeveralLibrariesAndNamesWithBlanks) {
    const TempFolder folder;
    folder.write("my first.mtl", "newmtl other\nKd 1 0 0\n");
    folder.write("second.mtl", "newmtl m\nKd 0 1 0\n");
    folder.write("third.mtl", "newmtl m\nKd 0 0 1\n");
    for (const char* uses :
         {"mtllib my first.mtl second.mtl\n", "mtllib second.mtl my first.mtl\n",
          "mtllib \"my first.mtl\" \"second.mtl\"\n", "mtllib my first.mtl\nmtllib .\\Second.MTL\n",
          "mtllib C:\\work\\second.mtl\n", "mtllib D:\\my work\\second.mtl\n",
          "mtllib C:\\work\\second.mtl C:\\work\\my first.mtl\n", "mtllib second.mtl # and nothing else\n"}) {
        const Scene scene = load_scene(folder.write("a.obj", uses + square_with_uvs));
        EXPECT_EQ(material_of(scene).base_color, glm::vec3(0, 1, 0)) << uses;
        EXPECT_TRUE(scene.notes.empty()) << uses << scene.notes[0];
    }
    // The first of two with one name counts, and that is said.
    const Scene twice = load_scene(folder.write("a.obj", "mtllib second.mtl third.mtl\n" + square_with_uvs));
    EXPECT_EQ(material_of(twice).base_color, glm::vec3(0, 1, 0));
    ASSERT_EQ(twice.notes.size(), 1u);
    EXPECT_MENTIONS(twice.notes[0], "the first counts");
    const Scene gone = load_scene(folder.write("a.obj", "mtllib no such.mtl second.mtl\n" + square_with_uvs));
    EXPECT_EQ(material_of(gone).base_color, glm::vec3(0, 1, 0));
    ASSERT_EQ(gone.notes.size(), 1u);
    EXPECT_MENTIONS(gone.notes[0], "\"no such.mtl\" is missing");
}

TEST(Mtl, DissolveMixesTheSurfaceWithWhatIsBehind) {
    const TempFolder folder;
    const auto load = [&](const std::string& lines) { return load_with(folder, "newmtl m\nKd 1 0 0\n" + lines); };
    for (const char* opaque : {"d 1\n", "Tr 0\n", "d 1.0\nTr 1.0\nillum 2\n", ""})
        EXPECT_EQ(material_of(load(opaque)).transmission, 0) << opaque;
    for (const char* most : {"d 0.9\n", "Tr 0.1\n", "d -halo 0.9\n", "d .9\nTf 1 1 1\n"}) {
        const Material m = material_of(load(most));
        EXPECT_TRUE(m.blended) << most;
        EXPECT_NEAR(m.alpha, 0.9f, 1e-6) << most;
        EXPECT_EQ(m.transmission, 0) << most;
        expect_color(m.base_color, {1, 0, 0});
    }
    // What Tf tints is a sheet of glass. Red's own share and what is behind it, under even light: half red, half green.
    const Material tinted = material_of(load("d 0.5\nTf 0.2 0.9 0.2\n"));
    expect_color(tinted.base_color, {0.6f, 0.45f, 0.1f});
    EXPECT_NEAR(tinted.transmission, 0.5f, 1e-6);
    EXPECT_EQ(tinted.thickness, 0);
    EXPECT_FALSE(tinted.blended);
    const Scene clear = load("d 0\n");
    EXPECT_EQ(material_of(clear).transmission, 1);
    EXPECT_EQ(material_of(clear).base_color, glm::vec3(1));
    ASSERT_EQ(clear.notes.size(), 1u);
    EXPECT_MENTIONS(clear.notes[0], "wholly transparent");
    EXPECT_MENTIONS(load("Tr 1\n").notes.at(0), "wholly transparent");
    EXPECT_MENTIONS(load("d 1\nTr 1\n").notes.at(0), "d counts");
    EXPECT_MENTIONS(load("d -halo 0.9\n").notes.at(0), "-halo");
    EXPECT_MENTIONS(load("Tf 0 1 0\n").notes.at(0), "opaque");
    // A glass takes its tint from Tf.
    const Material glass = material_of(load("illum 7\nTf 0.5 0.75 1\nNi 1.33\n"));
    EXPECT_EQ(glass.transmission, 1);
    EXPECT_EQ(glass.base_color, glm::vec3(0.5f, 0.75f, 1));
    EXPECT_GT(glass.thickness, 0);
    EXPECT_FLOAT_EQ(glass.ior, 1.33f);
}

TEST(Mtl, TextureOptions) {
    const TempFolder folder;
    folder.write("2 by 1.png", tiny_png());
    const auto load = [&](const std::string& map) { return load_with(folder, "newmtl m\nmap_Kd " + map + "\n"); };
    const auto expect_corners = [&](const std::string& map, glm::vec2 first, glm::vec2 last) {
        const Scene scene = load(map);
        ASSERT_EQ(scene.textures.size(), 1u) << map;
        EXPECT_EQ(corners_of(scene).first, first) << map;
        EXPECT_EQ(corners_of(scene).second, last) << map;
    };
    expect_corners("2 by 1.png", {0, 1}, {1, 0});
    expect_corners("\"2 by 1.png\" # quoted", {0, 1}, {1, 0});
    expect_corners("-s 4 4 1 2 by 1.png", {0, 1}, {4, -3});
    expect_corners("-s 4 -o 0.5 0.25 -clamp off 2 by 1.png", {0.5f, 0.75f}, {4.5f, -0.25f});
    expect_corners("-o .5 -blendu on -blendv on -cc off -mm 0 1 2 by 1.png", {0.5f, 1}, {1.5f, 0});
    expect_corners("2 by 1.png -s 2 3 1", {0, 1}, {2, -2});  // some write them behind the name
    EXPECT_TRUE(load("-s 4 4 1 2 by 1.png").notes.empty());
    EXPECT_EQ(load("-clamp on 2 by 1.png").textures[0].wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(load("2 by 1.png").textures[0].wrap_u, Texture::Wrap::repeat);
    for (const char* option : {"-bm 0.5", "-boost 2", "-t 1 1 1", "-mm 0.1 0.9", "-blendu off", "-cc on", "-imfchan l",
                               "-type sphere", "-texres 512"}) {
        const Scene scene = load(option + std::string(" 2 by 1.png"));
        EXPECT_EQ(scene.textures.size(), 1u) << option;
        ASSERT_EQ(scene.notes.size(), 1u) << option;
        EXPECT_MENTIONS(scene.notes[0], std::string(option).substr(0, std::string(option).find(' ')));
    }
    EXPECT_EQ(material_of(load("2 by 1.png")).base_color, glm::vec3(1));  // no Kd: the texture as it is
    EXPECT_EQ(material_of(load("gone.png")).base_color, glm::vec3(0.6f));
}

TEST(Mtl, NamesOfOtherMachines) {
    const TempFolder folder;
    folder.write("Wood.PNG", tiny_png());
    folder.write("textures/Bark#2.png", tiny_png());
    for (const char* name :
         {"wood.png", ".\\WOOD.png", "./Wood.PNG", "textures\\bark#2.png", "Textures/BARK#2.PNG # bark"}) {
        const Scene scene = load_with(folder, "newmtl m\nmap_Kd " + std::string(name) + "\n");
        EXPECT_EQ(scene.textures.size(), 1u) << name;
        EXPECT_TRUE(scene.notes.empty()) << name << ": " << scene.notes[0];
    }
    for (const char* name : {"C:\\Users\\me\\wood.png", "/home/me/wood.png", "D:/textures/Wood.PNG", "../else/wood.png",
                             "maps/wood.png", "\\\\server\\share\\wood.png"}) {
        const Scene scene = load_with(folder, "newmtl m\nmap_Kd " + std::string(name) + "\n");
        EXPECT_EQ(scene.textures.size(), 1u) << name;
        ASSERT_EQ(scene.notes.size(), 1u) << name;
        EXPECT_MENTIONS(scene.notes[0], "beside the model");
    }
}

TEST(Mtl, MissingImagesAreOneNote) {
    const TempFolder folder;
    folder.write("broken.png", "no image");
    const Scene scene = load_with(folder,
                                  "newmtl m\nKd 0.5 0.25 1\nmap_Kd gone.png\nmap_Ke gone.png\nKe 1 2 3\n"
                                  "newmtl n\nmap_Kd gone.png\nmap_Pr /tmp/none.png\nPr 0.5\n");
    EXPECT_EQ(material_of(scene).base_color, glm::vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(material_of(scene).emissive, glm::vec3(1, 2, 3));
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_MENTIONS(scene.notes[0], "2 images are missing");
    EXPECT_MENTIONS(scene.notes[0], "\"gone.png\", \"/tmp/none.png\"");
    const Scene broken = load_with(folder, "newmtl m\nKd 0.5 0.25 1\nmap_Kd broken.png\nnewmtl n\nmap_Kd broken.png\n");
    EXPECT_EQ(material_of(broken).base_color, glm::vec3(0.5f, 0.25f, 1));
    ASSERT_EQ(broken.notes.size(), 1u);
    EXPECT_MENTIONS(broken.notes[0], "broken.png");
}

TEST(Mtl, PhysicallyBasedAndEmissiveMaps) {
    const TempFolder folder;
    folder.write("red green.png", tiny_png());
    const Scene scene = load_with(folder,
                                  "newmtl m\nPr 0.5\nmap_Pr -imfchan g -s 2 3 1 red green.png\nmap_Pm -imfchan r red "
                                  "green.png\nKe 2 2 3\nmap_Ke -o 0.5 red green.png\n");
    const Material& m = material_of(scene);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
    ASSERT_EQ(scene.textures.size(), 1u);  // one image, four uses
    EXPECT_EQ(m.roughness, 0.5f);
    EXPECT_EQ(m.roughness_texture.texture, 0);
    EXPECT_EQ(m.roughness_texture.channel, 1u);
    EXPECT_EQ(m.roughness_texture.place({1, 0}), glm::vec2(2, -2));
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.metallic_texture.texture, 0);
    EXPECT_EQ(m.metallic_texture.channel, 0u);
    EXPECT_EQ(m.metallic_texture.place({1, 0}), glm::vec2(1, 0));
    EXPECT_EQ(m.emissive, glm::vec3(2, 2, 3));
    EXPECT_EQ(m.emissive_texture.texture, 0);
    EXPECT_EQ(m.emissive_texture.place({0, 0}), glm::vec2(0.5f, 0));
    EXPECT_FALSE(m.base_color_texture);
    // Without Ke the texture counts as it is; where its image is missing, so does Ke.
    EXPECT_EQ(material_of(load_with(folder, "newmtl m\nmap_Ke red green.png\n")).emissive, glm::vec3(1));
    EXPECT_EQ(material_of(load_with(folder, "newmtl m\nmap_Ke gone.png\n")).emissive, glm::vec3(0));
    const Material coated = material_of(load_with(folder, "newmtl m\nPc 0.75\nPcr 0.25\n"));
    EXPECT_EQ(coated.clearcoat, 0.75f);
    EXPECT_EQ(coated.coat_roughness, 0.25f);
    EXPECT_EQ(material_of(load_with(folder, "newmtl m\nPc 3\nPcr -1\n")).clearcoat, 1);
    EXPECT_EQ(m.clearcoat, 0);
    // Normals in tangent space are read, heights are not.
    const Scene normals = load_with(folder, "newmtl m\nnorm -bm 0.25 -clamp on red green.png\n");
    EXPECT_TRUE(normals.notes.empty()) << normals.notes[0];
    EXPECT_TRUE(material_of(normals).normal_texture);
    EXPECT_EQ(material_of(normals).normal_scale, 0.25f);
    EXPECT_EQ(normals.textures.at(0).wrap_v, Texture::Wrap::clamp);
    for (const glm::vec4& t : normals.meshes.at(0).primitives.at(0).tangents) EXPECT_EQ(std::abs(t.w), 1);
    EXPECT_FALSE(normals.meshes.at(0).primitives.at(0).tangents.empty());
    const Scene bump = load_with(folder, "newmtl m\nbump -bm 0.3 b.png\nmap_Bump b.png\n");
    ASSERT_EQ(bump.notes.size(), 1u);
    EXPECT_MENTIONS(bump.notes[0], "2 bump maps (map_bump), which hold heights, ignored");
    for (const char* key : {"Ka 1 1 1", "map_Ks a.png", "map_Ns a.png", "disp a.png", "decal a.png",
                            "refl -type sphere a.png", "Ps 0.5", "aniso 1", "sharpness 60", "map_aat on"}) {
        const Scene noted = load_with(folder, "newmtl m\n" + std::string(key) + "\n");
        ASSERT_EQ(noted.notes.size(), 1u) << key;
        EXPECT_MENTIONS(noted.notes[0], "\"" + std::string(key).substr(0, std::string(key).find(' ')) + "\"");
    }
    for (const char* line : {"Kd red", "Kd 1 0", "Ns", "d -halo", "illum 42", "illum two", "Kd spectral a.rfl",
                             "Kd 1 0 0 0", "map_Kd", "Ni nan"}) {
        const Scene noted = load_with(folder, "newmtl m\n" + std::string(line) + "\n");
        EXPECT_FALSE(noted.notes.empty()) << line;
        EXPECT_TRUE(std::any_of(noted.notes.begin(), noted.notes.end(), [&](const std::string& note) {
            return note.find("line 2 of \"m.mtl\"") != std::string::npos;
        })) << line;
    }
    EXPECT_MENTIONS(load_with(folder, "Kd 1 0 0\nnewmtl m\n").notes.at(0), "before the first newmtl");
    EXPECT_MENTIONS(load_with(folder, "newmtl m\nKd 2 0 0\n").notes.at(0), "above 1");
    EXPECT_MENTIONS(load_with(folder, "newmtl m\nillum 0\n").notes.at(0), "illum 0");
}

TEST(Mtl, DissolveMapsCutHoles) {
    const TempFolder folder;
    folder.write("red green.png", tiny_png());
    // Red's luminance is below one half, green's above.
    const Scene scene = load_with(folder, "newmtl m\nKd 1 1 1\nmap_d red green.png\nmap_Kd red green.png\n");
    const Material m = material_of(scene);
    EXPECT_EQ(m.alpha_cutoff, 0.5f);
    const Texture& cut = scene.textures.at(size_t(m.base_color_texture.texture));
    ASSERT_EQ(cut.texels.size(), 2u);
    EXPECT_LT(cut.texels[0] >> 24, 128u);
    EXPECT_GE(cut.texels[1] >> 24, 128u);
    EXPECT_EQ(cut.texels[0] & 0xFFFFFF, 0x0000FFu);  // still red
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_MENTIONS(scene.notes[0], "map_d");
    // Another channel: red is solid, green is not; no colour map: white, and the map's own transform.
    const Scene other = load_with(folder, "newmtl m\nmap_d -imfchan r -s 2 2 1 red green.png\n");
    const Texture& white = other.textures.at(size_t(material_of(other).base_color_texture.texture));
    EXPECT_EQ(white.texels, (std::vector<uint32_t>{0xFFFFFFFFu, 0x00FFFFFFu}));
    EXPECT_EQ(corners_of(other).second, glm::vec2(2, -1));
    // The blue channel is black all over: wholly dissolved. Its alpha is 255 all over: not at all.
    EXPECT_EQ(material_of(load_with(folder, "newmtl m\nmap_d -imfchan b red green.png\n")).transmission, 1);
    EXPECT_EQ(material_of(load_with(folder, "newmtl m\nmap_d -imfchan m red green.png\n")).transmission, 0);
}

}  // namespace
}  // namespace peelray::testing
