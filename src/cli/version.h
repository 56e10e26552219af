// Which program this is, for stats.
#pragma once

namespace peelray {

/// The commit it was built from; "unknown" without Git.
const char* build_commit();
const char* program_version();

}  // namespace peelray
