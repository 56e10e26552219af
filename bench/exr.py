"""Reads the scanline OpenEXR files that the program writes: half or float channels, uncompressed or ZIP."""
import struct
import zlib

import numpy

TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
LINES = {0: 1, 2: 1, 3: 16}  # of a block, by compression


def header_of(data):
    """The attributes, (type, bytes) by name, and where they end."""
    if data[:4] != b"\x76\x2f\x31\x01" or struct.unpack_from("<I", data, 4)[0] & ~0x400 != 2:
        raise ValueError("not a scanline OpenEXR file of one part")
    attributes, at = {}, 8
    while data[at]:
        name, kind = data[at:data.index(b"\0", at)], None
        at += len(name) + 1
        kind = data[at:data.index(b"\0", at)]
        at += len(kind) + 1
        size = struct.unpack_from("<I", data, at)[0]
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channels_of(attribute):
    channels, at = [], 0
    while attribute[at]:
        name = attribute[at:attribute.index(b"\0", at)]
        at += len(name) + 1
        channels.append((name.decode(), TYPES[struct.unpack_from("<I", attribute, at)[0]]))
        at += 16
    return channels


def unpacked(block, size, compression):
    if compression == 0 or len(block) == size:
        return block
    # The differences of bytes; first the even, then the odd ones.
    apart = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
    apart[1:] -= 128
    apart = (numpy.cumsum(apart) & 255).astype(numpy.uint8)
    together = numpy.empty_like(apart)
    half = (len(apart) + 1) // 2
    together[0::2], together[1::2] = apart[:half], apart[half:]
    return together.tobytes()


def read(path):
    """Arrays (rows, columns) of float64 by the channels' names."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = header_of(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    compression = attributes["compression"][0]
    channels = channels_of(attributes["channels"])
    line = sum(kind.itemsize for _, kind in channels) * width
    pictures = {name: numpy.empty((height, width)) for name, _ in channels}
    blocks = -(-height // LINES[compression])
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<iI", data, offset)
        rows = min(LINES[compression], bottom + 1 - y)
        block = unpacked(data[offset + 8:offset + 8 + size], rows * line, compression)
        start = 0
        for row in range(y - top, y - top + rows):
            for name, kind in channels:
                pictures[name][row] = numpy.frombuffer(block, kind, width, start)
                start += kind.itemsize * width
    return pictures


def read_rgb(path):
    """(rows, columns, 3)."""
    pictures = read(path)
    return numpy.stack([pictures[c] for c in "RGB"], axis=2)
