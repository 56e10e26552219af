// Checks a glTF file's JSON before tinygltf sees it.
//
// tinygltf 2.7 takes a value of the wrong type for a missing one, cuts integers to 32 bits, follows extras of any depth
// with its call stack, and its messages do not say where. So it gets only what is listed in gltf_check.cpp, checked.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "loaders/tally.h"

namespace peelray {

/// True for an extension that this loader understands.
bool is_supported_extension(const std::string& name);

/// The members that the loader uses, with types, lengths and indices checked, whole numbers written as integers and
/// defaults filled in where tinygltf insists on a value. `name` goes in front of the messages. Throws Error.
///
/// An accessor without a buffer view gets one: tinygltf refuses the legal indices without. That view has no bytes
/// behind it, and lies after the file's own ones.
///
/// What is no reason to refuse the file is counted in `ignored`, with the code that Khronos's validator has for it:
/// numbers out of their range, which stay, and extensions that the file does not declare.
nlohmann::json check_gltf(const nlohmann::json& root, const std::string& name, Tally& ignored);

}  // namespace peelray
