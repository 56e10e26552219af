// What commands ask of a workspace.
#pragma once

#include "cli/arguments.h"
#include "workspace/render_settings.h"
#include "workspace/workspace.h"

namespace peelray {

/// With a tracer: the one that was asked for; ldc if an option of the cubes was; else automatic_tracer().
RenderArguments with_tracer(RenderArguments arguments);
/// The picture's settings with what goes into other files.
RenderSettings render_settings(const RenderArguments& arguments);
/// Throws Error where what is to be counted cannot be or goes nowhere.
void check_counters(const RenderArguments& arguments);
/// Throws Error where what ends a picture early cannot.
void check_ends(const RenderArguments& arguments);
/// Is the auxiliary picture among those to be written?
bool wants(const RenderArguments& arguments, Aov aov);
/// A picture with a progress bar of its own, which is the progress of `watch`.
MadePicture render_with_bar(Workspace& workspace, const RenderSettings& settings, const Shot& shot = {},
                            PictureWatch watch = {});

}  // namespace peelray
