// What the camera sees where nothing is before it (Frame::backdrop).
#ifndef PEELRAY_BACKDROP_KINDS_H
#define PEELRAY_BACKDROP_KINDS_H

#define BACKDROP_ENVIRONMENT 0u
#define BACKDROP_BLURRED 1u
#define BACKDROP_COLOR 2u
#define BACKDROP_NONE 3u  // the picture is transparent there

#endif
