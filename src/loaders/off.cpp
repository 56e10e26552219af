#include "loaders/off.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "loaders/file_reader.h"
#include "loaders/polygon_mesh.h"

namespace peelray {

namespace {

/// What a face without a colour has where others have one, by Geomview's manual.
constexpr float default_grey = 0.666f;

/// Geomview's default colour map, 0xRRGGBB; nothing beyond its end.
std::optional<uint32_t> map_color(int64_t index) {
    constexpr std::array<uint32_t, 31> first = {
        0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xB22619, 0x3333CC, 0xE59905, 0x194CCC, 0x19B233,
        0xCCCC66, 0xB2B200, 0xB200B2, 0x00B2B2, 0xE50033, 0x33E500, 0x0033E5, 0xBFBFBF, 0xCC6600, 0xCC6600, 0x0066CC,
        0x0066CC, 0x00CC66, 0x00CC66, 0x6600CC, 0x6600CC, 0xCC0066, 0xCC0066, 0xB27F33, 0xB27F33};
    constexpr std::array<uint32_t, 39> middle = {
        0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0xFFFFFF, 0x0C4C19, 0xB20219, 0x330C99, 0xE5E505,
        0x003366, 0x196666, 0xCCCCCC, 0xB2B200, 0xB2B200, 0xB200B2, 0xB200B2, 0x00B2B2, 0x00B2B2, 0xE50000,
        0xE50000, 0x00E500, 0x00E500, 0x0000E5, 0x0000E5, 0xBFBFBF, 0xBFBFBF, 0xCC6600, 0xCC6600, 0x0066CC,
        0x0066CC, 0x00CC66, 0x00CC66, 0x6600CC, 0x6600CC, 0xCC0066, 0xCC0066, 0xB27F33, 0xB27F33};
    // These stand at 31, 44, 57, 109, 122 and 135.
    constexpr std::array<uint32_t, 13> cycle = {0xB2B200, 0xB200B2, 0x00B2B2, 0xE50000, 0x00E500, 0x0000E5, 0xBFBFBF,
                                                0xCC6600, 0x66CC00, 0x0066CC, 0x00CC66, 0x6600CC, 0xCC0066};
    if (index < 0 || index >= 148) return std::nullopt;
    const auto i = static_cast<size_t>(index);
    if (i < 31) return first[i];
    if (i < 70) return cycle[(i - 31) % 13];
    return i < 109 ? middle[i - 70] : cycle[(i - 109) % 13];
}

/// Colours as they stand in the file: whether whole numbers are parts of 255 shows only at its end.
class OffColors {
  public:
    /// `values`: 0 (none), 1 (an index into the colour map), 3 or 4; nothing else. `whole`: without a point or
    /// exponent.
    void add(const std::vector<double>& values, bool whole) {
        Kind kind = values.empty()       ? Kind::none
                    : values.size() == 1 ? Kind::index
                    : whole              ? Kind::whole
                                         : Kind::floating;
        glm::vec4 color(0, 0, 0, -1);
        for (size_t i = 0; i < values.size(); ++i) color[static_cast<int>(i)] = static_cast<float>(values[i]);
        if (kind == Kind::whole)
            for (const double value : values) largest_ = std::max(largest_, value);
        any_ |= kind != Kind::none;
        colors_.push_back(color);
        kinds_.push_back(kind);
    }

    void reserve(size_t count) {
        colors_.reserve(count);
        kinds_.reserve(count);
    }

    bool any() const { return any_; }

    /// Linear colours.
    std::vector<glm::vec4> take(std::vector<std::string>& notes) {
        uint64_t unknown = 0, small = 0;
        const bool bytes = largest_ > 1;
        for (size_t i = 0; i < colors_.size(); ++i) {
            if (kinds_[i] == Kind::whole && !bytes) ++small;
            colors_[i] = linear(colors_[i], kinds_[i], bytes, unknown);
        }
        if (unknown > 0)
            notes.push_back(counted("{} colour{|s} grey, whose index is not in the colour map (0 to 147)", unknown));
        if (small > 0)
            notes.push_back(counted("{} colour{|s} of whole numbers up to 1 taken for parts of 1, not of 255", small));
        return std::move(colors_);
    }

