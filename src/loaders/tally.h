// What a loader passed over, counted.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/text.h"

namespace peelray {

/// How often, by sentence as counted() takes it ("{} normal map{|s} ignored"); names out of files in it are escaped().
using Tally = std::map<std::string, size_t>;

/// Adds a line for each sentence, in alphabetic order.
inline void add_notes(const Tally& tally, std::vector<std::string>& notes) {
    for (const auto& [sentence, count] : tally) notes.push_back(counted(sentence, count));
}

}  // namespace peelray
