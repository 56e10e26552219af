// Times of passes by name.
#pragma once

#include <algorithm>
#include <vector>

#include "gpu/commands.h"
#include "render/renderer.h"

namespace peelray {

/// Adds up pass times by name, keeping the order of first appearance.
class TimeTable {
  public:
    void add(const std::vector<PassTime>& times) {
        for (const PassTime& time : times) {
            auto found = std::find_if(rows_.begin(), rows_.end(), [&](auto& row) { return row.name == time.name; });
            if (found == rows_.end()) found = rows_.insert(rows_.end(), {time.name, 0});
            found->ms += time.ms;
        }
    }
    const std::vector<RenderStats::Time>& rows() const { return rows_; }

  private:
    std::vector<RenderStats::Time> rows_;
};

}  // namespace peelray
