// The reference's geometry against an independent ray tracer, POV-Ray: where does each pixel's camera ray meet the
// scene? POV-Ray gets the triangles with their world position as colour and writes 16 bits a channel.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "../image/temp_folder.h"
#include "image/image.h"
#include "loaders/load.h"
#include "reference/path_tracer.h"

namespace peelray {
namespace {

std::string vec(const glm::dvec3& v) {
    return fmt::format("<{:.9g},{:.9g},{:.9g}>", v.x, v.y, v.z);
}

/// A PPM of 16 bits a channel: "P6", comment lines, width, height, 65535, then big-endian red, green, blue.
Image read_ppm16(const std::string& bytes) {
    std::istringstream stream(bytes);
    std::string word;
    std::vector<std::string> header;
    while (header.size() < 4 && stream >> word) {
        if (word[0] == '#')
            std::getline(stream, word);
        else
            header.push_back(word);
    }
    if (header.size() < 4 || header[0] != "P6" || header[3] != "65535") return {};
    Image image{uint32_t(std::stoul(header[1])), uint32_t(std::stoul(header[2])), {}};
    const size_t start = size_t(stream.tellg()) + 1, pixels = size_t(image.width) * image.height;
    if (bytes.size() < start + pixels * 6) return {};
    const auto value = [&](size_t i) {
        return float(uint8_t(bytes[start + 2 * i]) << 8 | uint8_t(bytes[start + 2 * i + 1])) / 65535;
    };
    for (size_t i = 0; i < pixels; i++) image.pixels.push_back({value(3 * i), value(3 * i + 1), value(3 * i + 2), 1});
    return image;
}

class PovRayTest : public TempFolder {
  protected:
    /// The scene for POV-Ray. Its camera takes any three vectors, so that handedness does not matter.
    void write_scene(const Geometry& geometry, const View& view) {
        std::ofstream file(folder / "scene.pov");
        file << "#version 3.7;\nglobal_settings { assumed_gamma 1 }\nbackground { color rgb 0 }\n"
             << fmt::format("camera {{ location {} direction {} right {} up {} }}\n", vec(view.eye), vec(view.forward),
                            vec(2.0 * glm::dvec3(view.right)), vec(2.0 * glm::dvec3(view.up)));
        file << "mesh2 {\nvertex_vectors { " << geometry.positions.size();
        for (const glm::vec3& p : geometry.positions) file << "," << vec(p);
        file << " }\nface_indices { " << geometry.triangles.size();
        for (const glm::uvec3& t : geometry.triangles) file << fmt::format(",<{},{},{}>", t.x, t.y, t.z);
        const glm::dvec3 size = glm::dvec3(geometry.upper) - glm::dvec3(geometry.lower);
        // Each channel rises linearly across the box, from 0.1 to 0.9, along its axis; the average's weights make up
        // for three.
        file << " }\ntexture { pigment { average pigment_map {\n";
        for (int axis = 0; axis < 3; axis++) {
            glm::dvec3 color(0);
            color[axis] = 3;
            file << fmt::format(
                "[1 gradient {} color_map {{ [0 rgb 0] [1 rgb {}] }} scale {:.9g} translate {}]\n", "xyz"[axis],
                vec(color), size[axis] / 0.8,
                vec(glm::dvec3(geometry.lower) - 0.1 / 0.8 * size[axis] * glm::dvec3(axis == 0, axis == 1, axis == 2)));
        }
        file << "} } finish { ambient 1 diffuse 0 } }\n}\n";
    }

    bool run_povray(uint32_t width, uint32_t height) {
        std::fflush(stdout);  // else the child would print it again
        const pid_t child = ::fork();
        if (child == 0) {
            if (::chdir(folder.c_str()) != 0 || !std::freopen("log", "w", stdout) || !std::freopen("log", "a", stderr))
                ::_exit(126);
            ::setenv("HOME", folder.c_str(), 1);
            const std::string w = fmt::format("+W{}", width), h = fmt::format("+H{}", height);
            ::execlp("povray", "povray", "+Iscene.pov", "+Oout.ppm", w.c_str(), h.c_str(), "-D", "+FP16", "-A",
                     "File_Gamma=1.0", "Output_Alpha=off", "Verbose=off", nullptr);
            ::_exit(127);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }
};

TEST_F(PovRayTest, CameraRaysMeetTheSamePoints) {
    if (std::system("command -v povray > /dev/null 2>&1") != 0) GTEST_SKIP() << "povray is not installed";
    for (const char* name : {"builtin:teapots", "builtin:glass", "builtin:tree"}) {
        SCOPED_TRACE(name);
        const Scene scene = load_scene(name);
        const Geometry geometry = flatten(scene);
        PictureSettings settings;
        settings.width = 320;
        settings.height = 256;
        settings.bounces = 0;
        settings.aovs = true;
        settings.camera = scene.cameras.at(0);
        const Environment black = color_environment(glm::vec3(0));
        const Picture picture = PathTracer(scene, at_rest(scene), geometry, black).render(settings);
        write_scene(geometry, make_view(settings.camera, 1.25f, geometry.lower, geometry.upper));
        ASSERT_TRUE(run_povray(settings.width, settings.height));
        const Image positions = read_ppm16(get(folder / "out.ppm"));
        ASSERT_EQ(positions.width, settings.width);

        const glm::dvec3 size = glm::dvec3(geometry.upper) - glm::dvec3(geometry.lower);
        size_t surface = 0, off = 0;
        double worst = 0;
        for (size_t i = 0; i < picture.aovs.position.size(); i++) {
            const glm::vec4 ours = picture.aovs.position[i], theirs = positions.pixels[i];
            const bool hit = theirs.x > 0 || theirs.y > 0 || theirs.z > 0;
            surface += ours.w > 0;
            double difference = hit == (ours.w > 0) ? 0 : INFINITY;
            for (int axis = 0; axis < 3 && hit && ours.w > 0; axis++) {
                const double share = (theirs[axis] - 0.1) / 0.8;
                difference = std::max(difference, std::abs(share - (ours[axis] - geometry.lower[axis]) / size[axis]));
            }
            // 16 bits resolve 2·10⁻⁵ of the box, and POV-Ray rounds to the nearest.
            if (difference > 1.2e-5)
                off++;
            else
                worst = std::max(worst, difference);
        }
        fmt::print("  {}: {} pixels with a surface, {} off, the others by at most {:.1e} of the box\n", name, surface,
                   off, worst);
        EXPECT_GT(surface, picture.aovs.position.size() / 3);
        EXPECT_EQ(off, 0u);
    }
}

}  // namespace
}  // namespace peelray
