// What tells a file's content from another's.
#pragma once

#include <filesystem>
#include <string>

namespace peelray {

/// "xxh128:" and 32 hexadecimal digits, those that `xxh128sum` prints. It is no seal: who means to can make two files
/// of one hash. Throws Error if the file cannot be read.
std::string content_hash(const std::filesystem::path& path);

}  // namespace peelray
