// Reading files and URIs on behalf of a scene file: nothing outside the scene file's folder is ever opened.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace peelray {

using Bytes = std::vector<uint8_t>;

/// Opens a file and says how many bytes it has. Throws Error when it is missing, not a regular file, or unreadable;
/// `where` says who asked for it.
std::ifstream open_file(const std::filesystem::path& path, uint64_t& size, const std::string& where = "");

/// The whole file. Throws Error as open_file() does.
Bytes read_file(const std::filesystem::path& path, const std::string& where = "");

/// Adds a file to those that were read, unless it is there already.
void remember_file(std::vector<std::filesystem::path>& files, const std::filesystem::path& file);

/// Undoes %XX. Throws Error (prefixed with `where`) for a stray '%' or a NUL byte.
std::string percent_decode(std::string_view text, const std::string& where);

/// Decodes "data:[type][;base64],…"; throws Error for what is not a valid data URI.
Bytes decode_data_uri(std::string_view uri, const std::string& where);
bool is_data_uri(std::string_view uri);

/// The file that `relative` (decoded, UTF-8) names inside `folder`. Throws Error for an absolute path, a scheme such as
/// http: or file:, and for whatever leads out of the folder once ".." and symbolic links are resolved.
std::filesystem::path resolve_inside(const std::filesystem::path& folder, const std::string& relative,
                                     const std::string& where);

/// A file that was looked for beside another one.
struct SideFile {
    std::filesystem::path path;
    bool is_elsewhere = false;  ///< not where the name says, but under its bare file name in the folder itself
};

/// The file inside `folder` that a mesh or material file means by `name`, which another machine may have written: with
/// backslashes, in another case, or with the absolute path that it had there, of which the bare name is looked for.
/// Nothing: there is no such file, or it lies outside of the folder.
std::optional<SideFile> find_beside(const std::filesystem::path& folder, std::string_view name);

}  // namespace peelray
