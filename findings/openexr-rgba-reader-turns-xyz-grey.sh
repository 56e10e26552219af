#!/bin/bash
# OpenEXR's RGBA reader takes a picture of X, Y and Z channels for a grey one.
#
# version    OpenEXR 3.1.5 (Debian libopenexr-dev 3.1.5-5), Imath 3.1.6
# guess      RgbaInputFile converts CIE XYZ to RGB, or refuses a file without R, G and B.
# behaviour  The channel Y is read as the luminance of a luminance-chroma picture, X and Z are not looked at: every
#            pixel is grey, R = G = B = Y, and the colours are gone without a word.
# seen       X 0.9, Y 0.3, Z 0.1 -> 0.3 0.3 0.3
# source     ImfRgbaFile.cpp, rgbaChannels: a channel named Y means luminance. "Technical Introduction to OpenEXR", CIE
#            XYZ Color: X, Y and Z are the channels of CIE images.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -q libopenexr-dev=3.1.5-5 libopenexr-3-1-30=3.1.5-5 libimath-dev=3.1.6-1 libimath-3-1-29=3.1.6-1 > apt.log 2>&1
for package in *.deb; do dpkg -x "$package" root; done
libraries=$(dirname "$(find root -name 'libOpenEXR-3_1.so' | head -1)")
cat > xyz.cpp <<'CPP'
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>

#include <cstdio>

int main() {
    const float values[3] = {0.9f, 0.3f, 0.1f};
    const char* const names[3] = {"X", "Y", "Z"};
    Imf::Header header(1, 1);
    Imf::FrameBuffer planes;
    for (int c = 0; c < 3; ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        planes.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(&values[c])), 4, 4));
    }
    {
        Imf::OutputFile file("xyz.exr", header);
        file.setFrameBuffer(planes);
        file.writePixels(1);
    }
    Imf::RgbaInputFile file("xyz.exr");
    Imf::Rgba pixel;
    file.setFrameBuffer(&pixel, 1, 1);
    file.readPixels(0, 0);
    std::printf("%.1f %.1f %.1f\n", float(pixel.r), float(pixel.g), float(pixel.b));
}
CPP
g++ -std=c++17 xyz.cpp -o xyz -Iroot/usr/include/OpenEXR -Iroot/usr/include/Imath -Iroot/usr/include \
    -L"$libraries" -lOpenEXR-3_1 -lImath-3_1 -lIlmThread-3_1 -lIex-3_1 -Wl,-rpath,"$folder/$libraries"
seen=$(./xyz)
echo "OpenEXR 3.1.5, RgbaInputFile: X 0.9, Y 0.3, Z 0.1 -> $seen"
[ "$seen" = '0.3 0.3 0.3' ]
