#include "loaders/gltf_image_light.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "base/text.h"
#include "loaders/images.h"
#include "scene/encoding.h"

namespace peelray {
namespace {

using nlohmann::json;

constexpr const char* kName = "EXT_lights_image_based";

/// A member; null where it is missing, or `value` no object.
const json& member(const json& value, const char* key) {
    static const json none;
    if (!value.is_object()) return none;
    const auto found = value.find(key);
    return found == value.end() ? none : *found;
}

double number_in(const json& value, const std::string& where) {
    if (!value.is_number() || !(std::abs(value.get<double>()) <= 3.4e38))
        fail("{}: is {}, must be a number", where,
             value.is_number() ? "no 32-bit floating point number" : value.type_name());
    return value.get<double>();
}

/// A whole number below `end`, of which the file has so many.
size_t index_in(const json& value, size_t end, const char* things, const std::string& where) {
    const double number = number_in(value, where);
    if (!(number >= 0 && number < double(end)) || number != std::floor(number))
        fail("{}: {} is out of range, the file has {} {}", where, number, end, things);
    return size_t(number);
}

const json& list_in(const json& value, const char* key, const std::string& where) {
    const json& list = member(value, key);
    if (list.is_null()) fail("{}: \"{}\" is missing", where, key);
    if (!list.is_array()) fail("{}.{}: is {}, must be an array", where, key, list.type_name());
    return list;
}

void expect_length(const json& list, size_t length, const char* things, const std::string& where) {
    if (!list.is_array() || list.size() != length)
        fail("{}: must be {} {}, is {}", where, length, things,
             list.is_array() ? fmt::format("{}", list.size()) : std::string(list.type_name()));
}

/// Nine harmonics of three colours. They are not used: all that is lit sees the image, whose harmonics those are to be.
void check_coefficients(const json& light, const std::string& where) {
    const json& rows = list_in(light, "irradianceCoefficients", where);
    const std::string at = where + ".irradianceCoefficients";
    expect_length(rows, 9, "triples of numbers", at);
    for (size_t i = 0; i < rows.size(); ++i) {
        const std::string row = fmt::format("{}[{}]", at, i);
        expect_length(rows[i], 3, "numbers", row);
        for (const json& value : rows[i]) number_in(value, row);
    }
}

/// How the light is turned; a quaternion without length turns nothing.
glm::dmat3 turn_of(const json& light, const std::string& where) {
    const json& rotation = member(light, "rotation");
    if (rotation.is_null()) return glm::dmat3(1);
    expect_length(rotation, 4, "numbers", where + ".rotation");
    double v[4];
    for (size_t i = 0; i < 4; ++i) v[i] = number_in(rotation[i], where + ".rotation");
    const glm::dquat turn(v[3], v[0], v[1], v[2]);
    return glm::length(turn) > 0 ? glm::mat3_cast(glm::normalize(turn)) : glm::dmat3(1);
}

/// Linear colour of a texel. PNG files with alpha are packed (RGBD): alpha divides.
glm::vec3 unpacked(const Texture& image, size_t texel) {
    const bool deep = !image.deep_texels.empty();
    const double most = deep ? 65535 : 255;
    const auto channel = [&](uint32_t i) {
        return double(deep ? image.deep_texels[texel] >> (16 * i) & 0xffff : image.texels[texel] >> (8 * i) & 0xff);
    };
    const double divisor = std::max(channel(3), 1.0) / most;
    glm::vec3 color;
    for (uint32_t i = 0; i < 3; ++i) color[int(i)] = float(srgb_to_linear(channel(i) / most) / divisor);
    return color;
}

}  // namespace

std::optional<GltfExtensions::ImageLight> image_light_of(const json& root, const std::string& file) {
    const json& scenes = member(root, "scenes");
    const json& chosen = member(root, "scene");
    const size_t scene = chosen.is_number_unsigned() ? chosen.get<size_t>() : 0;
    if (!scenes.is_array() || scene >= scenes.size()) return std::nullopt;
    const json& named = member(member(scenes[scene], "extensions"), kName);
    if (named.is_null()) return std::nullopt;
    const json& lights = member(member(member(root, "extensions"), kName), "lights");
    const std::string at = fmt::format("{}.scenes[{}].extensions.{}.light", file, scene, kName);
    const size_t index =
        index_in(member(named, "light"), lights.is_array() ? lights.size() : 0, "image-based lights", at);

    GltfExtensions::ImageLight out;
    out.where = fmt::format("{}.extensions.{}.lights[{}]", file, kName, index);
    const json& light = lights[index];
    if (!light.is_object()) fail("{}: is {}, must be an object", out.where, light.type_name());
    check_coefficients(light, out.where);
    out.turn = turn_of(light, out.where);
    if (const json& intensity = member(light, "intensity"); !intensity.is_null())
        out.intensity = number_in(intensity, out.where + ".intensity");
    if (out.intensity < 0) fail("{}.intensity: {} is below 0", out.where, out.intensity);
    const json& size = member(light, "specularImageSize");
    if (size.is_null()) fail("{}: \"specularImageSize\" is missing", out.where);
    out.size = number_in(size, out.where + ".specularImageSize");
    const json& levels = list_in(light, "specularImages", out.where);
    if (levels.empty()) fail("{}.specularImages: is empty, must have a level of six images at least", out.where);
    const json& images = member(root, "images");
    for (size_t level = 0; level < levels.size(); ++level) {
        const std::string place = fmt::format("{}.specularImages[{}]", out.where, level);
        expect_length(levels[level], 6, "images, one for each face of a cube", place);
        for (size_t face = 0; face < 6; ++face) {
            const size_t image = index_in(levels[level][face], images.is_array() ? images.size() : 0, "images",
                                          fmt::format("{}[{}]", place, face));
            if (level == 0) out.faces[face] = int(image);
        }
    }
    return out;
}

CubeLight read_image_light(GltfFile& file, const GltfExtensions::ImageLight& from) {
    CubeLight light;
    light.turn = from.turn;
    light.intensity = float(from.intensity);
    for (size_t face = 0; face < 6; ++face) {
        const std::string where = fmt::format("{}.specularImages[0][{}]", from.where, face);
        const Texture image = decode_image(file.image_bytes(from.faces[face]), where, Depth::as_stored);
        if (face == 0) light.size = image.width;
        if (image.width != light.size || image.height != light.size)
            fail("{}: the image has {}x{} pixels, the faces of a cube are squares of one size, here of {}", where,
                 image.width, image.height, light.size);
        for (size_t i = 0; i < size_t(image.width) * image.height; ++i) light.faces[face].push_back(unpacked(image, i));
    }
    if (from.size != light.size)
        ++file.ignored()[fmt::format(
            "{{}} image-based light{{|s}} whose specularImageSize {} is not that of {{its|their}} "
            "images, {}: theirs counts",
            from.size, light.size)];
    return light;
}

}  // namespace peelray
