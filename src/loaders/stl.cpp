#include "loaders/stl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/text.h"
#include "loaders/file_reader.h"
#include "loaders/polygon_mesh.h"

namespace peelray {

namespace {

constexpr uint64_t header_size = 84, facet_size = 50;

/// Finds the vertices that facets share.
class SharedPositions {
  public:
    explicit SharedPositions(std::vector<glm::vec3>& positions) : positions_(positions), table_(1024, no_value) {}

    uint32_t add(const glm::vec3& position) {
        if (positions_.size() * 2 >= table_.size()) grow();
        const size_t slot = find(position, table_);
        if (table_[slot] == no_value) {
            table_[slot] = static_cast<uint32_t>(positions_.size());
            positions_.push_back(position);
        }
        return table_[slot];
    }

  private:
    size_t find(const glm::vec3& position, const std::vector<uint32_t>& table) const {
        const size_t mask = table.size() - 1;
        uint64_t hash = 1;
        for (int k = 0; k < 3; ++k) {
            hash = (hash ^ std::bit_cast<uint32_t>(position[k])) * 0x9E3779B97F4A7C15ull;
            hash ^= hash >> 32;
        }
        size_t slot = hash & mask;
        while (table[slot] != no_value && std::memcmp(&positions_[table[slot]], &position, sizeof position) != 0)
            slot = (slot + 1) & mask;
        return slot;
    }

    void grow() {
        std::vector<uint32_t> larger(table_.size() * 2, no_value);
        for (uint32_t i = 0; i < positions_.size(); ++i) larger[find(positions_[i], larger)] = i;
        table_ = std::move(larger);
    }

    std::vector<glm::vec3>& positions_;
    std::vector<uint32_t> table_;  ///< open addressing
};

bool same_word(std::string_view word, std::string_view keyword) {
    return word.size() == keyword.size() && std::equal(word.begin(), word.end(), keyword.begin(), [](char a, char b) {
               return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
           });
}

/// Where "facet normal" stands in a line; at its end if nowhere.
size_t find_facet(std::string_view line) {
    constexpr std::string_view key = "facet normal";
    for (size_t i = 0; i + key.size() <= line.size(); ++i)
        if (same_word(line.substr(i, key.size()), key)) return i;
    return line.size();
}

/// The facets of a text.
class AsciiStl {
  public:
    AsciiStl(FileReader& file, Scene& scene, const glm::dvec3& origin)
        : file_(file), scene_(scene), shared_(mesh_.positions) {
        mesh_.origin = origin;
    }

    PolygonMesh read() {
        file_.part = {"a facet"};
        for (std::string_view word = file_.word(); !word.empty(); word = file_.word()) read_statement(word);
        if (corners_ > 0 || in_facet_) file_.fail_truncated();
        if (mesh_.corners.empty()) fail("{}: the STL file has no facets", file_.name());
        if (open_) scene_.notes.push_back("the STL file ends without \"endsolid\"; it may lack triangles");
        return std::move(mesh_);
    }

  private:
    void read_statement(std::string_view word) {
        if (same_word(word, "vertex")) {
            glm::dvec3 position;
            for (int k = 0; k < 3; ++k) position[k] = file_.number();
            mesh_.corners.push_back(shared_.add(mesh_.relative(position)));
            ++corners_;
        } else if (same_word(word, "facet")) {
            finish_facet();
            in_facet_ = true;
            skip_normal();
        } else if (same_word(word, "end")) {  // "end facet"
            read_end(file_.word());
        } else if (word.size() > 3 && same_word(word.substr(0, 3), "end")) {
            read_end(word.substr(3));
        } else if (same_word(word, "solid")) {
            start_solid();
        } else if (same_word(word, "color")) {
            for (int k = 0; k < 3; ++k) file_.number();
            if (!std::exchange(color_noted_, true))
                scene_.notes.push_back(
                    fmt::format("colours in an ASCII STL file have no effect, from line {} on", file_.line()));
        } else if (!same_word(word, "outer") && !same_word(word, "loop")) {
            fail("{}: line {}: \"{}\" is no keyword of STL; repair the file", file_.name(), file_.line(),
                 printable(word, 30));
        }
    }

    void read_end(std::string_view what) {
        if (same_word(what, "loop")) return;
        finish_facet();
        if (same_word(what, "solid")) {
            open_ = false;
            file_.rest_of_line();
        } else if (!same_word(what, "facet")) {
            fail("{}: line {}: \"end{}\" is no keyword of STL; repair the file", file_.name(), file_.line(),
                 printable(what, 30));
        }
    }

