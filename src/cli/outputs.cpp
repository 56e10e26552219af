#include "cli/outputs.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "image/image.h"

namespace peelray {

/// Whole paths.
static bool is_inside(const std::filesystem::path& file, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

void check_outputs(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs) {
    std::vector<std::filesystem::path> whole;  // those of the outputs so far
    const auto whole_path = [](const std::filesystem::path& path) {
        std::error_code error;
        // Of a path that begins with nothing that is there, weakly_canonical() alone leaves a relative one.
        return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
    };
    for (size_t i = 0; i < outputs.size(); i++) {
        check_writable(outputs[i]);
        whole.push_back(whole_path(outputs[i]));
        for (size_t k = 0; k < i; k++) {
            if (whole[k] == whole[i])
                fail("{} would be written twice: give each output a name of its own", outputs[i].string());
            for (const auto& [file, folder] : {std::pair(k, i), std::pair(i, k)})
                if (is_inside(whole[file], whole[folder]))
                    fail("{} would be a file and the folder of {}: give each output a name of its own",
                         outputs[folder].string(), outputs[file].string());
        }
        for (const auto& input : inputs)
            if (!input.empty() && whole_path(input) == whole[i])
                fail("{} is an input and would be overwritten: name another output", input.string());
    }
}

}  // namespace peelray