  private:
    enum class Kind : uint8_t { none, index, whole, floating };

    static glm::vec4 linear(glm::vec4 color, Kind kind, bool bytes, uint64_t& unknown) {
        if (kind == Kind::none) return {default_grey, default_grey, default_grey, 1};
        if (kind == Kind::index) {
            const std::optional<uint32_t> known = color.x == std::floor(color.x) && std::abs(color.x) < 1000
                                                      ? map_color(static_cast<int64_t>(color.x))
                                                      : std::nullopt;
            if (known)
                return encoded_color(static_cast<uint8_t>(*known >> 16), static_cast<uint8_t>(*known >> 8),
                                     static_cast<uint8_t>(*known));
            ++unknown;
            return {default_grey, default_grey, default_grey, 1};
        }
        const bool opaque = color.w < 0;
        if (kind == Kind::whole && bytes) {
            color /= 255.f;
            if (opaque) color.w = 1;
            // What does not fit a byte stays where it is and is counted as such later.
            return glm::all(glm::lessThanEqual(color, glm::vec4(1))) &&
                           glm::all(glm::greaterThanEqual(color, glm::vec4(0)))
                       ? encoded_color(color)
                       : color;
        }
        if (opaque) color.w = 1;
        return color;
    }

    std::vector<glm::vec4> colors_;
    std::vector<Kind> kinds_;
    double largest_ = 0;  ///< channel of the colours of whole numbers
    bool any_ = false;
};

class OffReader {
  public:
    OffReader(FileReader& file, Scene& scene, const glm::dvec3& origin) : file_(file), scene_(scene) {
        mesh_.origin = origin;
    }

    PolygonMesh read() {
        file_.allow_comments();
        read_header();
        reserve();
        file_.part = {"vertex", 0, vertices_};
        for (; file_.part.index < vertices_; ++file_.part.index) read_vertex();
        file_.part = {"face", 0, faces_};
        for (; file_.part.index < faces_; ++file_.part.index) read_face();
        if (binary_ ? file_.left() > 0 : !file_.word().empty())
            scene_.notes.push_back(
                binary_ ? counted("{} byte{|s} after the last face {has|have} no effect", file_.left())
                        : fmt::format("what follows the last face in line {} has no effect", file_.line()));
        take_colors();
        return std::move(mesh_);
    }

  private:
    /// Finds the prefixes of a keyword; false for a word that is none.
    bool read_prefixes(std::string_view prefixes) {
        while (!prefixes.empty()) {
            if (prefixes.starts_with("ST")) {
                texcoords_ = true;
                prefixes.remove_prefix(1);
            } else if (prefixes[0] == 'C' || prefixes[0] == 'c') {
                vertex_colors_ = true;
            } else if (prefixes[0] == 'N') {
                normals_ = true;
            } else if (prefixes[0] == '4') {
                homogeneous_ = true;
            } else if (prefixes[0] == 'n') {
                any_dimension_ = true;
            } else {
                return false;
            }
            prefixes.remove_prefix(1);
        }
        return true;
    }

    void read_header() {
        file_.part = {"the header"};
        std::string word(file_.word());
        std::string first;
        const size_t key = std::min(word.find("OFF"), word.find("off"));
        if (key != word.npos && read_prefixes(std::string_view(word).substr(0, key))) {
            first = word.substr(key + 3);
            if (first.empty()) first = file_.word();
            if (first == "BINARY") {
                binary_ = true;
                file_.rest_of_line();
            }
        } else if (const auto count = to_number(word)) {
            first = word;  // the keyword may be missing
        } else {
            fail("{}: not an OFF file: it does not begin with \"OFF\"", file_.name());
        }
        if (any_dimension_) {
            const int64_t dimensions = binary_ ? whole() : whole_of(first);
            if (dimensions != 3)
                fail("{}: its vertices have {} dimensions; only files of three are read", file_.name(), dimensions);
            if (!binary_) first = file_.word();
        }
        read_counts(first);
    }

