// The parts of `peelray bench`. Each throws Error, one line, also where it was interrupted; finished rows are kept.
#pragma once

#include "cli/arguments.h"

namespace peelray {

/// --paper: Table 1 of the paper again.
void run_paper_bench(const BenchArguments& arguments);
/// Rays and frames of many scenes, against rivals on the same rays.
void run_ray_bench(const BenchArguments& arguments);
/// --auto-check: what `auto` chooses against the best fixed choice.
void run_auto_check(const BenchArguments& arguments);
/// --sequence: frames on their whole way into files and streams, beside the encoders alone.
void run_sequence_bench(const BenchArguments& arguments);

}  // namespace peelray
