#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "loaders/assimp_loader.h"
#include "loaders/files.h"

namespace peelray {

namespace {

/// Words and lines of a text.
class Words {
  public:
    explicit Words(std::string_view text) : text_(text) {}

    /// The next word; empty at the end. `comments`: whether '#' hides the rest of its line.
    std::string_view next(bool comments) {
        for (;;) {
            while (at_ < text_.size() && std::strchr(" \t\r\n\v\f", text_[at_]) && text_[at_]) ++at_;
            if (!comments || at_ >= text_.size() || text_[at_] != '#') break;
            at_ = std::min(text_.find('\n', at_), text_.size());
        }
        const size_t begin = at_;
        while (at_ < text_.size() && !(std::strchr(" \t\r\n\v\f", text_[at_]) && text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }

    std::string_view line() {
        const size_t begin = std::min(at_, text_.size()), end = std::min(text_.find('\n', begin), text_.size());
        at_ = end + 1;
        std::string_view out = text_.substr(begin, end - begin);
        if (out.ends_with('\r')) out.remove_suffix(1);
        return out;
    }

    size_t position() const { return std::min(at_, text_.size()); }
    bool at_end() const { return at_ >= text_.size(); }

  private:
    std::string_view text_;
    size_t at_ = 0;
};

std::optional<uint64_t> whole(std::string_view word) {
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

struct Property {
    size_t size = 0;  ///< bytes of one value
    bool floating = false, is_signed = false;
    size_t count_size = 0;  ///< of a list's length; 0: no list
    bool indices = false;   ///< a list of vertex indices
};

struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;
};

struct PlyHeader {
    std::string format;
    std::vector<Element> elements;
    size_t size = 0;
    uint64_t vertices = 0;
};

bool set_type(Property& property, std::string_view type) {
    property.is_signed = type[0] != 'u';
    property.floating = type == "float" || type == "float32" || type == "double" || type == "float64";
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8")
        property.size = 1;
    else if (type == "short" || type == "ushort" || type == "int16" || type == "uint16")
        property.size = 2;
    else if (type == "int" || type == "uint" || type == "int32" || type == "uint32" || type == "float" ||
             type == "float32")
        property.size = 4;
    else if (type == "double" || type == "float64")
        property.size = 8;
    else
        return false;
    return true;
}

Property parse_property(Words& words, const std::string& name) {
    Property property, length;
    std::string_view type = words.next(false);
    if (type == "list") {
        const std::string_view count_type = words.next(false);
        if (count_type.empty() || !set_type(length, count_type))
            fail("{}: the PLY header has the unknown type \"{}\"", name, printable(count_type, 20));
        property.count_size = length.size;
        type = words.next(false);
    }
    if (type.empty() || !set_type(property, type))
        fail("{}: the PLY header has the unknown type \"{}\"", name, printable(type, 20));
    const std::string_view what = words.next(false);
    property.indices = property.count_size && (what == "vertex_indices" || what == "vertex_index");
    return property;
}

PlyHeader parse_ply_header(std::string_view text, const std::string& name) {
    PlyHeader header;
    Words lines(text);
    if (Words(lines.line()).next(false) != "ply") fail("{}: not a PLY file: it does not begin with \"ply\"", name);
    for (;;) {
        if (lines.at_end()) fail("{}: the PLY header has no end_header; the file is truncated or no PLY file", name);
        Words words(lines.line());
        const std::string_view key = words.next(false);
        if (key == "format") header.format = words.next(false);
        if (key == "element") {
            Element element;
            element.name = words.next(false);
            const std::optional<uint64_t> count = whole(words.next(false));
            if (!count) fail("{}: the PLY header gives no count for element \"{}\"", name, printable(element.name, 40));
            element.count = *count;
            if (element.name == "vertex") header.vertices = *count;
            header.elements.push_back(std::move(element));
        }
        if (key == "property") {
            if (header.elements.empty()) fail("{}: the PLY header has a property before any element", name);
            header.elements.back().properties.push_back(parse_property(words, name));
        }
        if (key == "end_header") break;
    }
    header.size = lines.position();
    return header;
}

/// Reads the values of a PLY body one by one, whichever its format.
class PlyBody {
  public:
    PlyBody(std::string_view body, const std::string& format)
        : body_(body), words_(body), ascii_(format == "ascii"), swap_(format == "binary_big_endian") {}

    /// The next value as a number, NaN where the word is none; nothing at the end of the data.
    std::optional<double> value(const Property& property, size_t size, bool floating) {
        if (ascii_) {
            const std::string_view word = words_.next(false);
            if (word.empty()) return std::nullopt;
            double number = std::numeric_limits<double>::quiet_NaN();
            std::from_chars(word.data(), word.data() + word.size(), number);
            return number;
        }
        if (size > body_.size() - at_) return std::nullopt;
        uint8_t raw[8] = {};
        for (size_t i = 0; i < size; ++i) raw[i] = static_cast<uint8_t>(body_[at_ + (swap_ ? size - 1 - i : i)]);
        at_ += size;
        if (floating) return 0.0;
        uint64_t bits;
        std::memcpy(&bits, raw, 8);
        const bool negative = property.is_signed && (bits >> (size * 8 - 1) & 1);
        return negative ? static_cast<double>(bits) - std::ldexp(1.0, static_cast<int>(size * 8))
                        : static_cast<double>(bits);
    }

    size_t left() const { return ascii_ ? body_.size() - words_.position() : body_.size() - at_; }

  private:
    std::string_view body_;
    Words words_;
    bool ascii_, swap_;
    size_t at_ = 0;
};

void check_list(PlyBody& body, const Property& property, const Element& element, uint64_t item, uint64_t vertices,
                const std::string& name) {
    Property length;
    const std::optional<double> count = body.value(length, property.count_size, false);
    const double available = static_cast<double>(body.left());
    if (!count || !(*count >= 0) || *count > available)
        fail("{}: {} {} claims a list of {} values, {} bytes are left; the file is truncated or damaged", name,
             element.name, item, count.value_or(0), available);
    for (uint64_t i = 0; i < static_cast<uint64_t>(*count); ++i) {
        const std::optional<double> value = body.value(property, property.size, property.floating);
        if (!value) fail("{}: the file ends in {} {} of {}; it is truncated", name, element.name, item, element.count);
        const bool restart = *value == -1 && element.name == "tristrips";
        if (property.indices && !restart && !(*value >= 0 && *value < static_cast<double>(vertices)))
            fail("{}: {} {} has index {}, the file has {} vertices", name, element.name, item, *value, vertices);
    }
}

}  // namespace

size_t check_ply(std::span<const uint8_t> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const PlyHeader header = parse_ply_header(text, name);
    if (header.format != "ascii" && header.format != "binary_little_endian" && header.format != "binary_big_endian")
        fail("{}: the PLY format \"{}\" is unknown", name, printable(header.format, 30));
    PlyBody body(text.substr(header.size), header.format);
    for (const Element& element : header.elements) {
        if (element.count > bytes.size())
            fail("{}: claims {} elements \"{}\" in a file of {} bytes", name, element.count,
                 printable(element.name, 40), bytes.size());
        for (uint64_t item = 0; item < element.count; ++item)
            for (const Property& property : element.properties) {
                if (property.count_size) {
                    check_list(body, property, element, item, header.vertices, name);
                } else if (!body.value(property, property.size, property.floating)) {
                    fail("{}: the file ends in {} {} of {}; it is truncated", name, element.name, item, element.count);
                }
            }
    }
    return header.size;
}

void check_off(std::span<const uint8_t> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Words words(text);
    const std::string_view magic = words.next(true);
    if (!magic.ends_with("OFF")) fail("{}: not an OFF file: it does not begin with \"OFF\"", name);
    const std::optional<uint64_t> vertices = whole(words.next(true)), faces = whole(words.next(true)),
                                  edges = whole(words.next(true));
    if (!vertices || !faces || !edges)
        fail("{}: the OFF header does not give the numbers of vertices, faces and edges", name);
    if (*vertices > bytes.size() / 2 || *faces > bytes.size() / 2)
        fail("{}: claims {} vertices and {} faces in a file of {} bytes", name, *vertices, *faces, bytes.size());
    if (magic != "OFF") return;  // with normals, colours or texture coordinates per vertex: only the counts are checked
    for (uint64_t i = 0; i < *vertices * 3; ++i)
        if (words.next(true).empty())
            fail("{}: the file ends in vertex {} of {}; it is truncated", name, i / 3, *vertices);
    words.line();
    for (uint64_t face = 0; face < *faces; ++face) {
        const std::optional<uint64_t> corners = whole(words.next(true));
        if (!corners || *corners > bytes.size())
            fail("{}: face {} of {} is missing or has no count; the file is truncated or damaged", name, face, *faces);
        for (uint64_t i = 0; i < *corners; ++i) {
            const std::string_view word = words.next(true);
            const std::optional<uint64_t> index = whole(word);
            if (!index || *index >= *vertices)
                fail("{}: face {} has index \"{}\", the file has {} vertices", name, face, printable(word, 20),
                     *vertices);
        }
        words.line();  // a colour may follow
    }
}

}  // namespace peelray