    void read_counts(const std::string& first) {
        const int64_t vertices = binary_ ? whole() : whole_of(first);
        const uint64_t line = file_.line();
        const int64_t faces = whole();
        // The number of edges serves nobody; some programs leave it out.
        const std::string_view edges = binary_ ? "" : file_.line() == line ? file_.word_on_line() : file_.word();
        if (binary_) whole();
        if (!edges.empty() && !to_number(edges))
            fail("{}: line {}: the OFF header does not give the numbers of vertices, faces and edges", file_.name(),
                 file_.line());
        const int64_t left = static_cast<int64_t>(file_.left()) + 1;
        const int64_t per_vertex = (binary_ ? 4 : 2) * (homogeneous_ ? 4 : 3), per_face = binary_ ? 8 : 2;
        if (vertices < 0 || faces < 0 || vertices > left / per_vertex || faces > left / per_face)
            fail("{}: claims {} vertices and {} faces in a file of {}; it is truncated or damaged", file_.name(),
                 vertices, faces, counted("{} byte{|s}", file_.size()));
        vertices_ = static_cast<uint64_t>(vertices);
        faces_ = static_cast<uint64_t>(faces);
        if (faces_ == 0)
            fail("{}: a point cloud of {} points without faces; reconstruct its surface first and give that mesh",
                 file_.name(), vertices_);
    }

    int64_t whole_of(std::string_view word) const {
        if (word.empty()) file_.fail_truncated();
        const std::optional<double> value = to_number(word);
        if (!value || !(std::abs(*value) < 9e15) || *value != std::floor(*value))
            fail("{}: line {}: the OFF header does not give the numbers of vertices, faces and edges", file_.name(),
                 file_.line());
        return static_cast<int64_t>(*value);
    }

    void reserve() {
        mesh_.positions.reserve(vertices_);
        if (normals_) mesh_.normals.values.reserve(vertices_);
        if (texcoords_) mesh_.uvs.values.reserve(vertices_);
        if (vertex_colors_) colors_of_vertices_.reserve(vertices_);
        mesh_.corners.reserve(std::min(faces_ * 3, file_.left() / (binary_ ? 4 : 2)));
    }

    double number() {
        if (!binary_) return file_.number();
        return std::bit_cast<float>(static_cast<uint32_t>(bits()));
    }

    int64_t whole() { return binary_ ? static_cast<int32_t>(bits()) : file_.whole(); }

    uint32_t bits() {
        const char* raw = file_.take(4);
        if (!raw) file_.fail_truncated();
        uint32_t out = 0;
        for (int i = 0; i < 4; ++i) out = out << 8 | static_cast<uint8_t>(raw[i]);
        return out;
    }

    void read_vertex() {
        glm::dvec4 p(0, 0, 0, 1);
        for (int k = 0; k < (homogeneous_ ? 4 : 3); ++k) p[k] = number();
        mesh_.positions.push_back(mesh_.relative(glm::dvec3(p / p.w)));
        if (normals_) {
            glm::vec3 normal;
            for (int k = 0; k < 3; ++k) normal[k] = static_cast<float>(number());
            mesh_.normals.values.push_back(normal);
        }
        if (vertex_colors_) read_vertex_color();
        if (texcoords_ && (binary_ || !vertex_colors_)) {
            const double u = number();
            mesh_.uvs.values.emplace_back(u, number());
        }
    }

    /// In ASCII the line tells how many numbers the colour has; texture coordinates follow it.
    void read_vertex_color() {
        read_rest(binary_ ? 4 : 0);
        if (!binary_ && texcoords_) {
            if (rest_.size() < 2)
                fail("{}: line {}: {} has no texture coordinates", file_.name(), file_.line(), file_.part_name());
            mesh_.uvs.values.emplace_back(rest_[rest_.size() - 2], rest_[rest_.size() - 1]);
            rest_.resize(rest_.size() - 2);
        }
        check_color();
        colors_of_vertices_.add(rest_, rest_whole_);
    }

