// Whether a word of the command line stands for a scene: for those who leave the command out.
#pragma once

#include <string>

namespace peelray {

/// A file or folder that is there, or a name that ends as models do.
bool is_scene_name(const std::string& word);

/// The same, or the first model in a folder; of one without models, a name to be filled in.
std::string scene_in(const std::string& word);

}  // namespace peelray
