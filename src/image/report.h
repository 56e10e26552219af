// A comparison as one HTML file that needs nothing else: no network, no server, no other file.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "image/metrics.h"

namespace peelray {

/// Label and value, as text.
using ReportFact = std::pair<std::string, std::string>;

struct ReportPicture {
    std::string name;                      ///< "cubemap", "ldc exact", "reference": unique in the report
    std::string command;                   ///< what makes this picture again, one line
    Image8 picture;                        ///< as encoded for a display
    std::vector<ReportFact> facts;         ///< how it was made: times, rays, memory
    std::optional<Difference> difference;  ///< from the report's reference; none: this is the reference
};

struct Report {
    std::string title;                    ///< the scene
    std::vector<ReportFact> facts;        ///< of the scene and the machine: triangles, device, version
    std::vector<std::string> notes;       ///< what the reader must know, one line each
    std::vector<ReportPicture> pictures;  ///< at least one; all of the same size
    size_t reference = 0;                 ///< index of the picture that the others are compared with
    std::string command;                  ///< what makes this report again
};

/// Writes the report to `path` (atomically). Any text may hold any characters; they are escaped. Throws Error if
/// unwritable or if pictures differ in size.
void write_report(const std::filesystem::path& path, const Report& report);

}  // namespace peelray