    void read_face() {
        const int64_t corners = whole();
        if (corners < 0 || static_cast<uint64_t>(corners) > file_.left())
            fail("{}: {}{} claims {} corners; the file is truncated or damaged", file_.name(), place(),
                 file_.part_name(), corners);
        for (int64_t i = 0; i < corners; ++i) {
            const int64_t index = whole();
            if (index < 0 || static_cast<uint64_t>(index) >= vertices_)
                fail("{}: {}{} has index \"{}\", the file has {}", file_.name(), place(), file_.part_name(), index,
                     counted("{} vert{ex|ices}", vertices_));
            mesh_.corners.push_back(static_cast<uint32_t>(index));
        }
        const size_t end = mesh_.corners.size();
        if (corners != 3 && mesh_.ends.empty())
            for (size_t i = 3; i + static_cast<size_t>(corners) <= end; i += 3)
                mesh_.ends.push_back(static_cast<uint32_t>(i));
        if (corners != 3 || !mesh_.ends.empty()) mesh_.ends.push_back(static_cast<uint32_t>(end));
        read_rest(binary_ ? whole() : 0);
        check_color();
        if (!rest_.empty() && !colors_of_faces_.any())
            for (uint64_t i = 0; i < file_.part.index; ++i) colors_of_faces_.add({}, true);
        if (!rest_.empty() || colors_of_faces_.any()) colors_of_faces_.add(rest_, rest_whole_);
    }

    /// The numbers up to the end of the line, or so many binary ones; of those one alone is an index.
    void read_rest(int64_t binary_count) {
        rest_.clear();
        rest_whole_ = !binary_;
        if (binary_count < 0 || binary_count > 4)
            fail("{}: {}{} has a colour of {} numbers; the file is damaged", file_.name(), place(), file_.part_name(),
                 binary_count);
        if (binary_count == 1) rest_.push_back(static_cast<double>(whole()));
        for (int64_t i = 0; i < binary_count && binary_count > 1; ++i) rest_.push_back(number());
        if (binary_) return;
        for (std::string_view word = file_.word_on_line(); !word.empty(); word = file_.word_on_line()) {
            const std::optional<double> value = to_number(word);
            if (!value)
                fail("{}: line {}: \"{}\" in the colour of {} is no number; repair the file", file_.name(),
                     file_.line(), printable(word, 30), file_.part_name());
            rest_whole_ &= word.find_first_not_of("+-0123456789") == word.npos;
            if (rest_.size() < 8) rest_.push_back(*value);
        }
    }

    /// A colour has 1, 3 or 4 numbers; others are none.
    void check_color() {
        if (rest_.empty() || rest_.size() == 1 || rest_.size() == 3 || rest_.size() == 4) return;
        ++odd_colors_;
        rest_.clear();
    }

    void take_colors() {
        using Per = MeshAttribute<glm::vec4>::Per;
        const bool of_faces = colors_of_faces_.any(), of_vertices = colors_of_vertices_.any();
        mesh_.colors.per = of_vertices ? Per::vertex : Per::face;
        if (of_vertices || of_faces)
            mesh_.colors.values = (of_vertices ? colors_of_vertices_ : colors_of_faces_).take(scene_.notes);
        if (of_vertices && of_faces)
            scene_.notes.push_back("the colours of faces have no effect beside those of vertices");
        if (odd_colors_ > 0)
            scene_.notes.push_back(
                counted("{} colour{|s} ignored, which {does|do} not have 1, 3 or 4 numbers", odd_colors_));
        Material material;
        if (!of_vertices && !of_faces) material.base_color = glm::vec3(0.6f);
        scene_.materials.push_back(material);
    }

    std::string place() const {
        return binary_ ? fmt::format("byte {}: ", file_.offset()) : fmt::format("line {}: ", file_.line());
    }

    FileReader& file_;
    Scene& scene_;
    PolygonMesh mesh_;
    bool texcoords_ = false, vertex_colors_ = false, normals_ = false, homogeneous_ = false, any_dimension_ = false;
    bool binary_ = false;
    uint64_t vertices_ = 0, faces_ = 0, odd_colors_ = 0;
    OffColors colors_of_vertices_, colors_of_faces_;
    std::vector<double> rest_;
    bool rest_whole_ = false;
};

}  // namespace

Scene load_off(const std::filesystem::path& path) {
    return load_polygons(path, [](FileReader& file, Scene& scene, const glm::dvec3& origin) {
        file.find_line_ends();
        return OffReader(file, scene, origin).read();
    });
}

}  // namespace peelray
