// How much a test does.
#pragma once

#include <cstdlib>

namespace peelray::test {

/// `all` in `make test-long`, which sets PEELRAY_TEST_LONG; elsewhere `usual`, which shows most faults in a fraction of
/// the time.
template <typename T>
T effort(T usual, T all) {
    return std::getenv("PEELRAY_TEST_LONG") ? all : usual;
}

}  // namespace peelray::test
