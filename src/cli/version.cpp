#include "cli/version.h"

namespace peelray {

const char* build_commit() {
    return PEELRAY_COMMIT;
}

const char* program_version() {
    return PEELRAY_VERSION;
}

}  // namespace peelray
