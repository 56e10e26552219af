#include "loaders/files.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <climits>
#include <fstream>

#include "base/error.h"
#include "base/text.h"

namespace peelray {

namespace fs = std::filesystem;

std::ifstream open_file(const fs::path& path, uint64_t& size, const std::string& where) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    const std::string name = (where.empty() ? "" : where + ": ") + printable(path.string(), 1000);
    if (!fs::exists(status)) fail("{}: no such file; check the path", name);
    if (!fs::is_regular_file(status)) fail("{}: not a regular file; check the path", name);
    size = fs::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) fail("{}: cannot be read; check its permissions", name);
    return stream;
}

Bytes read_file(const fs::path& path, const std::string& where) {
    uint64_t size = 0;
    std::ifstream stream = open_file(path, size, where);
    Bytes bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<uint64_t>(stream.gcount()) != size)
        fail("{}{}{}: only {} of {} bytes could be read", where, where.empty() ? "" : ": ",
             printable(path.string(), 1000), stream.gcount(), size);
    return bytes;
}

void remember_file(std::vector<fs::path>& files, const fs::path& file) {
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
}

namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// "http:", "file:", also "C:": a letter followed by letters, digits, '+', '-', '.' up to a colon.
bool has_scheme(std::string_view uri) {
    const size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0])))
        return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

}  // namespace

std::string percent_decode(std::string_view text, const std::string& where) {
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
            const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
            if (high < 0 || low < 0)
                fail("{}: the URI \"{}\" has a stray '%'; write it as %25", where, printable(text));
            c = static_cast<char>(high * 16 + low);
            i += 2;
        }
        if (c == 0) fail("{}: the URI \"{}\" holds a zero byte", where, printable(text));
        out += c;
    }
    return out;
}

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

Bytes decode_data_uri(std::string_view uri, const std::string& where) {
    const size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos)
        fail("{}: \"{}\" is no valid data URI", where, printable(uri, 40));
    const std::string_view header = uri.substr(0, comma), body = uri.substr(comma + 1);
    if (header.ends_with(";base64")) {
        // tinygltf knows a few media types only; its decoder ignores which, and stops at the first foreign character.
        Bytes bytes;
        std::string unused;
        if (body.size() > INT_MAX / 2) fail("{}: the base64 data is larger than 1 GiB; use a file", where);
        if (!tinygltf::DecodeDataURI(&bytes, unused, "data:application/octet-stream;base64," + std::string(body), 0,
                                     false))
            fail("{}: no bytes in the base64 data", where);
        return bytes;
    }
    const std::string text = percent_decode(body, where);
    return {text.begin(), text.end()};
}

fs::path resolve_inside(const fs::path& folder, const std::string& relative, const std::string& where) {
    const std::string shown = printable(relative);
    const fs::path wanted(relative);
    if (relative.empty()) fail("{}: the URI is empty", where);
    if (wanted.is_absolute() || relative[0] == '\\')
        fail("{}: refused to read the absolute path \"{}\"; keep the file in the scene's folder", where, shown);
    // A file really called "a:b" is fine; "http://…", "file:…" and "C:…" are not ours to open.
    std::error_code error;
    if (has_scheme(relative) && !fs::exists(folder / wanted, error))
        fail("{}: refused to read \"{}\"; only files in the scene's folder and data: URIs are read", where, shown);
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error) fail("{}: the folder {} cannot be resolved: {}", where, folder.string(), error.message());
    const fs::path target = fs::weakly_canonical(root / wanted, error);
    if (error) fail("{}: \"{}\" cannot be resolved: {}", where, shown, error.message());
    const auto [end, unused] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    if (end != root.end()) fail("{}: refused to read \"{}\", which leads outside the scene's folder", where, shown);
    return target;
}

namespace {

/// The entry of a folder by its name, exactly or else in another case; the first in alphabetic order of those.
std::optional<fs::path> find_entry(const fs::path& folder, const std::string& name) {
    std::error_code error;
    if (fs::exists(folder / name, error)) return folder / name;
    std::optional<fs::path> found;
    const std::string wanted = lower_case(name);
    for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        const fs::path file = entry->path();
        if (lower_case(file.filename().string()) == wanted && (!found || file < *found)) found = file;
    }
    return found;
}

/// Inside the folder, symbolic links resolved; nothing for what is no regular file there.
std::optional<fs::path> regular_inside(const fs::path& folder, const fs::path& relative) {
    std::error_code error;
    try {
        const fs::path path = resolve_inside(folder, relative.string(), "file");
        if (fs::is_regular_file(path, error)) return path;
    } catch (const Error&) {
    }
    return std::nullopt;
}

}  // namespace

std::optional<SideFile> find_beside(const fs::path& folder, std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '\\', '/');
    if (text.empty() || text.find('\0') != std::string::npos) return std::nullopt;
    if (const auto found = regular_inside(folder, text)) return SideFile{*found};
    const fs::path root = folder.empty() ? fs::path(".") : folder;
    fs::path relative;  // the name with the case that the files have
    for (const fs::path& part : fs::path(text)) {
        const bool plain = part != ".." && part != "/" && !part.empty();
        const auto entry = plain ? find_entry(root / relative, part.string()) : std::nullopt;
        relative = entry ? relative / entry->filename() : fs::path();
        if (!entry) break;
    }
    if (!relative.empty())
        if (const auto found = regular_inside(folder, relative)) return SideFile{*found};
    const auto bare = find_entry(root, fs::path(text).filename().string());
    if (!bare) return std::nullopt;
    const auto found = regular_inside(folder, bare->filename());
    return found ? std::optional(SideFile{*found, true}) : std::nullopt;
}

}  // namespace peelray