    void start_solid() {
        finish_facet();
        open_ = true;
        // Some programs write the first facet behind the name.
        const std::string_view line = file_.peek_line();
        const size_t end = find_facet(line);
        std::string_view name = line.substr(0, end);
        while (!name.empty() && (name.front() == ' ' || name.front() == '\t')) name.remove_prefix(1);
        while (!name.empty() && (name.back() == ' ' || name.back() == '\t' || name.back() == '\r'))
            name.remove_suffix(1);
        mesh_.objects.emplace_back(printable(name, 200));
        mesh_.parts.push_back({mesh_.polygon_count(), static_cast<uint32_t>(mesh_.objects.size() - 1), 0});
        file_.skip(end);
    }

    /// "normal" and three numbers, often wrong ones, or fewer.
    void skip_normal() {
        for (int k = 0; k < 4; ++k) {
            const std::string_view word = file_.word();
            if (!same_word(word, "normal") && !to_number(word)) return word.empty() ? void() : read_statement(word);
        }
    }

    void finish_facet() {
        if (corners_ == 0 && !in_facet_) return;
        if (corners_ < 3)
            fail("{}: line {}: the facet has {}, not three; repair the file", file_.name(), file_.line(),
                 counted("{} vert{ex|ices}", corners_));
        if (mesh_.objects.empty()) start_nameless();
        const auto end = static_cast<uint32_t>(mesh_.corners.size());
        if (corners_ > 3 && mesh_.ends.empty())
            for (uint32_t i = 3; i <= end - corners_; i += 3) mesh_.ends.push_back(i);
        if (corners_ > 3 || !mesh_.ends.empty()) mesh_.ends.push_back(end);
        corners_ = 0;
        in_facet_ = false;
    }

    void start_nameless() {
        mesh_.objects.emplace_back();
        mesh_.parts.push_back({});
    }

    FileReader& file_;
    Scene& scene_;
    PolygonMesh mesh_;
    SharedPositions shared_;
    uint32_t corners_ = 0;  ///< of the facet that is being read
    bool in_facet_ = false, open_ = false, color_noted_ = false;
};

/// What the header of Magics says of colours: "COLOR=" with red, green, blue, alpha, then perhaps ",MATERIAL=" with the
/// diffuse, specular and ambient colours. A material goes before the colour.
struct MagicsHeader {
    bool found = false, specular = false;
    glm::vec4 color{1};

    explicit MagicsHeader(std::string_view header) {
        constexpr std::string_view color_key = "COLOR=", material_key = "MATERIAL=";
        const size_t at = header.find(color_key);
        if (at == header.npos || at + color_key.size() + 4 > header.size()) return;
        found = true;
        color = bytes(header.substr(at + color_key.size()));
        const size_t material = header.find(material_key, at);
        if (material == header.npos || material + material_key.size() + 12 > header.size()) return;
        const std::string_view values = header.substr(material + material_key.size(), 12);
        if (values.find_first_not_of(values[0]) == values.npos) return;  // filled up, with blanks or zeros
        color = bytes(values);
        specular = true;
    }

  private:
    static glm::vec4 bytes(std::string_view four) {
        const auto at = [&](size_t i) { return static_cast<uint8_t>(four[i]); };
        return encoded_color(at(0), at(1), at(2), at(3));
    }
};

/// A facet's own colour: five bits a channel.
glm::vec4 facet_color(uint16_t attribute, bool red_lowest) {
    const auto channel = [&](int shift) { return static_cast<float>(attribute >> shift & 31) / 31; };
    return encoded_color(red_lowest ? glm::vec4(channel(0), channel(5), channel(10), 1)
                                    : glm::vec4(channel(10), channel(5), channel(0), 1));
}

/// The facets of a binary file.
class BinaryStl {
  public:
    BinaryStl(FileReader& file, Scene& scene, const glm::dvec3& origin)
        : file_(file), scene_(scene), magics_(file.peek(header_size).substr(0, 80)), shared_(mesh_.positions) {
        mesh_.origin = origin;
    }

    PolygonMesh read() {
        const uint32_t count = read_count();
        mesh_.corners.reserve(size_t(count) * 3);
        attributes_.reserve(count);
        for (uint32_t i = 0; i < count; ++i) read_facet(file_.take(facet_size));
        if (file_.left() > 0)
            scene_.notes.push_back(fmt::format("{} after the last of {} {} no effect",
                                               counted("{} byte{|s}", file_.left()), counted("{} facet{|s}", count),
                                               counted("{has|have}", file_.left())));
        add_colors();
        return std::move(mesh_);
    }

