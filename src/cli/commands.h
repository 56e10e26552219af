// The subcommands. Each throws Error for input or a device at fault.
#pragma once

#include "cli/arguments.h"

namespace peelray {

void run_render(const RenderArguments& arguments);
/// `run_render` where `is_sequence()`.
void run_sequence(const RenderArguments& arguments);
void run_compare(const CompareArguments& arguments);
void run_trace(const TraceArguments& arguments);
void run_bench(const BenchArguments& arguments);
void run_info(const std::string& scene);
void run_devices();
/// Returns the exit status: 0 where a Vulkan device passed its checked frame, else 1.
int run_doctor(bool json);

}  // namespace peelray
