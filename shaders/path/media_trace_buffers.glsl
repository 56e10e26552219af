// What the passes read and write that trace a queue of rays where media may overlap.
#include "path/media_params.h"
BUFFER(readonly, 30, MediaStack, media)  // where each ray starts
BUFFER(writeonly, 31, MediaWall, media_walls)  // at what it hits
BUFFER(readonly, 32, uint, media_ranks)