  private:
    uint32_t read_count() {
        uint32_t count = 0;
        std::memcpy(&count, file_.take(header_size) + 80, 4);
        const uint64_t room = file_.left() / facet_size;
        if (count == 0)
            fail("{}: the STL file claims 0 facets and holds bytes for {}; repair the count at byte 80", file_.name(),
                 room);
        if (count > room)
            fail("{}: claims {}, holds {} in {}; the file is truncated or no STL file", file_.name(),
                 counted("{} facet{|s}", count), counted("{} whole one{|s}", room),
                 counted("{} byte{|s}", file_.size()));
        return count;
    }

    void read_facet(const char* bytes) {
        for (size_t k = 0; k < 3; ++k) {
            glm::vec3 position;
            std::memcpy(&position, bytes + 12 + k * 12, 12);
            mesh_.corners.push_back(shared_.add(mesh_.relative(position)));
        }
        uint16_t attribute = 0;
        std::memcpy(&attribute, bytes + 48, 2);
        attributes_.push_back(attribute);
    }

    /// Magics sets the highest bit where a facet has the part's colour, the others where it has its own.
    bool has_own_color(uint16_t attribute) const { return magics_.found != (attribute >> 15 != 0); }

    void add_colors() {
        const auto count = [&](auto is) { return std::count_if(attributes_.begin(), attributes_.end(), is); };
        const bool any_own = count([&](uint16_t a) { return has_own_color(a); }) > 0;
        const auto unknown = magics_.found ? 0 : count([](uint16_t a) { return a != 0 && a >> 15 == 0; });
        Material material;
        // Some programs write Magics' header only: then no facet is meant to be black.
        if (!any_own || count([](uint16_t a) { return a != 0; }) == 0) {
            material.base_color = glm::vec3(magics_.color);
            if (magics_.color.w < 1)
                scene_.notes.push_back("the colour of the STL header has an alpha below 1 and is drawn opaque");
        } else {
            mesh_.colors.per = MeshAttribute<glm::vec4>::Per::face;
            mesh_.colors.values.reserve(attributes_.size());
            for (const uint16_t attribute : attributes_)
                mesh_.colors.values.push_back(has_own_color(attribute) ? facet_color(attribute, magics_.found)
                                                                       : magics_.color);
        }
        if (magics_.specular)
            scene_.notes.push_back("the specular and ambient colours of the STL header have no effect");
        if (unknown > 0)
            scene_.notes.push_back(
                counted("{} facet{|s} {has|have} attributes that are no colours, without effect", unknown));
        scene_.materials.push_back(material);
    }

    FileReader& file_;
    Scene& scene_;
    MagicsHeader magics_;
    PolygonMesh mesh_;
    SharedPositions shared_;
    std::vector<uint16_t> attributes_;
};

/// Binary files may begin with "solid", too: the size decides, else what stands in the first kilobytes.
bool is_binary(FileReader& file) {
    if (file.size() >= header_size) {
        uint32_t count = 0;
        std::memcpy(&count, file.peek(header_size).data() + 80, 4);
        if (file.size() == header_size + facet_size * count) return true;
    }
    const std::string_view begin = file.peek(4096);
    const size_t first = begin.find_first_not_of(" \t\r\n\v\f");
    if (first == begin.npos || begin.size() < first + 5 || !same_word(begin.substr(first, 5), "solid")) {
        // A text without its first line is still one.
        if (first != begin.npos && find_facet(begin.substr(first, 12)) == 0) return false;
        if (file.size() >= header_size) return true;
        fail("{}: no STL file: it does not begin with \"solid\" and has only {}", file.name(),
             counted("{} byte{|s}", file.size()));
    }
    return file.size() >= header_size && begin.find('\0') != begin.npos;
}

}  // namespace

Scene load_stl(const std::filesystem::path& path) {
    return load_polygons(path, [](FileReader& file, Scene& scene, const glm::dvec3& origin) {
        file.find_line_ends();
        if (is_binary(file)) return BinaryStl(file, scene, origin).read();
        PolygonMesh mesh = AsciiStl(file, scene, origin).read();
        scene.materials.emplace_back();
        return mesh;
    });
}

}  // namespace peelray
